"""Whether the marks of a limb go all round it."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh
from tempose.transfer.bodies.bones import split_role
from tempose.transfer.correspondence.limb import find_limb
from tempose.transfer.correspondence.section import Sections
from tempose.transfer.correspondence.suggest import pair_points
from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray

_GAP = 180.0
_MOST = 400
_CYLINDERS = ("upper_arm", "forearm", "thigh", "shin", "neck")


def open_rings(pairs: Pairs, target: Mesh) -> list[tuple[str, float, tuple[int, ...]]]:
    """Find limbs marked on one side only.

    Parameters
    ----------
    pairs : Pairs
        Pairs with part names, or of joints.
    target : Mesh
        Target at rest.

    Returns
    -------
    list of (str, float, tuple of int)
        Part, largest empty angle in degrees, and the pairs concerned. Only parts that are cylinders are
        asked for: arms, legs, neck, and whatever bears pairs made by the cross-section rule.
    """
    names = pairs.parts or (tuple(str(s) for s in pairs.source) if pairs.kind == "joints" else ())
    if not names or pairs.kind == "vertices":
        return []
    sections = Sections(target.vertices, target.faces)
    points = pair_points(target, pairs.target, pairs.kind)
    found: list[tuple[str, float, tuple[int, ...]]] = []
    for name in dict.fromkeys(names):
        rows = [i for i, other in enumerate(names) if other == name]
        ringed = bool(pairs.how) and any(pairs.how[i] == "ring" for i in rows)
        if not (ringed or split_role(name)[1] in _CYLINDERS) or len(rows) > _MOST:
            continue
        gap = _empty_angle(sections, points[rows], int(pairs.target[rows[0]]))
        if gap is not None and gap > _GAP:
            found.append((name, gap, tuple(rows)))
    return found


def _empty_angle(sections: Sections, points: FloatArray, face: int) -> float | None:
    limb = find_limb(sections, face)
    if limb is None:
        return None
    x = np.cross(limb.axis, np.eye(3)[np.abs(limb.axis).argmin()])
    x = x / np.linalg.norm(x)
    arm = points - limb.centre
    flat = arm - (arm @ limb.axis)[:, None] * limb.axis
    angle = np.sort(np.degrees(np.arctan2(flat @ np.cross(limb.axis, x), flat @ x)))
    return float(np.diff(np.append(angle, angle[0] + 360)).max())
