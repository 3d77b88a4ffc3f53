"""The time spline of shape coordinates, x_c: what plays between the frames of a clip nobody has edited."""

from __future__ import annotations

import numpy as np

from tempose._validate import as_floats
from tempose.curves import Spline, insert_knots, interpolating_spline, periodic_spline, slice_spline
from tempose.typing import FloatArray, IntArray

SAME_PHASE = 0.05
"""Ticks; frames nearer than this in phase are one place of the cycle."""

_FINER = 1.2  # places in a cycle for every tick; with fewer the other cycles tell nothing new


def time_path(X: FloatArray, period: float | None = None) -> Spline:
    """Return the cubic spline through shape coordinates, one frame a tick.

    Parameters
    ----------
    X : (n, m) float
        Shape coordinates of the frames, n >= 2.
    period : float, optional
        Ticks after which a cyclic clip repeats, not always a whole number; the frames of all cycles then say
        together what lies between two frames.

    Returns
    -------
    Spline
        Over 0 .. n - 1, through every frame: the natural cubic. With a period, the periodic cubic through the
        frames sorted by phase, unrolled, plus the natural cubic of what it misses of the frames; where all
        cycles show the same phases they tell nothing new, and it is the natural cubic again.

    Raises
    ------
    ValueError
        If there is one frame only, or the period is not shorter than the clip.
    """
    X = as_floats(X, "X", ("n", "m"))
    if len(X) < 2:
        raise ValueError(f"a path needs 2 frames or more, got {len(X)}")
    ticks = np.arange(float(len(X)))
    return path_through(ticks, X, period)


def path_through(ticks: FloatArray, X: FloatArray, period: float | None) -> Spline:
    """Return the cubic spline through shape coordinates at any ticks.

    Parameters
    ----------
    ticks : (n,) float
        Ascending.
    X : (n, m) float
        Shape coordinates there.
    period : float or None
        As for `time_path`.

    Returns
    -------
    Spline
        From the first tick to the last.

    Raises
    ------
    ValueError
        If the period is not shorter than the clip.
    """
    if period is None:
        return interpolating_spline(ticks, X)
    if not 0 < period < ticks[-1] - ticks[0]:
        raise ValueError(f"period must be shorter than {ticks[-1] - ticks[0]:.6g} ticks, got {period:.6g}")
    if _repeats(ticks, period):
        return interpolating_spline(ticks, X)
    cycle = cycle_spline(ticks, X, period)
    rolled = unrolled(cycle, float(ticks[0]), float(ticks[-1]))
    missed = interpolating_spline(ticks, X - rolled(ticks))
    return _sum(rolled, missed)


def repeats_phases(n: int, period: float) -> bool:
    """Return whether all cycles show about the same phases, so that they tell nothing of what lies between.

    Parameters
    ----------
    n : int
        Frames, one a tick.
    period : float
        Ticks of a cycle.

    Returns
    -------
    bool
        Whether hardly more places of the cycle are known than ticks it has.
    """
    return _repeats(np.arange(float(n)), period)


def _repeats(ticks: FloatArray, period: float) -> bool:
    places = _places(np.sort(ticks % period), period)[-1] + 1
    return bool(places < _FINER * period * len(ticks) / (ticks[-1] - ticks[0]))


def _places(phases: FloatArray, period: float) -> IntArray:
    # phases one after another; those at the end of the cycle may belong to its begin
    groups = np.concatenate([[0], np.cumsum(np.diff(phases) > SAME_PHASE)])
    if groups[-1] and phases[0] + period - phases[-1] <= SAME_PHASE:
        groups[groups == groups[-1]] = 0
    return np.append(groups, groups.max())


def cycle_spline(ticks: FloatArray, X: FloatArray, period: float) -> Spline:
    """Return the periodic cubic through the frames of all cycles, sorted by phase.

    Parameters
    ----------
    ticks : (n,) float
        Ticks of the frames.
    X : (n, m) float
        Shape coordinates.
    period : float
        Ticks of a cycle.

    Returns
    -------
    Spline
        One cycle; frames of nearly the same phase are averaged.
    """
    phases = ticks % period
    order = np.argsort(phases, kind="stable")
    phases, X = phases[order], X[order]
    groups = _places(phases, period)[:-1]
    phases = np.where((groups == 0) & (phases > 0.5 * period), phases - period, phases)
    counts = np.bincount(groups)
    at = np.bincount(groups, phases) / counts
    mean = np.zeros((len(counts), X.shape[1]))
    np.add.at(mean, groups, X)
    if len(counts) < 2:
        at, mean = np.array([at[0], at[0] + 0.5 * period]), np.repeat(mean, 2, axis=0)
        counts = np.repeat(counts, 2)
    return periodic_spline(at, mean / counts[:, None], period)


def unrolled(cycle: Spline, start: float, stop: float) -> Spline:
    """Return a periodic curve over any stretch of its parameter.

    Parameters
    ----------
    cycle : Spline
        One period, C2 where it closes.
    start, stop : float
        Where the stretch begins and ends.

    Returns
    -------
    Spline
        Over ``start .. stop``.
    """
    first, last = cycle.domain
    period, breaks = last - first, cycle.breaks[:-1]
    n = len(breaks)
    low = int(np.floor((start - first) / period)) * n - 3
    high = int(np.ceil((stop - first) / period)) * n + 4
    at = np.arange(low, high)
    knots = breaks[at % n] + period * (at // n)
    wrapped = _periodic_controls(cycle)
    controls = wrapped[(at[:-4] + 2) % n]
    return slice_spline(Spline(knots, controls), start, stop)


def _periodic_controls(cycle: Spline) -> FloatArray:
    # row i: the control whose middle knot is break i
    from tempose.curves.refine import blossom

    first, last = cycle.domain
    period, breaks = last - first, cycle.breaks[:-1]
    n = len(breaks)
    at = np.arange(n)[:, None] + np.arange(-1, 2)
    triples = breaks[at % n] + period * (at // n)
    return blossom(cycle, triples, np.arange(n) + 3)


def _sum(a: Spline, b: Spline) -> Spline:
    knots = np.union1d(a.breaks, b.breaks)
    near = np.concatenate([[np.inf], np.diff(knots)]) < 1e-11 * (knots[-1] - knots[0])
    a, b = (insert_knots(s, _missing(s.breaks, knots[~near])) for s in (a, b))
    return Spline(a.knots, a.controls + b.controls)


def _missing(breaks: FloatArray, wanted: FloatArray) -> FloatArray:
    room = 1e-11 * (breaks[-1] - breaks[0])
    near = np.abs(wanted[:, None] - breaks[None]).min(axis=1) <= room
    return wanted[~near]
