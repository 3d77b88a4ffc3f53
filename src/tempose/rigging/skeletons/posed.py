"""A human skeleton of any maker, posed and proportioned like the body in a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tempose.clips import Skeleton
from tempose.embedding import Embedding
from tempose.kinematics import bone_axis, bone_ends, rest_transforms
from tempose.rotations import conjugate, from_matrix, multiply, procrustes_rotation, rotate, shortest_rotation
from tempose.typing import FloatArray

_BODY = ("hips", "neck", "left_upper_arm", "right_upper_arm", "left_thigh", "right_thigh")


def posed_like(skeleton: Skeleton, roles: Mapping[str, int], embedding: Embedding) -> Skeleton:
    """Bring the joints of a skeleton to where an embedded skeleton has them.

    Parameters
    ----------
    skeleton : Skeleton
        J joints, among them those of a human.
    roles : mapping of str to int
        Which joint plays which part of the body.
    embedding : Embedding
        The body in the mesh.

    Returns
    -------
    Skeleton
        Joints with a role lie where the embedding has them, those between two of them in the same order on
        the straight way, all others as they lay about the joint above. Rest rotations turn with the bones.
    """
    rotations, P = rest_transforms(skeleton)
    target = _targets(skeleton, roles, embedding)
    scale, turns = _turns(skeleton, roles, P, target, _terminals(skeleton, roles, embedding))
    Q = np.zeros_like(P)
    for j, above in enumerate(skeleton.parents):
        if j in target:
            Q[j] = target[j]
        elif above >= 0:
            Q[j] = Q[above] + scale * rotate(turns[above], P[j] - P[above])
        else:
            hips = roles["hips"]
            Q[j] = target[hips] + scale * rotate(turns[j], P[j] - P[hips])
    return _rebuilt(skeleton, multiply(turns, rotations), Q, scale)


def _targets(skeleton: Skeleton, roles: Mapping[str, int], embedding: Embedding) -> dict[int, FloatArray]:
    """Places of the joints with a role and of those between two of them."""
    places = rest_transforms(embedding.skeleton)[1]
    at = {
        roles[role]: places[embedding.skeleton.index(role)]
        for role in embedding.skeleton.names
        if role in roles
    }
    P = rest_transforms(skeleton)[1]
    for j in list(at):
        path = [j]
        while (above := int(skeleton.parents[path[-1]])) >= 0 and above not in at:
            path.append(above)
        if above < 0 or len(path) == 1:
            continue
        chain = [above, *reversed(path)]
        steps = np.linalg.norm(np.diff(P[chain], axis=0), axis=1)
        share = np.cumsum(steps) / max(float(steps.sum()), 1e-300)
        for k, joint in enumerate(chain[1:-1]):
            at[joint] = at[above] + share[k] * (at[j] - at[above])
    return at


def _terminals(
    skeleton: Skeleton, roles: Mapping[str, int], embedding: Embedding
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Directions of head, hands and toes, at rest and in the body."""
    rotations, P = rest_transforms(skeleton)
    axes = bone_axis(skeleton, P, rotations, roles)
    places = dict(zip(embedding.names, embedding.joints))
    return {
        roles[role]: (axes[role], end - places[role])
        for role, end in embedding.ends.items()
        if role in axes and role in roles
    }


def _turns(
    skeleton: Skeleton,
    roles: Mapping[str, int],
    P: FloatArray,
    target: Mapping[int, FloatArray],
    terminals: Mapping[int, tuple[FloatArray, FloatArray]],
) -> tuple[float, FloatArray]:
    """Scale of the whole, and the world rotation of each joint from its rest to the pose of the body."""
    body = [roles[role] for role in _BODY if role in roles]
    here, there = P[body] - P[body].mean(axis=0), np.array([target[j] for j in body])
    there = there - there.mean(axis=0)
    whole = from_matrix(procrustes_rotation(here, there))
    scale = float(np.sqrt((there**2).sum() / max(float((here**2).sum()), 1e-300)))
    ends = {bone.start: bone.end for bone in bone_ends(skeleton, roles).values() if bone.tip is None}
    turns = np.zeros((skeleton.n_joints, 4))
    for j, above in enumerate(skeleton.parents):
        turns[j] = whole if above < 0 else turns[above]
        end = ends.get(j, _only_child(skeleton, j))
        if j in terminals or (j in target and end in target and j != roles["hips"]):
            way, wanted = terminals[j] if j in terminals else (P[end] - P[j], target[end] - target[j])
            turns[j] = multiply(shortest_rotation(rotate(turns[j], way), wanted), turns[j])
    return scale, turns


def _only_child(skeleton: Skeleton, joint: int) -> int:
    children = skeleton.children(joint)
    return int(children[0]) if len(children) == 1 else -1


def _rebuilt(skeleton: Skeleton, world: FloatArray, Q: FloatArray, scale: float) -> Skeleton:
    assert skeleton.tips is not None
    local, offsets = np.array(world), np.array(Q)
    for j, above in enumerate(skeleton.parents):
        if above >= 0:
            back = conjugate(world[above])
            local[j] = multiply(back, world[j])
            offsets[j] = rotate(back, Q[j] - Q[above])
    return replace(skeleton, offsets=offsets, rest_rotations=local, tips=scale * skeleton.tips)
