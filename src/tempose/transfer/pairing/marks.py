"""Faces marked for every bone: closed rings round limbs, whole end parts."""

from __future__ import annotations

import numpy as np

from tempose.transfer.bodies.bones import split_role
from tempose.typing import BoolArray, FloatArray, IntArray

RING_PLACES = (0.27, 0.73)
"""Where along a bone the rings lie; nearer to the joints bends sharper."""
PART_PLACES: dict[str, tuple[float, ...]] = {
    "upper_arm": (0.4, 0.6),
    "forearm": (0.4, 0.55, 0.72, 0.9),
    "thigh": (0.4, 0.6),
    "shin": (0.4, 0.6),
    "clavicle": (0.3,),
    "spine": (0.5,),
    "neck": (0.5,),
}
"""Parts with other rings. Limbs bend softly between rings near their middle, and `Lead` makes them follow all
the same; a forearm passes the twist of the hand on from ring to ring."""
RING_SIZE = 12
"""Marked faces a ring."""
_LAYER, _OUTLIER, _OUTER = 1.25, 1.7, 1.7
RIGID_PARTS = ("head", "hand", "foot", "toes")
"""Parts that move as a whole: all their faces are marked."""


def owned_faces(F: IntArray, weights: FloatArray) -> IntArray:
    """Which bone a face belongs to.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    weights : (n, B) float
        Influence of each bone on each vertex.

    Returns
    -------
    (m,) ndarray of int
        Bone of largest influence where that reaches half of what the bone has at its best, else -1.
    """
    per_face = weights[F].mean(axis=1)
    bone = per_face.argmax(axis=1)
    value = per_face[np.arange(len(F)), bone]
    best = per_face.max(axis=0)
    return np.where(value >= 0.5 * best[bone], bone, -1)


def mark_bones(
    V: FloatArray,
    F: IntArray,
    weights: FloatArray,
    roles: tuple[str, ...],
    starts: FloatArray,
    ends: FloatArray,
    ring_places: tuple[float, ...] | None = None,
) -> tuple[IntArray, IntArray]:
    """Mark faces from skin weights.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices.
    F : (m, 3) int
        Faces.
    weights : (n, B) float
        Influence of each bone, as of a skin.
    roles : tuple of str
        B body roles; head, hands, feet and toes are marked whole, others by rings.
    starts, ends : (B, 3) float
        Where each bone starts and ends in the rest pose.
    ring_places : tuple of float, optional
        Fractions of the bone at which rings lie; as `PART_PLACES` says if not given.

    Returns
    -------
    faces, bones : (k,) ndarray of int
        Marked faces, each once, and the bone of each. A bone that dominates nowhere gets none.
    """
    owner = owned_faces(F, weights)
    centres = V[F].mean(axis=1)
    faces: list[IntArray] = []
    bones: list[IntArray] = []
    for b, role in enumerate(roles):
        mine = np.flatnonzero(owner == b)
        part = split_role(role)[1]
        if part in RIGID_PARTS:
            chosen = mine
        else:
            places = ring_places or PART_PLACES.get(part, RING_PLACES)
            chosen = _rings(V, F, centres, mine, starts[b], ends[b], places)
        faces.append(chosen)
        bones.append(np.full(len(chosen), b))
    return np.concatenate(faces), np.concatenate(bones)


def _rings(
    V: FloatArray,
    F: IntArray,
    centres: FloatArray,
    mine: IntArray,
    start: FloatArray,
    end: FloatArray,
    places: tuple[float, ...],
) -> IntArray:
    axis = end - start
    length = float(np.linalg.norm(axis))
    if len(mine) <= RING_SIZE or length == 0:
        return mine
    axis = axis / length
    along = (V[F[mine]] - start) @ axis / length
    low, high = float(along.min()), float(along.max())
    if low > min(places) or high < max(places):
        # the part covers only a stretch of its bone, as hips do: rings go where it is
        places = tuple(low + s * (high - low) for s in places)
    chosen = [
        _ring(centres[mine[cut]] - (start + s * length * axis), axis, mine[cut])
        for s in places
        if (cut := _crossing(along, s)).any()
    ]
    # a bone that owns faces only beyond both rings (a short hip) still needs a hold on them
    return np.unique(np.concatenate(chosen)) if chosen else mine[:: max(1, len(mine) // RING_SIZE)]


def _crossing(along: FloatArray, s: float) -> BoolArray:
    return (along.min(axis=1) <= s) & (along.max(axis=1) >= s)


def _ring(offsets: FloatArray, axis: FloatArray, faces: IntArray) -> IntArray:
    """Pick faces evenly by angle: of the innermost layer, and of a skirt that hangs round it."""
    u = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    u = u / np.linalg.norm(u)
    x, y = offsets @ u, offsets @ np.cross(axis, u)
    angle, radius = np.arctan2(y, x), np.hypot(x, y)
    sector = np.floor((angle + np.pi) / (2 * np.pi) * RING_SIZE).astype(int) % RING_SIZE
    middle = (sector + 0.5) / RING_SIZE * 2 * np.pi - np.pi
    nearest = np.full(RING_SIZE, np.inf)
    np.minimum.at(nearest, sector, radius)
    typical = float(np.median(nearest[np.isfinite(nearest)]))
    inner = radius <= np.minimum(_LAYER * nearest[sector], _OUTLIER * typical)
    chosen = [
        _one_a_sector(layer, sector, np.abs(angle - middle)) for layer in (inner, radius > _OUTER * typical)
    ]
    return faces[np.concatenate(chosen)]


def _one_a_sector(allowed: BoolArray, sector: IntArray, distance: FloatArray) -> IntArray:
    order = np.lexsort((distance, sector))
    order = order[allowed[order]]
    return order[np.unique(sector[order], return_index=True)[1]]
