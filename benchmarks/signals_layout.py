"""Layouts and sites: scaling cold and while dragging, the greedy order against a fit for every step."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from signals_fit import plain_layout
from tempose.signals.pose import PoseLayout, choose_layout, order_sites
from tempose.signals.pose.choose import pose_distances

SITES = 144
"""Of figure 6 of the paper, with n = 204 and m = 42."""


def least(task: Callable[[], Any], rounds: int) -> float:
    """Least seconds of some runs: a shared machine only ever adds to them."""
    task()
    seconds = [np.inf]
    for _ in range(rounds):
        start = time.perf_counter()
        task()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def bouncing(n: int, m: int = 42) -> np.ndarray:
    """Shape coordinates of a motion with m modes, the later the faster and smaller, as of an elastic body."""
    rng = np.random.default_rng(7)
    t, mode = np.linspace(0.0, n / 20, n), np.arange(1, m + 1)
    speed, phase = 0.4 * mode * rng.uniform(0.7, 1.3, m), rng.uniform(0, 2 * np.pi, m)
    return np.sin(t[:, None] * speed + phase) / mode**1.3


def plain_order(P: np.ndarray, X: np.ndarray, sites: int) -> list[int]:
    """Section 3.2.2 as it is written: a least-squares fit for every number of sites."""
    Q = (P - P.mean(axis=0)) / np.sqrt(np.square(P - P.mean(axis=0)).sum(axis=1).mean())
    order = list(np.argsort(-np.square(X[:, 2:]).sum(axis=1))[:4])
    r2 = np.square(Q[:, None] - Q[None]).sum(axis=2)
    phi = 0.5 * r2 * np.log(np.where(r2 > 0, r2, 1.0))
    for _ in range(4, sites):
        affine = np.column_stack([np.ones(len(order)), Q[order]])
        null = np.linalg.qr(affine, mode="complete")[0][:, 3:]
        columns = np.column_stack([phi[:, order] @ null, np.ones(len(Q)), Q])
        off = np.linalg.norm(columns @ np.linalg.lstsq(columns, X, rcond=None)[0] - X, axis=1)
        off[order] = -1.0
        order.append(int(off.argmax()))
    return order


def drag_row(n: int, goal: tuple[float, float]) -> dict[str, Any]:
    layout = PoseLayout(pose_distances(bouncing(n)))
    P = layout.solve().positions
    pins = {0: P[0], n // 2: P[n // 2] * 1.3 + 0.05}
    seconds = least(lambda: layout.drag(P, pins), 30)
    return {
        "name": f"signals/drag {n}",
        "what": f"constrained MDS while dragging, {n} frames: 5 passes",
        "seconds": seconds,
        "goal": goal,
    }


def rows() -> list[dict[str, Any]]:
    """Rows of the table of benchmarks."""
    X = bouncing(204)
    D = pose_distances(X)
    layout = PoseLayout(D)
    found = layout.solve()
    P = found.positions
    cold, plain = least(layout.solve, 10), least(lambda: plain_layout(X), 1)
    greedy = least(lambda: order_sites(P, X, most=SITES), 10)
    refit = least(lambda: plain_order(P, X, SITES), 1)
    chosen = choose_layout(X)
    table: list[dict[str, Any]] = [
        {
            "name": "signals/layout",
            "what": f"MDS of 204 frames to 1e-6, cold: {found.n_iter} passes",
            "seconds": cold,
            "ratio": plain / cold,
            "against": "plain SMACOF in numpy",
        },
        drag_row(204, (2.0, 0.5)),
        drag_row(1000, (16.0, 10.0)),
        {
            "name": "signals/sites",
            "what": f"greedy order of {SITES} sites, 204 frames, m = 42, with every error",
            "seconds": greedy,
            "ratio": refit / greedy,
            "against": "a fit for every site",
        },
        {
            "name": "signals/choose",
            "what": f"choose_layout, 204 frames: {chosen.name}, {chosen.tried[0].bad} bad with plain MDS",
            "seconds": least(lambda: choose_layout(X), 1),
        },
    ]
    return table


if __name__ == "__main__":
    for entry in rows():
        print(entry["name"], entry["what"], f"{1000 * entry['seconds']:.2f} ms", entry.get("ratio", ""))
