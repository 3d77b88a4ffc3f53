"""Which surface belongs to a joint: for the volume lost there, and for giving it back."""

from __future__ import annotations

import numpy as np

from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.solver.fill import REACH, Patch, VolumeFill, make_patch
from tempose.transfer.solver.motion_transfer import MotionTransfer
from tempose.typing import BoolArray, FloatArray, IntArray

FILLED = ("upper_arm", "forearm", "thigh", "shin")
"""Bones at whose start volume is given back: shoulders, elbows, hips and knees."""
MIDDLES, MIDDLE_REACH = ("forearm",), 0.6
"""Bones whose middle counts too, because twist thins them there, and the radius of that patch in lengths."""
INNER = 0.35
"""Strength of inner edges at a volume of 1; the rest comes back by pushing the skin out."""
FAINT, FAINT_PARTS = 0.3, ("upper_arm", "clavicle", "chest", "neck", "head")
"""Round the shoulder inner edges bend the chest more than they help: they are weakened there."""
_MEETING = 2


def joint_patches(
    solver: MotionTransfer, bones: Bones, target: BonePose, owner: IntArray, parts: tuple[str, ...] = FILLED
) -> dict[str, Patch]:
    """Cut out the surface round the joints of a body.

    Parameters
    ----------
    solver : MotionTransfer
        Whose mesh it is.
    bones : Bones
        B bones.
    target : BonePose
        (B,) target at rest.
    owner : (n,) int
        Bone of largest influence on each vertex of the mesh.
    parts : tuple of str
        Which bones' starts count.

    Returns
    -------
    dict of str to Patch
        Role of the bone that starts at the joint to its patch; with ``_middle`` the patch round the middle of
        a forearm. Where no bone has a role, all joints between two bones of known length count, by name.
    """
    welded = solver.welded
    of_face = owner[welded.first][welded.faces]
    near = _meeting(bones.parents)
    patches: dict[str, Patch] = {}
    for b, (name, role) in enumerate(zip(bones.names, bones.roles)):
        wanted = split_role(role)[1] in parts if any(bones.roles) else bones.parents[b] >= 0
        if not wanted or target.lengths[b] == 0:
            continue
        allowed = np.flatnonzero(near[b][of_face].all(axis=1))
        places = {"": (target.starts[b], REACH)}
        if split_role(role)[1] in MIDDLES:
            places["_middle"] = ((target.starts[b] + target.ends[b]) / 2, MIDDLE_REACH)
        for which, (point, reach) in places.items():
            patch = make_patch(welded, allowed, point, reach * float(target.lengths[b]))
            if patch is not None:
                patches[(role or name) + which] = patch
    return patches


def _meeting(parents: IntArray) -> BoolArray:
    """(B, B) whether two bones are at most two steps apart in the tree."""
    B = len(parents)
    step = np.eye(B, dtype=bool)
    child = np.flatnonzero(parents >= 0)
    step[child, parents[child]] = step[parents[child], child] = True
    return np.linalg.matrix_power(step.astype(np.int64), _MEETING) > 0


def inner_strengths(roles: list[str], volume: float) -> FloatArray:
    """How strongly inner edges hold on the surface of each bone.

    Parameters
    ----------
    roles : list of str
        Role of the bone of each column.
    volume : float
        The slider: 0 for nothing, 1 for all volume.

    Returns
    -------
    (C,) ndarray
        Strengths for `MotionTransfer`.
    """
    faint = [split_role(role)[1] in FAINT_PARTS for role in roles]
    return INNER * volume * np.where(faint, FAINT, 1.0)


def volume_fill(solver: MotionTransfer, patches: dict[str, Patch], volume: float) -> VolumeFill | None:
    """Prepare what gives the volume back.

    Parameters
    ----------
    solver : MotionTransfer
        Whose mesh it is.
    patches : dict of str to Patch
        From `joint_patches`.
    volume : float
        The slider.

    Returns
    -------
    VolumeFill or None
        None where nothing is asked for.
    """
    if volume <= 0 or not patches:
        return None
    return VolumeFill(solver.mesh.vertices, list(patches.values()), min(volume, 1.0))
