"""Small meshes chosen by a property each, and poses of them, for all shape spaces."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

Mesh = tuple[np.ndarray, np.ndarray]


def joined(*parts: Mesh) -> Mesh:
    starts = np.cumsum([0] + [len(V) for V, _ in parts])
    return np.concatenate([V for V, _ in parts]), np.concatenate([F + s for (_, F), s in zip(parts, starts)])


def closed(subdivisions: int = 2) -> Mesh:
    """Bumpy ball without symmetry."""
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    V = np.array(ball.vertices)
    V = V * (1 + 0.15 * np.sin(3 * V @ [[0.3], [1.0], [0.2]] + 1) + 0.1 * V[:, [0]] * V[:, [2]])
    return V * [1.0, 1.6, 0.7], np.array(ball.faces)


def grid(rows: int, columns: int, height: float = 0.3) -> Mesh:
    x, z = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1.3, columns + 1), indexing="ij")
    V = np.stack([x.ravel(), height * np.sin(2 * x + z).ravel(), z.ravel()], axis=1)
    i = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    return V, np.concatenate([np.c_[i, i + 1, i + columns + 2], np.c_[i, i + columns + 2, i + columns + 1]])


def opened() -> Mesh:
    """Curved sheet."""
    return grid(5, 7)


def flat() -> Mesh:
    """Flat sheet: no curvature anywhere."""
    return grid(3, 4, 0.0)


def parts() -> Mesh:
    """Two balls, a sheet and a loose vertex."""
    a, b, c = closed(1), closed(1), grid(2, 3)
    V, F = joined(a, (0.5 * b[0] + [1.6, 0.1, 0], b[1]), (c[0] + [0.3, 2.4, 0.2], c[1]))
    return np.concatenate([V, [[0.1, 0.2, 5.0]]]), F


def slivers() -> Mesh:
    """Ball squeezed along one axis and sheared, some faces 500 times as long as high."""
    V, F = closed(2)
    V = V @ np.array([[1, 0.8, 0], [0, 1, 0], [0, 0.3, 0.02]])
    V[F[7, 2]] = V[F[7, :2]].mean(axis=0) + 0.002 * (V[F[7, 2]] - V[F[7, :2]].mean(axis=0))
    return V, F


def crumpled() -> Mesh:
    """Ball with vertices pushed about until faces fold over their neighbours."""
    V, F = closed(2)
    return V + 0.22 * np.random.default_rng(5).standard_normal(V.shape), F


def pinched() -> Mesh:
    """Two balls that share one vertex, and a fin: three faces at one edge."""
    (A, F), (B, G) = closed(1), closed(1)
    n = len(A)
    shared = np.where(np.arange(n) == 0, 0, np.arange(n) + n - 1)
    V = np.concatenate([A, (B - B[0] + A[0] + 0)[1:] * [1, 1, 1]])
    fin = len(V)
    edge = F[20, :2]
    V = np.concatenate([V, [1.5 * A[edge].mean(axis=0)]])
    return V, np.concatenate([F, shared[G], [[edge[0], edge[1], fin]]])


def one_sided() -> Mesh:
    """Moebius band: no orientation agrees everywhere."""
    k, turns = 24, np.arange(24) * 2 * np.pi / 24
    V = []
    for w in (-0.3, 0.0, 0.3):
        r = 1 + w * np.cos(turns / 2)
        V.append(np.stack([r * np.cos(turns), w * np.sin(turns / 2), r * np.sin(turns)], axis=1))
    F = []
    for j in range(2):
        for i in range(k):
            last = i == k - 1
            a, b = j * k + i, (j + 1) * k + i
            c, d = ((2 - j) * k, (1 - j) * k) if last else (a + 1, b + 1)
            F += [[a, b, c], [b, d, c]]
    return np.concatenate(V), np.array(F)


def triangle() -> Mesh:
    """One face."""
    return np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0.0]]), np.array([[0, 1, 2]])


ZOO = {
    mesh.__name__: mesh
    for mesh in (closed, opened, flat, parts, slivers, crumpled, pinched, one_sided, triangle)
}


def poses(V: np.ndarray, count: int = 4, size: float = 0.15, seed: int = 3) -> np.ndarray:
    """Bend, wave and move a mesh, (count, n, 3); the first is the mesh itself."""
    rng = np.random.default_rng(seed)
    frames = [V]
    for t in range(1, count):
        X = V + size * np.sin(2 * V @ rng.standard_normal((3, 3)) + t)
        R = Rotation.from_rotvec([0.3 * t, 0.5 * t, -0.2 * t]).as_matrix()
        frames.append(X @ R.T + [0.4 * t, 0.1, -0.2 * t])
    return np.stack(frames)


def diagonal(V: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(V, axis=-2), axis=-1).max())


def unaligned(A: np.ndarray, B: np.ndarray) -> float:
    """Root mean square distance of two meshes after the best rigid motion."""
    a, b = A - A.mean(axis=0), B - B.mean(axis=0)
    U, s, Vt = np.linalg.svd(b.T @ a)
    s[2] *= np.sign(np.linalg.det(U @ Vt))
    return float(np.sqrt(max(0.0, np.mean(np.sum(a**2 + b**2, axis=1)) - 2 * s.sum() / len(a))))
