"""Transfer: one frame and a batch against one bare cholespy solve with three right-hand sides, in one run."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.sparse as sp

from meshes import bumpy_body
from tempose.clips import Mesh
from tempose.geometry import cotangent_laplacian, cotangents
from tempose.linalg import SparseCholesky
from tempose.rotations import from_rotation_vector, to_matrix
from tempose.transfer import MotionTransfer, consistent_signs

BONES = 18
BATCH = 64
SIZES = {"50k": 50_000, "300k": 300_000}


def marked(mesh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Two hundred marked faces on eighteen bones stacked along the height."""
    rng = np.random.default_rng(0)
    faces = rng.choice(len(mesh.faces), 200, replace=False)
    y = mesh.vertices[mesh.faces[faces, 0], 1]
    bone = np.clip(((y + 0.85) / 1.7 * BONES).astype(int), 0, BONES - 1)
    return mesh.faces[faces].ravel(), np.repeat(bone, 3)


def rotations(frames: int) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, frames, endpoint=False)
    phase = np.arange(BONES) / BONES * np.pi
    angles = 0.5 * np.sin(t[:, None] + phase)
    Q = from_rotation_vector(angles[..., None] * np.array([0.3, 0.2, 0.93]))
    return consistent_signs(Q, np.arange(-1, BONES - 1))


def interleaved(tasks: dict[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Median seconds of each task, run in turn so that a busy machine disturbs all alike."""
    for task in tasks.values():
        task()
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(rounds):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            times[name].append(time.perf_counter() - start)
    return {name: statistics.median(values) for name, values in times.items()}


def plain_numpy(mesh: Any, basis: np.ndarray, solver: SparseCholesky) -> Callable[[np.ndarray], np.ndarray]:
    """The same frame in numpy with a prefactored solver: what one writes first."""
    V, F = mesh.vertices, mesh.faces
    half = cotangents(V, F)

    def frame(Q: np.ndarray) -> np.ndarray:
        q = (basis @ Q)[F].sum(axis=1)
        R = to_matrix(q / np.linalg.norm(q, axis=1, keepdims=True))
        rhs = np.zeros_like(V)
        for k in range(3):
            i, j = F[:, (k + 1) % 3], F[:, (k + 2) % 3]
            u = half[:, k, None] * np.einsum("mij,mj->mi", R, V[i] - V[j])
            np.add.at(rhs, i, u)
            np.add.at(rhs, j, -u)
        return solver.solve(rhs)

    return frame


WHAT = {
    "solve": "bare cholespy solve, 3 right-hand sides",
    "frame": "one frame, whole call",
    "batch": f"a frame of a batch of {BATCH}, 2 threads",
    "batch, 1 thread": f"a frame of a batch of {BATCH}, 1 thread",
    "numpy": "one frame, plain numpy + prefactored cholespy",
    "set-up": "factor and basis",
}


def measure(mesh: Mesh) -> dict[str, float]:
    """Seconds of every task on one mesh."""
    marks = marked(mesh)
    start = time.perf_counter()
    solver = MotionTransfer(mesh, *marks, BONES)
    setup = time.perf_counter() - start
    one_thread = MotionTransfer(mesh, *marks, BONES, workers=1)
    pull = np.zeros(len(mesh.vertices))
    pull[0] = 1.0
    L = cotangent_laplacian(mesh.vertices, mesh.faces) + sp.diags_array(pull)
    bare = SparseCholesky(L, "cholespy")
    b = np.random.default_rng(1).normal(size=(len(mesh.vertices), 3))
    Q, single = rotations(BATCH), rotations(BATCH)[7]
    numpy_frame = plain_numpy(mesh, np.asarray(solver.basis), bare)
    tasks = {
        "solve": lambda: bare.solve(b),
        "frame": lambda: solver.pose(single),
        "batch": lambda: solver.pose(Q),
        "batch, 1 thread": lambda: one_thread.pose(Q),
        "numpy": lambda: numpy_frame(single),
    }
    seconds = interleaved(tasks, 9 if len(mesh.faces) < 100_000 else 5)
    seconds["batch"] /= BATCH
    seconds["batch, 1 thread"] /= BATCH
    return seconds | {"set-up": setup}


def run() -> list[dict[str, Any]]:
    """Rows of the table, smallest mesh first; every ratio is against the bare solve on the same mesh."""
    rows: list[dict[str, Any]] = []
    for label, triangles in SIZES.items():
        mesh = bumpy_body(triangles)
        seconds = measure(mesh)
        rows += [
            {
                "name": f"transfer/{key}/{label}",
                "what": f"{text}, {len(mesh.faces)} triangles",
                "seconds": seconds[key],
                "ratio": seconds[key] / seconds["solve"],
                "against": "cholespy solve",
                "memory_mb": None,
            }
            for key, text in WHAT.items()
        ]
    return rows
