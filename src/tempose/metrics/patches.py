"""The piece of surface round a joint, whose volume tells how a bend is carried."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.geometry import face_components
from tempose.typing import FloatArray, IntArray


def patch_round(V_rest: FloatArray, F: IntArray, point: FloatArray, radius: float) -> IntArray:
    """Faces of the piece of surface round a joint, for a local volume.

    Parameters
    ----------
    V_rest : (n, 3) float
        Rest pose.
    F : (m, 3) int
        Faces.
    point : (3,) float
        Where the joint is at rest.
    radius : float
        Faces with all corners nearer than this count, unit of `V_rest`.

    Returns
    -------
    (k,) ndarray of int
        Face indices: of the connected pieces in that ball, the one that comes nearest to the joint.

    Raises
    ------
    ValueError
        If a shape is wrong, or no face lies in the ball.
    """
    V_rest = as_floats(V_rest, "V_rest", ("n", 3))
    F = as_indices(F, "F", ("m", 3), limit=len(V_rest))
    distance = np.linalg.norm(V_rest - as_floats(point, "point", (3,)), axis=1)
    inside = np.flatnonzero((distance[F] < radius).all(axis=1))
    if len(inside) == 0:
        raise ValueError(
            f"radius must reach the surface, got {radius} where the nearest vertex is "
            f"{distance.min(initial=np.inf):.3g} away"
        )
    _, labels = face_components(F[inside], len(V_rest))
    nearest = int(distance[F[inside]].min(axis=1).argmin())
    return inside[labels == labels[nearest]]
