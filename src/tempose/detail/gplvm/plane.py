"""A flat view of the latent space with the variance of residuals as background."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.gplvm.prediction import LatentProcess, squared_distances
from tempose.typing import FloatArray

_MARGIN = 0.15
"""Of the extent of the points, left free around them."""


@dataclass(frozen=True, eq=False)
class LatentPlane:
    """What a plot of the latent space draws."""

    x: FloatArray
    """(size,) coordinates of the columns of cells."""
    y: FloatArray
    """(size,) coordinates of the rows of cells."""
    variance: FloatArray
    """(size, size) row by row; variance of one coordinate of a residual, over that of the training."""
    points: FloatArray
    """(k, 2) frames of the training."""
    queries: FloatArray
    """(Q, 2) further frames."""
    share: float
    """Part of the spread of the latent points that the plane shows."""


def latent_plane(process: LatentProcess, queries: FloatArray | None = None, size: int = 80) -> LatentPlane:
    """Project latent points to their two widest directions and measure the variance around them.

    A cell of the plane stands for the latent point whose other coordinates are those of the frames nearby:
    the mean by their nearness in the plane. With those of the centre instead, frames would lie in the dark.

    Parameters
    ----------
    process : LatentProcess
        With k latent points.
    queries : (Q, q) float, optional
        Further latent points.
    size : int, default 80
        Cells a side.

    Returns
    -------
    LatentPlane
        Cells, points and variances.
    """
    X = process.X
    centre = X.mean(axis=0)
    _, spread, axes = np.linalg.svd(X - centre, full_matrices=False)
    two = np.pad(axes[:2], ((0, max(2 - len(axes), 0)), (0, 0)))
    flat = (X - centre) @ two.T
    shown = np.zeros((0, 2)) if queries is None else (queries - centre) @ two.T
    everything = np.concatenate([flat, shown])
    low, high = everything.min(axis=0), everything.max(axis=0)
    margin = _MARGIN * np.maximum(high - low, 1e-9)
    x, y = (np.linspace(low[i] - margin[i], high[i] + margin[i], size) for i in range(2))
    cells = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    lifted = _lift(cells, flat, X - centre - flat @ two) + cells @ two + centre
    variance = process.variance(lifted, np.zeros(len(lifted))).reshape(size, size)
    share = float((spread[:2] ** 2).sum() / max((spread**2).sum(), 1e-300))
    return LatentPlane(x, y, variance, flat, shown, share)


def _lift(cells: FloatArray, flat: FloatArray, rest: FloatArray) -> FloatArray:
    """Other coordinates of cells, from those of the frames that are near in the plane."""
    squares = squared_distances(cells, flat)
    apart = squared_distances(flat, flat)
    np.fill_diagonal(apart, np.inf)
    width = max(float(np.median(np.sqrt(apart.min(axis=1)))), 1e-12)
    nearness = np.exp(-0.5 * (squares - squares.min(axis=1, keepdims=True)) / width**2)
    return (nearness @ rest) / nearness.sum(axis=1, keepdims=True)
