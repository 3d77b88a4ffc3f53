"""Joints at their usual places along trunk, arms and legs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.embedding.cells import Cells
from tempose.embedding.limbs import Limb, Limbs
from tempose.embedding.search import Ends
from tempose.typing import FloatArray

# places as shares of the way from the head to the toes, between landmarks of the body itself;
# medians over people with known joints
_SHOULDER_ABOVE_PIT, _SHOULDER_TO_TIP, _PIT_WEIGHT = 0.022, 0.365, 0.65
_ELBOW_SHARE, _ELBOW_TO_TIP = 0.325, 0.238
_WRIST_SHARE = 0.70
_HIP_ABOVE_CROTCH, _HIP_BELOW_PIT, _HIP = 0.045, 0.205, 0.458
_HIP_WEIGHTS = (0.4, 0.5, 0.1)
_HIP_WEIGHTS_SKIRTED = (0.0, 0.7, 0.3)
_ANKLE_TO_TOE = 0.108
_KNEE_SHARE, _KNEE_TO_ANKLE = 0.445, 0.22
_NECK_ABOVE_PIT, _HEAD_ABOVE_NECK = 0.085, 0.06
_SPINE_SHARE = 0.17
_HIPS_UP = 0.008
HIPS_BACK = 0.015
"""How far the hip joint of most skeletons lies behind those of the thighs."""
_FOOT_FROM = 0.03
_BALL_SHARE = 0.36
_CENTRED = 0.6


@dataclass(frozen=True)
class Arm:
    """Joints of one arm, (3,) each."""

    upper_arm: FloatArray
    forearm: FloatArray
    hand: FloatArray
    tip: FloatArray


@dataclass(frozen=True)
class Leg:
    """Joints of one leg, (3,) each."""

    thigh: FloatArray
    shin: FloatArray
    foot: FloatArray
    sole: FloatArray
    """(k, 3) positions of the cells of the foot."""


@dataclass(frozen=True)
class Trunk:
    """Joints of the trunk, (3,) each."""

    hips: FloatArray
    spine: FloatArray
    neck: FloatArray
    head: FloatArray
    tip: FloatArray


def place_arm(cells: Cells, limb: Limb, size: float, tip: int) -> Arm:
    """Place the joints of an arm.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    limb : Limb
        The arm from the armpit.
    size : float
        Way from the head to the feet.
    tip : int
        Cell at the finger tips.

    Returns
    -------
    Arm
        Shoulder, elbow, wrist and finger tip.
    """
    by_pit, by_tip = limb.start - _SHOULDER_ABOVE_PIT * size, limb.end - _SHOULDER_TO_TIP * size
    shoulder = _PIT_WEIGHT * by_pit + (1 - _PIT_WEIGHT) * by_tip
    elbow = 0.5 * (limb.start + _ELBOW_SHARE * (limb.end - limb.start)) + 0.5 * (
        limb.end - _ELBOW_TO_TIP * size
    )
    wrist = limb.start + _WRIST_SHARE * (limb.end - limb.start)
    return Arm(
        _before(limb, shoulder, 0.03 * size, 0.12 * size), limb.at(elbow), limb.at(wrist), cells.points[tip]
    )


def place_leg(cells: Cells, limb: Limb, size: float, pit: float, *, skirted: bool = False) -> Leg:
    """Place the joints of a leg.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    limb : Limb
        The leg from the crotch.
    size : float
        Way from the head to the feet.
    pit : float
        Level of the armpits.
    skirted : bool, default False
        Whether the legs part at the hem of a skirt, which says nothing about hips and knees.

    Returns
    -------
    Leg
        Hip joint, knee, ankle and the cells of the foot.
    """
    ankle_level = limb.end - _ANKLE_TO_TOE * size
    by = (limb.start - _HIP_ABOVE_CROTCH * size, pit + _HIP_BELOW_PIT * size, _HIP * size)
    weights = _HIP_WEIGHTS_SKIRTED if skirted else _HIP_WEIGHTS
    hip = sum(weight * level for weight, level in zip(weights, by))
    knee = ankle_level - _KNEE_TO_ANKLE * size
    if not skirted:
        knee = 0.5 * knee + 0.5 * (limb.start + _KNEE_SHARE * (ankle_level - limb.start))
    foot = limb.way[limb.region] > ankle_level - _FOOT_FROM * size
    return Leg(
        _before(limb, hip, 0.03 * size, 0.12 * size),
        limb.at(knee),
        limb.at(ankle_level),
        cells.points[limb.region][foot],
    )


def centre_hips(legs: tuple[Leg, Leg], trunk: Limb) -> tuple[Leg, Leg]:
    """Move both hip joints sideways until the trunk ends in the middle between them.

    Parameters
    ----------
    legs : (Leg, Leg)
        The legs as placed.
    trunk : Limb
        Head to crotch.

    Returns
    -------
    (Leg, Leg)
        With other hip joints.
    """
    across = legs[0].thigh - legs[1].thigh
    across = across / max(float(np.linalg.norm(across)), 1e-300)
    centre = trunk.at(trunk.end - 0.15 * (trunk.end - trunk.start))
    shift = _CENTRED * ((centre - (legs[0].thigh + legs[1].thigh) / 2) @ across) * across
    return replace(legs[0], thigh=legs[0].thigh + shift), replace(legs[1], thigh=legs[1].thigh + shift)


def place_toes(leg: Leg, side: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Place the ball of the foot and the tip of the toes.

    Parameters
    ----------
    leg : Leg
        One leg.
    side : (3,) float
        Direction from right to left.

    Returns
    -------
    toes, tip : (3,) ndarray
        Ball of the foot, where the toes begin; the middle of the foremost cells.
    """
    ahead = (leg.sole - leg.foot) @ forward_of(leg, side)
    tip = leg.sole[ahead >= 0.93 * ahead.max()].mean(axis=0)
    return tip + _BALL_SHARE * (leg.foot - tip), tip


