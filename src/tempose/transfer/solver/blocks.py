"""A clip solved block by block on several threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from tempose.typing import FloatArray

BLOCK = 16
"""Frames solved together: one entry of the factor is loaded once for all of them."""


def solve_blocks(
    solve: Callable[[slice], FloatArray],
    n_frames: int,
    workers: int,
    receive: Callable[[slice, FloatArray], None],
) -> None:
    """Solve a clip block by block.

    Parameters
    ----------
    solve : callable
        Frames (a slice) to their vertices; called from the threads.
    n_frames : int
        Number of frames.
    workers : int
        Number of threads; the result does not depend on it.
    receive : callable
        Called with each slice and what `solve` made of it, in order, in the calling thread.
    """
    blocks = [slice(t, min(t + BLOCK, n_frames)) for t in range(0, n_frames, BLOCK)]
    if workers <= 1 or len(blocks) <= 1:
        for block in blocks:
            receive(block, solve(block))
        return
    with ThreadPoolExecutor(workers) as pool:
        # a window of pending blocks bounds the memory whatever the length of the clip
        pending = [(b, pool.submit(solve, b)) for b in blocks[: 2 * workers]]
        for following in blocks[2 * workers :] + [None] * len(pending):
            block, future = pending.pop(0)
            receive(block, future.result())
            if following is not None:
                pending.append((following, pool.submit(solve, following)))
