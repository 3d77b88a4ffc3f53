"""Where the moving mesh stands: scaled path, feet that stay where they are put."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tempose.metrics import sole_velocities
from tempose.typing import BoolArray, FloatArray

_SOLE = 0.01
_LEAST_TRAVEL = 0.05
"""Speed of the hips in contact, in heights a second, below which a scale means nothing."""


@dataclass(frozen=True)
class Placement:
    """A translation a frame and how it was found."""

    shift: FloatArray
    """(T, 3) metres, added to frames whose anchor is at its rest place."""
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
    soles: Sequence[FloatArray],
    contact: BoolArray,
    ground: float,
    height: float,
    leg_ratio: float,
    fps: float,
    hold: bool = True,
) -> Placement:
    """Find the translation of every frame.

    Parameters
    ----------
    anchor : (T, 3) float
        Movement of the source's anchor away from its reference place, metres.
    soles : list of (T, k, 3) float
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
        Whether the root is moved so that the feet in contact stand still.

    Returns
    -------
    Placement
        Path and height; without `hold` one height for the whole clip.

    Notes
    -----
    The scale is the one at which feet in contact move least: ``s = -sum(v_foot . v_hip) / sum(|v_hip|^2)``
    over contact frames. What is left is taken out of the root step by step and interpolated through flight,
    and so is what keeps the standing sole off the ground.
    """
    scale = fit_scale(anchor, soles, contact, height, fps)
    fitted = scale is not None
    scale = leg_ratio if scale is None else scale
    shift = anchor * np.array([scale, leg_ratio, scale])
    correction = 0.0
    if hold and soles:
        steps = _slip_steps(soles, contact, shift, height, fps)
        shift[1:, [0, 2]] -= np.cumsum(steps, axis=0)
        correction = float(np.linalg.norm(steps, axis=1).sum())
    heights = _lifts(soles, contact, shift[:, 1], ground)
    shift[:, 1] += _smooth(heights[:, None], max(1, round(fps / 20)))[:, 0] if hold else np.median(heights)
    return Placement(shift, float(scale), leg_ratio, fitted, correction)


def fit_scale(
    anchor: FloatArray, soles: Sequence[FloatArray], contact: BoolArray, height: float, fps: float
) -> float | None:
    """Horizontal scale at which feet in contact slide least.

    Parameters
    ----------
    anchor : (T, 3) float
        Path of the source's anchor, metres.
    soles : list of (T, k, 3) float
        Vertices of each target foot with the anchor held.
    contact : (T, f) bool
        Contacts.
    height : float
        Height of the target, metres.
    fps : float
        Frames per second.

    Returns
    -------
    float or None
        The scale; None where the body hardly travels in contact or the fit is absurd.
    """
    if len(anchor) < 3 or not soles:
        return None
    hip = sole_velocities(anchor[:, None, :], height, fps)[:, [0, 2]]
    against = along = 0.0
    for f, foot in enumerate(soles):
        mine = contact[:, f]
        v = sole_velocities(foot, height, fps)[mine][:, [0, 2]]
        against -= float((v * hip[mine]).sum())
        along += float((hip[mine] ** 2).sum())
    if along <= 0 or against <= 0:
        return None
    scale = against / along
    travel = scale * np.sqrt(along / int(contact.sum()))
    return scale if travel > _LEAST_TRAVEL * height else None


def _slip_steps(
    soles: Sequence[FloatArray], contact: BoolArray, shift: FloatArray, height: float, fps: float
) -> FloatArray:
    """Horizontal displacement of the standing soles from frame to frame, (T-1, 2), filled through flight."""
    T = len(shift)
    total, count = np.zeros((T - 1, 2)), np.zeros(T - 1)
    root = np.diff(shift, axis=0)[:, [0, 2]]
    for f, foot in enumerate(soles):
        both = contact[1:, f] & contact[:-1, f]
        y = foot[..., 1]
        low = (y <= y.min(axis=1, keepdims=True) + _SOLE * height).astype(np.float64)
        share = low[1:] + low[:-1]
        share /= share.sum(axis=1, keepdims=True)
        slip = np.einsum("tk,tki->ti", share, np.diff(foot, axis=0))[:, [0, 2]] + root
        total += np.where(both[:, None], slip, 0.0)
        count += both
    known = np.flatnonzero(count > 0)
    if len(known) == 0:
        return np.zeros((T - 1, 2))
    mean = total[known] / count[known, None]
    filled = np.column_stack([np.interp(np.arange(T - 1), known, mean[:, k]) for k in range(2)])
    return _smooth(filled, round(fps / 60))


def _smooth(x: FloatArray, reach: int) -> FloatArray:
    """Triangular filter over 2 reach + 1 samples, edges repeated."""
    kernel = np.r_[np.arange(1, reach + 1), reach + 1, np.arange(reach, 0, -1)].astype(np.float64)
    kernel /= kernel.sum()
    padded = np.pad(x, ((reach, reach), (0, 0)), mode="edge")
    return np.column_stack([np.convolve(padded[:, k], kernel, mode="valid") for k in range(x.shape[1])])


def _lifts(soles: Sequence[FloatArray], contact: BoolArray, y: FloatArray, ground: float) -> FloatArray:
    """Lift that puts the lowest sole on the ground while a foot stands, interpolated through flight."""
    frames = np.arange(len(y))
    if not soles:
        return np.zeros(len(y))
    lows = np.stack([foot[..., 1].min(axis=1) + y for foot in soles], axis=1)
    standing = contact.any(axis=1)
    if not standing.any():
        return np.full(len(y), ground - float(np.percentile(lows.min(axis=1), 5)))
    # the lower of both soles, standing or about to land: a heel must not sink before its toe is in contact
    low = lows.min(axis=1)[standing]
    return np.interp(frames, frames[standing], ground - low)
