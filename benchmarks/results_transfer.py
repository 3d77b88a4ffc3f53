"""Transfer on real clips: the table of pairs in docs/results.md, and the contact sheets of docs/gallery.

python benchmarks/results_transfer.py                  all pairs, renews the table and the sheets
python benchmarks/results_transfer.py walk-makehuman   one pair, prints its row
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np

from real_bodies import DATA, MOTIONS, ROOT, motion, person, reference_of
from results_page import line, table, write_block
from tempose.formats import load_clip, load_mesh
from tempose.render import contact_sheet, save_png
from tempose.transfer import TransferResult, load_pairs, transfer_motion

SHEET_FRAMES = 8
PEOPLE = ("makehuman", "human-male")

# findings/transfer.md section 8, MakeHuman: direction mean / max, edge p1 / p99, worst volume, skate
TARGETS = {
    "walk": {0: "3 / 7 · .85 / 1.15 · -5 · 3", 1: "3 / 7 · .83 / 1.20 · -1.5 · 3"},
    "run": {0: "5 / 9 · .80 / 1.20 · -6 · 5", 1: "5 / 9 · .75 / 1.25 · -2 · 5"},
    "jump": {0: "5 / 9 · .80 / 1.20 · -15 · -", 1: "5 / 9 · .78 / 1.25 · -4 · -"},
}


def person_pair(clip: str, target: str, volume: float) -> TransferResult:
    return transfer_motion(motion(clip), person(target), volume=volume, **reference_of(clip))


def camel(volume: float) -> TransferResult:
    folder = DATA / "horse-camel-poses"
    return transfer_motion(
        load_clip(DATA / "horse-gallop", fps=24),
        load_mesh(folder / "camel_ref.obj"),
        load_pairs(folder / "horse_camel.cons"),
        source_rest=load_mesh(folder / "horse_ref.obj"),
        volume=volume,
    )


PAIRS: dict[str, Callable[[float], TransferResult]] = {
    f"{clip}-{target}": (lambda volume, c=clip, t=target: person_pair(c, t, volume))
    for target in PEOPLE
    for clip in MOTIONS
}
PAIRS["gallop-camel"] = camel


def row(name: str, result: TransferResult, volume: float) -> str:
    r = result.report
    direction = r.get("bone_direction_deg")
    angles = f"{direction['mean']:.1f} / {direction['max']:.1f}" if direction else "-"
    skate = "-" if r["skate"] is None else f"{r['skate']:.1f} ({r['source_skate']:.1f})"
    clip, _, target = name.partition("-makehuman")
    goal = TARGETS.get(clip, {}).get(round(volume), "") if target == "" and name.endswith("makehuman") else ""
    seconds = r["seconds"]
    cells = [
        name,
        f"{volume:g}",
        str(result.clip.n_frames),
        angles,
        f"{r['flipped_percent']:.3f}",
        f"{r['folded_percent']:.3f}",
        f"{r['edge_ratio'][0]:.2f} / {r['edge_ratio'][1]:.2f}",
        f"{r['volume_mean']:.1f} / {r['volume_worst']:.1f}",
        skate,
        f"{r.get('penetration_cm', 0):.1f}",
        f"{r['quaternion_norm_min']:.2f}",
        f"{seconds['set-up']:.1f} + {1000 * seconds['frames'] / result.clip.n_frames:.0f} ms",
        goal,
    ]
    return line(*cells)


COLUMNS = (
    "pair",
    "inner edges",
    "frames",
    "direction mean / max °",
    "flipped %",
    "folded %",
    "edges p1 / p99",
    "volume mean / worst %",
    "skate (source's) % H/s",
    "sinks cm",
    "min q",
    "set-up s + a frame",
    "goal: direction · edges · volume · skate",
)


def sheet(name: str, result: TransferResult) -> None:
    clips = [result.source, result.clip]
    if name.startswith("gallop"):
        clips = [load_clip(DATA / "horse-gallop", fps=24), result.clip]
    last = 23 if name.startswith("gallop") else result.clip.n_frames - 1
    frames = [int(t) for t in np.linspace(0, last, SHEET_FRAMES)]
    image = contact_sheet([c for c in clips if c is not None], frames=frames, views=("front", "side"))
    save_png(image, ROOT / "docs" / "gallery" / f"transfer-{name}.png")


def gap_change(result: TransferResult) -> float:
    """Largest change of the gap between linked pieces, percent of D."""
    from tempose.geometry import weld
    from tempose.transfer.solver.links import link_pieces

    mesh = result.clip.mesh
    first, inverse = weld(mesh.vertices)
    pairs = link_pieces(mesh.vertices[first], inverse[mesh.faces]).pairs
    if len(pairs) == 0:
        return 0.0
    i, j = first[pairs[:, 0]], first[pairs[:, 1]]
    rest = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    now = np.linalg.norm(result.clip.vertices[:, i].astype(float) - result.clip.vertices[:, j], axis=2)
    return float(100 * np.abs(now - rest).max() / mesh.diagonal)


def main(names: list[str]) -> None:
    start = time.time()
    rows: list[str] = []
    for name in names or PAIRS:
        for volume in (0.0, 1.0):
            result = PAIRS[name](volume)
            rows.append(row(name, result, volume))
            print(rows[-1], flush=True)
            if name.endswith("human-male"):
                print(f"  gap between pieces changes by at most {gap_change(result):.2f} % D")
            if not names and volume == 0:
                sheet(name, result)
    if not names:
        write_block("pairs", table(COLUMNS, rows))
        print(f"{time.time() - start:.0f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
