"""Cylindrical parts whose axis and rings are known exactly, and rigid motions and numberings of meshes."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from tempose.clips import Mesh


def revolved(heights: np.ndarray, radii: np.ndarray, around: int = 24) -> Mesh:
    """Closed surface of revolution about +Y; its sections across are regular polygons about the axis."""
    angle = np.arange(around) * 2 * np.pi / around
    circle = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
    rings = [r * circle + [0, y, 0] for y, r in zip(heights, radii)]
    k, following, n = np.arange(around), (np.arange(around) + 1) % around, len(heights)
    V = np.concatenate([*rings, [[0, heights[0], 0], [0, heights[-1], 0]]])
    F = [np.c_[np.full(around, n * around), following, k]]
    for r in range(n - 1):
        low, high = r * around, (r + 1) * around
        F += [np.c_[low + k, low + following, high + following], np.c_[low + k, high + following, high + k]]
    F.append(np.c_[(n - 1) * around + k, (n - 1) * around + following, np.full(around, n * around + 1)])
    return Mesh(V, np.concatenate(F))


def cylinder() -> Mesh:
    return revolved(np.linspace(0, 2, 21), np.full(21, 0.25))


def cone() -> Mesh:
    return revolved(np.linspace(0, 2, 21), np.linspace(0.35, 0.1, 21))


def capsule() -> Mesh:
    bow = np.linspace(0, np.pi / 2, 7)
    low, high = 0.3 * (1 - np.cos(bow[1:])), 0.3 * np.sin(bow[1:])
    heights = np.r_[low, np.linspace(0.3, 1.7, 15)[1:-1], 2.0 - low[::-1]]
    return revolved(heights, np.r_[high, np.full(13, 0.3), high[::-1]])


PARTS = {"cylinder": cylinder, "cone": cone, "capsule": capsule}


def face_near(mesh: Mesh, point: list[float] | np.ndarray) -> int:
    return int(np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1) - point, axis=1).argmin())


def moved(mesh: Mesh, rng: np.random.Generator, scale: float = 1.0) -> tuple[Mesh, np.ndarray, np.ndarray]:
    R, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    return mesh.with_vertices(scale * mesh.vertices @ R.T + shift), R, shift


def renumbered(mesh: Mesh, rng: np.random.Generator) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """The same surface; returns for each old face (and vertex) its new number."""
    vertex, face = rng.permutation(len(mesh.vertices)), rng.permutation(len(mesh.faces))
    V, F = np.zeros_like(mesh.vertices), np.zeros_like(mesh.faces)
    V[vertex] = mesh.vertices
    F[face] = np.roll(vertex[mesh.faces], 1, axis=1)
    return Mesh(V, F), face, vertex


def merged(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0] + [len(m.vertices) for m in meshes])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + start for m, start in zip(meshes, starts)]),
    )
