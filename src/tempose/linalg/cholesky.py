"""One interface for sparse symmetric positive definite systems, three ways behind it."""

from __future__ import annotations

import importlib.util
import warnings
from typing import Any, Literal

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from tempose.linalg.block_factor import BlockFactor, block_factor
from tempose.typing import FloatArray, IntArray

Backend = Literal["numba", "splu", "cholespy"]
_BLOCK = 96


class SparseCholesky:
    """Factorise a sparse matrix once, then solve for any number of right-hand sides.

    Parameters
    ----------
    A : (n, n) sparse array
        Symmetric positive definite; both triangles stored.
    backend : {"numba", "splu", "cholespy"}, default "numba"
        ``"numba"``: our own, nested dissection and dense blocks; ``"splu"``: SuperLU, slower;
        ``"cholespy"``: CHOLMOD, where that package is installed. The results agree to rounding.
    order : (n,) int, optional
        Order of elimination for backend "numba"; found by `nested_dissection` if not given.

    Raises
    ------
    ValueError
        If A is not square, not symmetric or not positive definite; the message says what to do.
    ImportError
        If cholespy was asked for and is not installed.

    Examples
    --------
    >>> A = sp.csc_array(np.array([[4.0, 1.0], [1.0, 3.0]]))
    >>> SparseCholesky(A).solve(np.array([1.0, 2.0])).round(6).tolist()
    [0.090909, 0.636364]
    """

    def __init__(self, A: Any, backend: Backend = "numba", *, order: IntArray | None = None) -> None:
        A = sp.csc_array(A, dtype=np.float64)
        _check_symmetric(A)
        self.n = int(A.shape[0])
        self.backend: Backend = backend
        if backend == "cholespy":
            self._factor_cholespy(A)
        elif backend == "splu":
            self._factor_splu(A)
        elif backend == "numba":
            self.factor: BlockFactor = block_factor(A, order)
            self._check_pivots(self.factor.least_pivot)
        else:
            raise ValueError(f"backend must be 'numba', 'splu' or 'cholespy', got {backend!r}")

    def _check_pivots(self, least: float) -> None:
        # what elimination leaves of a singular matrix is rounding error of either sign
        if not least > 10 * self.n * np.finfo(float).eps:
            raise ValueError(_not_definite(f"smallest pivot {least:.3g} of its diagonal entry"))

    def _factor_splu(self, A: Any) -> None:
        options = {"SymmetricMode": True}
        try:
            # relaxed supernodes (the default) made one ordering of a geodesic sphere 30 times slower
            lu = splu(A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, relax=1, options=options)
        except RuntimeError as error:
            raise ValueError(_not_definite(f"SuperLU: {error}")) from None
        share = lu.U.diagonal()[lu.perm_c] / np.maximum(A.diagonal(), 1e-300)
        self._check_pivots(float(share.min()) if np.array_equal(lu.perm_r, lu.perm_c) else -1.0)
        self._lu = lu

    def _factor_cholespy(self, A: Any) -> None:
        if importlib.util.find_spec("cholespy") is None:
            raise ImportError("backend 'cholespy' needs the package cholespy: pip install cholespy")
        from cholespy import CholeskySolverD, MatrixType  # pyright: ignore

        coo = A.tocoo()
        try:
            self._solver = CholeskySolverD(self.n, coo.row, coo.col, coo.data, MatrixType.COO)
        except ValueError as error:
            raise ValueError(_not_definite(f"CHOLMOD: {error}")) from None
        # its pivots are out of reach: an answer far larger than the question betrays a singular matrix
        unit = np.sqrt(np.abs(A.diagonal()))
        growth = np.abs(unit * self.solve(unit)).max()
        if not growth < 1e13:
            raise ValueError(_not_definite(f"condition number over {growth:.3g}"))

    def solve(self, b: FloatArray) -> FloatArray:
        """Solve ``A x = b``.

        Parameters
        ----------
        b : (n,) or (n, k) float
            Right-hand sides in columns.

        Returns
        -------
        (n,) or (n, k) ndarray
            Solutions.

        Raises
        ------
        ValueError
            If `b` has another number of rows.
        """
        b = np.asarray(b, dtype=np.float64)
        if b.ndim not in (1, 2) or b.shape[0] != self.n:
            raise ValueError(f"b must have shape ({self.n},) or ({self.n}, k), got {b.shape}")
        return self._solve_columns(b.reshape(self.n, -1)).reshape(b.shape)

    def _solve_columns(self, b: FloatArray) -> FloatArray:
        if self.backend == "numba":
            return self.factor.solve(b)
        x = np.zeros(b.shape)
        for c in range(0, b.shape[1], _BLOCK):
            part = b[:, c : c + _BLOCK]
            if self.backend == "splu":
                x[:, c : c + _BLOCK] = self._lu.solve(np.asfortranarray(part))
            else:
                found = np.zeros(part.shape)
                self._solver.solve(np.ascontiguousarray(part), found)
                x[:, c : c + _BLOCK] = found
        return x


def _check_symmetric(A: Any) -> None:
    if A.shape[0] != A.shape[1]:
        raise ValueError(f"A must be square, got shape {A.shape}")
    if A.shape[0] == 0:
        raise ValueError("A must have at least one row, got none")
    if not np.isfinite(A.data).all():
        raise ValueError("A must be finite, found NaN or infinity; look for degenerate faces")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sp.SparseEfficiencyWarning)
        difference = abs(A - A.T).max()
    if difference > 1e-9 * max(abs(A).max(), 1e-300):
        raise ValueError(f"A must be symmetric, got |A - A^T| up to {difference:.3g}")


def _not_definite(found: str) -> str:
    return (
        f"A is not positive definite ({found}); hold at least one vertex of every connected component "
        "and remove degenerate faces"
    )
