"""Groups as one number a polygon: which set of groups it is in."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh
from tempose.formats._polygons import polygon_of_triangle
from tempose.typing import IntArray


def group_sets(mesh: Mesh, counts: IntArray) -> tuple[IntArray, list[tuple[str, ...]]]:
    """Give every set of groups that some polygon is in a number.

    Parameters
    ----------
    mesh : Mesh
        Mesh with groups.
    counts : (p,) int
        Corners per polygon.

    Returns
    -------
    set_of_polygon : (p,) ndarray of int
        Which set; a polygon is in a group if its first triangle is.
    sets : list of tuple of str
        Names of every set; set 0 is always the empty one.
    """
    polygon, is_first = polygon_of_triangle(counts), np.ones(len(mesh.faces), np.bool_)
    is_first[1:] = polygon[1:] != polygon[:-1]
    numbers = np.zeros(len(counts), np.int64)
    sets: list[tuple[str, ...]] = [()]
    for name, members in mesh.groups.items():
        inside = np.unique(polygon[members[is_first[members]]])
        # every set splits in two: those of its polygons that are in this group, and the rest
        old, new = np.unique(numbers[inside], return_inverse=True)
        numbers[inside] = len(sets) + new
        sets += [(*sets[k], name) for k in old.tolist()]
    used, numbers = np.unique(np.append(0, numbers), return_inverse=True)
    return numbers[1:], [sets[k] for k in used.tolist()]


def groups_of_sets(numbers: IntArray, sets: list[tuple[str, ...]], counts: IntArray) -> dict[str, IntArray]:
    """List the triangles of every group: the inverse of `group_sets`.

    Parameters
    ----------
    numbers : (p,) int
        Set of every polygon.
    sets : list of tuple of str
        Names of every set.
    counts : (p,) int
        Corners per polygon.

    Returns
    -------
    dict of str to ndarray of int
        Group to triangle indices.
    """
    of_triangle = numbers[polygon_of_triangle(counts)]
    names = dict.fromkeys(name for names in sets for name in names)
    holders = {name: [k for k, names in enumerate(sets) if name in names] for name in names}
    return {name: np.flatnonzero(np.isin(of_triangle, ids)) for name, ids in holders.items()}
