"""What `tempose demo` shows of rigs and detail: a skirt learned from two walks follows a third."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tempose

if TYPE_CHECKING:
    from tempose.clips import MeshClip, SkeletonClip
    from tempose.detail import DetailModel
    from tempose.render import Section
    from tempose.rigging import Rig
    from tempose.typing import Progress

NAME = "detail"
TRIANGLES = 6000
SECONDS = 1.6
FPS = 30.0
SPEEDS = (0.9, 1.5)
"""Of the walks that are learned from, metres a second."""
NEW = 1.2
"""Of the walk that is posed."""
LEARNER = "gp"
_CELL = 200
_MOMENTS = 7

HEADER = (
    "detail",
    "frames",
    "joints",
    "skin off %",
    "mean",
    "with detail",
    "on the new walk",
    "skin",
    "seconds",
)
"""Short, so that the table fits a terminal; `LEGEND` says what they mean."""

LEGEND = (
    "Errors are rms, percent of the diagonal. skin off: the skeleton with its skin alone, on frames that "
    "were learned from; mean: with a constant correction; with detail: with what was learned. on the new "
    "walk: a speed that was never seen, with detail, and with the skin alone."
)

_ABOUT = """\
Two walks of a person in a skirt become a skeleton that moves the skin, and what the skeleton alone does not
carry, the swing of the skirt, is learned from its angles and velocities. A third walk, at a speed between
the two, moves the skeleton only; the skirt follows."""


def run_detail(folder: Path, progress: Progress) -> dict[str, Any]:
    """Fit a rig and its detail to built-in clips, pose them by another motion, and draw it.

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
    from tempose.detail import DetailModel
    from tempose.metrics import compare
    from tempose.rigging import fit_rig

    progress(0, 0, "making the character")
    body = tempose.samples.human_character(TRIANGLES)
    clips = [_walk(speed) for speed in SPEEDS]
    truth, motion = _walk(NEW), _motion(body.skin.skeleton, NEW)
    began = time.perf_counter()
    rig = fit_rig(clips[0], body.skin, progress=progress)
    rigged = time.perf_counter()
    # a clip that was simulated comes with its motion; of a captured one fit finds it
    motions = [_motion(body.skin.skeleton, speed) for speed in SPEEDS]
    model = DetailModel(LEARNER).fit(clips, rig, motions, progress)
    learned = time.perf_counter()
    posed = model.pose(motion, progress=progress)
    D = rig.skin.mesh.diagonal
    report: dict[str, Any] = {
        "name": NAME,
        "title": "A skirt that follows",
        "frames": sum(clip.n_frames for clip in clips),
        "joints": rig.skin.skeleton.n_joints,
        "learner": model.report_["learner"],
        **{key: model.report_[key] for key in ("errors", "baselines", "heldout", "warnings")},
        "new": {
            "skin": compare(truth.vertices, rig.vertices(motion), D).as_dict(),
            "ours": compare(truth.vertices, posed.vertices, D).as_dict(),
        },
        "seconds": {"rig": rigged - began, "detail": learned - rigged, "pose": time.perf_counter() - learned},
    }
    report["seconds"]["total"] = sum(report["seconds"].values())
    model.save(folder / f"{NAME}.tempose")
    tempose.save(folder / f"{NAME}.glb", posed, progress=progress)
    _draw(model, rig, motion, (posed, truth), folder, progress)
    return report


def _walk(speed: float) -> MeshClip:
    return tempose.samples.sample_clip(
        "human", "walk", triangles=TRIANGLES, duration=SECONDS, fps=FPS, speed=speed
    )


def _motion(skeleton: Any, speed: float) -> SkeletonClip:
    return tempose.samples.MOTIONS["human"]["walk"](skeleton, duration=SECONDS, fps=FPS, speed=speed)


def _draw(
    model: DetailModel,
    rig: Rig,
    motion: SkeletonClip,
    clips: tuple[MeshClip, MeshClip],
    folder: Path,
    progress: Progress,
) -> None:
    from tempose.detail.fitting import training_inputs
    from tempose.detail.pictures import draw_heldout, skin_clip
    from tempose.render.drawing import save_drawing

    names = ["skin alone", "with detail", "truth"]
    look: dict[str, Any] = {"names": names, "cell": _CELL, "frames": _MOMENTS, "views": ["three-quarter"]}
    sheet = tempose.render.contact_sheet(
        [skin_clip(rig, motion), *clips], track=True, progress=progress, **look
    )
    tempose.render.save_png(sheet, folder / f"{NAME}.png")
    chains = training_inputs(model.motions_).chains
    chart = draw_heldout(model.report_["heldout"], LEARNER, rig.skin.mesh.diagonal, chains)
    save_drawing(chart, folder / f"{NAME}_heldout.svg")


def detail_row(report: dict[str, Any]) -> list[Any]:
    """Return the measures in the order of `HEADER`.

    Parameters
    ----------
    report : dict
        As `run_detail` returned it.

    Returns
    -------
    list
        A value a column.
    """
    learned = [report["baselines"]["skin"], report["baselines"]["mean"], report["errors"]]
    return [
        report["title"],
        report["frames"],
        report["joints"],
        *(errors["rms_percent"] for errors in learned),
        report["new"]["ours"]["rms_percent"],
        report["new"]["skin"]["rms_percent"],
        report["seconds"]["total"],
    ]


def detail_section(folder: Path, report: dict[str, Any]) -> Section:
    """Return what the page shows.

    Parameters
    ----------
    folder : Path
        Where the pictures lie.
    report : dict
        As `run_detail` returned it.

    Returns
    -------
    Section
        Text, pictures and a table.
    """
    render = tempose.render
    caption = "A walk that was not learned from: the skin of the skeleton, with detail, and as it truly is."
    chart = (folder / f"{NAME}_heldout.svg").read_text(encoding="utf-8")
    return render.Section(
        report["title"],
        [
            _ABOUT,
            render.Table(HEADER, [detail_row(report)], LEGEND),
            render.Figure(folder / f"{NAME}.png", caption),
            render.Chart(chart, "Frames learned from, each predicted without its part of the clips."),
            *(f"Note: {warning}." for warning in report["warnings"]),
        ],
    )
