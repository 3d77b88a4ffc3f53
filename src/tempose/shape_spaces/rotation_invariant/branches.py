"""Branch and bound over signs: the pattern with which the fewest edges are seen as two angles."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.shape_spaces.rotation_invariant.angles import turned

_NEGLIGIBLE = 1e-7


@numba.njit(cache=True, nogil=True)
def _doubt(views: Any, corners: Any, signs: Any, h: int) -> float:
    a, b = turned(views, h, 0, signs[corners[h, 0, 0]], signs[corners[h, 0, 1]])
    c, d = turned(views, h, 1, signs[corners[h, 1, 0]], signs[corners[h, 1, 1]])
    size = math.sqrt((a * a + b * b) * (c * c + d * d))
    across, along = a * d - b * c, a * c + b * d
    return across * across / (size + along) if along > 0 else size - along


@numba.njit(cache=True, nogil=True)
def _index(own: Any, corner: int) -> int:
    k = int(np.searchsorted(own, corner))
    return k if k < len(own) and own[k] == corner else -1


@numba.njit(cache=True, nogil=True)
def _open_signs(views: Any, corners: Any, own: Any, around: Any, members: Any) -> Any:
    """Mark the signs that matter: of parts that a hinge sees. Fill in which signs each hinge sees."""
    matters = np.zeros(len(own), dtype=np.bool_)
    for r in range(len(around)):
        h = around[r]
        for end in range(2):
            for side in range(2):
                k = _index(own, corners[h, end, side])
                members[r, 2 * end + side] = k
                if k >= 0 and views[h, end, side, 1] > _NEGLIGIBLE:
                    matters[k] = True
    return matters


@numba.njit(cache=True, nogil=True)
def _order(members: Any, matters: Any, order: Any, closing: Any) -> int:
    """Order the signs so that hinges are complete early; when each hinge is, -1 if from the start."""
    count = 0
    known = ~matters
    missing = np.zeros(len(members), dtype=np.int64)
    for r in range(len(members)):
        for q in range(4):
            k = members[r, q]
            if k >= 0 and not known[k]:
                missing[r] += 1
        closing[r] = -1
    while count < matters.sum():
        # the hinge that lacks least tells most: its signs come next
        best, least = -1, 9
        for r in range(len(members)):
            if 0 < missing[r] < least:
                best, least = r, missing[r]
        for q in range(4):
            k = members[best, q]
            if k >= 0 and not known[k]:
                known[k] = True
                order[count] = k
                for r in range(len(members)):
                    for p in range(4):
                        if members[r, p] == k:
                            missing[r] -= 1
                            if missing[r] == 0:
                                closing[r] = count
                count += 1
    return count


@numba.njit(cache=True, nogil=True)
def search(views: Any, corners: Any, signs: Any, own: Any, around: Any, bound: float, nodes: int) -> bool:
    """Find the best signs of some corners, all others held; changes them in place.

    Parameters
    ----------
    views, corners : ndarray
        As `views_of_normals` gives them.
    signs : (3 m,) ndarray
        1 or -1 for every corner.
    own : (k,) ndarray of int
        Corners that may change, ascending.
    around : (r,) ndarray of int
        Hinges that see them.
    bound : float
        Only patterns of less disagreement than this, and than that of the start, are looked for.
    nodes : int
        Signs tried at most; the best found by then is taken.

    Returns
    -------
    bool
        Whether a better pattern was found.
    """
    members = np.full((len(around), 4), -1)
    matters = _open_signs(views, corners, own, around, members)
    order, closing = np.zeros(len(own), dtype=np.int64), np.zeros(len(around), dtype=np.int64)
    count = _order(members, matters, order, closing)
    by_depth = np.argsort(closing)
    first = np.searchsorted(closing[by_depth], np.arange(count + 1))
    start, best = signs[own].copy(), signs[own].copy()
    least = 0.0
    for h in around:
        least += _doubt(views, corners, signs, h)
    least, found = min(least, bound), False
    base = 0.0
    for r in by_depth[: first[0]]:
        base += _doubt(views, corners, signs, around[r])
    spent = np.zeros(count + 1)
    spent[0] = base
    tried = np.zeros(count, dtype=np.int64)
    depth = 0
    while depth >= 0 and nodes > 0:
        if depth == count:
            if spent[depth] < least:
                least, found = spent[depth], True
                for p in range(count):
                    best[order[p]] = signs[own[order[p]]]
            depth -= 1
            continue
        if tried[depth] == 2:
            tried[depth] = 0
            depth -= 1
            continue
        k = order[depth]
        signs[own[k]] = start[k] if tried[depth] == 0 else -start[k]
        tried[depth] += 1
        nodes -= 1
        cost = spent[depth]
        for r in by_depth[first[depth] : first[depth + 1]]:
            cost += _doubt(views, corners, signs, around[r])
        if cost < least * (1 - 1e-9):
            spent[depth + 1] = cost
            depth += 1
    signs[own] = best
    return found
