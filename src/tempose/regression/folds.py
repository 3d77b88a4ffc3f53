"""Contiguous folds: frames next to each other are nearly equal and must not be split at random."""

from __future__ import annotations

import numpy as np

from tempose.typing import IntArray


def blocked_folds(chains: IntArray, n_folds: int = 5, gap: int = 1) -> list[tuple[IntArray, IntArray]]:
    """Cut frames into contiguous blocks, each tested with the rest as training.

    Parameters
    ----------
    chains : (T,) int
        Which clip every frame is from; frames of one clip follow one another.
    n_folds : int, default 5
        Number of blocks.
    gap : int, default 1
        Frames left out of the training on either side of the block.

    Returns
    -------
    list of (train, test)
        Indices of frames, sorted.
    """
    T = len(chains)
    folds: list[tuple[IntArray, IntArray]] = []
    for test in np.array_split(np.arange(T), min(n_folds, T)):
        near = np.zeros(T, dtype=bool)
        near[max(test[0] - gap, 0) : test[-1] + gap + 1] = True
        near &= np.isin(chains, chains[test])
        near[test] = True
        folds.append((np.flatnonzero(~near), test))
    return folds
