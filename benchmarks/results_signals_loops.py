"""Loops: strides that coincide in the pose plane, loops found, seams before and after closing.

python benchmarks/results_signals_loops.py        all, renews the tables
python benchmarks/results_signals_loops.py crane  one clip, prints its rows
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from real_bodies import DATA
from results_page import line, table, write_block
from signals_clips import elastic_ring
from tempose import load
from tempose.clips import MeshClip
from tempose.signals import SignalModel, Signals
from tempose.signals.loops import Loop, close_loop, find_loops
from tempose.signals.time.splice import Join, splice

# how many of the loops found are closed, and further ones
CLIPS: dict[str, tuple[int, tuple[tuple[int, int], ...]]] = {
    "horse-48": (2, ((11, 23),)),
    "crane": (1, ((19, 29),)),
    "elastic ring": (0, ((0, 12),)),  # it dies away: there is none
}
FOUND = ("clip", "loop", "frames", "distance (steps)", "velocity (mean speeds)", "grade")
CLOSED = ("clip", "loop", "closed by", "seam step / median", "seam acceleration / median", "frames change by")
WAYS: dict[str, Join | None] = {
    "nothing": None,
    "offsets, half-life 1": Join(half_life=1.0),
    "offsets, half-life 3 (default)": Join(),
    "crossfade of 6 frames": Join(fade=6.0),
    "2 frames inserted": Join(insert=2),
    "4 frames inserted": Join(insert=4),
}


def clip_of(name: str) -> MeshClip:
    if name == "elastic ring":
        return elastic_ring()
    clip: Any = load(DATA / {"horse-48": "horse-gallop", "crane": "vlasic-crane"}[name])
    return clip


def cycle(signals: Signals, start: int, stop: int, way: Join | None) -> tuple[np.ndarray, np.ndarray]:
    """Return the coordinates of one cycle, and how far its frames lie from those captured."""
    x = signals.coordinates(signals.times)[start:stop]
    if way is None:
        return x, np.zeros(len(x))
    if way == Join():
        closed = close_loop(signals, start, stop, insert=0)
    else:
        closed = splice(signals, [(start / signals.fps, stop / signals.fps)], way, closed=True)
    z = closed.coordinates(closed.times)[:-1]
    return z, np.linalg.norm(z[: len(x)] - x, axis=1)


def seam(z: np.ndarray, length: int) -> tuple[float, float]:
    """Return the largest step and acceleration from the last frame to the first, over the median ones."""
    round_twice = np.concatenate([z, z, z])
    n = len(z)
    steps = np.linalg.norm(np.diff(round_twice, axis=0), axis=1)
    bends = np.linalg.norm(np.diff(round_twice, 2, axis=0), axis=1)
    middle = slice(length - 1, n), slice(length - 2, n)
    one = steps[n : 2 * n], bends[n : 2 * n]
    return (
        float(steps[middle[0]].max() / np.median(one[0])),
        float(bends[middle[1]].max() / np.median(one[1])),
    )


def rows_of(name: str) -> tuple[list[str], list[str], str]:
    clip = clip_of(name)
    n = clip.n_frames
    model = SignalModel(k=n + 2, l=n, m=n - 1, layout="mds").fit(clip)
    signals = model.signals_
    X = signals.coordinates(signals.times)
    unit = 100 / (clip.mesh.diagonal * np.sqrt(len(clip.mesh.vertices)))
    loops = find_loops(X, fps=signals.fps)
    shown = best_by_period(loops)
    found = [
        line(name, f"{k.start} - {k.stop}", k.period, f"{k.distance:.3f}", f"{k.velocity:.3f}", k.grade)
        for k in shown
    ]
    closed: list[str] = []
    count, further = CLIPS[name]
    for start, stop in (*((k.start, k.stop) for k in shown[:count]), *further):
        for label, way in WAYS.items():
            z, change = cycle(signals, start, stop, way)
            step, bend = seam(z, stop - start)
            cells = f"{step:.2f}", f"{bend:.2f}", f"{change.max() * unit:.2f} % D"
            closed.append(line(name, f"{start} - {stop}", label, *cells))
    return found, closed, strides(model) if name == "horse-48" else ""


def best_by_period(loops: list[Loop]) -> list[Loop]:
    best = dict[int, Loop]()
    for loop in loops:
        best.setdefault(loop.period, loop)
    return list(best.values())[:3]


def strides(model: SignalModel) -> str:
    P = model.positions_
    apart = np.linalg.norm(P[:24] - P[24:48], axis=1).mean()
    extent = np.linalg.norm(np.ptp(P, axis=0))
    return (
        f"Horse gallop, 48 frames: frame i and i + 24 lie {100 * apart / extent:.2g} % of the curve's extent "
        f"apart in the pose plane; the period found is {model.report_['period']:g} frames."
    )


def main() -> None:
    found, closed, text = list[str](), list[str](), ""
    for name in sys.argv[1:] or CLIPS:
        rows = rows_of(name)
        found, closed, text = found + rows[0], closed + rows[1], text or rows[2]
        print(*rows[0], *rows[1], rows[2], sep="\n", flush=True)
    if not sys.argv[1:]:
        write_block("signals-loops", [text, "", *table(FOUND, found), "", *table(CLOSED, closed)])


if __name__ == "__main__":
    main()
