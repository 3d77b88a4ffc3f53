"""Clips made of rigid bones with known weights and joints."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics.skinning import bake
from tempose.rotations import from_rotation_vector


def tube(bones: int, rings: int = 12, around: int = 10) -> tuple[np.ndarray, np.ndarray]:
    """Vertices of a tube along x, a unit a bone, and its faces."""
    x = np.linspace(0, bones, bones * rings + 1)
    angle = np.linspace(0, 2 * np.pi, around, endpoint=False)
    ring = 0.25 * np.column_stack([np.cos(angle), np.sin(angle)])
    V = np.array([[u, *r] for u in x for r in ring])
    i, j = np.meshgrid(np.arange(len(x) - 1), np.arange(around), indexing="ij")
    a, b = (i * around + j).ravel(), (i * around + (j + 1) % around).ravel()
    F = np.concatenate([np.column_stack([a, b, b + around]), np.column_stack([a, b + around, a + around])])
    return V, F.astype(np.int32)


def chain_weights(V: np.ndarray, bones: int, width: float = 0.3) -> np.ndarray:
    """Ramps of a given width about each joint: two bones a vertex at most."""
    steps = np.clip((V[:, :1] - np.arange(1, bones)) / width + 0.5, 0, 1)
    ones, none = np.ones((len(V), 1)), np.zeros((len(V), 1))
    return np.hstack([ones, steps]) - np.hstack([steps, none])


def chain(
    bones: int, T: int, rng: np.random.Generator, unit: float = 1.0
) -> tuple[SkinnedMesh, SkeletonClip, MeshClip]:
    """A tube that bends about every joint in every direction, and travels."""
    V, F = tube(bones)
    offsets = np.tile([1.0, 0, 0], (bones, 1))
    offsets[0] = 0
    skeleton = Skeleton([f"j{k}" for k in range(bones)], np.arange(bones) - 1, unit * offsets)
    skin = SkinnedMesh(Mesh(unit * V, F), skeleton, chain_weights(V, bones))
    turns = from_rotation_vector(0.5 * rng.standard_normal((T, bones, 3)))
    motion = SkeletonClip(skeleton, turns, unit * rng.standard_normal((T, 3)))
    return skin, motion, MeshClip(bake(skin, motion), skin.mesh)


def matched(found: np.ndarray, true: np.ndarray) -> list[int]:
    """For every true bone the found one of the most similar weights."""
    return [int(np.abs(found - true[:, [j]]).sum(axis=0).argmin()) for j in range(true.shape[1])]
