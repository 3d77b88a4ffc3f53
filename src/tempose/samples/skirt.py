"""A skirt as a ring of pendulums that hang from the waist and are pushed aside by the legs.

Each pendulum, a gore, swings outwards and sideways. Gores are coupled to their neighbours by cloth, driven by
the acceleration of the hips, and may not swing inside the legs; what a leg has pushed aside swings back when
the leg is gone. So the skirt is late, overshoots, and remembers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, rotate
from tempose.samples.gores import swing_gores
from tempose.samples.motion_curves import ease
from tempose.samples.oscillators import acceleration
from tempose.samples.skirt_legs import least_angles
from tempose.typing import FloatArray

GORES = 36
"""Pendulums round the waist."""


@dataclass(frozen=True, eq=False)
class SkirtShape:
    """A skirt at rest, in the basis of the hips."""

    centre: FloatArray
    """(3,) middle of the waist, metres."""
    azimuth: FloatArray
    """(G,) direction of each gore, radians from +Z towards +X."""
    waist: FloatArray
    """(G,) distance of its upper end from the centre, metres."""
    slope: FloatArray
    """(G,) angle to the vertical, radians."""
    length: FloatArray
    """(G,) metres."""


def swing_skirt(
    skin: SkinnedMesh, clip: SkeletonClip, vertices: FloatArray, mask: FloatArray, skinned: FloatArray
) -> FloatArray:
    """Displace the vertices of a skirt to where it hangs from the hips, whatever joints they are bound to.

    Parameters
    ----------
    skin : SkinnedMesh
        The body, with joints ``hips``, ``left_thigh`` and so on.
    clip : SkeletonClip
        T frames.
    vertices : (k, 3) float
        Vertices of the skirt at rest, metres.
    mask : (k,) float
        How far each belongs to it, 0 to 1: the shape is taken from those above one half.
    skinned : (T, k, 3) float
        The same vertices skinned, metres.

    Returns
    -------
    (T, k, 3) ndarray
        Metres to add to the skinned vertices; nothing near the axis, where a lining goes with the legs.
    """
    hips = skin.skeleton.index("hips")
    local = vertices - rest_transforms(skin.skeleton)[1][hips]
    shape = measure_skirt(local[mask > 0.5])
    world, position = forward_kinematics(skin.skeleton, clip.rotations, clip.root_position)
    out, aside = gore_forces(shape, world[:, hips], position[:, hips], clip.fps)
    least = least_angles(skin, clip, shape) - shape.slope
    # the pelvis is in the way, too: a gore never swings in by more than a part of its slope
    least = np.maximum(least, -0.5 * np.abs(shape.slope))
    outward = swing_gores(out, clip.fps, least)
    sideways = swing_gores(aside, clip.fps, None)
    moved, outer = _swing(shape, local, outward, sideways)
    swung = position[:, hips, None] + rotate(world[:, hips, None], local + moved)
    return (mask * outer)[:, None] * (swung - skinned)


def measure_skirt(local: FloatArray) -> SkirtShape:
    """Find waist, hem and gores of a skirt.

    Parameters
    ----------
    local : (k, 3) float
        Its vertices at rest relative to the hips, metres.

    Returns
    -------
    SkirtShape
        Gores from waist to hem.
    """
    top, bottom = local[:, 1].max(), local[:, 1].min()
    centre = np.array([*local[:, :1].mean(axis=0), top, *local[:, 2:].mean(axis=0)])
    part = (top - local[:, 1]) / (top - bottom)
    azimuth = 2.0 * np.pi * np.arange(GORES) / GORES
    waist = _outline(local[part < 0.2] - centre, azimuth)
    hem = _outline(local[part > 0.85] - centre, azimuth)
    return SkirtShape(
        centre, azimuth, waist, np.arctan2(hem - waist, top - bottom), np.hypot(hem - waist, top - bottom)
    )


def _outline(points: FloatArray, azimuth: FloatArray) -> FloatArray:
    """Distance of the outer side from the axis as a smooth function of direction."""

    def basis(angle: FloatArray) -> FloatArray:
        return np.stack([f(k * angle) for k in range(3) for f in (np.cos, np.sin)], axis=1)

    angle = np.arctan2(points[:, 0], points[:, 2])
    distance = np.hypot(points[:, 0], points[:, 2])
    outer = np.ones(len(points), dtype=bool)
    curve = np.zeros(6)
    for _ in range(3):
        curve = np.linalg.lstsq(basis(angle[outer]), distance[outer], rcond=None)[0]
        # what lies further in is the lining, or the hollow for the legs
        outer = distance > basis(angle) @ curve - 0.1 * distance.mean()
    return basis(azimuth) @ curve


def gore_forces(
    shape: SkirtShape, turn: FloatArray, position: FloatArray, fps: float
) -> tuple[FloatArray, FloatArray]:
    """Angular accelerations that drive the gores, from gravity and the motion of the hips.

    Parameters
    ----------
    shape : SkirtShape
        G gores.
    turn : (T, 4) float
        World rotation of the hips, wxyz.
    position : (T, 3) float
        Place of the hips, metres.
    fps : float
        Frames per second.

    Returns
    -------
    outward, sideways : (T, G) ndarray
        Radians per second squared; zero when the hips rest upright.
    """
    gravity = np.array([0.0, -9.81, 0.0])
    radial = np.stack([np.sin(shape.azimuth), 0 * shape.azimuth, np.cos(shape.azimuth)], axis=1)
    along = np.stack([np.cos(shape.azimuth), 0 * shape.azimuth, -np.sin(shape.azimuth)], axis=1)
    down, out = np.cos(shape.slope)[:, None], np.sin(shape.slope)[:, None]
    middle = shape.centre + (shape.waist[:, None] + 0.5 * shape.length[:, None] * out) * radial
    middle[:, 1] -= 0.5 * (shape.length[:, None] * down)[:, 0]
    place = position[:, None] + rotate(turn[:, None], middle)
    felt = rotate(conjugate(turn)[:, None], gravity - acceleration(place, fps)) - gravity
    # a uniform rod turns about its end by 3/2 of the force at its middle over its length
    pull = 1.5 * felt / shape.length[:, None]
    outward = down * radial + out * np.array([0.0, 1.0, 0.0])
    return np.sum(pull * outward, axis=-1), np.sum(pull * along, axis=-1)


def _swing(
    shape: SkirtShape, local: FloatArray, outward: FloatArray, sideways: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Turn each vertex about the waist with the gores beside it; say how far out it lies, 0 to 1."""
    d = local - shape.centre
    azimuth, distance, depth = np.arctan2(d[:, 0], d[:, 2]), np.hypot(d[:, 0], d[:, 2]), -d[:, 1]
    shares = _shares(azimuth)
    out, aside = outward @ shares.T, sideways @ shares.T
    waist = shares @ shape.waist
    turned = ease(depth / (0.3 * depth.max())) * out
    radius = distance - waist
    wider = np.cos(turned) * radius + np.sin(turned) * depth - radius
    deeper = np.cos(turned) * depth - np.sin(turned) * radius - depth
    along = ease(depth / (0.3 * depth.max())) * depth * np.tanh(aside)
    sine, cosine = np.sin(azimuth), np.cos(azimuth)
    moved = np.stack([wider * sine + along * cosine, -deeper, wider * cosine - along * sine], axis=-1)
    full = waist + np.maximum(depth, 0.0) * (shares @ np.tan(shape.slope))
    return moved, ease((distance / full - 0.35) / 0.45)


def _shares(azimuth: FloatArray) -> FloatArray:
    """Share of each gore in each vertex: a periodic cubic B-spline over the directions."""
    x = np.abs((azimuth[:, None] * GORES / (2 * np.pi) - np.arange(GORES) + GORES / 2) % GORES - GORES / 2)
    near, far = 2.0 / 3.0 - x**2 + x**3 / 2.0, (2.0 - x) ** 3 / 6.0
    return np.where(x < 1, near, np.where(x < 2, far, 0.0))
