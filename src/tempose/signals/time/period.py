"""Whether a clip is cyclic, and after how many frames it repeats: not always a whole number."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.curves import interpolating_spline
from tempose.signals.time._period_scan import phase_errors
from tempose.signals.time.path import SAME_PHASE, path_through, repeats_phases
from tempose.typing import BoolArray, FloatArray

_MODES = 12
_WINDOW = 240  # frames; of a longer clip the middle is searched
_CLEARLY, _SURELY = 0.7, 0.25  # of the cubic's error
_LEAST = 3.0  # frames; less than that could be any of many periods


@dataclass(frozen=True)
class Period:
    """A period that predicts frames clearly better than their neighbours in time do."""

    ticks: float
    """Frames of the captured clip after which it repeats."""
    error: float
    """rms error of frames left out and predicted with the period, in shape coordinates."""
    cubic: float
    """What the cubic in time is expected to miss between two frames."""
    interleaves: bool
    """Whether frames of other cycles surely tell what lies between two frames better than the cubic does."""


def find_period(X: FloatArray) -> Period | None:
    """Find the period of a cyclic clip.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates of the frames, a frame a tick.

    Returns
    -------
    Period or None
        None for a clip that does not repeat, or too little to say after how many frames: a period must
        predict frames that are left out clearly better than the cubic in time can be expected to do with all.
    """
    X = as_floats(X, "X", ("n", "m"))
    start = max((len(X) - _WINDOW) // 2, 0)
    X = X[start : start + _WINDOW]
    if len(X) < 6:
        return None
    X = _main_modes(X)
    cubic = _cubic_error(X)
    scale = float(np.sqrt(np.square(X - X.mean(0)).sum(1).mean()))
    if cubic <= 1e-9 * scale or not _comes_back(X, cubic):
        return None
    found = [_refined(X, ticks) for ticks in _candidates(X)]
    return _whole(X, found, cubic) or _fraction(X, found, cubic)


def _whole(X: FloatArray, found: list[tuple[float, float]], cubic: float) -> Period | None:
    # cycles that show the same phases: each frame has a twin, what lies between is left to the cubic
    same = [
        (ticks, error) for ticks, error in found if error < _CLEARLY * cubic and repeats_phases(len(X), ticks)
    ]
    if not same:
        return None
    least = min(error for _, error in same)
    same = [f for f in same if f[1] <= max(1.5 * least, 0.05 * cubic)]
    # any fraction of a whole period finds the twins, too; the frames beside them it does not
    between = phase_errors(X, np.array([ticks for ticks, _ in same]), SAME_PHASE, True)
    between = between * [1.0 if ticks == round(ticks) else 1 / _CLEARLY for ticks, _ in same]
    ticks, error = min(f for f, e in zip(same, between) if e <= 1.05 * between.min() + 1e-12 * cubic)
    return Period(ticks, error, cubic, interleaves=False)


def _fraction(X: FloatArray, found: list[tuple[float, float]], cubic: float) -> Period | None:
    # cycles that interleave: of frames left out one by one and every second one the worse counts
    new = [(error, ticks) for ticks, error in found if not repeats_phases(len(X), ticks)]
    judged = [(max(error, _every_second(X, ticks)), ticks) for error, ticks in new]
    sure = _best(judged, _SURELY * cubic)
    if sure is not None and _spread(len(X), sure[1]) > 0.5:
        return Period(sure[1], sure[0], cubic, interleaves=True)
    clear = _best(new, _CLEARLY * cubic)
    return None if clear is None else Period(clear[1], clear[0], cubic, interleaves=False)


def _spread(n: int, period: float) -> float:
    # 1 if the frames of all cycles are spaced evenly, 0 if they fall together, by the gaps one meets
    phases = np.sort(np.arange(n) % period)
    gaps = np.diff(phases, append=phases[0] + period)
    return float((1 - np.square(gaps).sum() / gaps.sum()) / (1 - period / n))


def _best(judged: list[tuple[float, float]], limit: float) -> tuple[float, float] | None:
    if not judged or min(judged)[0] >= limit:
        return None
    least, best = min(judged)
    # few frames suit several periods: two that have nothing to do with each other and do about as well
    ratios = [max(ticks, best) / min(ticks, best) for error, ticks in judged if error < 1.25 * least]
    return None if any(abs(ratio - round(ratio)) > 0.06 * ratio for ratio in ratios) else (least, best)


def _every_second(X: FloatArray, period: float) -> float:
    # just what the path will be used for, with half of the frames
    ticks, total, count = np.arange(float(len(X))), 0.0, 0
    for first in (0, 1):
        kept = ticks[first::2]
        missing = np.arange(kept[0] + 1, kept[-1], 2)
        if len(missing) == 0 or not period < kept[-1] - kept[0]:
            return np.inf
        off = path_through(kept, X[first::2], period)(missing) - X[missing.astype(int)]
        total, count = total + float(np.square(off).sum()), count + len(missing)
    return float(np.sqrt(total / count))


def _main_modes(X: FloatArray) -> FloatArray:
    # beyond these hardly anything moves
    Y = X - X.mean(0)
    w, U = np.linalg.eigh(Y.T @ Y) if X.shape[1] <= len(X) else _from_gram(Y)
    power = np.cumsum(w[::-1]) / max(w.sum(), 1e-300)
    m = min(int(np.searchsorted(power, 1 - 1e-6)) + 1, _MODES)
    return np.ascontiguousarray(Y @ U[:, ::-1][:, :m])


def _from_gram(Y: FloatArray) -> tuple[FloatArray, FloatArray]:
    w, U = np.linalg.eigh(Y @ Y.T)
    keep = w > 1e-13 * w[-1]
    return w[keep], Y.T @ U[:, keep] / np.sqrt(w[keep])


def _cubic_error(X: FloatArray) -> float:
    # frames 2 apart and 4 apart say how fast the error falls with the distance
    two, four = (_left_out(X, step) for step in (2, 4))
    return two * min(1.0, two / four) if four > 0 else 0.0


def _left_out(X: FloatArray, step: int) -> float:
    ticks = np.arange(float(len(X)))
    kept = ticks[::step].astype(int)
    if len(kept) < 2:
        return np.inf
    missing = np.arange(step // 2, kept[-1], step)
    off = interpolating_spline(ticks[kept], X[kept])(ticks[missing]) - X[missing]
    return float(np.sqrt(np.square(off).sum(1).mean()))


def _comes_back(X: FloatArray, cubic: float) -> bool:
    # a cyclic clip passes near each of its frames once more: measured to the lines between other frames
    n = len(X)
    ends = X[1:] - X[:-1]
    length2 = np.square(ends).sum(1)
    off = X[:, None] - X[None, :-1]
    share = np.clip(np.einsum("ijm,jm->ij", off, ends) / np.where(length2 > 0, length2, 1.0), 0.0, 1.0)
    near = np.linalg.norm(off - share[..., None] * ends, axis=2)
    i, j = np.arange(n)[:, None], np.arange(n - 1)[None]
    near[(j > i - 3) & (j < i + 2)] = np.inf
    nearest = near.min(axis=1)
    bend = 0.125 * np.linalg.norm(np.diff(X, 2, axis=0), axis=1).max()
    return float(np.sqrt(np.mean(np.square(np.maximum(nearest - bend, 0.0))))) < cubic


def _candidates(X: FloatArray) -> FloatArray:
    least, most = _LEAST, (len(X) - 1) / 1.25
    if most <= least:
        return np.zeros(0)
    finer = 10 if len(X) <= 64 else 4  # steps a tick, over the whole clip
    steps = int(np.ceil(finer * len(X) * np.log(most / least)))
    periods = least * (most / least) ** (np.arange(steps + 1) / steps)
    periods = periods[_plausible(X, periods)]
    errors = phase_errors(X, periods, SAME_PHASE, False)
    padded = np.concatenate([[np.inf], errors, [np.inf]])
    lowest = np.flatnonzero((errors <= padded[:-2]) & (errors <= padded[2:]) & np.isfinite(errors))
    return periods[lowest[np.argsort(errors[lowest], kind="stable")[:8]]]


def _plausible(X: FloatArray, periods: FloatArray) -> BoolArray:
    # after a period of many frames a frame is nearer to where it was than it commonly is
    n = len(X)
    lags = np.arange(1, n)
    apart = np.array([np.sqrt(np.square(X[lag:] - X[:-lag]).sum(1).mean()) for lag in lags])
    return (periods < 8) | (np.interp(periods, lags, apart) < 0.7 * np.median(apart))


def _refined(X: FloatArray, ticks: float) -> tuple[float, float]:
    width = 0.1 * ticks / len(X)
    error = np.inf
    for _ in range(4):
        trials = np.concatenate([ticks + width * np.linspace(-1, 1, 9), [np.round(ticks)]])
        errors = phase_errors(X, trials, SAME_PHASE, False)
        # a whole number of frames is the likelier reading
        near = abs(trials[-1] - ticks) < 0.1 * ticks / len(X)
        best = len(trials) - 1 if near and errors[-1] <= 1.05 * errors.min() else int(np.argmin(errors[:-1]))
        ticks, error = float(trials[best]), float(errors[best])
        width *= 0.25
    return ticks, error
