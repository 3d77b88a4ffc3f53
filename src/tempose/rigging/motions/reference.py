"""Which pose of another skeleton is the one that ours can take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.kinematics import find_roles, forward_kinematics, rest_transforms
from tempose.rotations import IDENTITY, from_rotation_vector, rotate
from tempose.typing import FloatArray

_UPRIGHT = np.cos(np.radians(50.0))
_BONES = (
    ("hips", "neck"),
    *(
        (f"{side}_{start}", f"{side}_{end}")
        for side in ("left", "right")
        for start, end in (("upper_arm", "forearm"), ("forearm", "hand"), ("thigh", "shin"), ("shin", "foot"))
    ),
)


@dataclass(frozen=True)
class Reference:
    """A skeleton in one pose."""

    rotations: FloatArray
    """(K, 4) world rotations wxyz."""
    places: FloatArray
    """(K, 3) joints, metres."""
    note: str = ""
    """What was taken, where it is not the rest pose."""


def choose_reference(skeleton: Skeleton, motion: SkeletonClip, pairs: dict[int, int]) -> Reference:
    """Take the rest pose of a skeleton, or where no body can stand so, a frame.

    Parameters
    ----------
    skeleton : Skeleton
        Ours.
    motion : SkeletonClip
        Theirs.
    pairs : dict of int to int
        Our joint to theirs.

    Returns
    -------
    Reference
        Some programs write skeletons whose rest is no pose at all, with legs drawn sideways. Of such a
        human the frame is taken in which the bones lie most like ours at rest, whichever way it faces.
    """
    rest = Reference(*rest_transforms(motion.skeleton))
    roles = {role: j for role, j in find_roles(skeleton).items() if j in pairs}
    bones = [(roles[a], roles[b]) for a, b in _BONES if a in roles and b in roles]
    if len(bones) < 5 or _stands(rest.places, pairs, roles):
        return rest
    world, places = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)
    ours = rest_transforms(skeleton)[1]
    here = np.array([ours[b] - ours[a] for a, b in bones])
    there = np.stack([places[:, pairs[b]] - places[:, pairs[a]] for a, b in bones], axis=1)
    turned = rotate(facing(roles, pairs, ours, places)[..., None, :], here)
    cosine = (turned * there).sum(axis=-1) / np.maximum(
        np.linalg.norm(turned, axis=-1) * np.linalg.norm(there, axis=-1), 1e-30
    )
    best = int(np.arccos(np.clip(cosine, -1, 1)).sum(axis=1).argmin())
    note = f"The rest pose of the motion's skeleton is no standing pose: frame {best} is taken for it."
    return Reference(world[best], places[best], note)


def _stands(places: FloatArray, pairs: dict[int, int], roles: dict[str, int]) -> bool:
    """Whether the trunk is up and the thighs are down."""
    ends = [("hips", "neck", 1.0), ("left_thigh", "left_shin", -1.0), ("right_thigh", "right_shin", -1.0)]
    for start, end, sign in ends:
        if start in roles and end in roles:
            bone = places[pairs[roles[end]]] - places[pairs[roles[start]]]
            if sign * bone[1] < _UPRIGHT * np.linalg.norm(bone):
                return False
    return True


def facing(roles: dict[str, int], pairs: dict[int, int], ours: FloatArray, theirs: FloatArray) -> FloatArray:
    """Turn about the vertical between the directions in which two bodies face.

    Parameters
    ----------
    roles : dict of str to int
        Body role to our joint.
    pairs : dict of int to int
        Our joint to theirs.
    ours : (J, 3) float
        Our joints, metres.
    theirs : (..., K, 3) float
        Their joints, metres.

    Returns
    -------
    (..., 4) ndarray
        From our direction to theirs, by the hip sockets; the identity where these are not known.
    """
    left, right = roles.get("left_thigh", -1), roles.get("right_thigh", -1)
    if left not in pairs or right not in pairs:
        return np.broadcast_to(IDENTITY, (*theirs.shape[:-2], 4))
    a, b = ours[left] - ours[right], theirs[..., pairs[left], :] - theirs[..., pairs[right], :]
    angle = np.arctan2(-b[..., 2], b[..., 0]) - np.arctan2(-a[2], a[0])
    return from_rotation_vector(angle[..., None] * np.array([0.0, 1, 0]))
