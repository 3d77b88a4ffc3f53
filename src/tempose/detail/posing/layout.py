"""Vertices sorted into blocks that few joints move, so that one instruction works on many of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.typing import FloatArray, IntArray

BLOCK = 128
"""Vertices of a block: measured, 64 and 128 are equally fast, 16 and 32 slower."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Which vertex stands where."""

    order: IntArray
    """(n,) int64, the vertex at each place; places are numbered block by block."""
    n_blocks: int
    """Blocks of `BLOCK` places; those past n are empty."""

    def blocks(self, values: Any) -> Any:
        """Sort values a vertex into blocks.

        Parameters
        ----------
        values : (n, c) ndarray
            Numbers of every vertex, of any type.

        Returns
        -------
        (b, c, BLOCK) ndarray
            The same, each number of a block side by side; zero in empty places.
        """
        padded = np.zeros((self.n_blocks * BLOCK, values.shape[1]), values.dtype)
        padded[: len(self.order)] = values[self.order]
        cut = padded.reshape(self.n_blocks, BLOCK, -1)
        return np.ascontiguousarray(cut.transpose(0, 2, 1))

    def flat(self, values: FloatArray) -> FloatArray:
        """Undo `blocks`.

        Parameters
        ----------
        values : (b, c, BLOCK) float
            Numbers in blocks.

        Returns
        -------
        (n, c) ndarray
            Numbers of every vertex.
        """
        n = len(self.order)
        result = np.zeros((n, values.shape[1]), values.dtype)
        result[self.order] = values.transpose(0, 2, 1).reshape(-1, values.shape[1])[:n]
        return result


@dataclass(frozen=True, eq=False)
class BlockWeights:
    """Rows of weights: of every block the columns that are not zero there, filled up to fours."""

    starts: IntArray
    """(b + 1,) int32, where the columns of each block begin."""
    columns: IntArray
    """(c,) int32, joint or region."""
    values: FloatArray
    """(c, BLOCK) weights of that column."""


def sorted_layout(weights: FloatArray) -> Layout:
    """Put vertices together that the same joints move.

    Parameters
    ----------
    weights : (n, J) float
        Skin weights.

    Returns
    -------
    Layout
        Sorted by the joint of greatest weight, then the next two.
    """
    n = len(weights)
    leading = np.argsort(-weights, axis=1, kind="stable")[:, :3].T
    return Layout(np.lexsort(leading[::-1]), -(-n // BLOCK))


def block_weights(layout: Layout, weights: FloatArray, dtype: type = np.float32) -> BlockWeights:
    """Sort weights into blocks.

    Parameters
    ----------
    layout : Layout
        Blocks of n vertices.
    weights : (n, J) float
        Weights of joints or shares of regions.
    dtype : type, default float32
        Of the result.

    Returns
    -------
    BlockWeights
        Sorted weights.
    """
    blocks = layout.blocks(np.asarray(weights, dtype=dtype))
    used = (blocks != 0).any(axis=2)
    counts = 4 * -(-np.maximum(used.sum(axis=1), 1) // 4)
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    columns = np.zeros(starts[-1], np.int32)
    values = np.zeros((starts[-1], BLOCK), dtype)
    for b, start in enumerate(starts[:-1]):
        own = np.flatnonzero(used[b])
        columns[start : start + len(own)] = own
        values[start : start + len(own)] = blocks[b, own]
    return BlockWeights(starts, columns, values)
