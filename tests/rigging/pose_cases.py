"""A small skin with random bones, and motions of it, for tests of poses."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.kinematics import linear_blend_skinning, rest_transforms
from tempose.rotations import from_rotation_vector, multiply

PARENTS = np.array([-1, 0, 1, 1, 0, 4])
J, PER_BONE = len(PARENTS), 15


def random_skin(rng: np.random.Generator, unit: float = 1.0, at: float = 0.0) -> SkinnedMesh:
    """Clouds around six bones, each vertex held by two or three of them."""
    rest = from_rotation_vector(rng.normal(size=(J, 3)))
    offsets = rng.normal(size=(J, 3))
    offsets *= 0.8 / np.linalg.norm(offsets, axis=1, keepdims=True)
    offsets[0] += at
    tree = Skeleton(tuple("abcdef"), PARENTS, unit * offsets, rest, tips=0.5 * unit * np.ones((J, 3)))
    joints = rest_transforms(tree)[1]
    owner = np.repeat(np.arange(J), PER_BONE)
    V = joints[owner] + 0.5 * unit * rng.normal(size=(len(owner), 3))
    weights = 0.15 * rng.random((len(owner), J)) * (rng.random((len(owner), J)) < 0.4)
    weights[np.arange(len(owner)), owner] = 1
    weights /= weights.sum(axis=1, keepdims=True)
    return SkinnedMesh(Mesh(V, np.array([[0, 1, 2]])), tree, weights)


def random_motion(
    skin: SkinnedMesh, rng: np.random.Generator, T: int = 6, size: float = 0.5
) -> tuple[np.ndarray, np.ndarray]:
    """Rotations (T, J, 4) and places of the root (T, 3) that do not follow one another."""
    turn = from_rotation_vector(size * rng.normal(size=(T, J, 3)))
    extent = np.ptp(skin.mesh.vertices, axis=0).max()
    return multiply(skin.skeleton.rest_rotations, turn), extent * rng.normal(size=(T, 3))


def posed(skin: SkinnedMesh, motion: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    return linear_blend_skinning(skin, *motion)
