"""Principal components of data that does not fit into memory, read in a few passes over blocks of rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.typing import FloatArray, Progress, silent

Blocks = Callable[[], Iterable[FloatArray]]
"""Called once for each pass: the rows from the first to the last, (k, d) at a time, the same every time."""

OVERSAMPLING = 10
"""Directions looked at beyond those that are kept: the last few of a sketch are not yet principal."""

FIRST_SKETCH = 48
"""Directions of the first sketch when a tolerance, not a number of components, is asked for."""


@dataclass(frozen=True, eq=False)
class StreamedPca:
    """Principal components, and how much of the data they leave out."""

    mean: FloatArray
    """(d,) mean of the rows."""
    components: FloatArray
    """(m, d) orthonormal rows, the most energy first."""
    coordinates: FloatArray
    """(T, m) of the rows in the components."""
    singular_values: FloatArray
    """(m,) falling: the square root of the energy of each component."""
    spectrum: FloatArray
    """(s,) the same of all directions of the sketch, s >= m; the last few are too small."""
    left_out: FloatArray
    """(T,) squared length of each row outside the components."""
    total: float
    """Sum of the squares of all centred rows."""
    residual: float
    """The part of `total` outside the components: measured, not a bound, down to 1e-15 of it."""
    n_passes: int
    """How often the rows were read."""

    @property
    def rms(self) -> float:
        """Root mean square over the rows of the length that is left out."""
        return math.sqrt(self.residual / len(self.coordinates))


def streamed_pca(
    blocks: Blocks,
    d: int,
    m: int | None = None,
    *,
    tolerance: float | None = None,
    power_passes: int = 0,
    seed: int = 0,
    progress: Progress = silent,
) -> StreamedPca:
    """Find the principal components of rows that are read block by block.

    Memory is that of a block and of a few matrices (m + 10, d); time grows linearly with the rows.

    Parameters
    ----------
    blocks : callable
        Returns the blocks (k, d) of the rows, anew for each pass.
    d : int
        Length of a row.
    m : int, optional
        Number of components, 0 or more; fewer come back where the data has fewer.
    tolerance : float, optional
        Instead of `m`: the largest allowed root mean square, over the rows, of the length left out. The
        sketch grows until it is met, for 0 until all is found; none comes back if the mean alone meets it.
    power_passes : int, default 0
        Further passes that turn the sketch towards the true components: for spectra that fall slowly.
    seed : int, default 0
        Of the random directions.
    progress : Progress, optional
        Told how many rows each pass has read.

    Returns
    -------
    StreamedPca
        The same for the same rows and seed, whatever their blocks, up to rounding.

    Raises
    ------
    ValueError
        If not exactly one of `m` and `tolerance` is given or it is negative, there are fewer than two
        rows, a row has another length or holds NaN, or two passes differ.

    Notes
    -----
    The sketch is ``orth(Z^T Z Omega)``, one product with ``Z^T`` more than the plain range finder of [1]_,
    out of the same pass; a second pass projects the rows onto it, and the components are exact inside it.

    References
    ----------
    .. [1] Halko, Martinsson and Tropp, "Finding Structure with Randomness: Probabilistic Algorithms for
       Constructing Approximate Matrix Decompositions", SIAM Review 53, 2011.
    """
    _check(d, m, tolerance, power_passes)
    stream = _Stream(blocks, d, progress)
    random = np.random.default_rng(seed)
    V = np.zeros((d, 0))
    X = np.zeros((0, 0))
    width = FIRST_SKETCH if m is None else m + OVERSAMPLING
    while True:
        fresh = stream.sketch(random.standard_normal((d, min(width, d - V.shape[1]))), V)
        for _ in range(power_passes):
            fresh = stream.sketch(fresh, V)
        fresh = fresh[:, : max(stream.n_rows - 1 - V.shape[1], 1)]
        V, X = np.hstack([V, fresh]), np.hstack([X.reshape(stream.n_rows, -1), stream.project(fresh)])
        s, turn = _principal(X)
        if m is None:
            left = stream.total - np.append(0.0, np.cumsum(s**2))
            allowed = stream.n_rows * (tolerance or 0.0) ** 2
            enough = min(int(np.count_nonzero(left > allowed)), len(s))
        else:
            enough = m
        complete = V.shape[1] >= min(d, stream.n_rows - 1) or len(s) < V.shape[1]
        if m is not None or complete or enough + OVERSAMPLING <= V.shape[1]:
            return _result(stream, V, X, s, turn[:, :enough])
        width = V.shape[1]


class _Stream:
    """Rows read in passes; the first one that runs through finds their number, mean and energy."""

    def __init__(self, blocks: Blocks, d: int, progress: Progress) -> None:
        self.blocks, self.d, self.progress = blocks, d, progress
        self.n_rows, self.n_passes, self.total = 0, 0, 0.0
        self.mean: FloatArray = np.zeros(d)
        self.squares: FloatArray = np.zeros(0)

    def sketch(self, directions: FloatArray, known: FloatArray) -> FloatArray:
        """Return an orthonormal basis of ``Z^T Z directions``, orthogonal to what is known."""
        W = np.zeros_like(directions)
        shift = self.mean
        total, count, moment = 0.0, 0, np.zeros(self.d)
        for block in self._rows():
            # before the mean is known the first rows' stands in for it: what it is off is taken out below
            shift = block.mean(axis=0) if count + self.n_passes == 0 else shift
            Z = block - shift
            W += Z.T @ (Z @ directions)
            total += float(np.vdot(Z, Z))
            moment += Z.sum(axis=0)
            count += len(Z)
        if count < 2:
            raise ValueError(f"blocks must hold at least two rows, got {count}")
        if self.n_passes == 1:
            off = moment / count
            W -= count * np.outer(off, off @ directions)
            self.n_rows, self.mean, self.total = count, shift + off, total - count * float(off @ off)
        return _orthonormal(W, known)

    def project(self, V: FloatArray) -> FloatArray:
        """Return the coordinates (T, s) of the rows in orthonormal columns."""
        coordinates: list[FloatArray] = []
        squares: list[FloatArray] = []
        for block in self._rows():
            Z = block - self.mean
            coordinates.append(Z @ V)
            squares.append(np.einsum("td,td->t", Z, Z))
        self.squares = np.concatenate(squares)
        return np.concatenate(coordinates)

    def _rows(self) -> Iterator[FloatArray]:
        done, stage = 0, f"principal components, pass {self.n_passes + 1}"
        for block in self.blocks():
            rows = as_floats(block, "blocks", ("k", self.d))
            if len(rows) == 0:
                continue
            done += len(rows)
            yield rows
            self.progress(done, self.n_rows, stage)
        self.n_passes += 1
        if self.n_rows and done != self.n_rows:
            raise ValueError(
                f"blocks must give the same rows every time, got {self.n_rows} rows, then {done}: "
                "pass a function that starts anew, not an iterator"
            )


def _orthonormal(W: FloatArray, known: FloatArray) -> FloatArray:
    # twice: what the first projection leaves along the known directions is rounding made large by the scaling
    Q = np.linalg.qr(W - known @ (known.T @ W))[0]
    return np.linalg.qr(Q - known @ (known.T @ Q))[0] if known.shape[1] else Q


def _principal(X: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the singular values of coordinates (T, s), falling, and the turn (s, r) to their own axes."""
    w, U = np.linalg.eigh(X.T @ X)
    w, U = w[::-1], U[:, ::-1]
    n_kept = max(int(np.count_nonzero(w > 1e-13 * max(w[0], 0.0))), 1)
    return np.sqrt(np.maximum(w[:n_kept], 0.0)), U[:, :n_kept]


def _result(stream: _Stream, V: FloatArray, X: FloatArray, s: FloatArray, turn: FloatArray) -> StreamedPca:
    m = turn.shape[1]
    coordinates = X @ turn
    return StreamedPca(
        mean=stream.mean,
        components=np.ascontiguousarray((V @ turn).T),
        coordinates=coordinates,
        singular_values=s[:m],
        spectrum=s,
        left_out=np.maximum(stream.squares - np.square(coordinates).sum(axis=1), 0.0),
        total=stream.total,
        residual=max(stream.total - float(s[:m] @ s[:m]), 0.0),
        n_passes=stream.n_passes,
    )


def _check(d: int, m: int | None, tolerance: float | None, power_passes: int) -> None:
    if (m is None) == (tolerance is None):
        raise ValueError(f"give either m or tolerance, got m {m} and tolerance {tolerance}")
    if m is not None and m < 0:
        raise ValueError(f"m must not be negative, got {m}")
    if tolerance is not None and not 0 <= tolerance < math.inf:
        raise ValueError(f"tolerance must not be negative, got {tolerance}")
    if d < 1 or power_passes < 0:
        raise ValueError(
            f"d must be at least 1 and power_passes not negative, got d {d} and power_passes {power_passes}"
        )
