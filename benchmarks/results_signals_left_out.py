"""Frames left out and predicted: the paper's psi, ours, and what simple interpolation does.

python benchmarks/results_signals_left_out.py          all, renews the table
python benchmarks/results_signals_left_out.py horse-48 one clip, prints its rows
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from real_bodies import DATA
from results_page import line, table, write_block
from tempose import load
from tempose.clips.resample import select_frames
from tempose.metrics import compare
from tempose.signals import SignalModel
from tempose.signals.report.baselines import left_out_errors

CASES: dict[str, tuple[str, int | None, tuple[int, ...]]] = {
    "horse-24": ("horse-gallop", 24, (2, 4)),
    "horse-48": ("horse-gallop", 48, (2, 4, 5, 7)),
    "crane": ("vlasic-crane", None, (2, 4)),
}
SETTINGS: dict[str, dict[str, Any]] = {
    "paper": {"between": "paper", "layout": "mds"},
    "dense": {"between": "dense"},
    "default": {},
    "gradient": {"space": "gradient"},
}
COLUMNS = ("clip, kept", "linear", "cubic", *SETTINGS, "period found (kept frames)")


def row(name: str, every: int) -> str:
    folder, frames, _ = CASES[name]
    clip: Any = load(DATA / folder)
    clip = select_frames(clip, 0, frames, 1)
    kept = np.arange(0, clip.n_frames, every)
    between = np.setdiff1d(np.arange(kept[-1]), kept)
    n = len(kept)
    part = select_frames(clip, 0, None, every)
    simple = left_out_errors(clip, SignalModel(k=4, l=3, m=1), every)
    errors, period = dict[str, float](), None
    for setting, options in SETTINGS.items():
        sites = 3 * n if setting == "dense" else n
        model = SignalModel(k=n + 2, l=sites, m=n - 1, **options).fit(part)
        played = model.sample(between / clip.fps, dtype=np.float64)
        errors[setting] = compare(np.asarray(clip.vertices)[between], played, clip.mesh.diagonal).kg
        if setting == "default":
            period = model.report_.get("period")
    found = "none" if period is None else f"{period:.4g}"
    simple_cells = (f"{simple[key]['kg']:.2f}" for key in ("linear", "cubic"))
    return line(
        f"{name}, every {every}. ({n} of {clip.n_frames})",
        *simple_cells,
        *(f"{error:.2f}" for error in errors.values()),
        found,
    )


def main() -> None:
    wanted = sys.argv[1:] or list(CASES)
    rows: list[str] = []
    for name in wanted:
        for every in CASES[name][2]:
            rows.append(row(name, every))
            print(rows[-1], flush=True)
    if not sys.argv[1:]:
        write_block("signals-left-out", table(COLUMNS, rows))


if __name__ == "__main__":
    main()
