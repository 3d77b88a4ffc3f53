"""The linear map that makes a bone longer and thicker, and its blend over the flesh."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.clips import Skeleton, SkinnedMesh
from tempose.kinematics import rest_transforms
from tempose.rigging.proportions.factors import Factor
from tempose.rotations import rotate
from tempose.typing import FloatArray


def bone_directions(skeleton: Skeleton) -> FloatArray:
    """Direction in the world, at rest, in which the bone of each joint runs.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.

    Returns
    -------
    (J, 3) ndarray
        Unit vectors: to the only child; of several, to the one with the most joints below it that lies
        nearest to the direction in which the bone above runs, so from the hips up the spine; of a leaf, to
        its tip. A leaf without a tip continues the bone above it, a root without a child has zeros.
    """
    rotations, P = rest_transforms(skeleton)
    assert skeleton.tips is not None
    way = np.zeros_like(P)
    for j, above in enumerate(skeleton.parents):
        children = [int(c) for c in skeleton.children(j)]
        if children:
            way[j] = P[_main_child(skeleton, P, j, children)] - P[j]
        elif np.isfinite(skeleton.tips[j]).all() and np.any(skeleton.tips[j]):
            way[j] = rotate(rotations[j], skeleton.tips[j])
        elif above >= 0:
            way[j] = P[j] - P[above]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    return way / np.where(length > 0, length, 1.0)


def _main_child(skeleton: Skeleton, P: FloatArray, joint: int, children: list[int]) -> int:
    """Child in the middle of its siblings: the spine of the hips, the head of the neck."""
    if len(children) == 1:
        return children[0]
    ways = P[children] - P[joint]
    length = np.linalg.norm(ways, axis=1)
    units = ways / np.where(length > 0, length, 1.0)[:, None]
    # pairs of limbs leave to both sides, so what they share cancels the least with the odd one out
    mirrored = [_has_partner(skeleton.names[c], [skeleton.names[d] for d in children]) for c in children]
    above = int(skeleton.parents[joint])
    before = P[joint] - P[above] if above >= 0 else units.sum(axis=0)
    score = units @ before / max(float(np.linalg.norm(before)), 1e-300) - 10.0 * np.array(mirrored)
    score = np.where(length > 0, score, -np.inf)
    return children[int(score.argmax())]


def _has_partner(name: str, siblings: list[str]) -> bool:
    swapped = {name.replace(a, b) for a, b in _PARTNERS if a in name}
    return any(sibling in swapped for sibling in siblings)


_PARTNERS = (("left", "right"), ("right", "left"), ("Left", "Right"), ("Right", "Left"))
_PARTNERS += ((".L", ".R"), (".R", ".L"), ("_l", "_r"), ("_r", "_l"), ("_L", "_R"), ("_R", "_L"))


def stretches(skeleton: Skeleton, factors: Sequence[Factor]) -> FloatArray:
    """Linear map of the space about each joint, in the world at rest.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    factors : sequence of J Factor
        From `read_factors`.

    Returns
    -------
    (J, 3, 3) ndarray
        ``length`` along the bone, ``thickness`` across it; the identity, exactly, where both are 1.
    """
    a = bone_directions(skeleton)
    length = np.array([f.length for f in factors])
    thick = np.array([f.thickness for f in factors])
    along = (length - thick)[:, None, None] * a[:, :, None] * a[:, None, :]
    return thick[:, None, None] * np.eye(3) + along


def stretch_field(skin: SkinnedMesh, factors: Sequence[Factor]) -> FloatArray:
    """Linear map of the flesh at every vertex, as detail needs it to grow with the bones.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices bound to J joints.
    factors : sequence of J Factor
        From `read_factors`.

    Returns
    -------
    (n, 3, 3) ndarray
        Maps of the joints blended by the weights, in the world of the bind pose; the identity for what is
        bound to nothing.
    """
    S = stretches(skin.skeleton, factors)
    field = np.einsum("nj,jab->nab", skin.weights, S)
    unbound = skin.weights.sum(axis=1) == 0
    field[unbound] = np.eye(3)
    return field
