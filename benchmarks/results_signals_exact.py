"""Exactness of the literal representation: k - 2 = l = m + 1 = T gives every frame back.

python benchmarks/results_signals_exact.py [CLIP ...]      all clips, or some, in all shape spaces
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from real_bodies import DATA
from results_page import PAGE, line, table, write_block
from tempose.clips import MeshClip
from tempose.formats import load_clip
from tempose.samples import sample_clip
from tempose.shape_spaces import SPACES
from tempose.signals import SignalModel

COLUMNS = ("clip", "frames x vertices", *SPACES, "repeats")
GOALS = {"vertex": 1e-9}
GOAL = 1e-6


def horse(count: int) -> MeshClip:
    clip = load_clip(DATA / "horse-gallop", fps=24)
    return replace(clip, vertices=clip.vertices[:count])


CLIPS: dict[str, Callable[[], MeshClip]] = {
    "horse gallop, first 24": lambda: horse(24),
    "horse gallop, all 48": lambda: horse(48),
    "crane": lambda: load_clip(DATA / "vlasic-crane", fps=25),
    "sample human, walk": lambda: sample_clip("human", "walk", triangles=6000, duration=2.0),
    "sample human, jump": lambda: sample_clip("human", "jump", triangles=6000, duration=2.0),
    "sample animal, gallop": lambda: sample_clip("animal", "gallop", triangles=6000, duration=2.0),
}


def measured(clip: MeshClip, space: str) -> tuple[float, dict[str, Any], float]:
    start = time.perf_counter()
    T = clip.n_frames
    model = SignalModel(space, k=T + 2, l=T, m=T - 1, between="paper", layout="mds").fit(clip)
    worst = model.report_["errors"]["max_percent"] / 100
    return worst, model.report_, time.perf_counter() - start


def row(name: str, clip: MeshClip) -> str:
    cells: list[str] = []
    repeats = ""
    for space in SPACES:
        error, report, seconds = measured(clip, space)
        print(name, space, f"{error:.1e} D", f"{seconds:.1f} s", report["warnings"], flush=True)
        met = error <= GOALS.get(space, GOAL)
        cells.append(f"{error:.0e} D" + ("" if met else " (above the goal)"))
        if report["floor_percent"] > 1e-9:
            repeats = f"floor {report['floor_percent']:.1e} % D rms"
    return line(name, f"{clip.n_frames} x {len(clip.rest)}", *cells, repeats or "none")


def main() -> None:
    for name in sys.argv[1:] or CLIPS:
        renewed = row(name, CLIPS[name]())
        kept = {**written_rows(), name: renewed}
        write_block("signals-exact", table(COLUMNS, [kept[n] for n in CLIPS if n in kept]))


def written_rows() -> dict[str, str]:
    """Rows that the page has, by clip: some take minutes, so each is renewed for itself."""
    block = PAGE.read_text(encoding="utf-8").partition("<!-- signals-exact -->")[2]
    lines = block.partition("<!-- /signals-exact -->")[0].strip().split("\n")[2:]
    return {text.split("|")[1].strip(): text for text in lines if text.startswith("|")}


if __name__ == "__main__":
    main()
