"""Transfer: one frame and a batch against one bare cholespy solve with three right-hand sides, in one run."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from copy import copy
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from meshes import bumpy_body
from tempose.clips import Mesh
from tempose.embedding import embed_skin
from tempose.geometry import cotangent_laplacian, cotangents
from tempose.linalg import SparseCholesky
from tempose.rotations import from_rotation_vector, to_matrix
from tempose.samples import human_character
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
    """Least seconds of each task, run in turn: a shared machine only ever adds to them."""
    for task in tasks.values():
        task()
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(rounds):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            times[name].append(time.perf_counter() - start)
    return {name: min(values) for name, values in times.items()}


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
    "frame": "one frame, whole call, single precision",
    "frame, double": "one frame, whole call, double precision",
    "batch": f"a frame of a batch of {BATCH}, single precision, 2 threads",
    "batch, 1 thread": f"a frame of a batch of {BATCH}, single precision, 1 thread",
    "batch, double": f"a frame of a batch of {BATCH}, double precision, 2 threads",
    "numpy": "one frame, plain numpy + prefactored cholespy",
    "set-up": "weld, link, order, factor, basis",
}
GOALS = {"frame": (1.5, 0.6), "batch": (0.5, 0.2)}
SETUP_GOAL = (6.0, 3.0)


def set_up(mesh: Mesh) -> tuple[MotionTransfer, float]:
    """Build the solver three times; the least seconds."""
    seconds: list[float] = []
    for _ in range(3):
        start = time.perf_counter()
        solver = MotionTransfer(mesh, *marked(mesh), BONES, precision="single")
        seconds.append(time.perf_counter() - start)
    return solver, min(seconds)


def measure(mesh: Mesh) -> tuple[dict[str, float], float]:
    """Seconds of every task on one mesh, and the drift of single from double as a share of the height."""
    marks = marked(mesh)
    single, setup = set_up(mesh)
    double = MotionTransfer(mesh, *marks, BONES)
    one_thread = copy(single)
    one_thread.workers = 1
    pull = np.zeros(len(mesh.vertices))
    pull[0] = 1.0
    L = cotangent_laplacian(mesh.vertices, mesh.faces) + sp.diags_array(pull)
    bare = SparseCholesky(L, "cholespy")
    b = np.random.default_rng(1).normal(size=(len(mesh.vertices), 3))
    Q = rotations(BATCH)
    numpy_frame = plain_numpy(mesh, np.asarray(double.basis), bare)
    tasks = {
        "solve": lambda: bare.solve(b),
        "frame": lambda: single.pose(Q[7]),
        "frame, double": lambda: double.pose(Q[7]),
        "batch": lambda: single.pose(Q),
        "batch, 1 thread": lambda: one_thread.pose(Q),
        "batch, double": lambda: double.pose(Q),
        "numpy": lambda: numpy_frame(Q[7]),
    }
    seconds = interleaved(tasks, 40 if len(mesh.faces) < 100_000 else 10)
    for name in tasks:
        seconds[name] /= BATCH if name.startswith("batch") else 1
    drift = float(np.abs(single.pose(Q) - double.pose(Q)).max()) / mesh.height
    return seconds | {"set-up": setup}, drift


def speed_rows(label: str, mesh: Mesh) -> list[dict[str, Any]]:
    seconds, drift = measure(mesh)
    rows: list[dict[str, Any]] = []
    for key, text in WHAT.items():
        goal = SETUP_GOAL if key == "set-up" and label == "300k" else GOALS.get(key)
        rows.append(
            {
                "name": f"transfer/{key}/{label}",
                "what": f"{text}, {len(mesh.faces)} triangles",
                "seconds": seconds[key],
                "ratio": seconds[key] / seconds["solve"],
                "against": "cholespy solve",
                "value": f"{seconds[key]:.1f} s" if key == "set-up" else None,
                "goal": goal,
            }
        )
    found = {"name": f"transfer/drift/{label}", "what": "largest distance of single from double, heights"}
    return [*rows, found | {"value": f"{drift:.1e}", "goal": (5e-6, None)}]


MEMORY = """
import re
from pathlib import Path
import numpy as np
from bench_transfer import BONES, marked, rotations
from meshes import bumpy_body
from tempose.transfer import MotionTransfer
mesh = bumpy_body(50_000)
solver = MotionTransfer(mesh, *marked(mesh), BONES, precision="single")
Q = np.tile(rotations(50), (20, 1, 1))
V = np.zeros((len(Q), len(mesh.vertices), 3), dtype=np.float32)
solver.pose_blocks(Q, V.__setitem__)
# unlike ru_maxrss this does not count the process that started this one
peak = re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())
print(int(peak[1]) / 1024**2, V.nbytes / 1024**3)
"""


def memory_row() -> dict[str, Any]:
    """Peak of a process of its own that solves a clip and keeps every frame."""
    here = Path(__file__).parent
    done = subprocess.run(
        [sys.executable, "-c", MEMORY], cwd=here, capture_output=True, text=True, check=True
    )
    peak, kept = (float(word) for word in done.stdout.split())
    return {
        "name": "transfer/memory/50k",
        "what": f"peak of a process that solves and keeps 1000 frames ({kept:.2f} GB of it)",
        "value": f"{peak:.2f} GB",
        "memory_mb": round(1024 * peak),
        "goal": (1.5, 0.7),
    }


def zero_click_row() -> dict[str, Any]:
    """A skeleton placed inside a human of 25 000 vertices, and its weights."""
    mesh = human_character(50_000).skin.mesh
    embed_skin(human_character(5_000).skin.mesh)  # compiles
    start = time.perf_counter()
    embed_skin(mesh)
    seconds = time.perf_counter() - start
    return {
        "name": "pairs/zero-click/25k",
        "what": f"skeleton and weights inside a bare body, {len(mesh.vertices)} vertices",
        "seconds": seconds,
        "value": f"{seconds:.1f} s",
        "goal": (10.0, 3.0),
    }


def run() -> list[dict[str, Any]]:
    """Rows of the table, smallest mesh first; every ratio is against the bare solve on the same mesh."""
    bodies = {label: bumpy_body(triangles) for label, triangles in SIZES.items()}
    rows = [row for label, mesh in bodies.items() for row in speed_rows(label, mesh)]
    return [*rows, memory_row(), zero_click_row()]
