"""Signals: playing, fitting and encoding against plain numpy, in one run."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from meshes import bumpy_body
from tempose.clips import MeshClip
from tempose.signals import SignalModel
from tempose.signals.sampling import sample

FRAMES = 24
BATCH = 500
CALLS = 20
OTHERS = ("signals_fit", "signals_layout", "signals_gradients")
"""Modules beside this one whose `rows` belong to the table."""


def interleaved(tasks: dict[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Least processor seconds of each task, run in turn on one thread: others at work hardly count."""
    for task in tasks.values():
        task()
    least = dict.fromkeys(tasks, np.inf)
    for _ in range(rounds):
        for name, task in tasks.items():
            start = time.process_time()
            task()
            least[name] = min(least[name], time.process_time() - start)
    return least


def swaying_body() -> MeshClip:
    """24 frames of a body with a little more vertices than the paper's horse, bending about several axes."""
    mesh = bumpy_body(4 * 66**2)
    V = mesh.vertices
    t = 2 * np.pi * np.arange(FRAMES) / FRAMES
    waves = np.stack([np.sin((1 + i) * t + i) / (1 + i) for i in range(6)], axis=1)
    y = (V[:, 1] - V[:, 1].min()) / mesh.height
    shapes = [np.outer(y ** (1 + i), np.roll([0.2, 0.05, 0.1], i)) for i in range(6)]
    return MeshClip(V + np.einsum("ti,ivc->tvc", waves, np.stack(shapes)), mesh, 24.0)


def plain_numpy(model: SignalModel) -> Callable[[float], np.ndarray]:
    """The same psi as one writes it first: the sum over all sites and modes in double precision."""
    from scipy.interpolate import BSpline, CubicHermiteSpline

    s = model.signals_
    curve = BSpline(s.time.curve.knots, s.time.curve.controls, 3)
    pace = CubicHermiteSpline(s.time.pace.keys, s.time.pace.values, s.time.pace.slopes)

    def psi(t: float) -> np.ndarray:
        p = curve(pace(t * s.rate))
        r = np.linalg.norm(s.pose.sites - p, axis=1) / s.pose.radius
        phi = r**2 * np.log(np.where(r > 0, r, 1.0))
        q = (p - s.pose.centre) / s.pose.radius
        x = phi @ s.pose.weights + s.pose.affine[0] + q @ s.pose.affine[1:]
        return (s.shape.mean + s.shape.components.T @ x).reshape(-1, 3)

    return psi


def playing_rows() -> list[dict[str, Any]]:
    """One psi(t) and a batch of them, 8431 vertices, m = 7."""
    model = SignalModel(k=16, l=12, m=6).fit(swaying_body())
    signals = with_modes(model, 7)
    paper = replace(signals, path=None)
    model.signals_ = signals
    literal = SignalModel(k=16, l=12, m=6)
    literal.signals_ = paper
    psi = plain_numpy(literal)
    times = np.linspace(0.0, signals.duration, BATCH)
    out = np.zeros((BATCH, len(signals.mesh.vertices), 3), np.float32)
    tasks: dict[str, Callable[[], Any]] = {
        "plain": lambda: [psi(t) for t in times[:CALLS]],
        "one": lambda: [model(t) for t in times[:CALLS]],
        "one, paper": lambda: [literal(t) for t in times[:CALLS]],
        "batch": lambda: sample(signals, times, out),
        "batch, paper": lambda: sample(paper, times, out),
        "batch, new array": lambda: sample(signals, times),
    }
    seconds = interleaved(tasks, 40)
    seconds |= {name: seconds[name] / CALLS for name in ("plain", "one", "one, paper")}
    assert np.abs(psi(0.3) - literal(0.3, dtype=np.float64)).max() < 1e-9
    n = len(signals.mesh.vertices)
    found = [line("psi/plain", f"one psi(t) in plain numpy, {n} vertices, m = 7", seconds["plain"], seconds)]
    text = {"one": "one psi(t), the default", "one, paper": "one psi(t), literally h(g(f(t)))"}
    for name, what in text.items():
        found.append(
            line(f"psi/{name}", f"{what}, {n} vertices, m = 7, ms", seconds[name], seconds)
            | {"goal": (0.15, 0.04)}
        )
    for name in ("batch", "batch, paper", "batch, new array"):
        each = seconds[name] / BATCH
        found.append(
            line(f"psi/{name}", f"{BATCH} frames at once, same, frames/s", each, seconds)
            | {"value": f"{1 / each:.0f} frames/s", "goal": (15_000, 50_000)}
        )
    return found


def with_modes(model: SignalModel, m: int) -> Any:
    """Signals of a model with modes of nothing added, so that m is the paper's."""
    s = model.signals_
    more = m - len(s.shape.components)
    rows = 1e-3 * np.random.default_rng(0).normal(size=(more, s.shape.components.shape[1]))
    shape = replace(s.shape, components=np.concatenate([s.shape.components, rows]))
    pose = replace(
        s.pose,
        weights=np.pad(s.pose.weights, ((0, 0), (0, more))),
        affine=np.pad(s.pose.affine, ((0, 0), (0, more))),
    )
    assert s.path is not None
    path = s.path.with_controls(np.pad(s.path.controls, ((0, 0), (0, more))))
    return replace(s, shape=shape, pose=pose, path=path)


def line(name: str, what: str, seconds: float, all_seconds: dict[str, float]) -> dict[str, Any]:
    return {
        "name": f"signals/{name}",
        "what": what,
        "seconds": seconds,
        "value": f"{1000 * seconds:.3f} ms",
        "ratio": seconds / all_seconds["plain"],
        "against": "plain numpy",
    }


def run() -> list[dict[str, Any]]:
    """Rows of the table."""
    found = playing_rows()
    for name in OTHERS:
        try:
            module = importlib.import_module(name)
        except ModuleNotFoundError as error:
            if error.name != name:
                raise
            continue
        found += module.rows()
    return found


if __name__ == "__main__":
    for entry in playing_rows():
        print(entry["name"], entry["value"], f"{entry['ratio']:.2f}", entry.get("goal", ""))
