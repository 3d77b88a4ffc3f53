"""The pictures of docs/signals.md and of the front page: python benchmarks/pictures_signals.py

Reads horse-gallop, horse-poses and elephant-poses from TEMPOSE_DATA, or where `tempose data fetch` put them.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import tempose
from tempose.clips.resample import select_frames
from tempose.datasets import cache_folder
from tempose.render.drawing import Drawing, save_drawing
from tempose.signals import SignalModel
from tempose.signals.design import design
from tempose.signals.pictures import (
    bad_transitions,
    draw_errors,
    draw_pose_grid,
    draw_pose_plane,
    draw_retiming,
    draw_scree,
)
from tempose.signals.pictures.plot import named_errors

GALLERY = Path(__file__).resolve().parents[1] / "docs" / "gallery"
SCALE = 1.25


def data(name: str) -> Path:
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    root = Path(os.environ.get("TEMPOSE_DATA", beside))
    return root / name if (root / name).is_dir() else cache_folder() / name


def save(name: str, drawing: Drawing) -> None:
    save_drawing(drawing, GALLERY / f"signals-{name}.png", SCALE)
    print(f"signals-{name}.png")


def sheet(name: str, clips: Sequence[Any], names: Sequence[str], frames: int = 8, **look: Any) -> None:
    options: dict[str, Any] = {"cell": 150, "names": names, "views": ("side",), **look}
    tempose.render.save_png(
        tempose.render.contact_sheet(clips, frames, **options), GALLERY / f"signals-{name}.png"
    )
    print(f"signals-{name}.png")


def plane(name: str, model: SignalModel, **options: Any) -> None:
    save(name, draw_pose_plane(model.signals_, bad=bad_transitions(model.signals_), **options))


def stride() -> Any:
    clip = tempose.formats.load_clip(data("horse-gallop"), fps=24.0)
    return select_frames(clip, 0, 24)


def fitted(clip: Any) -> SignalModel:
    model = SignalModel(k=16, l=18, m=12).fit(clip)
    plane("plane", model)
    save("grid", draw_pose_grid(model.signals_, columns=9))
    errors = named_errors(model.report_["frame_errors"])
    save("errors", draw_errors(errors))
    save("scree", draw_scree(np.asarray(model.report_["scree"]), model.report_["m"]))
    return model


def edits(model: SignalModel) -> None:
    unedited = model.clip()
    moved = model.edited([{"op": "move", "control": 8, "by": [8.0, 1.0]}])
    plane("move", moved)
    sheet("move-frames", [unedited, moved.clip()], ["as captured", "control 8 moved"], frames=9)
    slow = model.edited([{"op": "speed", "from": 8, "to": 16, "factor": 0.4}])
    save("speed", draw_retiming(slow.signals_))
    drawn = [[11.0, -9.0], [0.0, -6.0], [-2.0, 4.0], [8.0, 8.0], [13.0, 6.0]]
    plane("insert-curve", model.edited([{"op": "insert_curve", "at": 12, "points": drawn, "frames": 10}]))
    plane("blend", model.edited([{"op": "blend", "from": 14, "to": 20, "frames": 4}]))
    plane("close-loop", model.edited([{"op": "close_loop", "from": 3, "to": 15}]))


def transfer(model: SignalModel) -> None:
    files = {
        key: [str(data(f"{animal}-poses") / f"{i}.obj") for i in (1, 2, 3, 4, 5, 6, 8, 10)]
        for key, animal in (("source", "horse"), ("target", "elephant"))
    }
    elephant = model.edited([{"op": "replace_shape", **files, "space": "gradient"}])
    sheet("replace-shape", [model.clip(), elephant.clip()], ["captured", "by eight pairs of poses"])


def from_scratch() -> None:
    folder = data("horse-poses")
    poses = [tempose.formats.load_mesh(folder / f"{i}.obj") for i in (1, 4, 5, 6, 8)]
    places = [[0, 0], [-1, 1], [1, 1], [1, -1], [-1, -1]]
    curve = [[0, 0], [-0.8, 0.2], [-1, 1], [0, 1.2], [1, 1], [1, 0], [1, -1], [0, -1], [0, 0]]
    signals = design(poses, places, curve, fps=24.0, seconds=3.0, align=True)
    model = SignalModel.from_signals(signals)
    plane("design", model)
    sheet("design-frames", [model.clip()], ["designed"])


def main() -> None:
    GALLERY.mkdir(exist_ok=True)
    model = fitted(stride())
    edits(model)
    transfer(model)
    from_scratch()


if __name__ == "__main__":
    main()
