"""How our rest pose turns into theirs: motion is carried over relative to a pose that both can take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.kinematics import find_roles, rest_transforms
from tempose.rigging.motions.reference import Reference, choose_reference, facing
from tempose.rotations import (
    IDENTITY,
    conjugate,
    from_matrix,
    multiply,
    polar_rotation,
    procrustes_rotation,
    rotate,
    shortest_rotation,
)
from tempose.typing import FloatArray

_TRUNK = ("hips", "spine", "chest", "neck", "head")
_LEG_ENDS = ("left_shin", "right_shin", "left_foot", "right_foot")
_SAME_SHAPE = 0.01
_RIGHT_ANGLE = 1e-3


@dataclass(frozen=True)
class Rests:
    """Two skeletons at rest, compared."""

    turns: FloatArray
    """(J, 4) world rotation of each of our joints that brings our rest pose into theirs."""
    reference: Reference
    """Their pose that ours is brought into."""
    angles: FloatArray
    """(J,) degrees between the bones, largest a joint, bodies facing alike; NaN where there is no pair."""
    scale: float
    """Our size over theirs."""
    same: bool
    """Whether both have the same bones up to scale and pose."""


def compare_rests(skeleton: Skeleton, motion: SkeletonClip, pairs: dict[int, int]) -> Rests:
    """Compare the rest poses of paired joints.

    Parameters
    ----------
    skeleton : Skeleton
        Ours, J joints.
    motion : SkeletonClip
        Theirs, K joints.
    pairs : dict of int to int
        Our joint to theirs.

    Returns
    -------
    Rests
        Of the same body every joint is turned as a whole. Of two different humans the limbs are brought
        into line from the root outwards by shortest rotations, the trunk by the direction it faces only:
        hip sockets and shoulders sit elsewhere in every skeleton. Of anything else joints with several bones
        are turned as a whole, with one by shortest rotations.
    """
    source = motion.skeleton
    turn, ours = rest_transforms(skeleton)
    above = [_paired_above(skeleton, pairs, j) for j in range(skeleton.n_joints)]
    reference = Reference(*rest_transforms(source))
    bones = _bones(pairs, above, ours, reference.places)
    roles = find_roles(skeleton)
    legs = [roles[role] for role in _LEG_ENDS if role in roles]
    scale, same = _shape(bones, pairs, above, ours, reference.places, legs)
    if same and _same_bases(skeleton, source, pairs, scale):
        turns = multiply(reference.rotations[[pairs[j] for j in range(skeleton.n_joints)]], conjugate(turn))
        return Rests(turns, reference, _angles(bones, IDENTITY, skeleton.n_joints), scale, True)
    start = IDENTITY
    if not same:
        reference = choose_reference(skeleton, motion, pairs)
        bones = _bones(pairs, above, ours, reference.places)
        # programs put the end of a last bone where they like: in the same body it says nothing
        bones |= _last_bones(skeleton, source, reference, pairs.keys() - bones.keys(), pairs)
        start = facing(roles, pairs, ours, reference.places)
        if reference.note:
            start = _leaning(start, roles, pairs, ours, reference.places)
    trunk = set[int]() if same else {roles[role] for role in _TRUNK if role in roles}
    turns = np.tile(start, (skeleton.n_joints, 1))
    for j in range(skeleton.n_joints):
        turns[j] = turns[above[j]] if above[j] >= 0 else start
        if j in bones and j not in trunk:
            turns[j] = _turned(turns[j], *bones[j])
    return Rests(turns, reference, _angles(bones, start, skeleton.n_joints), scale, same)


def _leaning(
    start: FloatArray, roles: dict[str, int], pairs: dict[int, int], ours: FloatArray, theirs: FloatArray
) -> FloatArray:
    """Lay our trunk along theirs, which in a frame of the motion may lean."""
    if not all(roles.get(role, -1) in pairs for role in ("hips", "neck")):
        return start
    hips, neck = roles["hips"], roles["neck"]
    along = rotate(start, ours[neck] - ours[hips])
    return multiply(shortest_rotation(along, theirs[pairs[neck]] - theirs[pairs[hips]]), start)


def _angles(bones: dict[int, tuple[FloatArray, FloatArray]], start: FloatArray, J: int) -> FloatArray:
    angles = np.full(J, np.nan)
    for j, (here, there) in bones.items():
        cosine = (_unit(rotate(start, here)) * _unit(there)).sum(axis=1)
        angles[j] = np.degrees(np.arccos(np.clip(cosine, -1, 1))).max()
    return angles


def axes_turn(skeleton: Skeleton, source: Skeleton, pairs: dict[int, int]) -> FloatArray | None:
    """Find out whether the same body merely lies along other axes: an up axis that was taken wrongly.

    Parameters
    ----------
    skeleton : Skeleton
        Ours.
    source : Skeleton
        Theirs.
    pairs : dict of int to int
        Our joint to theirs.

    Returns
    -------
    (4,) ndarray or None
        Right-angled rotation from their axes to ours; None if both stand alike or differ in more than that.
    """
    chosen = sorted(pairs)
    if len(chosen) < 4:
        return None
    ours = rest_transforms(skeleton)[1][chosen]
    theirs = rest_transforms(source)[1][[pairs[j] for j in chosen]]
    ours, theirs = ours - ours[0], theirs - theirs[0]
    size, other = np.linalg.norm(ours), np.linalg.norm(theirs)
    if not size or not other:
        return None
    R = procrustes_rotation(theirs, ours)
    cube = np.round(R)
    off = np.linalg.norm(theirs / other @ cube.T - ours / size)
    if off > _RIGHT_ANGLE or np.allclose(cube, np.eye(3)) or not np.allclose(cube @ cube.T, np.eye(3)):
        return None
    return from_matrix(cube)


def _paired_above(skeleton: Skeleton, pairs: dict[int, int], joint: int) -> int:
    joint = int(skeleton.parents[joint])
    while joint >= 0 and joint not in pairs:
        joint = int(skeleton.parents[joint])
    return joint


def _bones(
    pairs: dict[int, int], above: list[int], ours: FloatArray, theirs: FloatArray
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Vectors (k, 3) from each paired joint to the next ones below, in both skeletons."""
    small = 1e-6 * np.abs(ours - ours[0]).max(), 1e-6 * np.abs(theirs - theirs[0]).max()
    found: dict[int, list[tuple[FloatArray, FloatArray]]] = {}
    for j in [j for j in pairs if above[j] >= 0]:
        here, there = ours[j] - ours[above[j]], theirs[pairs[j]] - theirs[pairs[above[j]]]
        if np.linalg.norm(here) > small[0] and np.linalg.norm(there) > small[1]:
            found.setdefault(above[j], []).append((here, there))
    return {
        j: (np.array([b[0] for b in bones]), np.array([b[1] for b in bones])) for j, bones in found.items()
    }


