"""Where the moving mesh stands: scaled path, feet that stay where they are put."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from tempose.linalg import SparseCholesky
from tempose.transfer.feet.foot_hold import FADE, hold_feet
from tempose.transfer.feet.ground_plane import lift_above
from tempose.transfer.feet.soles import HORIZONTAL, FootFrames, Sole, find_sole
from tempose.transfer.feet.steady_path import second_differences
from tempose.typing import BoolArray, FloatArray

_LEAST_TRAVEL = 0.05
"""Speed of the hips in contact, in heights a second, below which a scale means nothing."""
_ROOT_TIME = 0.05
"""Seconds: what the feet ask of the root faster than this is left to the legs."""


@dataclass(frozen=True)
class Placement:
    """A translation a frame, a displacement a foot, and how they were found."""

    shift: FloatArray
    """(T, 3) metres, added to frames whose anchor is at its rest place."""
    feet: FloatArray
    """(T, f, 3) metres, by which each foot is displaced besides."""
    scale: float
    """Target metres per source metre, horizontally."""
    scale_vertical: float
    """The same vertically."""
    fitted: bool
    """Whether `scale` was fitted on stance; else it is `scale_vertical`."""
    correction: float
    """Length of the path by which the root was moved so that feet stand still, metres."""


def place_clip(
    anchor: FloatArray,
    soles: Sequence[FloatArray | FootFrames],
    contact: BoolArray,
    ground: float,
    height: float,
    leg_ratio: float,
    fps: float,
    hold: bool = True,
    levels: FloatArray | None = None,
    trunk: FloatArray | None = None,
) -> Placement:
    """Find the translation of every frame and the displacement of every foot.

    Parameters
    ----------
    anchor : (T, 3) float
        Movement of the source's anchor away from its reference place, metres.
    soles : list of (T, k, 3) float or FootFrames
        Vertices of each target foot, in frames whose anchor stands at its rest place.
    contact : (T, f) bool
        Contacts of the source's feet.
    ground : float
        Height of the ground under the target, metres.
    height : float
        Height of the target, metres.
    leg_ratio : float
        Leg length of the target over that of the source.
    fps : float
        Frames per second.
    hold : bool, default True
        Whether the feet in contact are held still: by the root, and by each leg in what is left.
    levels : (f,) float, optional
        Metres by which the ground under each foot is higher than `ground`.
    trunk : (T,) float, optional
        Height of the lowest vertex that the root alone keeps above the ground, metres.

    Returns
    -------
    Placement
        Path and height; without `hold` one height for the whole clip and no displaced feet.

    Notes
    -----
    The scale is the one at which feet in contact move least: ``s = -sum(v_foot . v_hip) / sum(|v_hip|^2)``
    over contact frames. The root takes the smooth share of what is left, by least squares over all feet; the
    rest is taken by each foot alone, exactly.
    """
    levels = np.zeros(len(soles)) if levels is None else levels
    found = [find_sole(foot, contact[:, f], height, fps, levels[f]) for f, foot in enumerate(soles)]
    scale = fit_scale(anchor, found, height, fps)
    fitted = scale is not None
    scale = leg_ratio if scale is None else scale
    shift = anchor * np.array([scale, leg_ratio, scale])
    correction = 0.0
    if hold and soles:
        steps = root_steps(found, shift, fps)
        shift[:, HORIZONTAL] += steps
        correction = float(np.linalg.norm(np.diff(steps, axis=0), axis=1).sum())
    shift[:, 1] += _root_lift(found, shift[:, 1], ground, fps, hold)
    if trunk is not None:
        shift[:, 1] += lift_above(trunk + shift[:, 1], ground, FADE * fps)
    feet = hold_feet(found, shift, ground, fps) if hold else np.zeros((len(shift), len(soles), 3))
    return Placement(shift, feet, float(scale), leg_ratio, fitted, correction)


def fit_scale(anchor: FloatArray, soles: Sequence[Sole], height: float, fps: float) -> float | None:
    """Horizontal scale at which feet in contact slide least.

    Parameters
    ----------
    anchor : (T, 3) float
        Path of the source's anchor, metres.
    soles : sequence of Sole
        Those of the target, found with the anchor held.
    height : float
        Height of the target, metres.
    fps : float
        Frames per second.

    Returns
    -------
    float or None
        The scale; None where the body hardly travels in contact or the fit is absurd.
    """
    if len(anchor) < 3:
        return None
    against = along = 0.0
    count = 0
    for sole in soles:
        span = (sole.windows @ np.arange(len(anchor), dtype=np.float64))[:, None] / fps
        hip, foot = sole.windows @ anchor[:, HORIZONTAL] / span, sole.travel / span
        against -= float((foot * hip).sum())
        along += float((hip**2).sum())
        count += len(hip)
    if along <= 0 or against <= 0:
        return None
    scale = against / along
    travel = scale * np.sqrt(along / count)
    return scale if travel > _LEAST_TRAVEL * height else None


def root_steps(soles: Sequence[Sole], shift: FloatArray, fps: float) -> FloatArray:
    """Horizontal share of the root in holding the feet: smooth, by least squares over all of them.

    Parameters
    ----------
    soles : sequence of Sole
        One a foot.
    shift : (T, 3) float
        Translation of the body so far, metres.
    fps : float
        Frames per second.

    Returns
    -------
    (T, 2) ndarray
        Metres, zero in the first frame and everywhere without contact.
    """
    T = len(shift)
    bend = second_differences(T)
    span = max(fps / 30, 2.0)
    # the last term keeps the root where no foot ever stands; it weighs nothing in a clip of any length
    matrix = bend.T @ bend * (_ROOT_TIME * fps) ** 2 + sp.eye_array(T) * 1e-9
    wanted = np.zeros((T, 2))
    for sole in soles:
        matrix = matrix + sole.windows.T @ sole.windows / span**2
        wanted -= sole.windows.T @ sole.slip(shift) / span**2
    if not wanted.any():
        return wanted
    steps = SparseCholesky(matrix).solve(wanted)
    return steps - steps[0]


def _root_lift(soles: Sequence[Sole], y: FloatArray, ground: float, fps: float, hold: bool) -> FloatArray:
    """Lift of the root that brings standing soles near the ground; one for the whole clip without `hold`."""
    T = len(y)
    if not soles:
        return np.zeros(T)
    gaps = np.stack([ground + sole.level - sole.low - y for sole in soles], axis=1)
    contact = np.stack([sole.contact for sole in soles], axis=1)
    standing = contact.any(axis=1)
    if not standing.any():
        return np.full(T, float(np.percentile(gaps.max(axis=1), 95)))
    highest = gaps.max(axis=1)
    middle = float(np.median(highest[standing]))
    if not hold:
        return np.full(T, middle)
    bend = second_differences(T)
    matrix = bend.T @ bend * (_ROOT_TIME * fps) ** 4 + sp.diags_array(contact.sum(axis=1) + 1e-9)
    wanted = np.where(contact, gaps - middle, 0.0).sum(axis=1)
    return middle + SparseCholesky(matrix).solve(wanted)
