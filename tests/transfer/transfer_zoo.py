"""Small meshes with a known property each, and rotations to move them by."""

from __future__ import annotations

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from tempose.clips import Mesh
from tempose.transfer import MotionTransfer


def sphere(subdivisions: int = 2) -> Mesh:
    """Closed, bumpy, without symmetry: no two distances tie."""
    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    V = np.array(ball.vertices)
    V = V * (1 + 0.15 * np.sin(3 * V @ [[0.3], [1.0], [0.2]] + 1) + 0.1 * V[:, [0]] * V[:, [2]])
    return Mesh(V * [1.0, 1.6, 0.7], np.array(ball.faces))


def sheet(k: int = 8) -> Mesh:
    """Open: a curved k by k patch."""
    x, z = np.meshgrid(np.linspace(0, 1, k + 1), np.linspace(0, 1.3, k + 1), indexing="ij")
    V = np.stack([x.ravel(), 0.3 * np.sin(2 * x + z).ravel(), z.ravel()], axis=1)
    i = (np.arange(k)[:, None] * (k + 1) + np.arange(k)).ravel()
    return Mesh(V, np.concatenate([np.c_[i, i + 1, i + k + 2], np.c_[i, i + k + 2, i + k + 1]]))


def tube(rings: int = 25, around: int = 24, length: float = 2.0, radius: float = 0.25) -> Mesh:
    """Closed cylinder along +Y from the origin, capped by fans."""
    angle = np.arange(around) * 2 * np.pi / around
    circle = np.stack([radius * np.sin(angle), 0 * angle, radius * np.cos(angle)], axis=1)
    body = [circle + np.array([0, y, 0]) for y in np.linspace(0, length, rings)]
    V = np.concatenate([*body, [[0, 0, 0], [0, length, 0]]])
    k, following = np.arange(around), (np.arange(around) + 1) % around
    F = [np.c_[np.full(around, rings * around), following, k]]
    for r in range(rings - 1):
        low, high = r * around, (r + 1) * around
        F += [np.c_[low + k, low + following, high + following], np.c_[low + k, high + following, high + k]]
    top = (rings - 1) * around
    F.append(np.c_[top + k, top + following, np.full(around, rings * around + 1)])
    return Mesh(V, np.concatenate(F))


def pieces() -> Mesh:
    """Three pieces: two nearly touching balls and a sheet further off."""
    a, b, c = sphere(1), sphere(1), sheet(4)
    parts = [a.vertices, b.vertices * 0.5 + [1.65, 0.1, 0], c.vertices + np.array([0.3, 2.4, 0.2])]
    starts = np.cumsum([0] + [len(p) for p in parts])
    F = [m.faces + start for m, start in zip((a, b, c), starts)]
    return Mesh(np.concatenate(parts), np.concatenate(F))


def dirty() -> Mesh:
    """Duplicated, flipped, degenerate and non-manifold faces, loose vertices, a doubled seam."""
    ball = sphere(1)
    V, F = ball.vertices, ball.faces
    n = len(V)
    seam, split = np.array(F[:10]), np.unique(F[:10])
    seam = n + np.searchsorted(split, seam)
    V = np.concatenate([V, V[split], [[0.1, 0.2, 0.3], [3.0, 0, 0], [0.1, 0.2, 0.3]], 1.4 * V[:1]])
    fin, loose = len(V) - 1, len(V) - 2
    added = [
        F[20],
        F[21],
        F[21][[1, 0, 2]],
        [F[30, 0], F[30, 0], F[30, 1]],
        [F[31, 0]] * 3,
        [F[40, 0], F[40, 1], fin],
        [F[40, 1], F[40, 0], fin],
        [F[50, 0], F[50, 1], loose],
    ]
    return Mesh(V, np.concatenate([seam, F[10:], np.array(added)]))


ZOO = {"sphere": sphere, "sheet": sheet, "tube": tube, "pieces": pieces, "dirty": dirty}


def marked(mesh: Mesh, n_bones: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Mark a face for each bone, spread over the mesh along its longest axis."""
    axis = np.ptp(mesh.vertices, axis=0).argmax()
    centres = mesh.vertices[mesh.faces].mean(axis=1)[:, axis]
    order = np.argsort(centres, kind="stable")
    faces = order[np.linspace(0, len(order) - 1, n_bones).astype(int)]
    return mesh.faces[faces].ravel(), np.repeat(np.arange(n_bones), 3)


def solver_for(mesh: Mesh, n_bones: int = 4, **options: object) -> MotionTransfer:
    return MotionTransfer(mesh, *marked(mesh, n_bones), n_bones, **options)  # type: ignore[arg-type]


def near_rotations(rng: np.random.Generator, shape: tuple[int, ...], degrees: float = 50.0) -> np.ndarray:
    """Quaternions wxyz with w > 0, so that all their signs agree."""
    vectors = rng.normal(size=(*shape, 3))
    vectors *= np.radians(degrees) * rng.random((*shape, 1)) / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return wxyz(Rotation.from_rotvec(vectors.reshape(-1, 3))).reshape(*shape, 4)


def wxyz(R: Rotation) -> np.ndarray:
    return R.as_quat()[..., [3, 0, 1, 2]]


def as_rotation(Q: np.ndarray) -> Rotation:
    return Rotation.from_quat(np.asarray(Q)[..., [1, 2, 3, 0]])


def centred(V: np.ndarray) -> np.ndarray:
    return V - V.mean(axis=-2, keepdims=True)


def volume_of(V: np.ndarray, F: np.ndarray) -> float:
    return float(np.einsum("fi,fi->", V[F[:, 0]], np.cross(V[F[:, 1]], V[F[:, 2]])) / 6)
