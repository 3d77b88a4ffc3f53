"""Polygons of any size to fans of triangles and back."""

from __future__ import annotations

import numpy as np

from tempose.typing import IntArray


def fan(corners: IntArray, counts: IntArray) -> IntArray:
    """Cut every polygon into triangles that share its first corner.

    Parameters
    ----------
    corners : (sum of counts,) int
        Corner indices of all polygons, one after the other.
    counts : (p,) int
        Corners per polygon, at least 3.

    Returns
    -------
    (m, 3) ndarray
        Triangles in the order of the polygons; m is the sum of ``counts - 2``.

    Examples
    --------
    >>> fan(np.array([0, 1, 2, 3]), np.array([4])).tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    if (counts == 3).all():
        return corners.reshape(-1, 3)
    first, step = _fan_places(counts)
    return corners[np.stack([first, first + step, first + step + 1], axis=1)]


def unfan(triangles: IntArray, counts: IntArray | None) -> tuple[IntArray, IntArray]:
    """Join fans back into polygons: the inverse of `fan`.

    Parameters
    ----------
    triangles : (m, 3) int
        Triangles as `fan` gives them.
    counts : (p,) int or None
        Corners per polygon; None for triangles.

    Returns
    -------
    corners : (sum of counts,) ndarray
        Corner indices of all polygons.
    counts : (p,) ndarray
        Corners per polygon.
    """
    if counts is None:
        return triangles.reshape(-1), np.full(len(triangles), 3)
    first, step = _fan_places(counts)
    corners = np.zeros(int(counts.sum()), triangles.dtype)
    corners[first] = triangles[:, 0]
    corners[first + step] = triangles[:, 1]
    corners[first + step + 1] = triangles[:, 2]
    return corners, counts


def polygon_of_triangle(counts: IntArray) -> IntArray:
    """Tell which polygon every triangle was cut from.

    Parameters
    ----------
    counts : (p,) int
        Corners per polygon.

    Returns
    -------
    (m,) ndarray of int
        Polygon of every triangle.
    """
    return np.repeat(np.arange(len(counts)), counts - 2)


def triangles_of_polygons(polygons: IntArray, counts: IntArray) -> IntArray:
    """List the triangles that some polygons were cut into.

    Parameters
    ----------
    polygons : (k,) int
        Which polygons.
    counts : (p,) int
        Corners of every polygon.

    Returns
    -------
    (q,) ndarray of int
        Their triangles, in order.
    """
    first = (np.cumsum(counts - 2) - (counts - 2))[polygons]
    each = counts[polygons] - 2
    return np.repeat(first - (np.cumsum(each) - each), each) + np.arange(int(each.sum()))


def _fan_places(counts: IntArray) -> tuple[IntArray, IntArray]:
    polygon = polygon_of_triangle(counts)
    begins = np.cumsum(counts) - counts
    first_triangle = np.cumsum(counts - 2) - (counts - 2)
    step = np.arange(len(polygon)) - first_triangle[polygon] + 1
    return begins[polygon], step
