"""The shape signal of a clip, and how much of the clip it leaves out (section 3.1 of the paper)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tempose.linalg.pca import GramPCA
from tempose.shape_spaces import ShapeSpace
from tempose.signals.shape.examples import orthonormal_basis, shape_coordinates, shape_from_examples
from tempose.signals.shape.signal import ShapeSignal
from tempose.typing import FloatArray, IntArray

CHECKED = 24
"""Frames decoded to see what a distance of the shape space means in vertices..."""

CHECKED_SLOW = {"edge-dihedral": 6, "rotation-invariant": 12}
"""...and in spaces where a mesh that is no frame takes long to decode."""

_CERTAIN = 1e-5
"""Part of the largest singular value down to which the Gram matrix of the frames knows them well."""

Percent = Callable[[FloatArray, IntArray], float]
"""Encoded frames (c, d) and the numbers (c,) of the frames they stand for, to rms percent of the diagonal."""


@dataclass(frozen=True, eq=False)
class FittedShape:
    """The shape signal and the clip in its coordinates."""

    shape: ShapeSignal
    """h."""
    X: FloatArray
    """(T, m) shape coordinates of the frames."""
    turn: FloatArray | None
    """(m, m) L: ``|x L|`` is a distance of the shape space; None where x itself is orthonormal."""
    left_out: FloatArray
    """(T,) squared distance of each frame to the subspace."""
    spectrum: FloatArray
    """(r,) root of the squared sum along each principal component, descending; all that were looked at."""
    scale: float
    """Rms percent of the diagonal for each root of a squared sum over all frames and coordinates."""

    @property
    def straight(self) -> FloatArray:
        """(T, m) coordinates in an orthonormal basis."""
        return self.X if self.turn is None else self.X @ self.turn

    def percent(self, squares: FloatArray | float) -> FloatArray:
        """Turn squared sums in the shape space into rms percent of the diagonal.

        Parameters
        ----------
        squares : (...) float
            Sums over all frames of squared distances.

        Returns
        -------
        (...) ndarray
            Percent.
        """
        return self.scale * np.sqrt(np.asarray(squares))


def fit_shape(
    space: ShapeSpace, Z: FloatArray, m: int | None, limit: float, unit: float, check: Percent | None = None
) -> FittedShape:
    """Find the principal components of a clip, as many as a tolerance asks for.

    Parameters
    ----------
    space : ShapeSpace
        Where the meshes live.
    Z : (T, d) float
        Encoded frames.
    m : int or None
        Number of components; None takes the smallest that meets `limit`.
    limit : float
        Largest error, rms percent of the diagonal.
    unit : float
        Percent for the root of a squared sum, where coordinates are vertices.
    check : callable, optional
        Measures decoded frames, where they are not.

    Returns
    -------
    FittedShape
        h and the coordinates.
    """
    pca = GramPCA(Z)
    scale = unit
    if check is None:
        chosen = _by_spread(pca, limit / unit) if m is None else pca.at_most(m)
    else:
        chosen, scale = _by_decoding(space, pca, m, limit, check)
    shape = ShapeSignal(space, pca.mean, pca.components(chosen))
    X, left_out = pca.coordinates(chosen), pca.left_out(chosen)
    return FittedShape(shape, X, None, left_out, pca.spread, scale)


def _by_spread(pca: GramPCA, limit: float) -> int:
    s = pca.spread if limit > _CERTAIN * pca.spread[0] else pca.singular_values
    beyond = np.append(np.cumsum(np.square(s)[::-1])[::-1], 0.0)
    return int(np.argmax(np.sqrt(beyond) <= limit))


def _by_decoding(
    space: ShapeSpace, pca: GramPCA, m: int | None, limit: float, check: Percent
) -> tuple[int, float]:
    """Bisect for the least m whose decoded frames meet the limit; what a unit of the space is in percent."""
    X, H = pca.coordinates(pca.rank), pca.components(pca.rank)
    beyond = np.append(np.cumsum(np.square(pca.singular_values)[::-1])[::-1], 0.0)
    frames = checked_frames(len(X), space.name)
    found: dict[int, float] = {}

    def percent(count: int) -> float:
        if count not in found:
            found[count] = check(pca.mean + X[frames, :count] @ H[:count], frames)
        return found[count]

    low, high = (-1, pca.rank) if m is None else (min(m, pca.rank) - 1, min(m, pca.rank))
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if percent(middle) <= limit else (middle, high)
    at = high if beyond[high] > 1e-12 * beyond[0] else pca.rank // 2
    outside = float(np.square(X[frames, at:]).sum()) * len(X) / len(frames)
    return high, percent(at) / np.sqrt(outside) if outside > 0 else 0.0


def fit_examples(space: ShapeSpace, Z: FloatArray, Q: FloatArray, unit: float) -> FittedShape:
    """Express a clip by example poses (section 4.3).

    Parameters
    ----------
    space : ShapeSpace
        Where the meshes live.
    Z : (T, d) float
        Encoded frames.
    Q : (m + 1, d) float
        Encoded examples, the reference pose first.
    unit : float
        Percent for the root of a squared sum.

    Returns
    -------
    FittedShape
        h and the coordinates.

    Raises
    ------
    ValueError
        If the examples are not independent.
    """
    shape = shape_from_examples(space, Q)
    X = shape_coordinates(shape, Z)
    left_out = np.square(Z - shape.mean - X @ shape.components).sum(axis=1)
    spectrum = GramPCA(Z).singular_values
    return FittedShape(shape, X, orthonormal_basis(shape), left_out, spectrum[spectrum > 0], unit)


def rescaled(fitted: FittedShape, check: Percent) -> FittedShape:
    """Measure by decoding what a unit of the shape space is in percent.

    Parameters
    ----------
    fitted : FittedShape
        A shape signal whose scale is not known.
    check : callable
        Measures decoded frames.

    Returns
    -------
    FittedShape
        The same with its scale.
    """
    frames, T = checked_frames(len(fitted.X), fitted.shape.space.name), len(fitted.X)
    Z = fitted.X[frames] @ fitted.shape.components
    size, outside = float(np.square(Z).sum()), float(fitted.left_out[frames].sum())
    if outside < 1e-6 * size:  # the subspace holds the clip: look at a tenth less of its motion instead
        Z, outside = 0.9 * Z, outside + 0.01 * size
    found = check(fitted.shape.mean + Z, frames)
    return replace(fitted, scale=found / np.sqrt(outside * T / len(frames)) if outside > 0 else 0.0)


def checked_frames(T: int, space: str = "gradient") -> IntArray:
    """Choose the frames whose decoded vertices are looked at.

    Parameters
    ----------
    T : int
        Frames of the clip.
    space : str, optional
        Name of the shape space: fewer where decoding is slow.

    Returns
    -------
    (c,) ndarray of int
        Evenly spread, both ends among them.
    """
    return np.unique(np.linspace(0, T - 1, min(T, CHECKED_SLOW.get(space, CHECKED))).round().astype(np.int64))
