"""Pairs out of the target's own skin weights."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton, SkinnedMesh
from tempose.kinematics.roles import bones_of_role, find_roles
from tempose.transfer.bodies.bones import bone_spans
from tempose.transfer.pairing.marks import mark_bones
from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray, IntArray


def pairs_from_skin(
    source: Skeleton,
    target: SkinnedMesh,
    mapping: dict[str, str] | None = None,
    ring_places: tuple[float, ...] | None = None,
) -> Pairs:
    """Mark the faces of a skinned target for the joints of a source skeleton.

    Parameters
    ----------
    source : Skeleton
        Skeleton that moves.
    target : SkinnedMesh
        Mesh with weights.
    mapping : dict of str to str, optional
        Source joint to body role, where the names do not tell.
    ring_places : tuple of float, optional
        Where rings lie along a bone; see `mark_bones`.

    Returns
    -------
    Pairs
        Of kind ``"joints"``, with the joints and ends of the target's bones. Skeletons that share most
        names are matched by name, others by the roles of their joints in a human body.

    Raises
    ------
    ValueError
        If fewer than two joints can be matched.
    """
    shared = [name for name in source.names if name in target.skeleton.names]
    source_roles = find_roles(source, mapping)
    target_roles = find_roles(target.skeleton)
    same = len(shared) > 0.5 * max(source.n_joints, 1) and not mapping
    if same:
        names, roles, joints, owners = _by_name(source, target.skeleton, shared, source_roles)
    else:
        names, roles, joints, owners = _by_role(source, target.skeleton, source_roles, target_roles)
    if len(names) < 2:
        raise ValueError(
            f"no joints of the source ({', '.join(source.names[:6])}, ...) correspond to those of the "
            f"target's skin ({', '.join(target.skeleton.names[:6])}, ...); give pairs, or a mapping of "
            "joint names"
        )
    weights = np.column_stack([target.weights[:, owner].sum(axis=1) for owner in owners])
    rest = np.asarray(target.skeleton.rest_rotations)
    _, starts, ends = bone_spans(target.skeleton, joints, target_roles, rest, target.skeleton.offsets[0])
    faces, bones = mark_bones(
        target.mesh.vertices,
        target.mesh.faces,
        weights,
        roles,
        starts,
        _mark_ends(roles, starts, ends),
        ring_places,
    )
    return Pairs(
        "joints",
        tuple(names[b] for b in bones),
        faces,
        tuple(roles[b] or names[b] for b in bones),
        joints={name: starts[b] for b, name in enumerate(names)},
        ends={name: ends[b] for b, name in enumerate(names)},
        origin="the target's skin weights",
    )


def _mark_ends(roles: tuple[str, ...], starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Let rings of the hips lie across the trunk: many skeletons have a hip bone that points forward."""
    top = next((roles.index(role) for role in ("neck", "head", "chest") if role in roles), None)
    if "hips" in roles and top is not None:
        ends = np.array(ends)
        ends[roles.index("hips")] = starts[top]
    return ends


_Match = tuple[tuple[str, ...], tuple[str, ...], IntArray, list[IntArray]]


def _by_role(
    source: Skeleton, target: Skeleton, source_roles: dict[str, int], target_roles: dict[str, int]
) -> _Match:
    common = {role: joint for role, joint in target_roles.items() if role in source_roles}
    groups = bones_of_role(target, common)
    roles = tuple(role for role in common if role in groups)
    names = tuple(source.names[source_roles[role]] for role in roles)
    joints = np.array([common[role] for role in roles], dtype=np.int64)
    return names, roles, joints, [groups[role] for role in roles]


def _by_name(source: Skeleton, target: Skeleton, shared: list[str], source_roles: dict[str, int]) -> _Match:
    joints = np.array([target.index(name) for name in shared], dtype=np.int64)
    owner = {int(j): b for b, j in enumerate(joints)}
    owners: list[list[int]] = [[] for _ in shared]
    for j in range(target.n_joints):
        above = j
        while above >= 0 and above not in owner:
            above = int(target.parents[above])
        if above >= 0:
            owners[owner[above]].append(j)
    role_of = {joint: role for role, joint in source_roles.items()}
    roles = tuple(role_of.get(source.index(name), "") for name in shared)
    return tuple(shared), roles, joints, [np.array(group, dtype=np.int64) for group in owners]


def estimate_joints(V: FloatArray, basis: FloatArray, parents: IntArray) -> tuple[FloatArray, FloatArray]:
    """Place joints where the fields of a bone and its parent meet, for pairs that state none.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices.
    basis : (n, B) float
        Harmonic field of each bone.
    parents : (B,) int
        Tree of bones.

    Returns
    -------
    starts, ends : (B, 3) ndarray
        A bone starts at the centroid of where its field and its parent's overlap, and ends at the mean
        start of its children, or for a leaf at twice the way to the centroid of its own field.
    """
    own = basis**4
    centroid = (own.T @ V) / np.maximum(own.sum(axis=0), 1e-12)[:, None]
    starts = np.array(centroid)
    for b, parent in enumerate(parents):
        if parent >= 0:
            overlap = (basis[:, b] * basis[:, parent]) ** 4
            starts[b] = (overlap @ V) / max(float(overlap.sum()), 1e-12)
    ends = 2 * centroid - starts
    for b in range(len(parents)):
        children = np.flatnonzero(parents == b)
        if len(children) == 1:
            ends[b] = starts[children[0]]
        elif len(children) > 1:
            ends[b] = starts[b] if parents[b] < 0 else starts[children].mean(axis=0)
    return starts, ends
