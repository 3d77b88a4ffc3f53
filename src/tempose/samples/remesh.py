"""Isotropic remeshing of an implicit surface, finer where it bends or where detail asks for it.

Edges are split, collapsed and flipped towards a wanted length; vertices move along the surface towards the
middle of their triangles and are projected back, after Botsch and Kobbelt [1]_. The length varies over the
surface with its curvature, as in Dunyach et al. [2]_, and with the detail that each part asks for.

References
----------
.. [1] Botsch and Kobbelt, "A Remeshing Approach to Multiresolution Modeling", SGP 2004.
.. [2] Dunyach et al., "Adaptive Remeshing for Real-Time Mesh Deformation", Eurographics 2013 short papers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from tempose.samples.edge_flips import flip_edges
from tempose.samples.edge_measures import edge_length, normal
from tempose.samples.edge_passes import collapse_short, count_long, split_long
from tempose.samples.field import Field
from tempose.samples.field_queries import mixture, project
from tempose.samples.half_edges import HalfEdges, build, compact, faces
from tempose.typing import FloatArray, IntArray

SLOPE = 0.4
"""Largest slope of the wanted edge length along the surface."""
TURN = 0.5
"""How far the normal may turn along an edge, radians, where the budget allows it."""
FINEST = 0.3
"""Shortest edges that bending asks for, relative to those on the flat trunk."""


class Surface(NamedTuple):
    """An implicit surface and how finely to mesh it."""

    field: Field
    """The surface."""
    detail: FloatArray
    """(P,) relative edge length for each part."""
    longest: FloatArray
    """(P,) longest edges that still show the part, metres."""


def remesh(surface: Surface, V: FloatArray, F: IntArray, triangles: int) -> tuple[FloatArray, IntArray]:
    """Mesh an implicit surface again, with about as many triangles as asked for.

    Parameters
    ----------
    surface : Surface
        The surface and its detail.
    V, F : (n, 3) float, (m, 3) int
        A closed mesh of it, of any quality.
    triangles : int
        Wanted number of triangles.

    Returns
    -------
    V, F : (k, 3) ndarray of float, (t, 3) ndarray of int
        A closed mesh of the same topology, `t` within a few percent of `triangles`.
    """
    mesh, V = build(V, F)
    longest = float(np.median(np.linalg.norm(V[F[:, 0]] - V[F[:, 1]], axis=1)))
    if len(F) > 3 * triangles:
        longest *= 1.9
        V, _, mesh = _changed(V, np.full(len(V), longest), mesh, 0.9)
    normals = project(surface.field, V, 1, longest)
    # what is thin may have half of all triangles
    spent = _covering(_graded(V, mesh, _parts_want(surface, V)[:, 1]), V, mesh) / (0.5 * triangles)
    surface = surface._replace(longest=surface.longest * max(1.0, np.sqrt(spent)))
    scale = _scale(surface, V, normals, mesh, triangles)
    while longest < 0.8 * scale:
        longest *= 1.9
        V, normals, mesh = _round(surface, V, normals, mesh, scale, longest)
    for i in range(12):
        V, normals, mesh = _round(surface, V, normals, mesh, scale, np.inf)
        ratio = len(mesh.start) / 3 / triangles
        if i > 3 and abs(ratio - 1.0) < 0.04:
            break
        scale *= np.sqrt(ratio)
    for _ in range(3):
        normals = _relax(surface, V, mesh, _wanted(surface, V, normals, mesh, scale, np.inf))
        flip_edges(V, mesh, True)
    return faces(mesh, V)


def _scale(surface: Surface, V: FloatArray, normals: FloatArray, mesh: HalfEdges, triangles: int) -> float:
    """Edge length at detail 1 at which equilateral triangles of the wanted sizes cover the surface."""
    scale = float(np.sqrt(_covering(np.ones(len(V)), V, mesh) / triangles))
    parts = _parts_want(surface, V)
    for _ in range(8):
        want = _graded(V, mesh, _bent(V, normals, mesh, _shorter(parts, scale), FINEST * scale))
        scale *= float(np.sqrt(_covering(want, V, mesh) / triangles))
    return scale


def _covering(want: FloatArray, V: FloatArray, mesh: HalfEdges) -> float:
    """How many equilateral triangles of the wanted sizes cover the surface."""
    F = mesh.start.reshape(-1, 3)
    area = 0.5 * np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1)
    return float((area / (np.sqrt(0.1875) * want[F].mean(axis=1) ** 2)).sum())


def _round(
    surface: Surface, V: FloatArray, normals: FloatArray, mesh: HalfEdges, scale: float, longest: float
) -> tuple[FloatArray, FloatArray, HalfEdges]:
    """All operations once, towards edges of ``min(scale * detail, longest)``."""
    V, want, mesh = _changed(V, _wanted(surface, V, normals, mesh, scale, longest), mesh, 0.3)
    return V, _relax(surface, V, mesh, want), mesh


def _changed(
    V: FloatArray, want: FloatArray, mesh: HalfEdges, flatness: float
) -> tuple[FloatArray, FloatArray, HalfEdges]:
    """Split, collapse and flip edges."""
    V, want, mesh = _split(V, want, mesh)
    collapse_short(V, want, mesh, flatness)
    flip_edges(V, mesh, False)
    return compact(V, want, mesh)


def _wanted(
    surface: Surface, V: FloatArray, normals: FloatArray, mesh: HalfEdges, scale: float, longest: float
) -> FloatArray:
    """Edge length at each vertex: by detail, shorter where the surface bends, changing slowly."""
    want = _shorter(_parts_want(surface, V), scale)
    return _graded(V, mesh, np.minimum(_bent(V, normals, mesh, want, FINEST * scale), longest))


def _parts_want(surface: Surface, V: FloatArray) -> FloatArray:
    return mixture(surface.field, V, 1.0, np.column_stack([surface.detail, surface.longest]))


def _shorter(parts: FloatArray, scale: float) -> FloatArray:
    return np.minimum(scale * parts[:, 0], parts[:, 1])


def _split(V: FloatArray, want: FloatArray, mesh: HalfEdges) -> tuple[FloatArray, FloatArray, HalfEdges]:
    n, room = len(V), count_long(V, want, mesh)
    V = np.concatenate([V, np.zeros((room, 3))])
    want = np.concatenate([want, np.zeros(room)])
    blank = np.full(6 * room, -1, dtype=np.int64)
    mesh = HalfEdges(
        np.concatenate([mesh.start, blank]),
        np.concatenate([mesh.twin, blank]),
        np.concatenate([mesh.out, np.full(room, -1, dtype=np.int64)]),
    )
    split_long(V, want, mesh, n)
    return V, want, mesh


def _relax(surface: Surface, V: FloatArray, mesh: HalfEdges, want: FloatArray) -> FloatArray:
    V += _shifts(V, want, mesh)
    length = float(np.median(want))
    # few triangles leave the surface further behind
    return project(surface.field, V, 1 if length < 0.015 else 2, 0.5 * length)


@njit(cache=True, error_model="numpy")
def _bent(V: FloatArray, normals: FloatArray, mesh: HalfEdges, want: FloatArray, finest: float) -> FloatArray:
    """Shorten edges until the normal turns by at most `TURN` along one, but not below `finest`."""
    out = want.copy()
    for h in range(len(mesh.start)):
        a = mesh.start[h]
        if a >= 0:
            b = mesh.start[mesh.twin[h]]
            turn = np.sqrt(np.sum((normals[a] - normals[b]) ** 2)) / max(edge_length(V, a, b), 1e-9)
            out[a] = min(out[a], max(TURN / max(turn, 1e-9), finest))
    return out


@njit(cache=True, error_model="numpy")
def _graded(V: FloatArray, mesh: HalfEdges, want: FloatArray) -> FloatArray:
    """Lower lengths until they change no faster than `SLOPE` along any edge."""
    want = want.copy()
    for sweep in range(8):
        for i in range(len(mesh.start)):
            h = i if sweep % 2 == 0 else len(mesh.start) - 1 - i
            a = mesh.start[h]
            if a >= 0:
                b = mesh.start[mesh.twin[h]]
                want[b] = min(want[b], want[a] + SLOPE * edge_length(V, a, b))
    return want


@njit(cache=True, error_model="numpy")
def _shifts(V: FloatArray, want: FloatArray, mesh: HalfEdges) -> FloatArray:
    """Along the surface, towards the middle of the triangles around each vertex, by their size."""
    total, weight, up = np.zeros(V.shape), np.zeros(len(V)), np.zeros(V.shape)
    n = np.zeros(3)
    for f in range(len(mesh.start) // 3):
        i, j, k = mesh.start[3 * f], mesh.start[3 * f + 1], mesh.start[3 * f + 2]
        if i < 0:
            continue
        area = normal(V, i, j, k, n)
        w = area / (want[i] + want[j] + want[k]) ** 2
        for v in (i, j, k):
            weight[v] += w
            for c in range(3):
                total[v, c] += w * (V[i, c] + V[j, c] + V[k, c]) / 3.0
                up[v, c] += area * n[c]
    for v in range(len(V)):
        if weight[v] > 0.0:
            step = total[v] / weight[v] - V[v]
            u = up[v] / max(np.sqrt(np.sum(up[v] ** 2)), 1e-30)
            total[v] = 0.8 * (step - np.dot(step, u) * u)
    return total
