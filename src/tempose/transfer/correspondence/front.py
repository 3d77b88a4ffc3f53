"""Where the feet of a standing body point."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from tempose.geometry import face_areas
from tempose.typing import FloatArray, IntArray

_SOLE, _ANKLE = 0.035, (0.06, 0.11)
_BESIDE = 0.06
_CLEAR = 0.02


def feet_front(V: FloatArray, F: IntArray) -> FloatArray | None:
    """Find the direction from the ankles to the soles: front and back of a body look alike, feet do not.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, Y up.
    F : (m, 3) int
        Faces.

    Returns
    -------
    (3,) ndarray or None
        Horizontal, in heights; None where the soles lie straight below what they carry.
    """
    height = float(np.ptp(V[:, 1]))
    if height == 0:
        return None
    P, areas = V[F].mean(axis=1), face_areas(V, F)
    y = (P[:, 1] - V[:, 1].min()) / height
    sole = np.flatnonzero(y < _SOLE)
    ankle = np.flatnonzero((y > _ANKLE[0]) & (y < _ANKLE[1]))
    if len(sole) == 0 or len(ankle) == 0:
        return None
    flat = P[:, [0, 2]] / height
    gap, _ = KDTree(flat[sole]).query(flat[ankle])
    ankle = ankle[gap < _BESIDE]
    if areas[sole].sum() == 0 or areas[ankle].sum() == 0:
        return None
    lead = np.average(flat[sole], axis=0, weights=areas[sole])
    lead = lead - np.average(flat[ankle], axis=0, weights=areas[ankle])
    return np.array([lead[0], 0.0, lead[1]]) if np.linalg.norm(lead) > _CLEAR else None
