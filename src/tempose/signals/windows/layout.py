"""The pose plane of a long clip: key frames first, then every frame among them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from tempose._validate import as_floats, read_only
from tempose.signals.pose.layout import PoseLayout
from tempose.signals.pose.pins import Pins
from tempose.signals.windows._near_keys import place_each
from tempose.signals.windows.key_frames import key_frames
from tempose.typing import FloatArray, IntArray, Progress, silent

KEYS = 300
"""Key frames of a long clip; more change the stress in the third digit."""

_BLOCK = 2000


@dataclass(frozen=True, eq=False)
class LongLayout:
    """Where the frames of a long clip lie in the pose plane."""

    positions: FloatArray
    """(T, 2) places of all frames; those of pinned frames are bit for bit the places asked for."""
    keys: IntArray
    """(c,) key frames, ascending."""
    stress: float
    """As `LayoutResult.stress`, over the pairs of a frame and a key frame."""
    converged: bool
    """Whether the layout of the key frames is."""
    warnings: tuple[str, ...] = ()
    """What the pins ask for that cannot be, with its measure."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", read_only(self.positions))
        object.__setattr__(self, "keys", read_only(self.keys))


def long_layout(
    X: FloatArray, keys: int = KEYS, pins: Pins | None = None, progress: Progress = silent
) -> LongLayout:
    """Lay out the frames of a clip in time linear in their number.

    Key frames that stand for all poses are laid out by multidimensional scaling. Then every other frame is
    put where its distances to the key frames are nearest to those of the poses. Its place depends on its pose
    alone: poses that come back, however much later, come to lie in the same place.

    Parameters
    ----------
    X : (T, m) float
        Shape coordinates of the frames.
    keys : int, default 300
        Number of key frames. With as many as frames it is plain scaling.
    pins : mapping of int to (2,) float, optional
        Frames that the user keeps at places; they are key frames.
    progress : Progress, optional
        Told how many frames have their places.

    Returns
    -------
    LongLayout
        The places, and how well distances there are those between poses.

    Raises
    ------
    ValueError
        If `X` is not finite, there are fewer than 3 keys, or the pins contradict the poses.

    Notes
    -----
    A frame is placed by the iteration of SMACOF [1]_ for a single free point and unit weights. Layouts of
    single windows, aligned where they overlap, are no better inside a window and put poses that come back
    later elsewhere.

    References
    ----------
    .. [1] Borg and Groenen, "Modern Multidimensional Scaling", second edition, Springer, 2005.
    """
    X = as_floats(X, "X", ("T", "m"))
    if keys < min(3, len(X)):
        raise ValueError(f"keys must be at least 3, got {keys}")
    pins = dict(pins or {})
    for frame in pins:
        if not 0 <= frame < len(X):
            raise ValueError(f"pins must name frames 0 to {len(X) - 1}, got {frame!r}")
    chosen = key_frames(X, keys, np.array(sorted(pins), dtype=np.int64))
    at = {int(np.searchsorted(chosen, frame)): place for frame, place in pins.items()}
    found = PoseLayout(cdist(X[chosen], X[chosen])).solve(at)
    if len(chosen) == len(X):
        return LongLayout(found.positions, chosen, found.stress, found.converged, found.warnings)
    P, stress = place_frames(X, X[chosen], found.positions, progress)
    P[chosen] = found.positions
    return LongLayout(P, chosen, stress, found.converged, found.warnings)


def place_frames(
    X: FloatArray, X_keys: FloatArray, P_keys: FloatArray, progress: Progress = silent
) -> tuple[FloatArray, float]:
    """Find places for poses among poses that have places.

    Parameters
    ----------
    X : (T, m) float
        Poses.
    X_keys : (c, m) float
        Poses that have places...
    P_keys : (c, 2) float
        ...and these places.
    progress : Progress, optional
        Told how many poses have their places.

    Returns
    -------
    positions : (T, 2) ndarray
        Each depends on its own pose alone.
    stress : float
        ``sqrt(sum (delta - d)^2 / sum delta^2)`` over all pairs of a pose and a key.
    """
    P = np.zeros((len(X), 2))
    x, y = np.ascontiguousarray(np.asarray(P_keys, dtype=np.float64).T)
    size = float(np.sqrt(np.square(P_keys - P_keys.mean(axis=0)).sum(axis=1).mean()))
    missed = total = 0.0
    for start in range(0, len(X), _BLOCK):
        part = slice(start, start + _BLOCK)
        D = cdist(X[part], X_keys)
        P[part] = _between_keys(D, P_keys)
        place_each(D, x, y, P[part], 1e-6 * size, 500)
        missed += float(np.square(D - cdist(P[part], P_keys)).sum())
        total += float(np.square(D).sum())
        progress(min(start + _BLOCK, len(X)), len(X), "pose plane")
    return P, float(np.sqrt(missed / total)) if total > 0 else 0.0


def _between_keys(D: FloatArray, P_keys: FloatArray) -> FloatArray:
    """Start each frame among the three key frames most like it, nearer to the more alike."""
    count = min(3, D.shape[1])
    nearest = np.argpartition(D, count - 1, axis=1)[:, :count]
    weights = 1.0 / (np.take_along_axis(D, nearest, axis=1) + 1e-6 * D.mean() + 1e-300)
    weights /= weights.sum(axis=1, keepdims=True)
    return np.einsum("tk,tkc->tc", weights, P_keys[nearest])
