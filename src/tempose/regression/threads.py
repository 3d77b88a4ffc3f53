"""Dense algebra of small matrices on one thread."""

from __future__ import annotations

from threadpoolctl import threadpool_limits


def one_blas_thread() -> threadpool_limits:
    """Hold the algebra libraries to one thread inside a ``with`` block.

    Several threads wait for each other on matrices of a few hundred rows: steps took 4 to 60 times as long.

    Returns
    -------
    context manager
        Restores the former number of threads when left.

    Examples
    --------
    >>> with one_blas_thread():
    ...     pass
    """
    return threadpool_limits(limits=1, user_api="blas")
