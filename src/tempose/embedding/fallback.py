"""An average person in the box of a mesh, for bodies without five ends."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.embedding.cells import Cells
from tempose.embedding.embedding import Embedding
from tempose.embedding.facing import body_frame, nearest_axis
from tempose.embedding.human import NAMES
from tempose.typing import FloatArray

# height and half width of each joint as shares of the stature, arms hanging (Drillis and Contini 1966)
_TRUNK = {"hips": 0.53, "spine": 0.58, "neck": 0.83, "head": 0.89}
_SIDE = {
    "upper_arm": (0.105, 0.805),
    "forearm": (0.125, 0.63),
    "hand": (0.135, 0.485),
    "thigh": (0.052, 0.52),
    "shin": (0.055, 0.285),
    "foot": (0.06, 0.045),
    "toes": (0.06, 0.015),
}
_TIPS = {"head": (0.0, 1.0, 0.0), "hand": (0.14, 0.38, 0.0), "toes": (0.06, 0.01, 0.13)}
_BALL = 0.085
_NO_PENALTY = 9.0


def average_body(cells: Cells, up: FloatArray | None, n_ends: int, report: dict[str, Any]) -> Embedding:
    """Stand an average person in the box of a body whose limbs were not found.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    up : (3,) float or None
        Axis that points up; None takes the longest extent.
    n_ends : int
        How many ends were found.
    report : dict
        What was measured so far.

    Returns
    -------
    Embedding
        Doubtful.
    """
    points = cells.points
    up = _longest(points) if up is None else up
    others = [axis for axis in np.eye(3) if abs(axis @ up) < 0.5]
    # the broader of the other two goes from side to side
    side = max(others, key=lambda axis: float(np.ptp(points @ axis)))
    frame = body_frame(side, up)
    local = points @ frame.T
    low, high = local.min(axis=0), local.max(axis=0)
    stature = float(high[1] - low[1])
    base = np.array([(low[0] + high[0]) / 2, low[1], float(np.median(local[:, 2]))])

    def world(x: float, y: float, z: float = 0.0) -> FloatArray:
        return (base + stature * np.array([x, y, z])) @ frame

    at = {name: world(0.0, y) for name, y in _TRUNK.items()}
    tips = {"head": world(*_TIPS["head"])}
    for name, sign in (("left", 1.0), ("right", -1.0)):
        for part, (x, y) in _SIDE.items():
            at[f"{name}_{part}"] = world(sign * x, y, _BALL if part == "toes" else 0.0)
        for part in ("hand", "toes"):
            x, y, z = _TIPS[part]
            tips[f"{name}_{part}"] = world(sign * x, y, z)
    reason = (
        f"head, hands and feet were not found: {n_ends} parts stand out, a human has 5 "
        "(arms or legs may be joined to the body); an average person was placed instead"
    )
    joints = np.array([at[name] for name in NAMES])
    return Embedding(joints, tips, _NO_PENALTY, frame, nearest_axis(up), (reason,), report)


def _longest(points: FloatArray) -> FloatArray:
    extent = np.ptp(points, axis=0) * np.array([1.0, 1.1, 1.0])
    return np.eye(3)[int(extent.argmax())]
