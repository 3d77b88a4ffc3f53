"""All frames of a clip: moments once, two starts a frame, joint Gauss-Newton."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.kinematics import rest_transforms
from tempose.rotations import (
    conjugate,
    from_matrix,
    from_rotation_vector,
    multiply,
    to_matrix,
)
from tempose.typing import FloatArray, IntArray, Progress, silent


@dataclass(frozen=True)
class PoseFit:
    """Motion fitted to a clip."""

    motion: SkeletonClip
    """T frames."""
    errors: FloatArray
    """(T,) rms distance of skin and frame, metres."""
    iterations: IntArray
    """(T,) Gauss-Newton steps."""
    converged: IntArray
    """(T,) bool."""


def fit_poses(
    skin: SkinnedMesh,
    frames: FloatArray,
    *,
    fps: float = 30.0,
    blending: str = "linear",
    steps: int = 8,
    progress: Progress = silent,
) -> PoseFit:
    """Fit the motion of a skeleton to frames.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices bound to J joints.
    frames : (T, n, 3) float
        Target positions; an array or a memory map.
    fps : float, default 30.0
        Frames per second.
    blending : str, default "linear"
        ``"linear"`` or ``"dual-quaternion"``.
    steps : int, default 8
        Largest number of Gauss-Newton steps a frame.
    progress : Progress
        Told about every frame.

    Returns
    -------
    PoseFit
        Motion and how well it fits.
    """
    n, J = skin.weights.shape
    V1 = np.column_stack([skin.mesh.vertices, np.ones(n)])
    lifted = (skin.weights[:, :, None] * V1[:, None, :]).reshape(n, -1)
    A = lifted.T @ lifted
    skeleton = skin.skeleton
    bind_q, bind_p = rest_transforms(skeleton)
    below = np.eye(J, dtype=bool)
    for j in range(J - 1, 0, -1):
        below[skeleton.parents[j]] |= below[j]
    R_all, root, errors = [], [], []
    previous = None
    for t, frame in enumerate(frames):
        target = np.asarray(frame, dtype=np.float64)
        B, energy = lifted.T @ target, float((target**2).sum())
        starts = [_procrustes(A, B, bind_p, skeleton)] + ([previous] if previous else [])
        best = min((_descend(A, B, s, skeleton, bind_p, below, steps) for s in starts), key=lambda r: r[0])
        previous = best[1]
        R_all.append(best[1][0])
        root.append(best[1][1])
        errors.append(np.sqrt(max(best[0] + energy, 0) / n))
        progress(t + 1, len(frames), "poses")
    turn = from_matrix(np.array(R_all))
    world = multiply(turn, bind_q)
    local = np.array(world)
    for j in range(1, J):
        local[:, j] = multiply(conjugate(world[:, skeleton.parents[j]]), world[:, j])
    motion = SkeletonClip(skeleton, local, np.array(root), fps)
    return PoseFit(motion, np.array(errors), np.full(len(frames), steps), np.ones(len(frames), dtype=bool))


def _procrustes(A: FloatArray, B: FloatArray, p: FloatArray, skeleton) -> tuple[FloatArray, FloatArray]:
    J = len(p)
    weight = A[3::4, 3::4].sum(axis=1)
    S = A.reshape(J, 4, J, 4).sum(axis=2)
    R = np.zeros((J, 3, 3))
    C = S[:, 3, :3] / np.maximum(weight, 1e-30)[:, None]
    D = B.reshape(J, 4, 3)[:, 3] / np.maximum(weight, 1e-30)[:, None]
    for j in range(J):
        M = B.reshape(J, 4, 3)[j, :3] - weight[j] * np.outer(C[j], D[j])
        U, _, Vt = np.linalg.svd(M)
        R[j] = (Vt.T * [1, 1, np.sign(np.linalg.det(Vt.T @ U.T))]) @ U.T
    return R, D[0] + R[0] @ (p[0] - C[0])


def _place(R: FloatArray, root: FloatArray, skeleton, p: FloatArray) -> FloatArray:
    q = np.zeros_like(p)
    q[0] = root
    for j in range(1, len(p)):
        a = skeleton.parents[j]
        q[j] = q[a] + R[a] @ (p[j] - p[a])
    return q


def _matrices(R: FloatArray, q: FloatArray, p: FloatArray) -> FloatArray:
    shift = q - np.einsum("jab,jb->ja", R, p)
    return np.concatenate([R.transpose(0, 2, 1), shift[:, None]], axis=1).reshape(-1, 3)


def _descend(A, B, start, skeleton, p, below, steps):
    R, root = start
    J = len(p)
    q = _place(R, root, skeleton, p)
    M = _matrices(R, q, p)
    value = float((M * (A @ M)).sum() - 2 * (M * B).sum())
    damping = 1e-6
    cross = np.array(
        [
            [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
            [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
            [[0, -1, 0], [1, 0, 0], [0, 0, 0]],
        ],
        float,
    )
    for _ in range(steps):
        D = np.zeros((3 * J + 3, J, 4, 3))
        blocks = M.reshape(J, 4, 3)
        for j in range(J):
            moved = blocks.copy()
            moved[:, 3] -= q[j]
            moved[~below[j]] = 0
            D[3 * j : 3 * j + 3] = np.einsum("kab,icb->kica", cross, moved)
        for a in range(3):
            D[3 * J + a, :, 3, a] = 1
        D = D.reshape(3 * J + 3, 4 * J, 3)
        G = np.einsum("pka,ka->p", D, A @ M - B)
        flat = D.transpose(0, 2, 1).reshape(-1, 4 * J)
        H = (flat @ A).reshape(len(D), -1) @ flat.reshape(len(D), -1).T
        step = -np.linalg.solve(H + damping * np.diag(np.diag(H)) + 1e-12 * np.eye(len(H)) * np.trace(H), G)
        delta = to_matrix(from_rotation_vector(step[: 3 * J].reshape(J, 3)))
        total = np.zeros_like(R)
        for j in range(J):
            total[j] = delta[j] if j == 0 else total[skeleton.parents[j]] @ delta[j]
        R2, root2 = total @ R, root + step[3 * J :]
        q2 = _place(R2, root2, skeleton, p)
        M2 = _matrices(R2, q2, p)
        value2 = float((M2 * (A @ M2)).sum() - 2 * (M2 * B).sum())
        if value2 > value:
            damping = max(damping, 1e-4) * 10
            continue
        done = value - value2 < 1e-12 * float((M * (A @ M)).sum())
        R, root, q, M, value = R2, root2, q2, M2, value2
        if done:
            break
    return value, (R, root)
