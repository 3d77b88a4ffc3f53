"""Whether a clip is cyclic, and after how many frames it repeats: not always a whole number."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.curves import interpolating_spline
from tempose.signals.time._period_scan import phase_errors
from tempose.signals.time.path import SAME_PHASE
from tempose.typing import BoolArray, FloatArray

_MODES = 12
_WINDOW = 240  # frames; of a longer clip the middle is searched
_CLEARLY = 0.7  # of the cubic's error
_LEAST = 3.0  # frames; less than that could be any of many periods


@dataclass(frozen=True)
class Period:
    """A period that predicts frames clearly better than their neighbours in time do."""

    ticks: float
    """Frames of the captured clip after which it repeats."""
    error: float
    """rms error of frames left out one by one and predicted with the period, in shape coordinates."""
    cubic: float
    """What the cubic in time is expected to miss between two frames."""


def find_period(X: FloatArray) -> Period | None:
    """Find the period of a cyclic clip.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates of the frames, a frame a tick.

    Returns
    -------
    Period or None
        None for a clip that does not repeat, or too little for the period to tell more than the neighbouring
        frames: taken is only a period that wins when frames are left out, clearly and against what the cubic
        would do with all of them.
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
    found = [(ticks, error) for ticks, error in found if error < _CLEARLY * cubic]
    if not found or _ambiguous(found, 0.05 * cubic):
        return None
    # of a period of whole frames any fraction predicts each frame by its twin: what lies between tells more
    least = min(error for _, error in found)
    found = [f for f in found if f[1] <= max(1.5 * least, 0.05 * cubic)]
    between = phase_errors(X, np.array([ticks for ticks, _ in found]), SAME_PHASE, True)
    good = [f for f, error in zip(found, between) if error <= 1.05 * between.min() + 1e-12 * scale]
    ticks, error = min(good)
    return Period(ticks, error, cubic)


def _ambiguous(found: list[tuple[float, float]], small: float) -> bool:
    # few frames suit several periods: two that have nothing to do with each other and do about as well
    best, least = min(found, key=lambda f: f[1])
    if least < small:
        return False
    ratios = [max(ticks, best) / min(ticks, best) for ticks, error in found if error < 1.25 * least]
    return any(abs(ratio - round(ratio)) > 0.06 * ratio for ratio in ratios)


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
    steps = int(np.ceil(10 * len(X) * np.log(most / least)))  # a tenth of a tick over the whole clip
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
