"""A plane through what a learner knows of motions, and how sure it is at every place of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.learners.latent_predictor import LatentPredictor
from tempose.detail.training import Inputs, Predictor
from tempose.typing import FloatArray, IntArray

_MARGIN = 0.35
"""Share of the extent of the frames that is shown around them."""
_NEAR = 0.12
"""Share of the extent over which frames lend a place what the plane leaves out."""


@dataclass(frozen=True, eq=False)
class LatentPlane:
    """Two directions in which motion varies most, and the spread of predictions over them."""

    points: FloatArray
    """(k, 2) where the frames of the training lie."""
    chains: IntArray
    """(k,) which clip every frame is from."""
    x: FloatArray
    """(w,) places of the map, ascending."""
    y: FloatArray
    """(h,) places of the map, ascending."""
    spread: FloatArray
    """(h, w) root mean square of the predicted error of a coordinate, metres."""
    share: float
    """Part of the variance of the motion that the plane shows, 0 to 1."""
    latent: bool
    """Whether the directions are those of a latent space, else of angles and velocities."""


def latent_plane(
    predictor: Predictor, inputs: Inputs, sizes: FloatArray, resolution: int = 44
) -> LatentPlane:
    """Lay a plane through the frames of a training and ask a learner how sure it is there.

    Parameters
    ----------
    predictor : Predictor
        A fitted learner; one with a latent space shows that.
    inputs : Inputs
        The T frames of its training.
    sizes : (R,) float
        Coordinates of each region, for the mean over the body.
    resolution : int, default 44
        Places of the map along the longer side.

    Returns
    -------
    LatentPlane
        Frames and map.

    Notes
    -----
    A place of the plane leaves all other directions open. They are filled as the frames nearby have them, so
    that the map is small along the path of the motion and grows away from it.
    """
    if isinstance(predictor, LatentPredictor) and predictor.process is not None:
        return _of_latent(predictor, inputs.chains, resolution)
    Z = _columns(inputs)
    mean = Z.mean(axis=0)
    _, s, Vt = np.linalg.svd(Z - mean, full_matrices=False)
    axes = np.zeros((2, Z.shape[1]))
    axes[: min(2, len(Vt))] = Vt[:2]
    points = (Z - mean) @ axes.T
    x, y = _grid(points, resolution)
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    full = mean + places @ axes + _left_out(places, points, Z - mean - points @ axes)
    variance = predictor.mix(_inputs(full, inputs)).variance
    share = sizes / sizes.sum() if variance.shape[1] == len(sizes) else np.ones(1)
    spread = np.sqrt(np.maximum(variance @ share, 0.0)).reshape(len(y), len(x))
    shown = float((s[:2] ** 2).sum() / max(float((s**2).sum()), 1e-300))
    return LatentPlane(points, inputs.chains, x, y, spread, shown, False)


def _of_latent(predictor: LatentPredictor, chains: IntArray, resolution: int) -> LatentPlane:
    found = predictor.plane(size=resolution)
    spread = np.sqrt(predictor.basis.variance * np.maximum(found.variance, 0.0))
    kept = chains[predictor.basis.frames]
    return LatentPlane(found.points, kept, found.x, found.y, spread, found.share, True)


def _columns(inputs: Inputs) -> FloatArray:
    """(T, P) angles and velocities, each block with the same total variance."""
    T = len(inputs)
    blocks = [inputs.angles.reshape(T, -1), inputs.velocity.reshape(T, -1)]
    return np.column_stack([block / _scale(block) for block in blocks])


def _scale(block: FloatArray) -> float:
    return float(np.sqrt(np.square(block - block.mean(axis=0)).sum(axis=1).mean())) or 1.0


def _inputs(Z: FloatArray, like: Inputs) -> Inputs:
    """Read columns as `_columns` wrote them; every place is a chain of its own."""
    T, K = len(like), like.angles.shape[1]
    blocks = np.split(Z, [3 * K], axis=1)
    scales = [_scale(block.reshape(T, -1)) for block in (like.angles, like.velocity)]
    angles, velocity = (b * s for b, s in zip(blocks, scales))
    extra = np.tile(like.extra.mean(axis=0), (len(Z), 1))
    shape = (len(Z), K, 3)
    return Inputs(angles.reshape(shape), velocity.reshape(shape), extra, np.arange(len(Z)), like.joints)


def _grid(points: FloatArray, resolution: int) -> tuple[FloatArray, FloatArray]:
    low, high = points.min(axis=0), points.max(axis=0)
    side = max(float((high - low).max()), 1e-9)
    grow = np.maximum(_MARGIN * side / 2, (0.5 * side - (high - low)) / 2)
    low, high = low - grow, high + grow
    step = float((high - low).max()) / max(resolution - 1, 1)
    x, y = (np.linspace(a, b, max(round((b - a) / step) + 1, 2)) for a, b in zip(low, high))
    return x, y


def _left_out(places: FloatArray, points: FloatArray, rest: FloatArray) -> FloatArray:
    """Return what frames near to each place have in the directions that the plane leaves out."""
    width = _NEAR * max(float(np.ptp(points, axis=0).max()), 1e-12)
    distances = np.square(places[:, None] - points).sum(axis=-1) / (2 * width**2)
    near = np.exp(distances.min(axis=1, keepdims=True) - distances)
    return near / near.sum(axis=1, keepdims=True) @ rest