def _last_bones(
    skeleton: Skeleton, source: Skeleton, reference: Reference, joints: set[int], pairs: dict[int, int]
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Vectors (1, 3) from joints to their tips, where both skeletons know them."""
    ours = rotate(rest_transforms(skeleton)[0], np.nan_to_num(np.asarray(skeleton.tips)))
    theirs = rotate(reference.rotations, np.nan_to_num(np.asarray(source.tips)))
    return {j: (ours[[j]], theirs[[pairs[j]]]) for j in joints if ours[j].any() and theirs[pairs[j]].any()}


def _shape(
    bones: dict[int, tuple[FloatArray, FloatArray]],
    pairs: dict[int, int],
    above: list[int],
    ours: FloatArray,
    theirs: FloatArray,
    legs: list[int],
) -> tuple[float, bool]:
    """Size of ours over theirs, and whether angles and lengths at every joint agree."""
    inner = [j for j in pairs if above[j] >= 0]
    if not inner:
        return 1.0, False
    lengths = np.linalg.norm(ours[inner] - ours[[above[j] for j in inner]], axis=1)
    others = np.linalg.norm(
        theirs[[pairs[j] for j in inner]] - theirs[[pairs[above[j]] for j in inner]], axis=1
    )
    if not lengths.sum() or not others.sum():
        return 1.0, False
    # travel goes with the legs, where there are any
    chosen = [inner.index(j) for j in legs if j in inner] or list(range(len(inner)))
    scale = float(lengths[chosen].sum() / (others[chosen].sum() or others.sum()))
    size = float(lengths.max())
    off = 0.0
    for here, there in bones.values():
        R = polar_rotation(here.T @ there)
        off = max(off, float(np.abs(there @ R.T * scale - here).max()))
    complete = len(inner) + 1 == len(above)
    return (1.0 if abs(scale - 1) < 1e-4 else scale), complete and off < _SAME_SHAPE * size


def _same_bases(skeleton: Skeleton, source: Skeleton, pairs: dict[int, int], scale: float) -> bool:
    """Whether all bones lie alike in the joints' own bases: then these are the same, whatever the poses."""
    order = [pairs[j] for j in range(1, skeleton.n_joints)]
    parents = [pairs[int(j)] for j in skeleton.parents[1:]]
    if [int(source.parents[k]) for k in order] != parents:
        return False
    off = np.abs(scale * source.offsets[order] - skeleton.offsets[1:]).max(initial=0.0)
    return bool(off < _SAME_SHAPE * np.abs(skeleton.offsets[1:]).max(initial=0.0))


def _turned(start: FloatArray, here: FloatArray, there: FloatArray) -> FloatArray:
    """Rotation that brings bones into line, as near to `start` as they allow."""
    moved = _unit(rotate(start, here))
    other = _unit(there)
    if len(here) > 1 and np.linalg.svd(moved, compute_uv=False)[1] > 0.1:
        return multiply(from_matrix(polar_rotation(other.T @ moved)), start)
    return multiply(shortest_rotation(moved.sum(axis=0), other.sum(axis=0)), start)


def _unit(x: FloatArray) -> FloatArray:
    return x / np.linalg.norm(x, axis=-1, keepdims=True)
