"""A tube on three joints that bends, with a bulge that follows the bend: small enough to rig in a blink."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import linear_blend_skinning
from tempose.rotations import from_rotation_vector

RINGS, AROUND = 13, 8
NAMES = ("root", "middle", "end")


def tube_mesh() -> Mesh:
    """A closed tube one metre high."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    ring = np.column_stack([0.12 * np.cos(angle), np.zeros(AROUND), 0.12 * np.sin(angle)])
    V = np.concatenate([ring + np.array([0, y, 0]) for y in np.linspace(0, 1, RINGS)])
    F: list[list[int]] = []
    for r in range(RINGS - 1):
        for i in range(AROUND):
            a, b = AROUND * r + i, AROUND * r + (i + 1) % AROUND
            F += [[a, a + AROUND, b], [b, a + AROUND, b + AROUND]]
    low, top = len(V), len(V) + 1
    V = np.concatenate([V, [[0, 0, 0], [0, 1, 0]]])
    last = AROUND * (RINGS - 1)
    for i in range(AROUND):
        j = (i + 1) % AROUND
        F += [[low, i, j], [top, last + j, last + i]]
    return Mesh(V, np.array(F), name="tube")


def tube_skin() -> SkinnedMesh:
    mesh = tube_mesh()
    y = mesh.vertices[:, 1]
    W = np.column_stack([np.clip((0.45 - y) / 0.2, 0, 1), np.zeros(len(y)), np.clip((y - 0.6) / 0.2, 0, 1)])
    W[:, 1] = 1 - W.sum(axis=1)
    offsets = np.array([[0, 0, 0], [0, 0.35, 0], [0, 0.35, 0]])
    tips = np.array([[np.nan] * 3, [np.nan] * 3, [0, 0.3, 0]])
    return SkinnedMesh(mesh, Skeleton(NAMES, np.array([-1, 0, 1]), offsets, tips=tips), W)


def tube_motion(n_frames: int = 30, names: tuple[str, ...] = NAMES, fps: float = 25.0) -> SkeletonClip:
    t = np.arange(n_frames) / fps
    vectors = np.zeros((n_frames, 3, 3))
    vectors[:, 0, 1] = 0.3 * np.sin(2 * t)
    vectors[:, 1, 2] = 0.7 * np.sin(6 * t)
    vectors[:, 2, 0] = 0.5 * np.sin(4 * t + 1)
    root = np.column_stack([0.2 * t, np.zeros(n_frames), np.zeros(n_frames)])
    skeleton = tube_skin().skeleton
    skeleton = Skeleton(names, skeleton.parents, skeleton.offsets, tips=skeleton.tips)
    return SkeletonClip(skeleton, from_rotation_vector(vectors), root, fps)


def tube_clip(n_frames: int = 30) -> MeshClip:
    """The skin in motion, and a bulge of up to 3 cm that grows with the bend of the middle joint."""
    skin, motion = tube_skin(), tube_motion(n_frames)
    V = linear_blend_skinning(skin, motion.rotations, motion.root_position, skin.skeleton)
    y = skin.mesh.vertices[:, 1]
    bend = np.sin(6 * np.arange(n_frames) / 25.0)
    bulge = 0.03 * np.exp(-(((y - 0.5) / 0.12) ** 2))
    V[:, :, 2] += bend[:, None] * bulge
    return MeshClip(V.astype(np.float32), skin.mesh, 25.0)
