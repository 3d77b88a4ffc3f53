"""What a fit tells about itself: errors, where they come from, how long it took."""

from __future__ import annotations

import math
import time
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from tempose._version import __version__
from tempose.clips import MeshClip
from tempose.clips.blocks import read_block
from tempose.metrics import ErrorMeter
from tempose.signals.blocks import block_slices
from tempose.signals.fit.clip import FittedClip
from tempose.signals.fit.options import FitOptions
from tempose.signals.report.frame_errors import frame_errors, scree
from tempose.signals.sampling import evaluate
from tempose.signals.signals import Signals
from tempose.typing import FloatArray, Progress, silent

ROUNDING = 1e-9
"""Percent of the diagonal below which an error is none."""


def fit_report(
    clip: MeshClip, fitted: FittedClip, options: FitOptions, progress: Progress = silent
) -> dict[str, Any]:
    """Measure a fit.

    Parameters
    ----------
    clip : MeshClip
        The clip.
    fitted : FittedClip
        Its signals.
    options : FitOptions
        What was asked for.
    progress : Progress, optional
        Told that errors are being measured.

    Returns
    -------
    dict
        ``errors`` of what is played, ``paper`` of the literal ``h(g(f(t)))``, ``budget`` of h, g and f in rms
        percent of the diagonal, ``frame_errors`` and ``scree`` for pictures, ``seconds``, ``warnings``, and
        the numbers k, l, m, d chosen.
    """
    signals, notes = fitted.signals, fitted.notes
    start = time.perf_counter()
    errors, played = clip_errors(clip, signals, fitted.diagonal, progress)
    literal = replace(signals, path=None)
    paper = errors if signals.path is None else clip_errors(clip, literal, fitted.diagonal, progress)[0]
    facts = dict(notes.facts)
    floor = float(fitted.shape.percent(facts.pop("floor", 0.0)))
    report: dict[str, Any] = {
        "version": __version__,
        "options": asdict(options),
        "frames": clip.n_frames,
        "vertices": len(clip.rest),
        "diagonal": fitted.diagonal,
        "dimension": signals.shape.space.dimension,
        "k": len(signals.time.curve.controls),
        "l": len(signals.pose.sites),
        "m": len(signals.shape.components),
        **facts,
        "errors": errors,
        "paper": paper,
        "budget": error_budget(fitted),
        "frame_errors": frame_errors(fitted, played),
        "floor_percent": floor,
        "scree": scree(fitted.shape),
        "warnings": [*notes.warnings, *_result_warnings(floor, options, paper)],
    }
    seconds = {**notes.seconds, "check": time.perf_counter() - start}
    report["seconds"] = {**seconds, "total": sum(seconds.values())}
    return report


def clip_errors(
    clip: MeshClip, signals: Signals, diagonal: float, progress: Progress = silent
) -> tuple[dict[str, float | None], FloatArray]:
    """Compare the frames of a clip with those that signals play, block by block.

    Parameters
    ----------
    clip : MeshClip
        The truth, T frames.
    signals : Signals
        What is played, unedited.
    diagonal : float
        D, metres.
    progress : Progress, optional
        Told how many frames were compared.

    Returns
    -------
    errors : dict
        The keys of `tempose.metrics.ClipErrors`; None where a measure is infinite.
    frames : (T,) ndarray
        Mean squared distance of each frame, square metres.
    """
    T, n, _ = clip.vertices.shape
    meter = ErrorMeter(T * n, diagonal)
    frames = np.zeros(T)
    for where in block_slices(T, signals.shape.space.dimension):
        times = np.arange(where.start, where.stop) / clip.fps
        played = evaluate(signals, times, np.float64)
        frames[where] = meter.add(read_block(clip.vertices, where), played)
        progress(where.stop, T, "measuring errors")
    measures = meter.errors.as_dict()
    return {name: value if math.isfinite(value) else None for name, value in measures.items()}, frames


def error_budget(fitted: FittedClip) -> dict[str, float]:
    """Say how much each signal adds to the error at the frames.

    Parameters
    ----------
    fitted : FittedClip
        A fit.

    Returns
    -------
    dict
        Rms percent of the diagonal. ``h`` and ``g``, of the pose signal as fitted to the places of the
        frames, add in squares, since they are orthogonal; f does not, and g is fitted once more to the curve:
        ``f`` is how far the curve moves the poses, ``g(f(t)) - g(P)``, and ``f_signed`` the root of what the
        squares of the whole have more than those of h and g, negative where they have less.
    """
    shape, signals, plane = fitted.shape, fitted.signals, fitted.plane
    h, g = float(shape.left_out.sum()), float(fitted.pose_left_out.sum())
    ticks = np.arange(len(shape.X), dtype=np.float64)
    on_curve = signals.pose(signals.time(ticks), ticks)
    on_curve = on_curve if shape.turn is None else on_curve @ shape.turn
    moved = 0.0 if plane is None else np.square(plane.pose(plane.positions, ticks) - on_curve).sum()
    whole = h + float(np.square(shape.straight - on_curve).sum())
    rest = whole - h - g
    percent = {n: float(shape.percent(v)) for n, v in (("h", h), ("g", g), ("f", moved), ("whole", whole))}
    return {**percent, "f_signed": math.copysign(float(shape.percent(abs(rest))), rest)}


def _result_warnings(floor: float, options: FitOptions, paper: dict[str, float | None]) -> list[str]:
    """Say what only the finished fit shows."""
    found: list[str] = []
    # where all frames are wanted back any floor matters, else only one near the tolerance
    exact = None not in (options.k, options.l, options.m)
    if floor > (ROUNDING if exact else 0.01 * options.percent):
        found.append(
            f"frames that repeat lie at one place: g(f(t)) cannot be nearer to the clip than {floor:.2g} % "
            "of the diagonal, whatever k, l and m"
        )
    reached = paper["rms_percent"]
    if options.tolerance is not None and reached is not None and reached > 1.02 * options.tolerance:
        found.append(
            f"the tolerance of {options.tolerance:g} % is not met by h(g(f(t))): it reaches {reached:.3g} %"
        )
    return found
