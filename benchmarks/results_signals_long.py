"""Signals of a clip that does not fit into memory: time, memory and error against the number of frames.

python benchmarks/results_signals_long.py                 5000 frames x 10 000 vertices, renews the table
python benchmarks/results_signals_long.py 1000 2000       smaller: largest number of frames, vertices; prints
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from long_clip import open_long_clip, write_long_clip
from results_page import line, table, write_block
from signals_long_layouts import layouts, modes
from tempose.signals import SignalModel

COLUMNS = (
    "frames",
    "placement",
    "m",
    "sites",
    "windows",
    "fit s",
    "ms a frame",
    "all frames back s",
    "peak MB",
    "rms % D",
    "stress",
    "bad transitions",
)


def measure(path: Path, frames: int, vertices: int, placement: bool) -> dict[str, Any]:
    """Fit and play in this process, whose peak memory is then that of the work."""
    clip = open_long_clip(path, frames, vertices)
    SignalModel(placement=placement, window=16).fit(open_long_clip(path, 60, vertices))  # nothing to compile
    start = time.process_time()
    model = SignalModel(placement=placement).fit(clip)
    fitted = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        shape = clip.vertices.shape
        out = np.lib.format.open_memmap(Path(folder) / "back.npy", mode="w+", dtype=np.float32, shape=shape)
        before = time.process_time()
        model.sample(out=out)
        played = time.process_time() - before
    report = model.report_
    return {
        "frames": frames,
        "placement": placement,
        "vertices": len(clip.rest),
        "m": report["m"],
        "l": report["l"],
        "windows": report.get("windows", 1),
        "fit": fitted - start,
        "stages": report["seconds"],
        "played": played,
        "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "rms": report["errors"]["rms_percent"],
        "stress": report["layout"]["stress"],
        "bad": len(report["transitions"]["bad"]),
    }


def apart(path: Path, frames: int, vertices: int, placement: bool) -> dict[str, Any]:
    """Measure in a process of its own."""
    arguments = ["--measure", str(path), str(frames), str(vertices), str(int(placement))]
    run = subprocess.run([sys.executable, __file__, *arguments], capture_output=True, text=True, check=False)
    if run.returncode:
        raise SystemExit(run.stderr)
    return json.loads(run.stdout)


def report(rows: list[dict[str, Any]]) -> list[str]:
    cells = [
        line(
            r["frames"],
            "split off" if r["placement"] else "in the shape",
            r["m"],
            r["l"],
            r["windows"],
            f"{r['fit']:.1f}",
            f"{1000 * r['fit'] / r['frames']:.1f}",
            f"{r['played']:.1f}",
            f"{r['peak']:.0f}",
            f"{r['rms']:.3f}",
            f"{r['stress']:.3f}",
            r["bad"],
        )
        for r in rows
    ]
    largest = rows[-1]
    size = largest["frames"] * largest["vertices"] * 12 / 1e6
    return [
        f"Someone walks, runs and stands in turn on a circle, {largest['vertices']} vertices, read from a "
        f"memory map ({size:.0f} MB for {largest['frames']} frames; its pages in memory count as used). "
        "Tolerance 0.5 % of D. The frames back are written to another memory map. One core's seconds.",
        "",
        *table(COLUMNS, cells),
        "",
        "Layouts of long clips: repeats are frames a third of the clip apart or more whose poses are less "
        "than a step apart; distances in the plane are medians. Windows of 300 frames (crane 60), overlap a "
        "fifth. Bad transitions with g fitted to the frames alone.",
        "",
        *layouts(),
        "",
        "Modes that a tolerance takes:",
        "",
        *modes(),
    ]


def main(arguments: list[str]) -> None:
    if arguments[:1] == ["--measure"]:
        path, frames, vertices, placement = arguments[1:]
        sys.stdout.write(json.dumps(measure(Path(path), int(frames), int(vertices), placement == "1")))
        return
    frames, vertices = (int(a) for a in arguments) if arguments else (5000, 10_400)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.npy"
        write_long_clip(path, frames, vertices)
        parts = (frames // 4, frames // 2, frames)
        rows = [apart(path, T, vertices, split) for split in (False, True) for T in parts]
    for row in rows:
        stages = {name: round(seconds, 1) for name, seconds in row["stages"].items()}
        sys.stderr.write(f"{row['frames']} frames, placement {row['placement']}: {stages}\n")
    lines = report(rows)
    if arguments:
        sys.stdout.write("\n".join(lines) + "\n")
    else:
        write_block("signals-long", lines)


if __name__ == "__main__":
    main(sys.argv[1:])
