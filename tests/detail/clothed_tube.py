"""A bending tube whose surface hangs behind its bones by a rule that is known."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.detail import vertex_bases
from tempose.kinematics import bone_transforms
from tempose.rigging import Rig
from tempose.rotations import from_rotation_vector, multiply, rotate, to_matrix


def tube_rig(rings: int = 20, around: int = 12, joints: int = 3, blending="linear", unit: float = 1.0) -> Rig:
    """A tube of height `joints` along Y, joint j at height j; weights blend over half a bone."""
    y = np.repeat(np.linspace(0, joints, rings), around)
    a = np.tile(2 * np.pi * np.arange(around) / around, rings)
    V = unit * np.column_stack([0.3 * np.cos(a), y, 0.3 * np.sin(a)])
    F = []
    for r in range(rings - 1):
        for i in range(around):
            p, q = around * r + i, around * r + (i + 1) % around
            F += [[p, p + around, q], [q, p + around, q + around]]
    near = np.maximum(0, 0.75 - np.abs(y[:, None] - (np.arange(joints) + 0.5)))
    weights = near / near.sum(axis=1, keepdims=True)
    offsets = unit * np.array([[0.0, 0, 0]] + [[0.0, 1, 0]] * (joints - 1))
    parents = np.arange(joints) - 1
    skeleton = Skeleton(tuple(f"joint_{j}" for j in range(joints)), parents, offsets)
    skin = SkinnedMesh(Mesh(V, np.array(F)), skeleton, weights)
    rest = SkeletonClip(skeleton, np.tile([1.0, 0, 0, 0], (1, joints, 1)), offsets[:1])
    return Rig(skin, rest, blending)


def swing(rig: Rig, T: int = 40, fps: float = 30.0, seed: int = 0, turning: float = 0.0) -> SkeletonClip:
    """Smooth swings of all joints; the root turns about Y by `turning` radians over the clip."""
    rng = np.random.default_rng(seed)
    t = np.arange(T) / 30.0
    J = rig.skin.skeleton.n_joints
    vectors = np.zeros((T, J, 3))
    for j in range(1, J):
        for c in range(3):
            beat, phase = rng.uniform(0.7, 1.3), rng.uniform(0, 2 * np.pi)
            vectors[:, j, c] = 0.35 * np.sin(2 * np.pi * beat * t + phase)
    vectors[:, 0, 1] = turning * np.linspace(0, 1, T)
    unit = rig.skin.skeleton.offsets[1, 1]
    root = unit * np.column_stack([0.2 * t, 0 * t, 0.1 * t])
    return SkeletonClip(rig.skin.skeleton, from_rotation_vector(vectors), root, fps)


def blended_turns(rig: Rig, motion: SkeletonClip) -> np.ndarray:
    """(T, n, 3, 3) blended rotations, joint by joint and vertex by vertex."""
    turns, _ = bone_transforms(rig.skin.skeleton, motion.rotations, motion.root_position, motion.skeleton)
    turns = np.array(turns)
    result = np.zeros((len(turns), len(rig.skin.weights), 4))
    for t, frame in enumerate(turns):
        for j, parent in enumerate(rig.skin.skeleton.parents):
            if parent >= 0 and frame[j] @ frame[parent] < 0:
                frame[j] = -frame[j]
        for v, row in enumerate(rig.skin.weights):
            q = sum(w * q for w, q in zip(row, frame))
            result[t, v] = q / np.linalg.norm(q)
    return to_matrix(result)


def hanging(rig: Rig, motion: SkeletonClip) -> np.ndarray:
    """(T, n, 3) residuals in blended bases: a bulge with the bend, a lag behind its change."""
    vectors = np.array([[_vector(q) for q in frame] for frame in motion.rotations])[:, 1:]
    velocity = np.diff(vectors, axis=0, prepend=2 * vectors[:1] - vectors[1:2])
    velocity[0] = velocity[1]
    V, unit = rig.skin.mesh.vertices, rig.skin.skeleton.offsets[1, 1]
    waves = np.stack([np.sin((2 + k) * V / unit + k) for k in range(2 * vectors.shape[1] * 3)])
    drive = np.concatenate(
        [vectors.reshape(len(vectors), -1), 5 * velocity.reshape(len(vectors), -1)], axis=1
    )
    return 0.05 * unit * (np.einsum("tk,kvc->tvc", drive, waves) + 0.5 * np.cos(3 * V / unit))


def clothed(rig: Rig, motion: SkeletonClip) -> MeshClip:
    """A clip that is the skin and what hangs on it."""
    D = hanging(rig, motion)
    V = rig.vertices(motion) + np.einsum("tvab,tvb->tva", vertex_bases(rig, motion), D)
    return MeshClip(V, rig.skin.mesh, motion.fps)


def faced(motion: SkeletonClip, turn: np.ndarray) -> SkeletonClip:
    """The same motion by a body that has been turned as a whole."""
    rotations = np.array(motion.rotations)
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    return SkeletonClip(motion.skeleton, rotations, rotate(turn, motion.root_position), motion.fps)


def _vector(q: np.ndarray) -> np.ndarray:
    sine = np.linalg.norm(q[1:])
    return 2 * np.arctan2(sine, q[0]) * q[1:] / sine if sine > 0 else np.zeros(3)
