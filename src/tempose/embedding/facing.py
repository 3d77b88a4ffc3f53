"""Which side is left: the toes point forward, knees bend forward."""

from __future__ import annotations

import numpy as np

from tempose.embedding.place import Arm, Leg, Trunk, forward_of
from tempose.typing import FloatArray

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
"""Names of the axes of a mesh."""


def axis_vector(name: str) -> FloatArray:
    """Direction of an axis.

    Parameters
    ----------
    name : str
        ``"y"``, ``"+z"``, ``"-x"`` and so on.

    Returns
    -------
    (3,) ndarray
        Unit vector.

    Raises
    ------
    ValueError
        If there is no such axis.
    """
    full = name.lower() if name[:1] in ("+", "-") else f"+{name.lower()}"
    if full not in AXES:
        raise ValueError(f"up must be one of {', '.join(AXES)}, got {name!r}")
    vector = np.zeros(3)
    vector["xyz".index(full[1])] = 1.0 if full[0] == "+" else -1.0
    return vector


def nearest_axis(direction: FloatArray) -> str:
    """Name of the axis nearest to a direction.

    Parameters
    ----------
    direction : (3,) float
        Any vector.

    Returns
    -------
    str
        One of `AXES`.
    """
    return max(AXES, key=lambda name: float(axis_vector(name) @ direction))


def find_side(
    trunk: Trunk, arms: tuple[Arm, Arm], legs: tuple[Leg, Leg]
) -> tuple[FloatArray, float, dict[str, float]]:
    """Find the direction from right to left of a body whose sides are not known yet.

    Parameters
    ----------
    trunk : Trunk
        Its trunk.
    arms, legs : (Arm, Arm), (Leg, Leg)
        Its limbs, in any order.

    Returns
    -------
    side : (3,) ndarray
        Unit vector at right angles to the trunk.
    clearness : float
        How sure the sign is: the sum of the votes; of a standing person about 1.
    votes : dict of str to float
        Positive where a cue agrees: ``toes`` reach further ahead of the ankle than the heel behind it,
        ``knees`` bend forward, ``elbows`` backward, ``head`` lies ahead of the neck.
    """
    up = _unit(trunk.neck - trunk.hips)
    across = _unit(legs[0].thigh - legs[1].thigh)
    width = _unit(arms[0].upper_arm - arms[1].upper_arm)
    side = across + (1.0 if across @ width >= 0 else -1.0) * width
    side = _unit(side - (side @ up) * up)
    votes = _votes(trunk, arms, legs, side, np.cross(side, up))
    total = sum(votes.values())
    if total < 0:
        side, votes = -side, {cue: -vote for cue, vote in votes.items()}
    return side, abs(total), votes


def _votes(
    trunk: Trunk, arms: tuple[Arm, Arm], legs: tuple[Leg, Leg], side: FloatArray, front: FloatArray
) -> dict[str, float]:
    toes = 0.0
    for leg in legs:
        ahead = (leg.sole - leg.foot) @ forward_of(leg, side)
        toes += float((ahead.max() + ahead.min()) / max(ahead.max() - ahead.min(), 1e-300))
    knees = [_bend(leg.thigh, leg.shin, leg.foot) for leg in legs]
    elbows = [_bend(arm.upper_arm, arm.forearm, arm.hand) for arm in arms]
    head = (trunk.tip + trunk.head) / 2 - trunk.neck
    return {
        "toes": toes,
        "knees": float(sum(knees) @ front),
        "elbows": -0.5 * float(sum(elbows) @ front),
        "head": 0.3 * float(head @ front) / max(float(np.linalg.norm(head)), 1e-300),
    }


def _bend(start: FloatArray, middle: FloatArray, end: FloatArray) -> FloatArray:
    """Where a hinge sticks out of the line between its ends, as a share of half that limb."""
    length = float(np.linalg.norm(middle - start) + np.linalg.norm(end - middle))
    way = _unit(end - start)
    out = middle - start
    return (out - (out @ way) * way) / max(0.5 * length, 1e-300)


def body_frame(side: FloatArray, up: FloatArray) -> FloatArray:
    """Rotation from the mesh's axes to Y up, +Z front.

    Parameters
    ----------
    side : (3,) float
        From right to left.
    up : (3,) float
        Unit vector.

    Returns
    -------
    (3, 3) ndarray
        Rows left, up, front.
    """
    left = _unit(side - (side @ up) * up)
    return np.stack([left, up, np.cross(left, up)])


def _unit(vector: FloatArray) -> FloatArray:
    return vector / max(float(np.linalg.norm(vector)), 1e-300)
