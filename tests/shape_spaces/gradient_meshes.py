"""Small meshes with a property each, for the spaces of deformation gradients."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

Mesh = tuple[np.ndarray, np.ndarray]


def ball(subdivisions: int = 2) -> Mesh:
    """Closed, bumpy, without symmetry."""
    found = trimesh.creation.icosphere(subdivisions=subdivisions)
    V = np.array(found.vertices)
    V = V * (1 + 0.15 * np.sin(3 * V @ [[0.3], [1.0], [0.2]] + 1) + 0.1 * V[:, [0]] * V[:, [2]])
    return V * [1.0, 1.6, 0.7], np.array(found.faces)


def sheet(rows: int = 6, columns: int = 8) -> Mesh:
    """Open: a curved patch."""
    x, z = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1.3, columns + 1), indexing="ij")
    V = np.stack([x.ravel(), 0.3 * np.sin(2 * x + z).ravel(), z.ravel()], axis=1)
    return V, grid_faces(rows, columns)


def grid_faces(rows: int, columns: int) -> np.ndarray:
    i = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    return np.concatenate([np.c_[i, i + 1, i + columns + 2], np.c_[i, i + columns + 2, i + columns + 1]])


def pieces() -> Mesh:
    """Three pieces and a vertex without faces."""
    parts = [ball(1), sheet(3, 4), ball(1)]
    shifts = np.array([[0.0, 0, 0], [0.3, 2.4, 0.2], [1.65, 0.1, 0]])
    V = [p[0] * size + shift for p, size, shift in zip(parts, (1.0, 1.0, 0.5), shifts)]
    starts = np.cumsum([0] + [len(v) for v in V])
    F = [p[1] + start for p, start in zip(parts, starts)]
    return np.concatenate([*V, [[0.1, 0.2, 5.0]]]), np.concatenate(F)


def dirty() -> Mesh:
    """Degenerate in every way, a duplicated face, a turned one, a fin."""
    V, F = ball(1)
    n = len(V)
    V = np.concatenate([V, [V[0] + 0.3 * (V[1] - V[0])], 1.4 * V[:1], V[:1]])
    added = [[3, 3, 4], [5, 5, 5], [0, n, 1], F[7], F[8][[1, 0, 2]], [F[9][0], F[9][1], n + 1], [0, n + 2, 2]]
    return V, np.concatenate([F, added])


def lone_triangle() -> Mesh:
    return np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0.0]]), np.array([[0, 1, 2]])


ZOO = {"ball": ball, "sheet": sheet, "pieces": pieces, "dirty": dirty, "triangle": lone_triangle}


def deformed(V: np.ndarray, rng: np.random.Generator, count: int, size: float = 0.2) -> np.ndarray:
    """Poses: a wave through the mesh, a turn of the whole, noise."""
    t = np.arange(count)[:, None, None] * 0.4
    wave = size * np.sin(2 * V @ rng.normal(size=(3, 3)) + t)
    turns = Rotation.from_rotvec(0.3 * np.arange(count)[:, None] * [0.2, 1.0, -0.4]).as_matrix()
    noise = 0.05 * size * rng.normal(size=(count, *V.shape))
    return (V + wave + noise) @ turns.transpose(0, 2, 1) + 0.1 * t


def strip(columns: int = 24, length: float = 2.0) -> Mesh:
    """Flat, in the plane y = 0, along x, every column of the same width."""
    x, z = np.meshgrid(np.linspace(0, length, columns + 1), np.linspace(0, 0.4, 4), indexing="ij")
    return np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1), grid_faces(columns, 3)


def bent(V: np.ndarray, angle: float) -> np.ndarray:
    """Rolled round the axis z; `angle` from end to end, to the side of +y for a positive one."""
    length = np.ptp(V[:, 0])
    r, phi = length / angle, V[:, 0] / length * angle
    return np.stack([r * np.sin(phi), r * (1 - np.cos(phi)), V[:, 2]], axis=1)
