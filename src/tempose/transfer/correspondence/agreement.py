"""Pairs that contradict each other: exchanged sides, marks on the wrong limb."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, Skeleton
from tempose.kinematics.roles import find_roles
from tempose.transfer.bodies.bones import split_role
from tempose.transfer.correspondence.front import feet_front
from tempose.transfer.correspondence.side_names import swap_side
from tempose.transfer.correspondence.similarity import align_points
from tempose.transfer.correspondence.suggest import pair_points
from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray

_NEIGHBOURS = 6
_OFF, _LEAST = 5.0, 0.08
_MOST = 1500


def disagreeing_pairs(pairs: Pairs, source: Mesh, target: Mesh) -> list[tuple[int, float]]:
    """Find pairs that lie elsewhere than their neighbours tell.

    Parameters
    ----------
    pairs : Pairs
        Of faces or vertices.
    source, target : Mesh
        Rest poses.

    Returns
    -------
    list of (int, float)
        Pair and distance from where the similarity of its nearest pairs puts it, share of the diagonal;
        only those five times farther off than is usual in this list, the worst first.
    """
    k = len(pairs)
    if not _NEIGHBOURS + 2 <= k <= _MOST:
        return []
    P = pair_points(source, np.asarray(pairs.source), pairs.kind)
    Q = pair_points(target, pairs.target, pairs.kind)
    off = np.array([_left_out(P, Q, i) for i in range(k)]) / target.diagonal
    limit = max(_OFF * float(np.median(off)), _LEAST)
    # a wrong pair also spoils its neighbours: the worst first, then again without it
    found: list[tuple[int, float]] = []
    alive = np.ones(k, dtype=np.bool_)
    while off[alive].max() > limit and alive.sum() > _NEIGHBOURS + 2 and len(found) < 0.2 * k:
        worst = int(np.where(alive, off, -1.0).argmax())
        found.append((worst, float(off[worst])))
        alive[worst] = False
        rows = np.flatnonzero(alive)
        for place, i in enumerate(rows):
            off[i] = _left_out(P[rows], Q[rows], place) / target.diagonal
    return found


def _left_out(P: FloatArray, Q: FloatArray, i: int) -> float:
    gap = np.linalg.norm(P - P[i], axis=1)
    gap[i] = np.inf
    near = np.argsort(gap, kind="stable")[:_NEIGHBOURS]
    if np.ptp(P[near], axis=0).max() == 0 or np.ptp(Q[near], axis=0).max() == 0:
        return 0.0
    guess = align_points(P[near], Q[near]).apply(P[i])
    return float(np.linalg.norm(guess - Q[i]))


def exchanged_sides(
    pairs: Pairs, target: Mesh, source: Mesh | Skeleton | None = None
) -> list[tuple[str, str, tuple[int, ...]]]:
    """Find left and right exchanged.

    Parameters
    ----------
    pairs : Pairs
        Pairs with side names, or of a source mesh.
    target : Mesh
        Target at rest, upright.
    source : Mesh or Skeleton, optional
        Source at rest.

    Returns
    -------
    list of (str, str, tuple of int)
        Place, sentence, pairs. By names: the left marks must lie on the left of where the feet point, and
        all limbs the same way round. Without names: pairs of two meshes must not need a reflection.
    """
    names = _side_names(pairs, source)
    sided = [swap_side(name) != name for name in names]
    if any(sided):
        return _by_name(pairs, target, names)
    if isinstance(source, Mesh) and pairs.kind != "joints" and len(pairs) >= 8:
        return _by_reflection(pairs, source, target)
    return []


def _side_names(pairs: Pairs, source: Mesh | Skeleton | None) -> list[str]:
    if pairs.kind != "joints":
        return list(pairs.parts)
    roles: dict[str, str] = {}
    if isinstance(source, Skeleton):
        roles = {source.names[j]: role for role, j in find_roles(source).items()}
    return [roles.get(str(name), str(name)) for name in pairs.source]


def _by_name(pairs: Pairs, target: Mesh, names: list[str]) -> list[tuple[str, str, tuple[int, ...]]]:
    points = pair_points(target, pairs.target, pairs.kind)
    rows = {name: tuple(i for i, other in enumerate(names) if other == name) for name in dict.fromkeys(names)}
    across: dict[str, FloatArray] = {}
    for name in rows:
        other = swap_side(name)
        if _is_left(name) and other in rows:
            across[name] = points[list(rows[name])].mean(axis=0) - points[list(rows[other])].mean(axis=0)
    if not across:
        return []
    front = feet_front(target.vertices, target.faces)
    left = np.array([front[2], 0.0, -front[0]]) if front is not None else None
    # without feet to tell, most limbs must be right
    common = left if left is not None else np.sum([v / np.linalg.norm(v) for v in across.values()], axis=0)
    wrong = [
        name for name, v in across.items() if v @ common < -0.25 * np.linalg.norm(v) * np.linalg.norm(common)
    ]
    found: list[tuple[str, str, tuple[int, ...]]] = []
    for name in wrong:
        told = "where the feet point" if left is not None else "what the other limbs tell"
        other = swap_side(name)
        sentence = f"the marks of {name} lie right of those of {other}, against {told}"
        found.append((split_role(name)[1] or name, sentence, rows[name] + rows[other]))
    return found


def _is_left(name: str) -> bool:
    other = swap_side(name)
    changed = [(a, b) for a, b in zip(name.lower(), other.lower()) if a != b]
    return bool(changed) and changed[0] == ("l", "r")


def _by_reflection(pairs: Pairs, source: Mesh, target: Mesh) -> list[tuple[str, str, tuple[int, ...]]]:
    P = pair_points(source, np.asarray(pairs.source), pairs.kind)
    Q = pair_points(target, pairs.target, pairs.kind)
    flipped = P * [-1.0, 1.0, 1.0]
    straight, mirrored = (align_points(X, Q).residual for X in (P, flipped))
    if mirrored > 0.7 * straight:
        return []
    sentence = (
        "all pairs together fit a mirror image of the source better "
        f"({100 * mirrored:.1f} against {100 * straight:.1f} % of the diagonal)"
    )
    return [("whole body", sentence, tuple(range(len(pairs))))]
