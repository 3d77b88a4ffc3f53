"""What a fit tells about itself: errors, where they come from, how long it took."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from tempose._version import __version__
from tempose.clips import MeshClip
from tempose.metrics import compare
from tempose.signals.fitting import FittedClip
from tempose.signals.frame_errors import frame_errors, scree
from tempose.signals.options import FitOptions
from tempose.signals.sampling import sample
from tempose.signals.signals import Signals
from tempose.typing import FloatArray, Progress, silent


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
    signals = fitted.signals
    progress(5, 5, "measuring errors")
    report: dict[str, Any] = {
        "version": __version__,
        "options": asdict(options),
        "frames": clip.n_frames,
        "vertices": len(clip.rest),
        "dimension": signals.shape.space.dimension,
        "k": len(signals.time.curve.controls),
        "l": len(fitted.site_frames),
        "m": len(signals.shape.components),
        **fitted.facts,
        "errors": clip_errors(clip, signals, fitted.diagonal),
        "paper": clip_errors(clip, replace(signals, path=None), fitted.diagonal),
        "budget": error_budget(fitted),
        "frame_errors": frame_errors(clip, fitted),
        "scree": scree(fitted.shape),
        "warnings": list(fitted.warnings),
    }
    report["seconds"] = {**fitted.seconds, "total": sum(fitted.seconds.values())}
    return report


def clip_errors(clip: MeshClip, signals: Signals, diagonal: float) -> dict[str, float | None]:
    """Compare the frames of a clip with those that signals play.

    Parameters
    ----------
    clip : MeshClip
        The truth.
    signals : Signals
        What is played, unedited.
    diagonal : float
        D, metres.

    Returns
    -------
    dict
        The keys of `tempose.metrics.ClipErrors`; None where a measure is infinite.
    """
    played = sample(signals, np.arange(clip.n_frames) / clip.fps, dtype=np.float64)
    errors = compare(clip.vertices, played, diagonal).as_dict()
    return {name: value if math.isfinite(value) else None for name, value in errors.items()}


def error_budget(fitted: FittedClip) -> dict[str, float]:
    """Say how much each signal adds to the error at the frames.

    Parameters
    ----------
    fitted : FittedClip
        A fit.

    Returns
    -------
    dict
        Rms percent of the diagonal. ``h`` and ``g`` add in squares, since they are orthogonal; f does not:
        ``f`` is its own rms, ``g(P) - g(f(t))``, and ``f_signed`` the root of what the squares of the whole
        have more than those of h and g, negative where they have less.
    """
    shape, signals = fitted.shape, fitted.signals
    ticks = np.arange(len(shape.X), dtype=np.float64)
    at_places, on_curve = signals.pose(fitted.positions, ticks), signals.pose(signals.time(ticks), ticks)

    def squares(x: FloatArray) -> float:
        return float(np.square(x if shape.turn is None else x @ shape.turn).sum())

    h, g = float(shape.left_out.sum()), squares(shape.X - at_places)
    whole = h + squares(shape.X - on_curve)
    f = whole - h - g
    found = {"h": h, "g": g, "f": squares(at_places - on_curve), "whole": whole}
    percent = {name: float(shape.percent(value)) for name, value in found.items()}
    return {**percent, "f_signed": math.copysign(float(shape.percent(abs(f))), f)}
