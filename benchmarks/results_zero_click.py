"""Transfer without a click: a skeleton placed inside four bodies, five motions each.

python benchmarks/results_zero_click.py              all, renews the table of docs/results.md and the sheets
python benchmarks/results_zero_click.py walk-crane   one pair, prints its rows
"""

from __future__ import annotations

import sys
import time

import numpy as np

from real_bodies import MOTIONS, ROOT, bare_person, motion, reference_of
from results_page import line, table, write_block
from tempose.render import contact_sheet, save_png
from tempose.transfer import TransferResult, transfer_motion

BODIES = ("makehuman", "human-male", "crane", "sample-human")
STAGES = {
    "before": {"contacts": False, "volume": 0.0},
    "contacts": {"contacts": True, "volume": 0.0},
    "contacts, volume": {"contacts": True, "volume": 1.0},
}
COLUMNS = (
    "pair",
    "with",
    "direction mean / max °",
    "edges p1 / p99",
    "flipped %",
    "folded %",
    "volume worst %",
    "skate (source's) % H/s",
    "sinks cm",
    "pairs s",
    "all s",
)


def run(clip: str, body: str, stage: str) -> TransferResult:
    return transfer_motion(motion(clip), bare_person(body), **STAGES[stage], **reference_of(clip))


def row(name: str, stage: str, result: TransferResult) -> str:
    r = result.report
    angles, skate, worst = r["bone_direction_deg"], r["skate"], r["volume_worst"]
    return line(
        name,
        stage,
        f"{angles['mean']:.1f} / {angles['max']:.1f}",
        f"{r['edge_ratio'][0]:.2f} / {r['edge_ratio'][1]:.2f}",
        f"{r['flipped_percent']:.3f}",
        f"{r['folded_percent']:.3f}",
        "-" if worst is None else f"{worst:.1f}",
        "-" if skate is None else f"{skate:.2f} ({r['source_skate']:.1f})",
        f"{r.get('penetration_cm', 0):.1f}",
        f"{r['seconds']['pairs']:.1f}",
        f"{r['seconds']['total']:.0f}",
    )


def sheet(name: str, result: TransferResult) -> None:
    frames = [int(t) for t in np.linspace(0, result.clip.n_frames - 1, 8)]
    assert result.source is not None
    image = contact_sheet([result.source, result.clip], frames=frames, views=("front", "side"))
    save_png(image, ROOT / "docs" / "gallery" / f"zero-click-{name}.png")


def main(names: list[str]) -> None:
    start = time.time()
    rows: list[str] = []
    for name in names or [f"{clip}-{body}" for body in BODIES for clip in MOTIONS]:
        clip = next(c for c in sorted(MOTIONS, key=len, reverse=True) if name.startswith(c + "-"))
        for stage in STAGES:
            result = run(clip, name[len(clip) + 1 :], stage)
            rows.append(row(name, stage, result))
            print(rows[-1], flush=True)
        if not clip.startswith("bandai"):
            sheet(name, result)
    if not names:
        write_block("zero-click", table(COLUMNS, rows))
        print(f"{time.time() - start:.0f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