def forward_of(leg: Leg, side: FloatArray) -> FloatArray:
    """Where the toes of a leg must point, whatever way the knee is bent.

    Parameters
    ----------
    leg : Leg
        One leg.
    side : (3,) float
        Direction from right to left.

    Returns
    -------
    (3,) ndarray
        Unit vector, at right angles to the shin.
    """
    shin = leg.shin - leg.foot
    ahead = np.cross(side, shin)
    return ahead / max(float(np.linalg.norm(ahead)), 1e-300)


def place_trunk(cells: Cells, limbs: Limbs, ends: Ends, legs: tuple[Leg, Leg]) -> Trunk:
    """Place the joints of the trunk.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    limbs : Limbs
        The parts of the body.
    ends : Ends
        Its ends.
    legs : (Leg, Leg)
        The legs, already placed.

    Returns
    -------
    Trunk
        Hips, spine, neck, head and its top.
    """
    size = ends.size
    neck_level = limbs.pit - _NECK_ABOVE_PIT * size
    hips = (legs[0].thigh + legs[1].thigh) / 2
    neck = limbs.trunk.at(neck_level)
    head = limbs.trunk.at(neck_level - _HEAD_ABOVE_NECK * size)
    spine = hips + _SPINE_SHARE * (neck - hips)
    hips = hips + _HIPS_UP * size * (neck - hips) / max(float(np.linalg.norm(neck - hips)), 1e-300)
    return Trunk(hips, spine, neck, head, cells.points[ends.cells[0]])


def _before(limb: Limb, level: float, near: float, far: float) -> FloatArray:
    """Continue the middle line of a limb backwards from where it is a limb of its own."""
    here, there = limb.at(limb.start + near), limb.at(limb.start + far)
    return here + (here - there) * (limb.start + near - level) / (far - near)
