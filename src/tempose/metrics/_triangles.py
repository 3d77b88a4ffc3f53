"""Triangles of many frames, one array a coordinate: several times quicker than arrays of vectors."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from tempose.typing import FloatArray, IntArray

Vectors: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]
"""x, y and z of as many vectors as each array holds."""


def coordinates(V: FloatArray) -> Vectors:
    """Split frames into coordinates.

    Parameters
    ----------
    V : (..., n, 3) float
        Vertices.

    Returns
    -------
    x, y, z : (..., n) ndarray
        Contiguous arrays.
    """
    x, y, z = (np.ascontiguousarray(V[..., k]) for k in range(3))
    return x, y, z


def take(V: Vectors, index: IntArray) -> Vectors:
    """Pick vertices.

    Parameters
    ----------
    V : three of (..., n)
        Vertices.
    index : (k,) int
        Which.

    Returns
    -------
    three of (..., k) ndarray
        ``V[index]``.
    """
    x, y, z = (np.take(c, index, axis=-1) for c in V)
    return x, y, z


def differences(V: Vectors, start: IntArray, end: IntArray) -> Vectors:
    """Subtract some vertices from others.

    Parameters
    ----------
    V : three of (..., n)
        Vertices.
    start, end : (e,) int
        From which vertex to which.

    Returns
    -------
    three of (..., e) ndarray
        ``V[end] - V[start]``.
    """
    a, b = take(V, start), take(V, end)
    return b[0] - a[0], b[1] - a[1], b[2] - a[2]


def cross(a: Vectors, b: Vectors) -> Vectors:
    """Multiply vectors to vectors.

    Parameters
    ----------
    a, b : three of (...)
        Vectors.

    Returns
    -------
    three of (...) ndarray
        ``a x b``.
    """
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Vectors, b: Vectors) -> FloatArray:
    """Multiply vectors to numbers.

    Parameters
    ----------
    a, b : three of (...)
        Vectors.

    Returns
    -------
    (...) ndarray
        ``a . b``.
    """
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def area_vectors(V: Vectors, F: IntArray) -> tuple[Vectors, FloatArray]:
    """Find the normals of faces, as long as twice the area, and how long the longest edge is.

    Parameters
    ----------
    V : three of (..., n)
        Vertices.
    F : (m, 3) int
        Faces.

    Returns
    -------
    normals : three of (..., m) ndarray
        Cross products of two edges.
    longest : (..., m) ndarray
        Squared length of the longest edge.
    """
    a, b = differences(V, F[:, 0], F[:, 1]), differences(V, F[:, 0], F[:, 2])
    c = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    longest = np.maximum(np.maximum(dot(a, a), dot(b, b)), dot(c, c))
    return cross(a, b), longest
