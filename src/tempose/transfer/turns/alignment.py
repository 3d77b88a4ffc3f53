"""The common reference pose: how the target's rest is laid into the source's reference.

Of all steps this one changes the result most. Without it a source whose rest is a T-pose crosses the arms
of a target whose rest is an A-pose, and no measure of distortion notices.
"""

from __future__ import annotations

import numpy as np

from tempose.rotations import (
    conjugate,
    from_matrix,
    mean_rotation,
    multiply,
    normalise,
    rotate,
    shortest_rotation,
)
from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.facing import UP, heading, yaw, yaw_between
from tempose.transfer.bodies.pose import BonePose
from tempose.typing import BoolArray, FloatArray

LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toes")
"""Parts whose direction is aligned; spine, neck, head and clavicle inherit, because two skeletons place
those joints differently by definition."""

TARGET_BENT = np.radians(20.0)
SOURCE_BENT = np.radians(12.0)
LEAN = np.radians(15.0)
SAME_POSE = np.radians(0.5)
"""Bones that differ by less are the same skeleton in the same pose: nothing is aligned."""


def align_reference(
    bones: Bones,
    motion: BonePose,
    reference: BonePose,
    target: BonePose,
    standing: BoolArray,
    upright: bool = True,
) -> FloatArray:
    """Constant right factor K of every bone, so that the target's bone turns by ``Q(t) = R(t) K``.

    Parameters
    ----------
    bones : Bones
        B bones with roles, parents first.
    motion : BonePose
        (T, B) source motion; tells the axes of the elbows and how the feet stand.
    reference : BonePose
        (B,) source in its reference pose.
    target : BonePose
        (B,) target at rest.
    standing : (T, B) bool
        When a foot or toe bone stands flat.
    upright : bool, default True
        Whether the reference is a pose with a straight trunk; if not, its lean is taken out of the trunk.

    Returns
    -------
    (B, 4) ndarray
        ``K = R(ref)^T A`` with A the rotation from the target's rest into the source's reference pose.
    """
    d, e = reference.directions, target.directions
    turn = yaw_between(bones, reference.starts, target.starts)
    if limb_angles(bones, reference, target).max() < SAME_POSE:
        return multiply(conjugate(reference.turns), turn)
    trunk = turn if upright else multiply(_lean(bones, reference, target, turn), turn)
    A = np.zeros((len(bones.names), 4))
    for b, parent in enumerate(bones.parents):
        above = A[parent] if parent >= 0 else trunk
        part = split_role(bones.roles[b])[1]
        aligned = part in LIMBS or (not part and parent >= 0)
        known = d[b].any() and e[b].any()
        A[b] = multiply(shortest_rotation(rotate(above, e[b]), d[b]), above) if aligned and known else above
        if part == "forearm":
            _align_elbow(bones, b, motion, reference, target, A)
    K = multiply(conjugate(reference.turns), A)
    _align_soles(bones, motion, target, standing, K)
    return K


def _lean(bones: Bones, reference: BonePose, target: BonePose, turn: FloatArray) -> FloatArray:
    """Rotation that tilts the target's trunk like the reference's, where they differ much."""
    low, high = bones.find("hips"), bones.find("neck")
    high = bones.find("head") if high is None else high
    if low is None or high is None:
        return np.array([1.0, 0, 0, 0])
    a = rotate(turn, target.starts[high] - target.starts[low])
    b = reference.starts[high] - reference.starts[low]
    tilt = shortest_rotation(a, b)
    angle = 2 * np.arccos(np.clip(abs(tilt[0]), 0, 1))
    return tilt if angle > LEAN else np.array([1.0, 0, 0, 0])


