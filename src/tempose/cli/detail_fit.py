"""`tempose detail fit`: learn what a skeleton alone does not carry."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tempose.cli import rig_options as given
from tempose.cli import signals_options as reading_options
from tempose.cli.console import note, progress_bar, show_json, show_table, writing
from tempose.cli.options import Clip, Group, Json, Start, Step, Stop, Topology
from tempose.cli.report import make_report, write_report
from tempose.cli.rig_files import check_kept_out, load_body, load_rig
from tempose.cli.rig_fit import fitted, trimmed
from tempose.cli.signals_files import check_folder
from tempose.cli.signals_options import merged_options

if TYPE_CHECKING:
    from tempose.clips import MeshClip
    from tempose.detail import DetailModel
    from tempose.rigging import Rig

_BASES = ("blended", "root", "world")


def fit(  # numpydoc ignore=PR01
    clip_files: given.Clips,
    out: given.OutModel,
    rig: given.RigFile = None,
    learner: given.Learner = "auto",
    basis: given.Basis = "blended",
    resolution: given.Resolution = None,
    report: given.ReportFile = None,
    plot: given.DetailPlot = None,
    start: Start = None,
    stop: Stop = None,
    step: Step = None,
    up: reading_options.InputUp = None,
    unit: reading_options.InputUnit = None,
    fps: reading_options.InputFps = None,
    group: Group = None,
    clip: Clip = None,
    topology: Topology = None,
    json: Json = False,
) -> None:
    """Learn cloth and flesh of clips, so that they follow any motion of the skeleton."""
    began = time.perf_counter()
    options = merged_options(locals(), "clip_files", "out", "report", "plot", "json", "began")
    check_kept_out(out, "model")
    for path in (report, plot):
        if path is not None:
            check_folder(path)
    model = _model(learner, basis, resolution)
    rigged = None if rig is None else load_rig(rig)
    reading = {"up": up, "unit": unit, "fps": fps, "group": group, "clip": clip, "topology": topology}
    clips = [_load_clip(path, start, stop, step, reading) for path in clip_files]
    _check_alike(clips, clip_files, rigged)
    loaded = time.perf_counter()
    if rigged is None:
        rigged = _human_rig(clips[0], clip_files[0])
        _warn(rigged.report.get("warnings", ()))
    with progress_bar() as progress:
        try:
            model.fit(clips, rigged, progress=progress)
        except ValueError as error:
            raise ValueError(f"{', '.join(clip_files)}: {error}") from None
    with writing(out):
        model.save(out)
    seconds = {"load": loaded - began, **model.report_.get("seconds", {})}
    found = {**model.report_, "seconds": seconds}
    inputs = {"clips": list(clip_files), "rig": None if rig is None else str(rig), "out": str(out)}
    full = make_report("detail fit", inputs, options, found, began)
    if report is not None:
        write_report(report, full)
    if plot is not None:
        write_detail_plots(model, clips, plot)
    _tell(full, out, json)


def _model(learner: str, basis: str, resolution: float | None) -> DetailModel:
    from tempose.detail import DetailModel
    from tempose.detail.learners import LEARNERS

    if basis not in _BASES:
        raise ValueError(f"--basis must be one of {', '.join(_BASES)}, got {basis!r}")
    if learner != "auto" and learner not in LEARNERS:
        raise ValueError(f"--learner must be one of auto, {', '.join(LEARNERS)}, got {learner!r}")
    if resolution is not None and not 0 < resolution <= 100:
        raise ValueError(f"--resolution must be above 0 and at most 100 percent, got {resolution:g}")
    settings: dict[str, Any] = {} if resolution is None else {"resolution": resolution}
    chosen: Any = basis
    return DetailModel(learner, chosen, **settings)


def _load_clip(
    path: str, start: int | None, stop: int | None, step: int | None, reading: dict[str, Any]
) -> MeshClip:
    from tempose.clips import MeshClip

    body = trimmed(load_body(path, **reading), start, stop, step)
    if not isinstance(body, MeshClip):
        raise ValueError(f"{path}: detail is learned from a moving mesh, found a still one")
    if body.n_frames < 2:
        raise ValueError(f"{path}: detail needs 2 frames or more, found {body.n_frames}")
    return body


def _check_alike(clips: list[MeshClip], paths: list[str], rig: Rig | None) -> None:
    n = len(clips[0].rest) if rig is None else len(rig.skin.mesh.vertices)
    whose = f"{paths[0]}" if rig is None else "the rig"
    for path, clip in zip(paths, clips):
        if len(clip.rest) != n:
            raise ValueError(f"{path}: must have the {n} vertices of {whose}, got {len(clip.rest)}")


def _warn(warnings: Any) -> None:
    for warning in warnings:
        note(f"note: {warning}")


def write_detail_plots(model: DetailModel, clips: list[MeshClip], folder: Path) -> None:
    """Draw a model into a folder, with a progress bar.

    Parameters
    ----------
    model : DetailModel
        What to draw.
    clips : list of MeshClip
        What it was learned from.
    folder : Path
        Where; its parent must exist.
    """
    from tempose.detail.pictures import plot_detail

    with progress_bar() as progress, writing(folder):
        written = plot_detail(model, folder, clips, progress=progress)
    note(f"wrote {len(written)} pictures into {folder}")


def _tell(report: dict[str, Any], out: Path, json: bool) -> None:
    _warn(report["warnings"])
    if json:
        show_json(report)
        return
    show_table(detail_rows(report))
    note(f"wrote {out}: {out.stat().st_size / 1e6:.3g} MB")


def detail_rows(report: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what a person wants to read of a model.

    Parameters
    ----------
    report : dict
        Of the fit.

    Returns
    -------
    list of (str, str)
        Name and value.
    """
    rows = [("learner", str(report.get("learner", report["options"]["learner"])))]
    skin, errors = report["baselines"].get("skin"), report["errors"]
    if errors:
        alone = f", skin alone {skin['rms_percent']:.3g}" if skin else ""
        rows.append(
            ("frames learned from are off by", f"{errors['rms_percent']:.3g} % of the diagonal{alone}")
        )
    if report["heldout"]:
        words = ", ".join(f"{name} {row['rms_percent']:.3g}" for name, row in report["heldout"].items())
        rows.append(("parts left out, predicted, off by", f"{words} %"))
    rows.append(("seconds", f"{report['seconds']['total']:.1f}"))
    return rows


def _human_rig(clip: MeshClip, path: str) -> Rig:
    try:
        return fitted(clip, path, "human")
    except ValueError as error:
        way = "; `tempose rig fit` takes --skeleton, and --rig takes what it makes"
        raise ValueError(f"{error}{way if '--skeleton' in str(error) else ''}") from None
