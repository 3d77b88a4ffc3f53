"""`tempose signals fit`: a clip becomes a curve through a plane of poses."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import tempose
from tempose.cli import signals_options as given
from tempose.cli.console import note, progress_bar, tell, writing
from tempose.cli.options import Clip, Group, Json, Start, Step, Stop, Topology
from tempose.cli.report import make_report, write_report
from tempose.cli.signals_files import check_folder, check_model_out, write_plots

if TYPE_CHECKING:
    from tempose.clips import MeshClip
    from tempose.signals import SignalModel


def fit(  # numpydoc ignore=PR01
    clip_file: given.ClipFile,
    out: given.OutModel,
    tolerance: given.FitTolerance = None,
    k: given.K = None,
    l: given.L = None,
    m: given.M = None,
    space: given.Space = "vertex",
    fix: given.Fix = None,
    between: given.Between = "path",
    layout: given.Layout = "auto",
    placement: given.Placement = False,
    period: given.Period = "auto",
    window: given.Window = 300,
    examples: given.Examples = None,
    plot: given.Plot = None,
    report: given.ReportFile = None,
    held_out: given.HeldOut = 2,
    start: Start = None,
    stop: Stop = None,
    step: Step = None,
    up: given.InputUp = None,
    unit: given.InputUnit = None,
    fps: given.InputFps = None,
    group: Group = None,
    clip: Clip = None,
    topology: Topology = None,
    json: Json = False,
) -> None:
    """Turn a clip into a curve through a plane of poses, which can be played at any moment and edited."""
    began = time.perf_counter()
    options = given.merged_options(locals(), "clip_file", "out", "report", "json", "plot", "began")
    check_model_out(out)
    for path in (report, plot):
        if path is not None:
            check_folder(path)
    settings: dict[str, Any] = {"k": k, "l": l, "m": m, "between": between, "layout": layout}
    settings |= {"placement": placement, "period": given.parse_period(period), "window": window}
    model = tempose.SignalModel(space, tolerance=tolerance, **settings)
    model.options  # noqa: B018  # wrong options are told before a long clip is read
    pins = given.parse_pins(fix)
    if held_out < 0 or held_out == 1:
        raise ValueError(f"--held-out must be 2 or more frames, or 0 to measure nothing, got {held_out}")
    reading: dict[str, Any] = {"up": up, "unit": unit, "fps": fps, "group": group, "clip": clip}
    source = _load(clip_file, start, stop, step, reading | {"topology": topology})
    if not placement:
        _advise_placement(source)
    poses = _load_examples(examples, source, up, unit)
    loaded = time.perf_counter()
    with progress_bar() as progress:
        try:
            model.fit(source, pins or None, poses, progress)
        except ValueError as error:
            raise ValueError(f"{clip_file}: {error}") from None
        measured = _measures(source, model, held_out, progress) if report is not None or json else {}
    with writing(out):
        model.save(out)
    seconds = {"load": loaded - began, **model.report_["seconds"]}
    found = {**model.report_, **measured, "seconds": seconds}
    full = make_report("signals fit", {"clip": clip_file, "out": str(out)}, options, found, began)
    if report is not None:
        write_report(report, full)
    if plot is not None:
        write_plots(model, plot)
    tell(full, fit_rows(full, model), json)


def _load(
    path: str, start: int | None, stop: int | None, step: int | None, reading: dict[str, Any]
) -> MeshClip:
    from tempose.clips.resample import select_frames

    with progress_bar() as progress:
        source = tempose.formats.load_clip(path, progress=progress, **reading)
    note(tempose.formats.describe(source))
    if (start, stop, step) == (None, None, None):
        return source
    return select_frames(source, start or 0, stop, 1 if step is None else step)


def _advise_placement(clip: MeshClip) -> None:
    from tempose.signals.loops.of_clip import travels

    if travels(clip):
        note(
            "note: the body travels, and where it stands is part of every pose; with --placement it is kept "
            "apart, and loops go on from where they end"
        )


def _load_examples(paths: list[str] | None, clip: MeshClip, up: str | None, unit: str | None) -> Any:
    import numpy as np

    if not paths:
        return None
    found: list[Any] = []
    for path in paths:
        with progress_bar() as progress:
            poses = tempose.formats.load_clip(path, up=up, unit=unit, progress=progress)
        if poses.vertices.shape[1:] != clip.vertices.shape[1:]:
            raise ValueError(
                f"{path}: must have the {len(clip.rest)} vertices of the clip, got {len(poses.rest)}"
            )
        found.extend(np.asarray(poses.vertices, dtype=np.float64))
    return np.stack(found)


def _measures(clip: MeshClip, model: SignalModel, held_out: int, progress: Any) -> dict[str, Any]:
    from tempose.signals.report.baselines import LARGEST, key_frame_errors, left_out_errors

    if clip.vertices.size > LARGEST:
        warnings = [*model.report_["warnings"], "baselines were not measured: the clip is too large"]
        return {"warnings": warnings}
    found: dict[str, Any] = {"baselines": key_frame_errors(clip, model.report_["k"])}
    if held_out >= 2:
        found["heldout"] = left_out_errors(clip, model, held_out, progress)
    return found


def fit_rows(report: dict[str, Any], model: SignalModel) -> list[tuple[str, str]]:
    """Return what a person wants to read of a fit.

    Parameters
    ----------
    report : dict
        Of the fit.
    model : SignalModel
        The model.

    Returns
    -------
    list of (str, str)
        Name and value.
    """
    from tempose.signals.pictures import bad_transitions

    T, budget, errors = report["frames"], report.get("budget", {}), report["errors"]
    bad = bad_transitions(model.signals_)
    rows = [
        ("shape space", f"{model.space}, {report['dimension']} numbers a frame"),
        ("k, control points of the curve", f"{report['k']} of at most {T + 2}"),
        ("l, sites of the pose surface", f"{report['l']} of at most {T}"),
        ("m, modes of deformation", f"{report['m']} of at most {T - 1}"),
        ("frames played are off by", f"{errors['rms_percent']:.3g} % of the diagonal (rms)"),
    ]
    if budget:
        parts = ", ".join(f"{name} {budget[key]:.3g}" for name, key in _SIGNALS)
        rows.append(("  by signal, without the time spline", f"{parts}; together {budget['whole']:.3g} %"))
    rows.append(("bad transitions", ", ".join(f"{i}-{i + 1}" for i in bad) if bad else "none"))
    heldout: dict[str, Any] = report.get("heldout") or {}
    if heldout:
        words = ", ".join(f"{name} {row['rms_percent']:.3g}" for name, row in heldout.items())
        rows.append(("frames left out, predicted, off by", f"{words} %"))
    rows.append(("seconds", f"{report['seconds']['total']:.1f}"))
    return rows


_SIGNALS = (("shape h", "h"), ("pose g", "g"), ("time f", "f"))