def _align_elbow(
    bones: Bones, lower: int, motion: BonePose, reference: BonePose, target: BonePose, A: FloatArray
) -> None:
    """Give upper arm and forearm the twist at which both elbows bend about the same axis."""
    upper = int(bones.parents[lower])
    if upper < 0 or split_role(bones.roles[upper])[1] != "upper_arm":
        return
    e_u, e_l = target.directions[upper], target.directions[lower]
    hinge = np.cross(e_u, e_l)
    if np.linalg.norm(hinge) < np.sin(TARGET_BENT):
        return
    a, b = motion.directions[:, upper], motion.directions[:, lower]
    axes = np.cross(a, b)
    bent = np.linalg.norm(axes, axis=-1) > np.sin(SOURCE_BENT)
    if not bent.any():
        return
    for bone, along in ((upper, e_u), (lower, e_l)):
        local = rotate(conjugate(motion.turns[bent, bone]), axes[bent]).mean(axis=0)
        source_axis = rotate(reference.turns[bone], local)
        A[bone] = _frame_rotation(along, hinge, reference.directions[bone], source_axis)


def _frame_rotation(e: FloatArray, h: FloatArray, d: FloatArray, g: FloatArray) -> FloatArray:
    """Rotation that takes direction e to d and, as nearly as that allows, axis h to g."""

    def basis(x: FloatArray, y: FloatArray) -> FloatArray:
        y = y - x * (x @ y)
        y = y / np.linalg.norm(y)
        return np.column_stack([x, y, np.cross(x, y)])

    return from_matrix(basis(d, g) @ basis(e, h).T)


def _align_soles(
    bones: Bones, motion: BonePose, target: BonePose, standing: BoolArray, K: FloatArray
) -> None:
    """Let the target's sole, flat in its rest pose, lie flat when the source stands."""
    for b, role in enumerate(bones.roles):
        if split_role(role)[1] not in ("foot", "toes") or not standing[:, b].any():
            continue
        flat = standing[:, b]
        forward = motion.directions[flat, b]
        if np.linalg.norm(forward[:, [0, 2]], axis=1).min() < 1e-6 or not target.directions[b].any():
            continue
        # the heading is taken out first, so that a person who turns round still has one mean
        level = mean_rotation(multiply(yaw(-heading(forward)), motion.turns[flat, b]))
        K[b] = normalise(multiply(conjugate(level), yaw(-heading(target.directions[b]))))


def limb_angles(bones: Bones, source: BonePose, target: BonePose) -> FloatArray:
    """Angle between the bones of source and target after they face alike.

    Parameters
    ----------
    bones : Bones
        B bones.
    source : BonePose
        (..., B) source.
    target : BonePose
        (B,) target at rest.

    Returns
    -------
    (..., B) ndarray
        Radians; 0 where a direction is unknown.
    """
    turn = yaw_between(bones, source.starts, target.starts)
    e = rotate(turn[..., None, :], target.directions)
    d = source.directions
    sine = np.linalg.norm(np.cross(e, d), axis=-1)
    return np.arctan2(sine, np.sum(e * d, axis=-1)) * d.any(axis=-1) * e.any(axis=-1)


def stands_upright(bones: Bones, pose: BonePose) -> bool:
    """Tell whether a pose can serve as a rest: trunk up, legs down.

    Parameters
    ----------
    bones : Bones
        B bones.
    pose : BonePose
        (B,) one pose.

    Returns
    -------
    bool
        True also for a body without known trunk and legs, of which nothing can be said.
    """
    low, high = bones.find("hips"), bones.find("head")
    high = bones.find("neck") if high is None else high
    checks: list[float] = []
    if low is not None and high is not None:
        trunk = pose.starts[high] - pose.starts[low]
        checks.append(float(trunk @ UP / max(np.linalg.norm(trunk), 1e-12)) - np.cos(np.radians(35)))
    for side in ("left_", "right_"):
        for part in ("thigh", "shin"):
            b = bones.find(side + part)
            if b is not None and pose.directions[b].any():
                checks.append(float(-pose.directions[b] @ UP) - np.cos(np.radians(50)))
    return all(c > 0 for c in checks)
