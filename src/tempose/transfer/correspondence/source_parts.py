"""Parts of the source that move nothing."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tempose.clips import Mesh, Skeleton
from tempose.kinematics.roles import find_roles
from tempose.transfer.correspondence.reach import far_regions, mark_distances, name_place
from tempose.transfer.pairing.pairs import Pairs

_LIMBS = ("thigh", "shin", "upper_arm", "forearm")
_FAR = 0.2


def unpaired_parts(
    pairs: Pairs, source: Mesh | Skeleton | None
) -> list[tuple[str, Literal["warning", "note"]]]:
    """Name the parts of the source without a partner.

    Parameters
    ----------
    pairs : Pairs
        The pairs.
    source : Mesh or Skeleton, optional
        What they start from.

    Returns
    -------
    list of (str, str)
        Name and severity: limbs, hips and head of a skeleton are a warning, its other roles a note; of a
        mesh the groups that bear no mark, else regions far from every mark. Fingers are not asked for.
    """
    if isinstance(source, Skeleton):
        return _roles_without(pairs, source)
    if not isinstance(source, Mesh) or pairs.kind == "joints":
        return []
    swapped = Pairs(pairs.kind, pairs.target, np.asarray(pairs.source), pairs.parts)
    if source.groups and pairs.kind == "faces":
        marked = np.asarray(pairs.source)
        return [
            (name, "warning") for name, faces in source.groups.items() if not np.isin(marked, faces).any()
        ]
    distance, nearest = mark_distances(source, swapped)
    found: list[tuple[str, Literal["warning", "note"]]] = []
    for region in far_regions(source, distance, _FAR):
        tip = int(region[distance[region].argmax()])
        found.append((f"the region {name_place(source, pairs, tip, int(nearest[tip]))}", "note"))
    return found


def _roles_without(pairs: Pairs, source: Skeleton) -> list[tuple[str, Literal["warning", "note"]]]:
    used = {str(name) for name in pairs.source}
    found: list[tuple[str, Literal["warning", "note"]]] = []
    for role, j in find_roles(source).items():
        if source.names[j] in used:
            continue
        heavy = role in ("hips", "head") or role.split("_", 1)[-1] in _LIMBS
        found.append((f"{source.names[j]} ({role})", "warning" if heavy else "note"))
    return found
