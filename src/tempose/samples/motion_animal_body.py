"""Trunk, neck, head and tail of an animal in a gait."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.rotations import IDENTITY, multiply, rotate
from tempose.samples.motion_clip import Body, BodyPose
from tempose.samples.motion_curves import about, wave
from tempose.typing import FloatArray


@dataclass(frozen=True)
class AnimalStyle:
    """Means and swings; angles in radians, crests in strides after the left hind hoof lands."""

    beats: int
    """Bobs a stride."""
    bob: float
    """Half the range of the centre, metres."""
    crest: float
    """When the centre is highest."""
    drop: float
    """Mean height below the rest pose, metres."""
    pitch: float
    """The trunk rocks, nose down, ..."""
    pitch_crest: float
    """... most at this phase."""
    tuck: tuple[float, float]
    """Mean and swing of the bend of the loins: the pelvis under the body, ..."""
    tuck_crest: float
    """... most at this phase."""
    neck: float
    """Neck lowered from the rest pose."""
    nod: float
    """Swing of the neck, ..."""
    nod_crest: float
    """... lowest at this phase."""
    bend: float
    """Sideways swing of pelvis and spine."""
    tail: float
    """Tail lifted."""
    tail_swing: tuple[float, float]
    """Swing of the tail up and down, and from side to side."""


STYLE_FIELDS = ("nod", "bend", "neck", "tail", "pitch")
"""Amplitudes that differ from one performer to another."""

SPINE = (("spine_1", 0.4), ("spine_2", 0.3), ("spine_3", 0.2), ("chest", 0.1))
"""Joints that take up the bend of the loins, and their shares."""


def animal_body(skeleton: Skeleton, style: AnimalStyle, speed: float, period: float) -> Body:
    """Trunk that rocks about its centre, neck against it, tail behind.

    Parameters
    ----------
    skeleton : Skeleton
        An animal.
    style : AnimalStyle
        Amplitudes.
    speed : float
        Metres per second along +Z.
    period : float
        Seconds a stride.

    Returns
    -------
    Body
        Pose as a function of time.
    """
    rest = rest_transforms(skeleton)[1]
    centre = 0.5 * (rest[0] + rest[skeleton.index("chest")])

    def body(times: FloatArray) -> BodyPose:
        phase = times / period
        rotations = np.tile(IDENTITY, (len(times), skeleton.n_joints, 1))
        pitch = style.pitch * wave(phase, style.pitch_crest, style.beats)
        _set_spine(skeleton, rotations, style, phase, pitch)
        _set_neck(skeleton, rotations, style, phase, pitch)
        _set_tail(skeleton, rotations, style, phase)
        height = style.bob * wave(phase, style.crest, style.beats) - style.drop
        travel = np.stack([0.0 * phase, height, speed * times], axis=1)
        root = centre + travel + rotate(about("x", pitch), rest[0] - centre)
        return BodyPose(root, rotations, np.zeros(len(times)))

    return body


def _set_spine(
    skeleton: Skeleton, rotations: FloatArray, style: AnimalStyle, phase: FloatArray, pitch: FloatArray
) -> None:
    tuck = style.tuck[0] + style.tuck[1] * wave(phase, style.tuck_crest)
    # the hip of the hind leg that lands goes ahead
    bend = -style.bend * wave(phase, 0.0)
    rotations[:, 0] = multiply(about("y", bend), about("x", pitch - tuck))
    for name, share in SPINE:
        rotations[:, skeleton.index(name)] = multiply(about("y", -2 * share * bend), about("x", share * tuck))


def _set_neck(
    skeleton: Skeleton, rotations: FloatArray, style: AnimalStyle, phase: FloatArray, pitch: FloatArray
) -> None:
    level = style.neck + style.nod * wave(phase, style.nod_crest, style.beats)
    late = style.neck + style.nod * wave(phase, style.nod_crest + 0.05, style.beats)
    rotations[:, skeleton.index("neck_1")] = about("x", 0.6 * level - 0.5 * pitch)
    rotations[:, skeleton.index("neck_2")] = about("x", 0.4 * late - 0.3 * pitch)
    # a lowered neck is stretched, nose ahead
    rotations[:, skeleton.index("head")] = about("x", -1.0 * late)


def _set_tail(skeleton: Skeleton, rotations: FloatArray, style: AnimalStyle, phase: FloatArray) -> None:
    for k, share in enumerate((0.7, 0.22, 0.08, 0.0)):
        lag = 0.1 + 0.1 * k
        lift = share * style.tail + style.tail_swing[0] * (1 + 0.25 * k) * wave(phase, lag, style.beats)
        aside = style.tail_swing[1] * (1 + 0.25 * k) * wave(phase, lag)
        rotations[:, skeleton.index(f"tail_{k + 1}")] = multiply(about("z", aside), about("x", lift))


def hip_height(skeleton: Skeleton) -> float:
    """Height of the hip of an animal in the rest pose, the unit of every length in its gaits.

    Parameters
    ----------
    skeleton : Skeleton
        An animal.

    Returns
    -------
    float
        Metres.
    """
    return float(rest_transforms(skeleton)[1][skeleton.index("left_hind_thigh"), 1])


def degrees(**angles: float) -> dict[str, float]:
    """State of a swinging limb, with angles given in degrees.

    Parameters
    ----------
    **angles : float
        ``at`` as it is; angles of `STATE` in degrees.

    Returns
    -------
    dict
        The same in radians.
    """
    return {name: value if name == "at" else radians(value) for name, value in angles.items()}
