"""Frames rendered side by side: the compiled parts let go of the interpreter."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


def in_order(
    work: Callable[[Item], Result], items: Iterable[Item], workers: int | None = None
) -> Iterator[Result]:
    """Do a piece of work for each item on a few threads and give the results in the order of the items.

    Parameters
    ----------
    work : callable
        Takes an item.
    items : iterable
        Taken a few at a time, so that results do not pile up.
    workers : int, optional
        Threads; None for one per core, at most four.

    Yields
    ------
    result
        What `work` returned.

    Raises
    ------
    ValueError
        If `workers` is below 1.
    """
    count = min(os.cpu_count() or 1, 4) if workers is None else workers
    if count < 1:
        raise ValueError(f"workers must be at least 1, got {workers}")
    if count == 1:
        yield from map(work, items)
        return
    waiting: deque[Future[Result]] = deque()
    with ThreadPoolExecutor(count) as pool:
        try:
            for item in items:
                waiting.append(pool.submit(work, item))
                if len(waiting) > count:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()
