"""The factor of a sparse positive definite matrix as dense blocks."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose.linalg.block_solve import backward_4, forward_4, solve_8
from tempose.linalg.multifrontal import factor_fronts
from tempose.linalg.ordering import nested_dissection
from tempose.linalg.symbolic import (
    WIDEST,
    column_counts,
    elimination_tree,
    padded_rows,
    postorder,
    supernode_rows,
    supernodes,
)
from tempose.typing import FloatArray, IntArray

SIDES = 48
"""Right-hand sides solved together: more do not fit the cache, fewer load the factor more often."""


@dataclass(frozen=True)
class BlockFactor:
    """Block ``L D L^T`` of a matrix, its unknowns reordered; how it is stored says `block_solve`."""

    permutation: IntArray
    """(n,) int: row of the factor that belongs to each unknown."""
    first: IntArray
    """(s + 1,) int: first column of every supernode."""
    own: IntArray
    """(s + 1,) int: where the rows of each begin."""
    below: IntArray
    """(s,) int: where those of its panel begin."""
    rows: IntArray
    """(own[-1],) int."""
    place: IntArray
    """(s + 1,) int: where the blocks of each begin."""
    blocks: FloatArray
    """(place[-1],) float64 or float32."""
    least_pivot: float
    """Smallest pivot as a share of its diagonal entry; not positive where the matrix is not definite."""

    def astype(self, dtype: Any) -> BlockFactor:
        """Round the factor to another precision.

        Parameters
        ----------
        dtype : type
            ``numpy.float32`` or ``numpy.float64``.

        Returns
        -------
        BlockFactor
            The same factor, its solves in that precision.
        """
        return replace(self, blocks=self.blocks.astype(dtype))

    def solve_rows(self, X: FloatArray) -> None:
        """Solve in place for right-hand sides already in the order of the factor.

        Parameters
        ----------
        X : (n + 1, k) ndarray, C-contiguous, of the factor's precision
            Row ``permutation[i]`` belongs to unknown i, the last row is zero; k is 4 or a multiple of 8.
        """
        k = X.shape[1]
        factor = (self.first, self.own, self.below, self.rows, self.place, self.blocks)
        scratch = np.zeros(k * WIDEST, dtype=X.dtype)
        if k == 4:
            count = len(self.below)
            forward_4(*factor, X.reshape(-1), 0, count)
            backward_4(*factor, X.reshape(-1), scratch, 0, count)
        else:
            solve_8(*factor, X.reshape(-1), scratch, k)

    def solve(self, b: FloatArray) -> FloatArray:
        """Solve for any number of right-hand sides in the order of the unknowns.

        Parameters
        ----------
        b : (n, k) float
            Right-hand sides in columns.

        Returns
        -------
        (n, k) ndarray
            Solutions.
        """
        n, k = b.shape
        x = np.zeros((n, k))
        for c in range(0, k, SIDES):
            part = b[:, c : c + SIDES]
            wide = 4 if part.shape[1] <= 4 else -(-part.shape[1] // 8) * 8
            X = np.zeros((n + 1, wide), dtype=self.blocks.dtype)
            X[self.permutation, : part.shape[1]] = part
            self.solve_rows(X)
            x[:, c : c + SIDES] = X[self.permutation, : part.shape[1]]
        return x


def block_factor(A: Any, order: IntArray | None = None) -> BlockFactor:
    """Factor a symmetric positive definite matrix.

    Parameters
    ----------
    A : (n, n) sparse array
        Both triangles stored.
    order : (n,) int, optional
        Order of elimination; nested dissection if not given.

    Returns
    -------
    BlockFactor
        In float64.
    """
    A = sp.csr_array(A)
    order = nested_dissection(A) if order is None else order
    parent, counts, after = _tree(_reordered(A, order))
    order = order[after]
    B = _reordered(A, order)
    indptr, indices = B.indptr, B.indices
    first = supernodes(parent, counts)
    start, rows, above = supernode_rows(indptr, indices, counts, first)
    own, below, padded, place = padded_rows(first, start, rows)
    blocks = np.zeros(place[-1])
    least = factor_fronts(indptr, indices, B.data, first, start, rows, above, own, below, place, blocks)
    permutation = np.zeros(len(order), dtype=np.int64)
    permutation[order] = np.arange(len(order))
    return BlockFactor(permutation, first, own, below, padded, place, blocks, float(least))


def _reordered(A: Any, order: IntArray) -> Any:
    B = A[order][:, order]
    B.sort_indices()
    return B


def _tree(B: Any) -> tuple[IntArray, IntArray, IntArray]:
    """Elimination tree and column counts in postorder, and that order."""
    parent = elimination_tree(B.indptr, B.indices)
    counts = column_counts(B.indptr, B.indices, parent)
    after = postorder(parent)
    place = np.zeros(len(after) + 1, dtype=np.int64)
    place[after] = np.arange(len(after))
    place[-1] = -1
    return place[parent[after]], counts[after], after
