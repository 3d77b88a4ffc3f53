"""Bad transitions: what plain scaling makes of clips, what the automatic layout makes of them.

python benchmarks/results_signals_transitions.py            all, renews the table and the picture
python benchmarks/results_signals_transitions.py gestures   one clip, prints its rows
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from real_bodies import DATA
from results_page import line, table, write_block
from signals_clips import elastic_ring, four_gestures
from tempose import load
from tempose.clips import MeshClip
from tempose.clips.resample import select_frames
from tempose.curves import interpolating_spline
from tempose.linalg.pca import gram_pca
from tempose.metrics import compare
from tempose.render.drawing import save_drawing
from tempose.shape_spaces import shape_space
from tempose.signals import Signals
from tempose.signals.pictures import draw_pose_plane
from tempose.signals.pose import choose_layout, densified_pose_signal, find_bad_transitions, order_sites
from tempose.signals.pose.choose import LayoutChoice
from tempose.signals.pose.middles import curve_through
from tempose.signals.shape.signal import ShapeSignal

COLUMNS = (
    "clip, kept",
    "layout",
    "bad",
    "worst, steps",
    "crossings",
    "stress",
    "aspect",
    "the paper's psi",
    "g of 3n sites",
    "default",
    "steepness p99",
)
GALLERY = Path(__file__).resolve().parents[1] / "docs" / "gallery"


def horse() -> MeshClip:
    clip: Any = load(DATA / "horse-gallop")
    return select_frames(clip, 0, 24, 1)


CLIPS: dict[str, tuple[Callable[[], MeshClip], tuple[int, ...]]] = {
    "gestures": (four_gestures, (4, 2)),
    "ring": (lambda: elastic_ring(407, fps=50.0), (2, 4)),
    "horse": (horse, (1, 2)),
}


class Kept:
    """Every few frames of a clip, and the frames between them."""

    def __init__(self, name: str, clip: MeshClip, every: int) -> None:
        self.name, self.clip, self.every = name, clip, every
        V = np.asarray(clip.vertices, dtype=np.float64)
        self.kept = np.arange(0, len(V), every)
        self.pca = gram_pca(V[self.kept].reshape(len(self.kept), -1))
        self.X = self.pca.coordinates
        self.n = len(self.X)
        self.path = interpolating_spline(np.arange(self.n, dtype=np.float64), self.X)
        if every == 1:
            # nothing is known between the frames: the time spline stands for it
            self.ticks = (np.arange(self.n - 1)[:, None] + np.array([0.25, 0.5, 0.75])).ravel()
            self.truth = self.vertices(self.path(self.ticks))
        else:
            between = np.setdiff1d(np.arange(self.kept[-1]), self.kept)
            self.ticks, self.truth = between / every, V[between]

    def vertices(self, x: np.ndarray) -> np.ndarray:
        return (self.pca.mean + x @ self.pca.components).reshape(len(x), -1, 3)

    def error(self, x: np.ndarray) -> str:
        return f"{compare(self.truth, self.vertices(x), self.clip.mesh.diagonal).kg:.2f}"

    def row(self, layout: str, P: np.ndarray, samples: tuple[np.ndarray, np.ndarray], judged: Any) -> str:
        f = curve_through(P)
        g, dense = order_sites(*samples).signal(), densified_pose_signal(P, self.X, f)
        found = find_bad_transitions(g, f, self.X)
        steep = np.linalg.norm(g.jacobian(f(self.ticks)), ord=2, axis=(1, 2))
        default = "0 (is the spline)" if self.every == 1 else self.error(self.path(self.ticks))
        return line(
            f"{self.name}, {self.n} of {self.clip.n_frames}",
            layout,
            f"{found.bad.sum()} of {self.n - 1}",
            f"{found.worst:.2f}",
            judged.crossings,
            f"{judged.stress:.3f}",
            f"{judged.aspect:.2f}",
            self.error(g(f(self.ticks))),
            self.error(dense(f(self.ticks))),
            default,
            f"{np.percentile(steep, 99):.1f}",
        )

    def signals(self, P: np.ndarray, samples: tuple[np.ndarray, np.ndarray]) -> Signals:
        clip = self.clip
        space = shape_space(
            "vertex", clip.rest, clip.faces, np.asarray(clip.vertices[self.kept], dtype=float)
        )
        shape = ShapeSignal(space, self.pca.mean, self.pca.components)
        fps = clip.fps / self.every
        return Signals(
            shape, order_sites(*samples).signal(), curve_through(P), None, None, (), fps, fps, clip.mesh
        )


def rows(name: str, pictures: bool = False) -> list[str]:
    make, steps = CLIPS[name]
    clip, found = make(), list[str]()
    for every in steps:
        case = Kept(name, clip, every)
        choice: LayoutChoice = choose_layout(case.X)
        plain, samples = choice.tried[0], choice.samples(case.X)
        found.append(case.row("plain MDS", plain.positions, (plain.positions, case.X), plain))
        print(found[-1], flush=True)
        if choice.name != "mds":
            found.append(case.row(f"automatic: {choice.name}", choice.positions, samples, choice))
            print(found[-1], flush=True)
        if pictures and every == steps[0] and name == "gestures":
            before, after = (
                case.signals(plain.positions, (plain.positions, case.X)),
                case.signals(choice.positions, samples),
            )
            bad = np.flatnonzero(plain.transitions.bad).tolist()
            draw(f"signals-transitions-{name}-before", before, bad, f"plain MDS: {len(bad)} bad transitions")
            draw(f"signals-transitions-{name}-after", after, choice.bad.tolist(), f"automatic: {choice.name}")
    return found


def draw(name: str, signals: Signals, bad: list[int], title: str) -> None:
    save_drawing(draw_pose_plane(signals, bad=bad, title=title), GALLERY / f"{name}.png", 1.0)


def main() -> None:
    if len(sys.argv) > 1:
        rows(sys.argv[1])
        return
    write_block("signals-transitions", table(COLUMNS, [row for name in CLIPS for row in rows(name, True)]))


if __name__ == "__main__":
    main()
