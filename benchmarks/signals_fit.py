"""The whole fit of an elastic clip, ours against the plain version, and the stages of both."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import BSpline

from signals_clips import elastic_ring
from tempose.clips import Mesh, MeshClip
from tempose.linalg.pca import gram_pca
from tempose.signals.pose import PoseLayout, PoseSignal, order_sites
from tempose.signals.pose.choose import pose_distances
from tempose.signals.time.fit import fit_time_signal
from tempose.signals.time.parameters import averaged_knots, centripetal_parameters

NUMBERS = {"k": 155, "l": 144, "m": 42}
"""Figure 6 of the paper: n = 204, d = 8712."""


def elastic_clip() -> MeshClip:
    """204 frames of 2904 vertices; simulated once, kept beside other temporary files."""
    kept = Path(tempfile.gettempdir()) / "tempose-elastic-ring.npz"
    if not kept.exists():
        clip = elastic_ring()
        np.savez(kept, vertices=clip.vertices, rest=clip.rest, faces=clip.faces, fps=clip.fps)
    with np.load(kept) as data:
        return MeshClip(data["vertices"], Mesh(data["rest"], data["faces"]), float(data["fps"]))


def timed(stages: dict[str, float], name: str, work: Callable[[], Any]) -> Any:
    start = time.process_time()
    found = work()
    stages[name] = time.process_time() - start
    return found


def ours(Z: np.ndarray, k: int, l: int, m: int) -> dict[str, float]:
    """Gram matrix, layout to 1e-6, one Gram-Schmidt for all sites, banded least squares."""
    seconds: dict[str, float] = {}
    pca = timed(seconds, "h", lambda: gram_pca(Z, m))
    X = pca.coordinates
    P = timed(seconds, "layout", lambda: PoseLayout(pose_distances(X)).solve(tolerance=1e-6).positions)
    timed(seconds, "g", lambda: order_sites(P, X, most=l).signal(l))
    timed(seconds, "f", lambda: fit_time_signal(P, k))
    return seconds


def plain(Z: np.ndarray, k: int, l: int, m: int) -> dict[str, float]:
    """What one writes first: thin SVD, plain SMACOF steps, a new least-squares problem for every site."""
    seconds: dict[str, float] = {}
    X = timed(seconds, "h", lambda: plain_shape(Z, m))
    P = timed(seconds, "layout", lambda: plain_layout(X))
    timed(seconds, "g", lambda: plain_pose(P, X, l))
    timed(seconds, "f", lambda: plain_time(P, k))
    return seconds


def plain_shape(Z: np.ndarray, m: int) -> np.ndarray:
    U, s, _ = np.linalg.svd(Z - Z.mean(axis=0), full_matrices=False)
    return U[:, :m] * s[:m]


def plain_layout(X: np.ndarray, tolerance: float = 1e-6) -> np.ndarray:
    """Plain Guttman steps from the first two coordinates until none is longer than a part of the layout."""
    D, P = np.linalg.norm(X[:, None] - X[None], axis=2), X[:, :2]
    while True:
        d = np.linalg.norm(P[:, None] - P[None], axis=2)
        B = np.where(d > 0, -D / np.where(d > 0, d, 1.0), 0.0)
        np.fill_diagonal(B, 0.0)
        np.fill_diagonal(B, -B.sum(axis=1))
        before, P = P, B @ P / len(P)
        if np.linalg.norm(P - before) <= tolerance * np.linalg.norm(P):
            return P


def plain_pose(P: np.ndarray, X: np.ndarray, l: int) -> tuple[np.ndarray, np.ndarray]:
    """The greedy order of section 3.2.2: least squares anew for every number of sites."""
    P = (P - P.mean(axis=0)) / np.sqrt(np.square(P - P.mean(axis=0)).sum(axis=1).mean())
    off = np.square(X[:, 2:]).sum(axis=1)
    sites = list(np.argsort(off)[::-1][:4])
    while True:
        columns = radial_columns(P, P[sites])
        solution = np.linalg.lstsq(columns, X, rcond=None)[0]
        if len(sites) == l:
            return np.array(sites), solution
        left = np.square(X - columns @ solution).sum(axis=1)
        left[sites] = -1.0
        sites.append(int(np.argmax(left)))


def radial_columns(P: np.ndarray, S: np.ndarray) -> np.ndarray:
    """Thin-plate functions of the sites under the side conditions, and the affine part."""
    r2 = np.square(P[:, None] - S[None]).sum(axis=2)
    phi = 0.5 * r2 * np.log(np.where(r2 > 0, r2, 1.0))
    side = np.column_stack([np.ones(len(S)), S])
    free = np.linalg.qr(side, mode="complete")[0][:, 3:]
    return np.column_stack([phi @ free, np.ones(len(P)), P])


def plain_time(P: np.ndarray, k: int) -> np.ndarray:
    t = centripetal_parameters(P)
    knots = averaged_knots(t, k)
    B = np.column_stack([BSpline(knots, np.eye(k)[j], 3)(t) for j in range(k)])
    return np.linalg.lstsq(B, P, rcond=None)[0]


def compare(rounds: int = 4) -> tuple[dict[str, float], dict[str, float]]:
    """Least processor seconds of every stage of both; one thread each."""
    clip = elastic_clip()
    Z = clip.vertices.astype(np.float64).reshape(clip.n_frames, -1)
    ours(Z, **NUMBERS)
    mine, theirs = ours(Z, **NUMBERS), plain(Z, **NUMBERS)
    for _ in range(rounds):
        mine = {name: min(s, mine[name]) for name, s in ours(Z, **NUMBERS).items()}
        theirs = {name: min(s, theirs[name]) for name, s in plain(Z, **NUMBERS).items()}
    return mine, theirs


def rows() -> list[dict[str, Any]]:
    mine, theirs = compare()
    names = {"h": "shape signal", "layout": "layout", "g": "all sites and pose signal", "f": "time signal"}
    found = [row(f"fit/{n}/204", f"{text} of 204 frames", mine[n], theirs[n]) for n, text in names.items()]
    whole = row("fit/204", "whole fit, 204 frames x 2904 vertices", sum(mine.values()), sum(theirs.values()))
    return [whole | {"goal": (15.0, 60.0)}, *found]


def row(name: str, what: str, seconds: float, against: float) -> dict[str, Any]:
    times = against / seconds
    return {
        "name": f"signals/{name}",
        "what": what,
        "seconds": seconds,
        "value": f"{1000 * seconds:.1f} ms, {times:.0f} times faster",
        "ratio": seconds / against,
        "against": f"plain version, {1000 * against:.0f} ms",
    }


def check_agreement() -> float:
    """Largest difference of the pose signal to that of the plain version on the same places, of its range."""
    clip = elastic_clip()
    X = plain_shape(clip.vertices.astype(np.float64).reshape(clip.n_frames, -1), NUMBERS["m"])
    P = plain_layout(X)
    order = order_sites(P, X)
    sites, solution = plain_pose(P, X, NUMBERS["l"])
    Q = (P - P.mean(axis=0)) / np.sqrt(np.square(P - P.mean(axis=0)).sum(axis=1).mean())
    theirs = radial_columns(Q, Q[sites]) @ solution
    pose: PoseSignal = order.signal(NUMBERS["l"])
    return float(np.abs(pose(P) - theirs).max() / np.ptp(X))


if __name__ == "__main__":
    for entry in rows():
        print(entry["name"], entry["value"], entry["against"])
    print("greatest difference of g at the frames", check_agreement())
