"""Where legs stand in the way of a skirt."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, rotate
from tempose.typing import FloatArray

CLEARANCE = 0.018
"""Metres between a leg and the middle of the cloth."""

BEADS = 7
"""Balls along a bone."""

FADE = 1.2
"""How fast the cloth falls beside a leg and below the hem, radians a radius."""


class Ring(Protocol):
    """What is needed of a skirt: gores at rest, in the basis of the hips."""

    @property
    def centre(self) -> FloatArray:
        """(3,) middle of the waist, metres."""
        ...

    @property
    def azimuth(self) -> FloatArray:
        """(G,) directions, radians."""
        ...

    @property
    def waist(self) -> FloatArray:
        """(G,) distance of the upper end from the centre, metres."""
        ...

    @property
    def slope(self) -> FloatArray:
        """(G,) angle to the vertical, radians."""
        ...

    @property
    def length(self) -> FloatArray:
        """(G,) metres."""
        ...


def least_angles(skin: SkinnedMesh, clip: SkeletonClip, ring: Ring) -> FloatArray:
    """Angle to the vertical that each gore must have to lie outside the legs.

    Parameters
    ----------
    skin : SkinnedMesh
        The body, with ``hips`` and the thighs and shins of two legs.
    clip : SkeletonClip
        T frames.
    ring : Ring
        G gores.

    Returns
    -------
    (T, G) ndarray
        Radians; at rest never more than the slope of the gore itself.
    """
    skeleton = skin.skeleton
    rest = skeleton.rest_rotations
    assert rest is not None
    still = _least(skin, ring, rest[None], skeleton.offsets[:1])
    moving = _least(skin, ring, clip.rotations, clip.root_position)
    return moving - np.maximum(still - ring.slope, 0.0)


def _least(skin: SkinnedMesh, ring: Ring, rotations: FloatArray, root: FloatArray) -> FloatArray:
    centres, radii = leg_beads(skin, rotations, root)
    p = centres - ring.centre
    sine, cosine = np.sin(ring.azimuth), np.cos(ring.azimuth)
    out = p[..., 0, None] * sine + p[..., 2, None] * cosine - ring.waist
    aside = np.abs(p[..., 0, None] * cosine - p[..., 2, None] * sine)
    depth = np.broadcast_to(-p[..., 1, None], out.shape)
    distance = np.hypot(out, depth)
    r = radii[:, None] + CLEARANCE
    section = np.sqrt(np.maximum(r**2 - aside**2, 0.0))
    angle = np.arctan2(out, depth) + np.arcsin(np.minimum(section / np.maximum(distance, 1e-9), 1.0))
    angle -= FADE * np.maximum(aside - r, 0.0) / r
    angle -= FADE * np.maximum(distance - ring.length, 0.0) / r
    return angle.max(axis=1)


def leg_beads(skin: SkinnedMesh, rotations: FloatArray, root: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Balls that fill thighs and shins, in the basis of the hips.

    Parameters
    ----------
    skin : SkinnedMesh
        The body.
    rotations : (T, J, 4) float
        Local rotations wxyz.
    root : (T, 3) float
        Place of the root, metres.

    Returns
    -------
    centres : (T, B, 3) ndarray
        Metres.
    radii : (B,) ndarray
        Metres, as thick as the mesh is there.
    """
    skeleton = skin.skeleton
    world, positions = forward_kinematics(skeleton, rotations, root)
    hips = skeleton.index("hips")
    s = (np.arange(BEADS) + 0.5) / BEADS
    centres: list[FloatArray] = []
    radii: list[FloatArray] = []
    for side in ("left", "right"):
        for upper, lower in (("thigh", "shin"), ("shin", "foot")):
            a, b = skeleton.index(f"{side}_{upper}"), skeleton.index(f"{side}_{lower}")
            centres.append(positions[:, a, None] * (1 - s)[:, None] + positions[:, b, None] * s[:, None])
            radii.append(_thickness(skin, a, b, s))
    local = np.concatenate(centres, axis=1) - positions[:, hips, None]
    return rotate(conjugate(world[:, hips])[:, None], local), np.concatenate(radii)


def _thickness(skin: SkinnedMesh, joint: int, child: int, s: FloatArray) -> FloatArray:
    """Radius of the mesh round a bone at some places along it."""
    positions = rest_transforms(skin.skeleton)[1]
    V = skin.mesh.vertices[skin.weights[:, joint] > 0.5] - positions[joint]
    bone = positions[child] - positions[joint]
    along = V @ bone / (bone @ bone)
    distance = np.linalg.norm(V - along[:, None] * bone, axis=1)
    near = [distance[np.abs(along - x) < 0.75 / len(s)] for x in s]
    fallback = 0.12 * float(np.linalg.norm(bone))
    return np.array([np.percentile(d, 75) if len(d) else fallback for d in near])
