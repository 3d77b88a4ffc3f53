"""Inverse kinematics of a limb of two bones: its end goes to a place by turns no larger than needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.rotations import conjugate, from_rotation_vector, multiply, rotate, shortest_rotation
from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.limb_range import within_range
from tempose.transfer.bodies.pose import BonePose
from tempose.typing import FloatArray, IntArray

ENDS = {"hand": ("upper_arm", "forearm"), "foot": ("thigh", "shin")}
"""Part at the end of a limb, and the two bones that move it."""
_BENT = np.sin(np.radians(20.0))
"""A limb bent further bends in its own plane alone."""
_HOLD = 0.7
"""Weight of the given hinge when the limb is straight: a knee pressed back by 12 degrees still bends back."""


@dataclass(frozen=True)
class Limb:
    """Two bones and what hangs on them, in the target at rest."""

    upper: int
    """Bone that starts at the body."""
    lower: int
    """Bone that starts where the first ends."""
    carried: IntArray
    """Bones below the lower one: hand or foot and what follows them."""
    first: FloatArray
    """(3,) metres: joint of the upper bone."""
    second: FloatArray
    """(3,) metres: elbow or knee."""
    end: FloatArray
    """(3,) metres: wrist or ankle, or any point that the lower bone carries."""
    hinge: FloatArray
    """(3,) unit axis in the upper bone's own axes (those of the rest pose) about which the limb bends."""


def find_limb(bones: Bones, target: BonePose, part: str, Q: FloatArray | None = None) -> Limb | None:
    """Find the limb that ends in a hand or foot.

    Parameters
    ----------
    bones : Bones
        B bones with roles.
    target : BonePose
        (B,) the target's bones at rest.
    part : str
        Role of the end, such as ``"left_hand"`` or ``"right_foot"``.
    Q : (T, B, 4) float, optional
        Rotations of a clip: they tell about which axis this limb bends.

    Returns
    -------
    Limb or None
        None where a bone of it is missing.
    """
    side, kind = split_role(part)
    if kind not in ENDS:
        return None
    upper, lower, end = (bones.find(side + name) for name in (*ENDS[kind], kind))
    if upper is None or lower is None or end is None:
        return None
    first, second, tip = (target.starts[b] for b in (upper, lower, end))
    forward = np.array([0.0, 0.0, -1.0 if kind == "foot" else 1.0])
    hinge = bend_axis(second - first, tip - second, forward, None if Q is None else Q[:, [upper, lower]])
    return Limb(upper, lower, bones_below(bones.parents, lower)[1:], first, second, tip, hinge)


def bones_below(parents: IntArray, bone: int) -> IntArray:
    """List a bone and all that hangs on it.

    Parameters
    ----------
    parents : (B,) int
        Tree, parents first, -1 at the root.
    bone : int
        Where to begin.

    Returns
    -------
    (k,) ndarray of int
        In order, `bone` first.
    """
    mine = {bone}
    for b in range(bone + 1, len(parents)):
        if int(parents[b]) in mine:
            mine.add(b)
    return np.array(sorted(mine), dtype=np.int64)


def bend_axis(
    upper: FloatArray, lower: FloatArray, forward: FloatArray, Q: FloatArray | None = None
) -> FloatArray:
    """Axis about which a limb bends, in the upper bone's own axes.

    Parameters
    ----------
    upper, lower : (3,) float
        The two bones at rest, each from its start to its end.
    forward : (3,) float
        Where the lower bone goes when the limb bends, if nothing else tells.
    Q : (T, 2, 4) float, optional
        Rotations of both bones: the mean axis of the frames, bent ones counting more, if they agree.

    Returns
    -------
    (3,) ndarray
        Unit axis, perpendicular to `upper`.
    """
    scale = np.linalg.norm(upper) * np.linalg.norm(lower)
    axis = np.cross(upper, lower)
    if Q is not None and len(Q):
        seen = np.cross(upper, rotate(multiply(conjugate(Q[:, 0]), Q[:, 1]), lower))
        total, bent = np.linalg.norm(seen.sum(axis=0)), np.linalg.norm(seen, axis=1)
        if bent.max() > 0.1 * scale and total > 0.5 * bent.sum():
            axis = seen.mean(axis=0)
    if np.linalg.norm(axis) < 0.03 * scale:
        axis = np.cross(upper, forward)
    if not axis.any():
        axis = np.cross(upper, np.eye(3)[np.abs(upper).argmin()])
    return axis / np.linalg.norm(axis)


