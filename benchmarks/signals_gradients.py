"""Deformation gradients: a frame to coordinates and back, beside the same in plain numpy, in one run."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import scipy.sparse as sp

from meshes import bumpy_body
from tempose.geometry import cotangents
from tempose.linalg import SparseCholesky
from tempose.rotations import from_matrix, from_rotation_vector, to_matrix, to_rotation_vector
from tempose.shape_spaces import GradientSpace, PatchSpace

FACES = 16_843
"""As many as the horse of the paper has."""
FRAMES = 16
ROUNDS = 60


def body_and_poses() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A body of about as many faces as the horse, bending and turning."""
    mesh = bumpy_body(17_500)
    t = np.linspace(0, 2, FRAMES)[:, None]
    angle = 0.6 * np.sin(t + 2 * mesh.vertices[:, 1]) + t
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = mesh.vertices.T
    return mesh.vertices, mesh.faces, np.stack([c * x + s * z, y + 0.1 * c, c * z - s * x], axis=2)


class PlainNumpy:
    """The same coordinates as one writes them first: batched SVD, logarithms, `numpy.add.at`, one factor."""

    def __init__(self, V: np.ndarray, F: np.ndarray) -> None:
        self.V, self.F, self.half = V, F, cotangents(V, F)
        self.inverse = np.linalg.inv(self.edges(V))
        rows, columns, values = [], [], []
        for k in range(3):
            i, j, w = F[:, (k + 1) % 3], F[:, (k + 2) % 3], self.half[:, k]
            rows += [i, j, i, j]
            columns += [i, j, j, i]
            values += [w, w, -w, -w]
        rows, columns, values = [*rows, [0]], [*columns, [0]], [*values, [1.0]]
        L = sp.coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))
        self.solver = SparseCholesky(L.tocsc(), "splu")

    def edges(self, V: np.ndarray) -> np.ndarray:
        a, b = V[self.F[:, 1]] - V[self.F[:, 0]], V[self.F[:, 2]] - V[self.F[:, 0]]
        n = np.cross(a, b)
        return np.stack([a, b, n / np.sqrt(np.linalg.norm(n, axis=1, keepdims=True))], axis=2)

    def encode(self, V: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        U, s, Vt = np.linalg.svd(self.edges(V) @ self.inverse)
        S = (Vt.swapaxes(1, 2) * s[:, None]) @ Vt
        return to_rotation_vector(from_matrix(U @ Vt)), S

    def decode(self, w: np.ndarray, S: np.ndarray) -> np.ndarray:
        T = to_matrix(from_rotation_vector(w)) @ S
        right = np.zeros_like(self.V)
        for k in range(3):
            i, j = self.F[:, (k + 1) % 3], self.F[:, (k + 2) % 3]
            u = self.half[:, k, None] * np.einsum("mij,mj->mi", T, self.V[i] - self.V[j])
            np.add.at(right, i, u)
            np.add.at(right, j, -u)
        return self.solver.solve(right)


def least_seconds(tasks: dict[str, Callable[[], Any]]) -> dict[str, float]:
    """Least seconds of each task, run in turn: a shared machine only ever adds to them."""
    best: dict[str, float] = {}
    for round_ in range(ROUNDS):
        for name, task in tasks.items():
            if name.startswith("numpy") and round_ > 8:
                continue
            start = time.perf_counter()
            task()
            seconds = time.perf_counter() - start
            best[name] = min(best.get(name, seconds), seconds)
    return best


WHAT = {
    "encode": ("vertices to coordinates, one frame", "numpy encode", (1.0, 0.3)),
    "encode, path": (f"the same with rotations that go on, a frame of {FRAMES}", "numpy encode", None),
    "decode": ("coordinates to vertices, one frame", "numpy decode", (2.0, 0.5)),
    "decode, batch": (f"the same, a frame of a batch of {FRAMES}", "numpy decode", (2.0, 0.5)),
    "patch encode": ("relative to 80 patches, one frame", "numpy encode", None),
    "patch decode": ("relative to 80 patches, one frame", "numpy decode", None),
    "set-up": ("describe the faces, factor, mean rotations of the clip", "", None),
}


def rows() -> list[dict[str, Any]]:
    """Rows of the table of benchmarks."""
    V, F, poses = body_and_poses()
    plain, space, patch = PlainNumpy(V, F), GradientSpace(V, F), PatchSpace(V, F)
    z, p, slow = space.encode_path(poses), patch.encode(poses[3]), plain.encode(poses[3])
    seconds = least_seconds(
        {
            "encode": lambda: space.encode(poses[3]),
            "encode, path": lambda: space.encode_path(poses),
            "decode": lambda: space.decode(z[3]),
            "decode, batch": lambda: space.decode(z),
            "patch encode": lambda: patch.encode(poses[3]),
            "patch decode": lambda: patch.decode(p),
            "set-up": lambda: GradientSpace.from_clip(V, F, poses),
            "numpy encode": lambda: plain.encode(poses[3]),
            "numpy decode": lambda: plain.decode(*slow),
        }
    )
    for name in ("encode, path", "decode, batch"):
        seconds[name] /= FRAMES
    found: list[dict[str, Any]] = []
    for name, (what, against, goal) in WHAT.items():
        row = {"name": f"signals/gradients/{name}", "what": f"{what}, {len(F)} faces"}
        row |= {"seconds": seconds[name], "goal": goal, "against": against}
        if against:
            row |= {"ratio": seconds[name] / seconds[against]}
            row |= {"value": f"{1e3 * seconds[name]:.2f} ms, 1/{seconds[against] / seconds[name]:.0f}"}
        found.append(row)
    D = np.linalg.norm(np.ptp(V, axis=0))
    error = np.abs(space.decode(z) - poses).max() / D
    trip = {"name": "signals/gradients/round trip", "what": f"largest error of {FRAMES} frames, diagonals"}
    return [*found, trip | {"value": f"{error:.1e}", "goal": (1e-6, 1e-12)}]


if __name__ == "__main__":
    from run import table

    print(table(rows()))
