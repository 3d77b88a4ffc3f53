"""Training of learned detail: 100 steps of the latent model and the default, whatever the number of vertices.

python benchmarks/detail_training.py    the rows, printed
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from tempose.detail.gplvm import SharedObjective, gram_factor, unit_gram
from tempose.detail.learners import LEARNERS
from tempose.detail.regions import region_grams
from tempose.detail.training import Inputs, Training

JOINTS, REGIONS, RANK = 17, 18, 60
VERTICES = (500, 10_000, 100_000)
GOALS = {100: (0.5, 0.15), 400: (5.0, 2.0)}
ROUNDS = 2


def swings(T: int, count: int, rng: np.random.Generator) -> np.ndarray:
    """(T, count) angles driven by four swings of wandering pace, 30 frames a second."""
    pace = 1 + 0.3 * np.sin(np.arange(T)[:, None] / 40 + rng.uniform(0, 6, 4))
    phase = np.cumsum(2 * np.pi * np.array([0.8, 1.0, 1.3, 1.7]) * pace / 30, axis=0)
    return 0.3 * np.sin(phase) @ rng.normal(size=(4, count))


def residuals(T: int, n: int) -> tuple[Inputs, np.ndarray, np.ndarray]:
    """Inputs, residuals (T, n, 3) that bend with pose and velocity, shares (n, REGIONS) of soft regions."""
    rng = np.random.default_rng(0)
    angles = swings(T, 3 * JOINTS, rng).reshape(T, JOINTS, 3)
    velocity = np.diff(angles, axis=0, prepend=angles[:1])
    seen = np.concatenate([angles, 5 * velocity], axis=1).reshape(T, -1)
    bent = np.tanh(seen @ rng.normal(size=(seen.shape[1], RANK))) + 0.05 * rng.normal(size=(T, RANK))
    D = (0.003 * bent @ rng.normal(size=(RANK, 3 * n))).astype(np.float32).reshape(T, n, 3)
    place = np.sort(rng.uniform(0, REGIONS - 1, n))
    shares = np.maximum(1 - np.abs(place[:, None] - np.arange(REGIONS)), 0)
    inputs = Inputs(angles, velocity, np.zeros((T, 0)), np.zeros(T, dtype=np.int64))
    return inputs, D, shares / shares.sum(axis=1, keepdims=True)


def least(task: Callable[[], Any], rounds: int = ROUNDS) -> float:
    """Least processor seconds of a few runs: others at work hardly count."""
    found = np.inf
    for _ in range(rounds):
        start = time.process_time()
        task()
        found = min(found, time.process_time() - start)
    return found


def plain_objective(X: np.ndarray, Y: np.ndarray, D: np.ndarray) -> tuple[float, np.ndarray]:
    """The three likelihoods and their slope in the points as one writes them first, with all coordinates."""
    apart = np.square(X[:, None] - X).sum(axis=2)
    value, slope = 0.0, np.zeros_like(X)
    for Z in (Y, D):
        P = np.exp(-0.5 * apart)
        inverse = np.linalg.inv(P + 0.05 * np.eye(len(X)))
        A = inverse @ Z
        E = 0.5 * (Z.shape[1] * inverse - A @ A.T) * P
        value += 0.5 * (-Z.shape[1] * np.linalg.slogdet(inverse)[1] + float((Z * A).sum()))
        slope -= 2 * (E.sum(axis=1)[:, None] * X - E @ X)
    before = X[:-1]
    K = P[:-1, :-1] + before @ before.T + 0.05 * np.eye(len(before))
    inverse = np.linalg.inv(K)
    A = inverse @ X[1:]
    E = 0.5 * (X.shape[1] * inverse - A @ A.T)
    W = E * P[:-1, :-1]
    slope[:-1] += 2 * E @ before - 2 * (W.sum(axis=1)[:, None] * before - W @ before)
    slope[1:] += A
    value += 0.5 * (np.linalg.slogdet(K)[1] * X.shape[1] + float((X[1:] * A).sum()))
    return value, slope


def objective_rows(T: int = 100, q: int = 4) -> tuple[list[dict[str, Any]], float]:
    """One value and slope of the joint likelihood, and the plain seconds."""
    inputs, D, _ = residuals(T, VERTICES[1])
    flat = D.reshape(T, -1).astype(np.float64)
    flat -= flat.mean(axis=0)
    Y = np.concatenate([inputs.angles, inputs.angles - inputs.velocity], axis=1).reshape(T, -1)
    Y -= Y.mean(axis=0)
    factors = [np.asfortranarray(gram_factor(unit_gram(Z @ Z.T)[0])) for Z in (Y, flat)]
    joint = SharedObjective(*factors, np.arange(T - 1), np.array([0]), (102.0, 30_000.0, float(q)), q)
    theta = np.concatenate([factors[0][:, :q].ravel(), np.log([1, 1, 0.05, 1, 1, 0.05, 0.5, 0.5, 0.05, 0.5])])
    X = theta[: T * q].reshape(T, q)
    joint(theta)
    plain = least(lambda: plain_objective(X, Y, flat), 3)
    seconds = least(lambda: [joint(theta) for _ in range(20)], 3) / 20
    what = f"value and slope of the joint likelihood, {T} frames, {VERTICES[1]} vertices"
    return [
        row("objective/plain numpy", f"{what}, from the vertices", plain, plain, None),
        row("objective", f"{what}, from inner products", seconds, plain, None),
    ], plain


def row(
    name: str, what: str, seconds: float, against: float, goal: tuple[float, float] | None
) -> dict[str, Any]:
    return {
        "name": f"detail/{name}",
        "what": what,
        "seconds": seconds,
        "value": f"{seconds:.2f} s" if seconds > 0.1 else f"{1000 * seconds:.2f} ms",
        "ratio": seconds / against,
        "against": "plain numpy, 100 steps" if goal else "plain numpy",
        "goal": goal,
    }


def training_rows(plain: float) -> list[dict[str, Any]]:
    """Each learner at 100 and 400 frames, from Gram matrices to a predictor."""
    found: list[dict[str, Any]] = []
    for T, goal in GOALS.items():
        inputs, D, shares = residuals(T, VERTICES[0])
        training = Training(inputs, *region_grams(D, shares))
        for name in ("gplvm-paper", "gplvm", "regional-gp"):
            learner = LEARNERS[name]()
            LEARNERS["gplvm" if name != "regional-gp" else name]().fit(training.take(np.arange(20)))
            seconds = least(lambda learner=learner, training=training: learner.fit(training))
            # a step of the plain way grows with the square of the frames: its products with the vertices
            steps = 100 * plain * (T / 100) ** 2
            found.append(row(f"train/{name}/{T}", f"{name} from {T} frames", seconds, steps, goal))
    return found


def vertex_rows(T: int = 100) -> list[dict[str, Any]]:
    """Inner products once, and the training after them, for few and many vertices."""
    found: list[dict[str, Any]] = []
    few = 0.0
    for n in VERTICES:
        inputs, D, shares = residuals(T, n)
        grams, sizes = region_grams(D, shares)
        once = least(lambda D=D, shares=shares: region_grams(D, shares))
        learner = replace(LEARNERS["gplvm-paper"](), iterations=100)
        training = Training(inputs, grams, sizes)
        learning = least(lambda training=training, learner=learner: learner.fit(training))
        few = few or learning
        entry = row(
            f"vertices/{n}", f"{T} frames: latent model as in the paper, {n} vertices", learning, few, None
        )
        found.append(entry | {"against": f"{VERTICES[0]} vertices"})
        what = f"inner products of {n} vertices in {REGIONS} regions, once"
        found.append(row(f"grams/{n}", what, once, few, None) | {"against": "that training"})
    return found


def rows() -> list[dict[str, Any]]:
    found, plain = objective_rows()
    return [*found, *training_rows(plain), *vertex_rows()]


if __name__ == "__main__":
    for entry in rows():
        print(
            f"{entry['name']:36} {entry['value']:>10} {entry['ratio']:.3f} {entry['against']} {entry['goal']}"
        )
