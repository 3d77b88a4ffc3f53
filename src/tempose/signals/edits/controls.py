"""Edits of the curve's control points: only frames under the support of what moved change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tempose._validate import as_floats
from tempose.curves import Spline
from tempose.curves.refine import insert_knots
from tempose.signals.edits._frames import frame_seconds
from tempose.signals.edits.knots import free_place
from tempose.signals.signals import Signals
from tempose.typing import FloatArray

FARTHEST = 1e6
"""Sizes of the curve beyond which a control cannot be: splines of the plane overflow long after that."""


def move_control(signals: Signals, control: int, by: Sequence[float] | FloatArray) -> Signals:
    """Move a control point of the curve.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    control : int
        Which, from 0.
    by : (2,) float
        How far, in units of the pose plane.

    Returns
    -------
    Signals
        Frames outside the support of the control are the same bit for bit (section 4.1 of the paper).

    Raises
    ------
    ValueError
        If there is no such control or `by` is no pair of numbers.
    """
    i = _control_index(signals, control)
    at = signals.time.curve.controls[i] + as_floats(by, "by", (2,))
    return _with_control(signals, i, at, "by")


def place_control(signals: Signals, control: int, at: Sequence[float] | FloatArray) -> Signals:
    """Put a control point of the curve somewhere.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    control : int
        Which, from 0.
    at : (2,) float
        Where, in the pose plane.

    Returns
    -------
    Signals
        As `move_control` returns it.

    Raises
    ------
    ValueError
        If there is no such control or `at` is no pair of numbers.
    """
    return _with_control(signals, _control_index(signals, control), as_floats(at, "at", (2,)), "at")


def insert_control(signals: Signals, at: float) -> Signals:
    """Insert a control point; what is played stays the same.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    at : float
        Frame from 0 where a finer hold on the curve is wanted. The knot goes into the middle half of the
        span of knots there.

    Returns
    -------
    Signals
        With one control more; those behind it count one higher.

    Raises
    ------
    ValueError
        If there is no such frame.
    """
    time = signals.time
    u = float(time.pace(signals.ticks(np.array(frame_seconds(signals, at, "at")))))
    at_u = np.array([free_place(time.curve, u)])
    curve, unedited = insert_knots(time.curve, at_u), insert_knots(time.unedited, at_u)
    return replace(signals, time=replace(time, curve=curve, unedited=unedited))


def _control_index(signals: Signals, control: Any) -> int:
    last = len(signals.time.curve.controls) - 1
    if isinstance(control, bool) or not isinstance(control, int | np.integer) or not 0 <= control <= last:
        raise ValueError(f"control must be from 0 to {last}, got {control!r}")
    return int(control)


def _with_control(signals: Signals, i: int, at: FloatArray, name: str) -> Signals:
    curve = signals.time.curve
    size = float(np.abs(signals.time.unedited.controls).max()) or 1.0
    if not np.abs(at).max() <= FARTHEST * size:
        raise ValueError(
            f"{name} puts control {i} at [{at[0]:.3g}, {at[1]:.3g}], expected a place in or near the curve, "
            f"whose coordinates go up to {size:.3g}"
        )
    controls = curve.controls.copy()
    controls[i] = at
    step = signals.pose_step if signals.fade_step is None else signals.fade_step
    return replace(signals, time=replace(signals.time, curve=Spline(curve.knots, controls)), fade_step=step)