def reach(
    limb: Limb, Q: FloatArray, shift: FloatArray, *, follow: bool = False, beyond: FloatArray | None = None
) -> FloatArray:
    """Turn a limb so that its end moves by a displacement.

    Parameters
    ----------
    limb : Limb
        The limb.
    Q : (..., B, 4) float
        World rotations of the bones relative to the target's rest.
    shift : (..., 3) float
        Where the end shall go from where these rotations put it, metres; the first joint stays.
    follow : bool, default False
        Whether hand or foot turn with the lower bone; otherwise they keep their rotation in the world.
    beyond : (..., 3) float, optional
        From the end to a point that moves in its stead, as it is now, metres; for one that follows.

    Returns
    -------
    (..., B, 4) ndarray
        Rotations; those of other bones are unchanged. A frame without shift keeps its own to rounding.
    """
    upper = rotate(Q[..., limb.upper, :], limb.second - limb.first)
    lower = rotate(Q[..., limb.lower, :], limb.end - limb.second) + (0.0 if beyond is None else beyond)
    hinge = rotate(Q[..., limb.upper, :], limb.hinge)
    turn_upper, turn_lower = two_bone_turns(upper, lower, upper + lower + shift, hinge)
    out = np.array(Q, dtype=np.float64)
    out[..., limb.upper, :] = multiply(turn_upper, Q[..., limb.upper, :])
    moved = [limb.lower, *limb.carried] if follow else [limb.lower]
    out[..., moved, :] = multiply(turn_lower[..., None, :], Q[..., moved, :])
    return out


def two_bone_turns(
    upper: FloatArray, lower: FloatArray, goal: FloatArray, hinge: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Turn two bones so that the end of the second comes to a place.

    Parameters
    ----------
    upper, lower : (..., 3) float
        The bones as they are, each from its start to its end.
    goal : (..., 3) float
        Where the end shall be, from the start of the first bone.
    hinge : (..., 3) float
        Unit axis about which the limb bends when it is straight; ``lower`` turns about it the positive way.

    Returns
    -------
    turn_upper, turn_lower : (..., 4) ndarray
        World rotations, to be multiplied on the left; the identity where the goal is where the end is.

    Notes
    -----
    The limb bends about its own normal (blended smoothly into `hinge` as it gets straight, so that it never
    flips), by the law of cosines; then the shortest rotation takes its end onto the line to the goal. A goal
    near or beyond full reach is approached, never passed (`within_range`).
    """
    h = _bend_normal(upper, lower, hinge)
    a = np.linalg.norm(upper, axis=-1)
    flat = lower - np.sum(lower * h, axis=-1, keepdims=True) * h
    b = np.linalg.norm(flat, axis=-1)
    aside2 = np.sum(lower * lower, axis=-1) - b * b
    near, far = np.sqrt((a - b) ** 2 + aside2), np.sqrt((a + b) ** 2 + aside2)
    distance = np.linalg.norm(goal, axis=-1)
    r = within_range(distance, np.linalg.norm(upper + lower, axis=-1), near, far)
    # by half the angle: the arc cosine loses half of the digits where the limb is straight
    angle = 2 * np.arctan2(np.sqrt(np.maximum(far**2 - r**2, 0)), np.sqrt(np.maximum(r**2 - near**2, 0)))
    now = np.arctan2(np.sum(np.cross(upper, flat) * h, axis=-1), np.sum(upper * flat, axis=-1))
    bend = from_rotation_vector((_signed(angle, now) - now)[..., None] * h)
    swing = shortest_rotation(upper + rotate(bend, lower), goal)
    return swing, multiply(swing, bend)


def _bend_normal(upper: FloatArray, lower: FloatArray, hinge: FloatArray) -> FloatArray:
    """Find the unit normal of the plane in which the limb bends, perpendicular to the upper bone."""
    along = _unit(upper)
    own = np.cross(along, _unit(lower))
    bent = np.minimum(np.sum(own * own, axis=-1, keepdims=True) / _BENT**2, 1.0)
    given = hinge - np.sum(hinge * along, axis=-1, keepdims=True) * along
    return _unit(own + _HOLD * (1 - bent) ** 3 * given)


def _signed(angle: FloatArray, now: FloatArray) -> FloatArray:
    """Give an angle its sign: the bent way, unless the joint is bent back and asked to stay so."""
    back = np.maximum(-now, 0.0)
    s = np.clip((angle - back) / np.maximum(3 * back, 1e-12), 0.0, 1.0)
    kept = 1 - s * s * s * (s * (6 * s - 15) + 10)
    return np.where(now < 0, angle * (1 - 2 * kept), angle)


def _unit(x: FloatArray) -> FloatArray:
    length = np.linalg.norm(x, axis=-1, keepdims=True)
    return x / np.where(length > 0, length, 1.0)
