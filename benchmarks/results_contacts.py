"""Contacts on real clips, free and held: skate, sinking, acceleration of the feet, edges and pose.

python benchmarks/results_contacts.py                  all pairs, renews the table
python benchmarks/results_contacts.py walk-makehuman   one pair, prints its rows
"""

from __future__ import annotations

import sys
from typing import Any

from real_bodies import DATA, MOTIONS, motion, person, reference_of
from results_page import line, table, write_block
from tempose.formats import load_skeleton_clip
from tempose.transfer import transfer_motion

PEOPLE = ("makehuman", "human-male")
COLUMNS = (
    "pair",
    "frames a second",
    "feet",
    "skate (source's) % H/s",
    "sinks cm",
    "ankle acceleration rms / p99 / max",
    "edges p1 / p99",
    "direction mean / max °",
    "moved by cm",
    "leg at longest",
    "unmet cm",
    "placement s",
)


def row(name: str, fps: float, held: bool, r: dict[str, Any]) -> str:
    speed, angle, feet = r["foot_acceleration"], r["bone_direction_deg"], r["contacts"].values()
    return line(
        name,
        f"{fps:.0f}",
        "held" if held else "free",
        f"{r['skate']:.3f} ({r['source_skate']:.1f})",
        f"{r['penetration_cm']:.2f}",
        f"{speed['rms']:.2f} / {speed['p99']:.2f} / {speed['max']:.2f}",
        f"{r['edge_ratio'][0]:.3f} / {r['edge_ratio'][1]:.3f}",
        f"{angle['mean']:.2f} / {angle['max']:.1f}",
        f"{max(f['largest_cm'] for f in feet):.1f}",
        f"{max(f['stretch'] for f in feet):.3f}",
        f"{max(f['unmet_cm'] for f in feet):.2f}",
        f"{r['seconds']['placement']:.1f}",
    )


def main(names: list[str]) -> None:
    rows: list[str] = []
    for name in names or [f"{clip}-{target}" for target in PEOPLE for clip in MOTIONS]:
        clip, target = next((c, t) for t in PEOPLE for c in MOTIONS if f"{c}-{t}" == name)
        whole = load_skeleton_clip(DATA / MOTIONS[clip][0])
        for source in (motion(clip), whole) if MOTIONS[clip][1] > 1 else (whole,):
            for held in (False, True):
                result = transfer_motion(source, person(target), contacts=held, **reference_of(clip))
                rows.append(row(name, source.fps, held, result.report))
                print(rows[-1], flush=True)
    if not names:
        write_block("contacts", table(COLUMNS, rows))


if __name__ == "__main__":
    main(sys.argv[1:])
