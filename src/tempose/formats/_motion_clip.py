"""From what a motion file says to a clip in our axes and metres; what it leaves out is guessed."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tempose.clips import Skeleton, SkeletonClip, Source
from tempose.formats.conventions import guess_unit, to_inside, y_up_rotation
from tempose.kinematics import forward_kinematics
from tempose.rotations import conjugate, from_matrix, multiply, rotate
from tempose.typing import FloatArray

_FEET = re.compile(r"foot|feet|toe|ankle|hoof|paw", re.IGNORECASE)
_UNITS = ("mm", "cm", "dm", "m", "in", "cmu")
_RATES = (
    *(24, 25, 30, 48, 50, 60, 72, 75, 90, 96, 100, 120, 144, 150, 180, 200, 240, 250, 300, 360, 480, 500),
    *(1000, 24000 / 1001, 30000 / 1001, 60000 / 1001, 120000 / 1001),
)
_SAMPLED = 32


@dataclass(frozen=True)
class Found:
    """What the file itself said."""

    path: str
    format: str
    fps: float | None
    notes: tuple[str, ...] = ()


def to_clip(
    skeleton: Skeleton,
    rotations: FloatArray,
    root: FloatArray,
    found: Found,
    *,
    up: str | None,
    unit: float | None,
    fps: float | None,
    usual_fps: float = 30.0,
) -> SkeletonClip:
    """Convert joints, rotations and root path as in the file; rest rotations are the identity."""
    if up not in (None, "x", "y", "z"):
        raise ValueError(f"up must be 'x', 'y' or 'z', got {up!r}")
    guessed = [
        name for name, value in (("up", up), ("unit", unit), ("fps", fps or found.fps)) if value is None
    ]
    points = _sampled_points(skeleton, rotations, root)
    up = guess_up(skeleton.names, points[:, : skeleton.n_joints]) if up is None else up
    if unit is None:
        unit = guess_unit(float(np.median(np.ptp(points[:, :, "xyz".index(up)], axis=1))), _UNITS)
    source = Source(found.path, found.format, up, unit, found.fps, tuple(guessed), found.notes)
    rate = (found.fps or usual_fps) if fps is None else fps
    skeleton, rotations = _turned(skeleton, rotations, up, unit)
    name = Path(found.path).stem
    return SkeletonClip(skeleton, rotations, to_inside(root, up, unit), rate, name, source)


def _turned(skeleton: Skeleton, rotations: FloatArray, up: str, unit: float) -> tuple[Skeleton, FloatArray]:
    # every basis turns with the world, so that rest stays the identity
    assert skeleton.tips is not None
    offsets, tips = to_inside(skeleton.offsets, up, unit), to_inside(skeleton.tips, up, unit)
    skeleton = Skeleton(skeleton.names, skeleton.parents, offsets, tips=tips)
    if up == "y":
        return skeleton, rotations
    turn = from_matrix(y_up_rotation(up))
    return skeleton, multiply(multiply(turn, rotations), conjugate(turn))


def _sampled_points(skeleton: Skeleton, rotations: FloatArray, root: FloatArray) -> FloatArray:
    """(k, 2 J, 3): joints, then tips, in at most 32 frames spread over the clip."""
    chosen = np.unique(np.linspace(0, len(rotations) - 1, _SAMPLED).round().astype(int))
    world, joints = forward_kinematics(skeleton, rotations[chosen], root[chosen])
    assert skeleton.tips is not None
    tips = joints + rotate(world, np.nan_to_num(skeleton.tips))
    return np.concatenate([joints, tips], axis=1)


def guess_up(names: tuple[str, ...], joints: FloatArray) -> str:
    """Axis along which the body stands over its feet, known by name; y where none stands out.

    `joints` is (k, J, 3), some frames in the axes of the file.
    """
    feet = np.array([bool(_FEET.search(name)) for name in names])
    if not feet.any() or feet.all():
        return "y"
    stance = np.median(joints[:, ~feet].mean(axis=1) - joints[:, feet].mean(axis=1), axis=0)
    best = int(np.abs(stance).argmax())
    return "xyz"[best] if abs(stance[best]) > 1.5 * abs(stance[1]) else "y"


def rate_from_period(text: str) -> float:
    """Frame rate that a rounded frame time stands for.

    The usual rate nearest to it, else the nearest whole one, within the rounding of the last digit;
    else the reciprocal.

    Examples
    --------
    >>> rate_from_period(".0083333"), rate_from_period("0.04"), rate_from_period("0.041667")
    (120.0, 25.0, 24.0)
    """
    period = float(text)
    mantissa, _, exponent = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2]) - int(exponent or 0)
    slack = 0.5001 * 10.0**-decimals
    exact = 1.0 / period
    if math.isclose(exact, round(exact), rel_tol=1e-9):
        return float(round(exact))
    for rates in (_RATES, (max(round(exact), 1),)):
        rate = min(rates, key=lambda r: abs(1.0 / r - period))
        if abs(1.0 / rate - period) <= slack:
            return float(rate)
    return exact
