"""`tempose detail pose`: the skeleton moves, cloth and flesh follow."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

import tempose
from tempose._tables import read_table
from tempose.cli import rig_options as given
from tempose.cli.console import note, progress_bar, writing
from tempose.cli.detail_words import parse_strength, read_mask
from tempose.cli.options import Clip, FromFps, FromUnit, FromUp, Tolerance, UnitOption, Up, check_out
from tempose.cli.report import make_report, write_report
from tempose.cli.rig_files import load_detail, load_rig, model_kind
from tempose.cli.signals_files import check_folder
from tempose.cli.signals_options import merged_options

if TYPE_CHECKING:
    from tempose.clips import MeshClip, SkeletonClip
    from tempose.detail import DetailModel
    from tempose.rigging import Rig

Out = Annotated[
    Path,
    typer.Option(
        "-o",
        "--out",
        metavar="OUT",
        help="Its ending chooses the format; a folder or name.####.obj takes frames.",
    ),
]


def pose(  # numpydoc ignore=PR01
    model_file: given.ModelFile,
    motion_file: given.Motion = None,
    *,
    out: Out,
    mapping: given.Mapping = None,
    missing_rest: given.MissingRest = False,
    strength: given.Strength = None,
    damp: given.Damp = None,
    mask: given.Mask = None,
    proportions: given.Proportions = None,
    report: given.ReportFile = None,
    from_up: FromUp = None,
    from_unit: FromUnit = None,
    from_fps: FromFps = None,
    clip: Clip = None,
    up: Up = None,
    unit: UnitOption = None,
    tolerance: Tolerance = None,
) -> None:
    """Pose a model, or a rig without detail, by a motion: edited in another package, or of another clip."""
    began = time.perf_counter()
    options = merged_options(locals(), "model_file", "motion_file", "out", "report", "began")
    check_out(out)
    if report is not None:
        check_folder(report)
    if tolerance is not None and out.suffix.lower() != ".glb":
        raise ValueError(f"{out}: --tolerance is for .glb")
    if damp is not None and not 0 < damp < np.inf:
        raise ValueError(f"--damp must be a positive number of seconds, got {damp}")
    strengths = parse_strength(strength)
    factors = None if proportions is None else read_table(proportions)
    names = _names(mapping)
    model = _load_model(model_file, {"--strength": strength, "--damp": damp, "--mask": mask})
    settings: dict[str, Any] = {"strength": strengths, "damp": damp, "mask": read_mask(mask)}
    reading = {"up": from_up, "unit": from_unit, "fps": from_fps, "clip": clip}
    motion, warnings = None, list[str]()
    if motion_file is not None:
        rig = model if isinstance(model, tempose.Rig) else model.rig_
        motion, warnings = _load_motion(motion_file, rig, names, missing_rest, reading)
        warnings += _far(model, motion)
    with progress_bar() as progress:
        progress(0, 0, "posing")
        if isinstance(model, tempose.Rig):
            posed = _pose_rig(model, motion, factors)
        else:
            posed = model.pose(motion, proportions=factors, **settings)
    _write(posed, out, up, unit, tolerance)
    if report is not None:
        inputs = {"model": str(model_file), "motion": motion_file, "out": str(out)}
        write_report(report, make_report("detail pose", inputs, options, {"warnings": warnings}, began))
    note(f"wrote {out}: {posed.n_frames} frames at {posed.fps:.6g} fps, {len(posed.rest)} vertices")


def _names(path: Path | None) -> dict[str, str] | None:
    from tempose.rigging.motions import read_mapping

    return None if path is None else read_mapping(path)


def _load_model(path: Path, edits: dict[str, Any]) -> DetailModel | Rig:
    """Load detail, or a rig where no edit asks for detail."""
    if model_kind(path) != "rig":
        return load_detail(path)
    for option, value in edits.items():
        if value is not None:
            raise ValueError(
                f"{path}: a rig without detail, {option} has nothing to act on; see `tempose detail fit`"
            )
    return load_rig(path)


def _pose_rig(rig: Rig, motion: SkeletonClip | None, factors: Any) -> MeshClip:
    from tempose.rigging import change_proportions

    rig = rig if motion is None else replace(rig, motion=motion)
    return (rig if factors is None else change_proportions(rig, factors)).clip()


def _load_motion(
    path: str, rig: Rig, mapping: dict[str, str] | None, missing_rest: bool, reading: dict[str, Any]
) -> tuple[SkeletonClip, list[str]]:
    from tempose.rigging.motions import matched_motion

    if Path(path).suffix.lower() == ".tempose":
        motion = load_rig(Path(path)).motion
    else:
        motion = tempose.formats.load_skeleton_clip(path, **reading)
        note(tempose.formats.describe(motion))
    try:
        found = matched_motion(
            rig.skin.skeleton, motion, mapping, missing="rest" if missing_rest else "error"
        )
    except ValueError as error:
        way = "" if mapping else "; --map takes a file of them, --missing-rest leaves joints at rest"
        raise ValueError(f"{path}: {error}{way}") from None
    for warning in found.warnings:
        note(f"note: {warning}")
    return found.motion, list(found.warnings)


def _far(model: DetailModel | Rig, motion: SkeletonClip) -> list[str]:
    if isinstance(model, tempose.Rig):
        return []
    far = np.asarray(model.far(motion))
    share = float((far > 1).mean())
    if share == 0:
        return []
    worst = int(far.argmax())
    warning = (
        f"{100 * share:.0f} % of the frames are far from what was learned (frame {worst} most, "
        f"{far[worst]:.2g} times the usual distance); detail there is a guess"
    )
    note(f"note: {warning}")
    return [warning]


def _write(clip: MeshClip, out: Path, up: str | None, unit: str | None, tolerance: float | None) -> None:
    with progress_bar() as progress, writing(out):
        if tolerance is None:
            tempose.save(out, clip, up=up, unit=unit, progress=progress)
        else:
            from tempose.formats.glb import write

            write(out, clip, tolerance=tolerance, progress=progress)
