"""What `tempose demo` shows of signals: a clip fitted, looped, slowed down and reshaped by its curve."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tempose

if TYPE_CHECKING:
    from tempose.clips import MeshClip
    from tempose.render import Section
    from tempose.signals import SignalModel
    from tempose.typing import Progress

NAME = "signals"
TRIANGLES = 8000
SECONDS = 1.6
FPS = 24.0
SLOW = 0.4
_CELL = 200
_MOMENTS = 7
_FILM = (340, 240)

HEADER = ("signals", "frames", "k", "l", "m", "off %", "loop", "seam", "seconds")
"""Short, so that the table fits a terminal; `LEGEND` says what they mean."""

LEGEND = (
    "k control points of the curve, l poses that hold the pose surface, m modes of deformation. off: rms "
    "error of the frames, percent of the diagonal. loop: the frames that it was made of. seam: largest step "
    "over it, against the median step of the loop."
)

_ABOUT = """\
A gallop becomes a curve through a plane of poses: nearby places are similar poses. The curve is edited and
played again: one stride is found and closed into a loop, played three times, the second time in slow motion,
and one control point is moved in the first. Where the animal is was split off, so it gallops on."""


def run_signals(folder: Path, progress: Progress) -> dict[str, Any]:
    """Fit, edit and play a built-in clip, and draw it.

    Parameters
    ----------
    folder : Path
        Where clips and pictures go.
    progress : Progress
        Told what is being done.

    Returns
    -------
    dict
        Measures for table, page and ``report.json``.
    """
    progress(0, 0, "making the character")
    clip = tempose.samples.sample_clip("animal", "gallop", triangles=TRIANGLES, duration=SECONDS, fps=FPS)
    began = time.perf_counter()
    model = tempose.SignalModel(placement=True).fit(clip, progress=progress)
    fitted = time.perf_counter()
    edited, operations, loop = _edited(model)
    report: dict[str, Any] = {
        "name": NAME,
        "title": "A gallop as a curve",
        "frames": clip.n_frames,
        **{key: model.report_[key] for key in ("k", "l", "m", "errors", "warnings")},
        "operations": operations,
        "loop": [loop.start, loop.stop],
        "seam": _seam(edited, loop.period),
        "played": edited.signals_.n_frames,
        "seconds": {"fit": fitted - began, "edit": time.perf_counter() - fitted},
    }
    report["seconds"]["total"] = sum(report["seconds"].values())
    edited.save(folder / f"{NAME}.tempose")
    played = edited.clip()
    tempose.save(folder / f"{NAME}.glb", played, progress=progress)
    _draw(clip, played, edited, folder, progress)
    return report


def _edited(model: SignalModel) -> tuple[SignalModel, list[dict[str, Any]], Any]:
    from tempose.signals.loops import find_loops

    signals = model.signals_
    loop = find_loops(signals.coordinates(signals.times), shortest=round(0.4 * FPS))[0]
    n = loop.period
    closed: list[dict[str, Any]] = [
        {"op": "close_loop", "from": loop.start, "to": loop.stop},
        {"op": "loop", "from": 0, "to": n, "times": 3},
        {"op": "speed", "from": n, "to": 2 * n, "factor": SLOW},
    ]
    # a control whose support lies well inside the first stride, moved outwards
    curve = model.edited(closed).signals_.time.curve
    middle = curve.controls.mean(axis=0)
    control = max(len(curve.controls) // 9, 3)
    push = 0.3 * (curve.controls[control] - middle)
    operations = [*closed, {"op": "move", "control": control, "by": [round(float(v), 3) for v in push]}]
    return model.edited(operations), operations, loop


def _seam(model: SignalModel, period: int) -> float:
    """Largest step over the seam, against the median step of the stride, where the clock runs normally."""
    import numpy as np

    signals = model.signals_
    ticks = np.arange(0.0, 2 * period + 1)
    path = signals.path
    if path is None:
        return float("nan")
    steps = np.linalg.norm(np.diff(path(ticks), axis=0), axis=1)
    return float(steps[period - 1 : period + 1].max() / np.median(steps))


def _draw(clip: MeshClip, played: MeshClip, edited: SignalModel, folder: Path, progress: Progress) -> None:
    from tempose.clips.resample import select_frames
    from tempose.render.drawing import save_drawing
    from tempose.signals.pictures import draw_pose_plane, draw_retiming

    look: dict[str, Any] = {
        "names": ["captured", "edited"],
        "cell": _CELL,
        "frames": _MOMENTS,
        "views": ["side"],
    }
    tempose.render.save_png(
        tempose.render.contact_sheet([clip, played], progress=progress, **look), folder / f"{NAME}.png"
    )
    for theme in ("light", "dark"):
        plane = draw_pose_plane(edited.signals_, theme=theme)
        save_drawing(plane, folder / f"{NAME}_plane_{theme}.png", 1.5)
    save_drawing(draw_retiming(edited.signals_), folder / f"{NAME}_retiming.svg")
    film = select_frames(played, step=2)
    tempose.render.render(film, folder / f"{NAME}.mp4", progress=progress, size=_FILM)


def signals_row(report: dict[str, Any]) -> list[Any]:
    """Return the measures in the order of `HEADER`.

    Parameters
    ----------
    report : dict
        As `run_signals` returned it.

    Returns
    -------
    list
        A value a column.
    """
    return [
        report["title"],
        report["frames"],
        *(report[key] for key in ("k", "l", "m")),
        report["errors"]["rms_percent"],
        "-".join(map(str, report["loop"])),
        report["seam"],
        report["seconds"]["total"],
    ]


def signals_section(folder: Path, report: dict[str, Any]) -> Section:
    """Return what the page shows.

    Parameters
    ----------
    folder : Path
        Where the pictures lie.
    report : dict
        As `run_signals` returned it.

    Returns
    -------
    Section
        Text, pictures and a table.
    """
    render = tempose.render
    film = folder / f"{NAME}.mp4"
    shown: list[Any] = [render.Figure(film, "What is played after the edits.")] if film.is_file() else []
    return render.Section(
        report["title"],
        [
            _ABOUT,
            render.Table(HEADER, [signals_row(report)], LEGEND),
            *shown,
            render.Figure(folder / f"{NAME}.png", "The captured clip, above; the edited one, below."),
            render.Figure(
                folder / f"{NAME}_plane_light.png",
                "The curve that is played, in the colours of time; one control point was moved outwards.",
                folder / f"{NAME}_plane_dark.png",
            ),
            render.Chart((folder / f"{NAME}_retiming.svg").read_text(encoding="utf-8"), "Slow motion."),
            *(f"Note: {warning}." for warning in report["warnings"]),
        ],
    )
