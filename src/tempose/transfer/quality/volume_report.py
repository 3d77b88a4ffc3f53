"""How much volume each joint loses, frame by frame."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.metrics import Enclosed
from tempose.transfer.frames import BLOCK
from tempose.transfer.solver.fill import Patch
from tempose.typing import FloatArray


def joint_volumes(V: FloatArray, V_rest: FloatArray, patches: dict[str, Patch]) -> dict[str, Any]:
    """Measure the change of the volume round joints.

    Parameters
    ----------
    V : (T, n, 3) float
        Frames, in memory or in a file.
    V_rest : (n, 3) float
        Rest pose.
    patches : dict of str to Patch
        Name of a joint to a fixed patch of surface round it, whose rim is closed by fans.

    Returns
    -------
    dict
        ``joint_volume``: name to ``worst``, ``mean`` and ``frames``, percent of the volume at rest. A joint
        whose patch encloses nothing is left out.
    """
    found: dict[str, Any] = {}
    meters = {name: Enclosed(patch.faces, len(patch.vertices)) for name, patch in patches.items()}
    rest = {name: float(m.volumes(V_rest[patches[name].vertices][None])[0]) for name, m in meters.items()}
    solid = [name for name in patches if abs(rest[name]) > 1e-6 * patches[name].radius ** 3]
    change = {name: np.zeros(len(V)) for name in solid}
    for start in range(0, len(V), BLOCK):
        block = np.asarray(V[start : start + BLOCK], dtype=np.float64)
        for name in solid:
            volume = meters[name].volumes(block[:, patches[name].vertices])
            change[name][start : start + BLOCK] = 100 * (volume / rest[name] - 1)
    for name in solid:
        worst = change[name][np.abs(change[name]).argmax()]
        found[name] = {
            "worst": round(float(worst), 2),
            "mean": round(float(change[name].mean()), 2),
            "frames": [round(float(x), 2) for x in change[name]],
        }
    return {"joint_volume": found}
