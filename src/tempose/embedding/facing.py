"""Which side is left: the toes point forward."""

from __future__ import annotations

import numpy as np

from tempose.embedding.place import Arm, Leg, Trunk
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


def body_frame(
    trunk: Trunk, arms: tuple[Arm, Arm], legs: tuple[Leg, Leg]
) -> tuple[FloatArray, bool, bool, float]:
    """Find the frame of a body whose sides are not known yet.

    Parameters
    ----------
    trunk : Trunk
        Its trunk.
    arms, legs : (Arm, Arm), (Leg, Leg)
        Its limbs, in any order.

    Returns
    -------
    frame : (3, 3) ndarray
        Rows left, up along the trunk, front: a rotation from the mesh's axes to Y up, +Z front.
    swap_arms, swap_legs : bool
        Whether the second arm, the second leg is the left one.
    clearness : float
        How much further the toes point forward than backward, as a share of the feet; 0 is no sign.
    """
    up = _unit(trunk.neck - trunk.hips)
    across = legs[0].thigh - legs[1].thigh
    width = arms[0].upper_arm - arms[1].upper_arm
    same = 1.0 if across @ width >= 0 else -1.0
    side = across / np.linalg.norm(across) + same * width / np.linalg.norm(width)
    side = _unit(side - (side @ up) * up)
    front = np.cross(side, up)
    feet = [leg.tip - leg.foot for leg in legs]
    ahead = [float(foot @ front) / max(float(np.linalg.norm(foot)), 1e-300) for foot in feet]
    total = sum(ahead) / 2
    if total < 0:
        side, front = -side, -front
    frame = np.stack([side, up, front])
    return frame, bool(width @ side < 0), bool(across @ side < 0), abs(total)


def _unit(vector: FloatArray) -> FloatArray:
    return vector / max(float(np.linalg.norm(vector)), 1e-300)
