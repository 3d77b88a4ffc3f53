"""Halfway between two far poses in every shape space: volume, edges, times, and the picture of the docs.

python benchmarks/results_shape_spaces.py            renews the table and the pictures
python benchmarks/results_shape_spaces.py pictures   the pictures alone
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, cast

import numpy as np

import tempose
from real_bodies import DATA, ROOT
from results_page import line, table, write_block
from tempose.geometry import edge_list
from tempose.metrics import volumes
from tempose.render import Camera, render_frame, save_png
from tempose.render.text import draw_text
from tempose.shape_spaces import SPACES, EdgeDihedralSpace, ShapeSpace, shape_space
from tempose.shape_spaces.edge_dihedral.hinges import find_hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals

PICTURES = ROOT / "docs" / "shape_spaces"
# clip, the two frames from 0, which frames the space is made from
PAIRS: dict[str, tuple[str, int, int, slice]] = {
    "horse 3-6": ("horse-poses", 3, 6, slice(None)),
    "horse 0-4": ("horse-poses", 0, 4, slice(None)),
    "crane 0-100": ("vlasic-crane", 0, 100, slice(0, 101, 5)),
}
NOTES: dict[tuple[str, str], str] = {
    ("vertex", "horse 3-6"): "-4.5, .73/1.00, 5.3",
    ("vertex", "horse 0-4"): "-4.3, .70/1.00, 4.5",
    ("vertex", "crane 0-100"): "-44, .42/1.00, 4.6",
    ("gradient", "horse 3-6"): "+2.1, .90/1.03, 5.7",
    ("gradient", "horse 0-4"): "+2.0, .91/1.03",
    ("gradient", "crane 0-100"): "+1.1, .93/1.05, 2.1",
    ("patch", "horse 3-6"): "+2.4, .91/1.03, 5.0",
    ("patch", "horse 0-4"): "+2.1, .92/1.03, 4.5",
    ("patch", "crane 0-100"): "+1.2, .96/1.02, 1.6",
    ("edge-dihedral", "horse 3-6"): "+3.9, .91/1.06, 4.6",
    ("edge-dihedral", "horse 0-4"): "+4.0, .93/1.05, 4.0",
    ("edge-dihedral", "crane 0-100"): "+1.9, .97/1.03, 1.3",
    ("rotation-invariant", "horse 3-6"): "+6.0, .92/1.07, 4.2",
    ("rotation-invariant", "horse 0-4"): "+5.8, .93/1.06, 3.6",
    ("rotation-invariant", "crane 0-100"): "+3.2, .97/1.04, 2.2",
}
REFINED = "edge-dihedral, refined"
REFINED_NOTES = {
    "horse 3-6": "+4.1, .99/1.01, 3.7",
    "horse 0-4": "+3.6, .99/1.01, 3.2",
    "crane 0-100": "+2.3, .99/1.01, 1.3",
}
COLUMNS = (
    "pair",
    "space",
    "d",
    "round trip, D",
    "volume %",
    "edges p1 / p99",
    "bends deg",
    "prototype",
    "encode ms",
    "decode ms",
    "halfway ms",
)


@cache
def clip_of(name: str) -> tuple[np.ndarray, np.ndarray]:
    clip = tempose.load(DATA / name)
    return np.asarray(clip.vertices, dtype=np.float64), np.asarray(clip.faces)


@cache
def made(space: str, pair: str) -> tuple[ShapeSpace, np.ndarray]:
    """The space of the clip, and the pose halfway."""
    name, a, b, frames = PAIRS[pair]
    V, F = clip_of(name)
    found = shape_space(space, V[0], F, V[frames])
    return found, found.decode(found.encode(V[[a, b]]).mean(axis=0))


def least_ms(call: Callable[[], Any], times: int = 5) -> float:
    spent = []
    for _ in range(times):
        # processor time: other work on the machine does not count
        start = time.process_time()
        call()
        spent.append(time.process_time() - start)
    return 1000 * min(spent)


def quality(X: np.ndarray, A: np.ndarray, B: np.ndarray, F: np.ndarray) -> tuple[float, float, float, float]:
    """Volume against the mean of both in percent, edges against their mean length, rms of the bends."""
    v = volumes(np.stack([X, A, B]), F)
    edges, hinges = edge_list(F), find_hinges(F)
    lengths = [np.linalg.norm(P[edges[:, 0]] - P[edges[:, 1]], axis=1) for P in (X, A, B)]
    ratio = lengths[0] / (0.5 * (lengths[1] + lengths[2]))
    bends = [lengths_and_dihedrals(P, F, hinges)[1] for P in (X, A, B)]
    middle = np.angle(np.exp(1j * bends[1]) + np.exp(1j * bends[2]))
    away = np.angle(np.exp(1j * (bends[0] - middle)))
    low, high = np.percentile(ratio, [1, 99])
    return 100 * (v[0] / (0.5 * (v[1] + v[2])) - 1), low, high, float(np.degrees(np.sqrt(np.mean(away**2))))


def row(space: str, pair: str) -> str:
    if space == REFINED:
        return refined_row(pair)
    name, a, b, _ = PAIRS[pair]
    V, F = clip_of(name)
    found, X = made(space, pair)
    z = found.encode(V[[a, b]])
    D = float(np.linalg.norm(np.ptp(V[a], axis=0)))
    back = float(np.abs(found.decode(z) - V[[a, b]]).max()) / D
    volume, low, high, bends = quality(X, V[a], V[b], F)
    times = (
        least_ms(lambda: found.encode(V[a])),
        least_ms(lambda: found.decode(z[0])),
        least_ms(lambda: found.decode(z.mean(axis=0)), 2),
    )
    return line(
        pair,
        space,
        found.dimension,
        f"{back:.0e}",
        f"{volume:+.1f}",
        f"{low:.2f} / {high:.2f}",
        f"{bends:.1f}",
        NOTES[space, pair],
        *(f"{t:.1f}" for t in times),
    )


def refined_row(pair: str) -> str:
    """Lengths and dihedrals with Gauss-Newton to its end."""
    name, a, b, _ = PAIRS[pair]
    V, F = clip_of(name)
    found = cast(EdgeDihedralSpace, made("edge-dihedral", pair)[0])
    z = found.encode(V[[a, b]]).mean(axis=0)
    result = found.decode_measured(z, 8, near=0.0)
    volume, low, high, bends = quality(result.vertices, V[a], V[b], F)
    spent = least_ms(lambda: found.decode_measured(z, 8, near=0.0), 1)
    edges = f"{low:.2f} / {high:.2f}"
    note = f"{result.n_iter} Gauss-Newton steps"
    return line(
        pair,
        note,
        "",
        "",
        f"{volume:+.1f}",
        edges,
        f"{bends:.1f}",
        REFINED_NOTES[pair],
        "",
        "",
        f"{spent:.0f}",
    )


def picture(pair: str, azimuth: float, cell: tuple[int, int]) -> np.ndarray:
    """Both poses and what stands between them, in one row."""
    name, a, b, _ = PAIRS[pair]
    V, F = clip_of(name)
    shown = [("from", V[a]), *((space, made(space, pair)[1]) for space in SPACES), ("to", V[b])]
    centred = [(label, X - [*np.mean(X, axis=0)[[0]], X[:, 1].min(), X[:, 2].mean()]) for label, X in shown]
    everything = np.concatenate([X for _, X in centred])
    camera = Camera.fit(everything, azimuth, np.radians(8), aspect=cell[0] / cell[1])
    cells = []
    for label, X in centred:
        words = np.full((26, cell[0], 3), 255, dtype=np.uint8)
        draw_text(words, label, (cell[0] // 2, 5), 15, np.array([0.25, 0.25, 0.28]), "ma")
        cells.append(np.concatenate([words, render_frame(X, F, camera, size=cell, ground=0.0)]))
    return np.concatenate(cells, axis=1)


def pictures() -> None:
    PICTURES.mkdir(exist_ok=True)
    rows = [
        picture("crane 0-100", np.radians(40), (190, 300)),
        picture("horse 3-6", np.radians(70), (190, 170)),
    ]
    save_png(np.concatenate(rows), PICTURES / "halfway.png")
    print(Path("docs/shape_spaces/halfway.png"))


def main() -> None:
    if "pictures" not in sys.argv[1:]:
        rows = [row(space, pair) for pair in PAIRS for space in (*SPACES, REFINED)]
        write_block("shape-spaces", table(COLUMNS, rows))
        print("\n".join(rows))
    pictures()


if __name__ == "__main__":
    main()
