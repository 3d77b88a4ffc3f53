"""Elbows and knees moved to where the middle lines of the limbs bend, alike on both sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from tempose.embedding.limbs import Limb, Limbs
from tempose.embedding.place import Arm, Leg
from tempose.typing import FloatArray

# standard deviations, as shares of the way from the head to the feet
_LINE, _ALIKE = 0.004, 0.015
# calves make the middle line of a straight leg bend where the knee is not
_PLACE = np.array([0.02, 0.02, 0.01, 0.01])
_SAMPLES = 24


def refine_hinges(
    limbs: Limbs, arms: tuple[Arm, Arm], legs: tuple[Leg, Leg], size: float
) -> tuple[tuple[Arm, Arm], tuple[Leg, Leg]]:
    """Move the hinges of arms and legs to the best place near their usual one.

    Parameters
    ----------
    limbs : Limbs
        Middle lines of the limbs, in the order of `arms` and `legs`.
    arms, legs : (Arm, Arm), (Leg, Leg)
        Limbs as placed.
    size : float
        Way from the head to the feet.

    Returns
    -------
    arms, legs
        The same with other elbows and knees.

    Notes
    -----
    Least squares of three things: the two bones follow the middle line, the hinge stays near its usual
    place, left and right bones are equally long.
    """
    chains = [(arm.upper_arm, arm.forearm, arm.hand) for arm in arms]
    chains += [(leg.thigh, leg.shin, leg.foot) for leg in legs]
    lines = [_line(limb, chain) for limb, chain in zip((*limbs.arms, *limbs.legs), chains)]
    usual = np.array([chain[1] for chain in chains])

    def residuals(x: FloatArray) -> FloatArray:
        hinges = x.reshape(4, 3)
        parts = [((hinges - usual) / (_PLACE[:, None] * size)).ravel()]
        lengths: list[FloatArray] = []
        for (start, _, end), hinge, line in zip(chains, hinges, lines):
            off = np.minimum(_to_segment(line, start, hinge), _to_segment(line, hinge, end))
            parts.append(off / (_LINE * size * np.sqrt(len(line))))
            lengths.append(np.array([np.linalg.norm(hinge - start), np.linalg.norm(end - hinge)]))
        parts += [(lengths[i] - lengths[i + 1]) / (_ALIKE * size) for i in (0, 2)]
        return np.concatenate(parts)

    hinges = least_squares(residuals, usual.ravel(), xtol=1e-6, max_nfev=50).x.reshape(4, 3)
    new_arms = tuple(replace(arm, forearm=hinge) for arm, hinge in zip(arms, hinges[:2]))
    new_legs = tuple(replace(leg, shin=hinge) for leg, hinge in zip(legs, hinges[2:]))
    return (new_arms[0], new_arms[1]), (new_legs[0], new_legs[1])


def _line(limb: Limb, chain: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
    """Sample the middle line from clear of the body to the wrist or ankle."""
    end = limb.levels[np.linalg.norm(limb.centres - chain[2], axis=1).argmin()]
    return limb.at(np.linspace(limb.start + 0.15 * (end - limb.start), end, _SAMPLES))


def _to_segment(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    way = end - start
    share = np.clip((points - start) @ way / max(float(way @ way), 1e-300), 0.0, 1.0)
    return np.linalg.norm(points - start - share[:, None] * way, axis=1)
