"""Texture coordinates: the surface cut into pieces of cloth, each flattened, all laid into one square."""

from __future__ import annotations

import numpy as np

from tempose.samples.uv_charts import connected_pieces, cut_open, face_neighbours, is_disc
from tempose.samples.uv_flatten import flatten_rigidly, flatten_safely
from tempose.samples.uv_pack import pack_charts
from tempose.typing import FloatArray, IntArray

SMALL = 24
"""Faces below which a piece that folds over is no longer divided."""


def texture_atlas(V: FloatArray, F: IntArray, labels: IntArray) -> tuple[FloatArray, IntArray]:
    """Map a closed mesh to the unit square.

    Parameters
    ----------
    V, F : (n, 3) float, (m, 3) int
        The mesh.
    labels : (m,) int
        Pieces to cut it into; those that cannot be flattened are cut further.

    Returns
    -------
    uv : (k, 2) ndarray
        Texture coordinates, 0 to 1; no two triangles overlap.
    uv_faces : (m, 3) ndarray of int
        Faces into them.
    """
    charts, corners = _flattened(V, F, labels)
    placed = pack_charts(charts)
    uv_faces = np.zeros(F.shape, dtype=np.int64)
    offset = 0
    for uv, (faces, local) in zip(placed, corners):
        uv_faces[faces] = local + offset
        offset += len(uv)
    return np.clip(np.concatenate(placed), 0.0, 1.0), uv_faces


def _flattened(
    V: FloatArray, F: IntArray, labels: IntArray
) -> tuple[list[FloatArray], list[tuple[IntArray, IntArray]]]:
    """Flat charts, and for each the faces in it and their corners there."""
    neighbours = face_neighbours(F)
    charts: list[FloatArray] = []
    corners: list[tuple[IntArray, IntArray]] = []
    waiting = connected_pieces(labels, neighbours)
    while waiting:
        faces = waiting.pop()
        local = cut_open(F[faces])
        P = np.zeros((int(local.max()) + 1, 3))
        P[local.ravel()] = V[F[faces].ravel()]
        uv = None
        if is_disc(local):
            uv = flatten_rigidly(P, local)
            if uv is None and len(faces) <= SMALL:
                uv = flatten_safely(P, local)
        if uv is None:
            waiting += _halves(V, F, faces, neighbours)
        else:
            charts.append(uv)
            corners.append((faces, local))
    return charts, corners


def _halves(V: FloatArray, F: IntArray, faces: IntArray, neighbours: IntArray) -> list[IntArray]:
    """Cut a piece across its longest direction."""
    P = V[F[faces]].mean(axis=1)
    P = P - P.mean(axis=0)
    along = P @ np.linalg.svd(P, full_matrices=False)[2][0]
    part = np.full(len(F), -1)
    part[faces] = along > np.median(along)
    return connected_pieces(part, neighbours)
