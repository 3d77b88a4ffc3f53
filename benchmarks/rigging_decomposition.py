"""Rows of the suite "rigging": skinning decomposition of a moving chain, its steps and their cost by size."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from tempose.rigging.decomposition import decompose
from tempose.rigging.decomposition.growth import grow
from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.steps import bone_step, predicted, weight_step
from tempose.rotations import from_rotation_vector, to_matrix

VERTICES, FRAMES, BONES = 8_000, 48, 20


def swaying(n: int, T: int) -> tuple[np.ndarray, np.ndarray]:
    """A long body whose cross-sections turn smoothly along it, other in each frame."""
    rng = np.random.default_rng(0)
    rest = rng.standard_normal((n, 3)) * [0.1, 0.1, 0.0] + [0, 0, 1] * rng.random((n, 1))
    t = np.arange(T)[:, None]
    angles = np.sin(2 * np.pi * (rest[:, 2] * 2 + t / 24))[..., None] * [0.4, 0.2, 0.0]
    R = to_matrix(from_rotation_vector(angles))
    return rest, np.einsum("tnij,nj->tni", R, rest)


def least(task: Callable[[], Any], rounds: int = 5) -> float:
    times: list[float] = []
    for _ in range(rounds):
        start = time.process_time()
        task()
        times.append(time.process_time() - start)
    return min(times)


def rows() -> list[dict[str, Any]]:
    rest, frames = swaying(VERTICES, FRAMES)
    problem = Problem.of(rest, frames)
    part = problem.part(np.arange(0, VERTICES, 8))
    found, _ = grow(part, BONES, 4, np.random.default_rng(0), 1e-9)
    n, B = VERTICES, found.n_bones
    state = State(found.motions, np.zeros((n, 4), np.int64), np.zeros((n, 4)), np.zeros(n))
    weight_step(problem, state)
    size = f"{n} vertices, {FRAMES} frames, {B} bones"
    once = least(lambda: predicted(problem, state))
    tasks = {
        "predict": ("what the bones make, once", once),
        "weights": (f"weights of all vertices, {size}", least(lambda: weight_step(problem, state))),
        "bones": (f"motions of all bones, {size}", least(lambda: bone_step(problem, state))),
        "whole": (f"decomposition, {size}", least(lambda: decompose(frames, rest, bones=BONES), 1)),
    }
    return [
        {
            "name": f"rigging/decomposition/{name}",
            "what": what,
            "seconds": seconds,
            "ratio": seconds / once,
            "against": "what the bones make, once",
        }
        for name, (what, seconds) in tasks.items()
    ]


if __name__ == "__main__":
    for row in rows():
        print(f"{row['name']}: {row['what']}: {1000 * row['seconds']:.1f} ms")
