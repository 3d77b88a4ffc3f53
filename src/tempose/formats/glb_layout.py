"""How a mesh lies in a glTF primitive: one texture coordinate a vertex, so vertices are split at UV seams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Mesh
from tempose.formats.glb_restore import gather, repeats
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Layout:
    """A mesh split into k glTF vertices."""

    vertex_of: IntArray
    """(k,) vertex of the mesh."""
    uv_of: IntArray | None
    """(k,) texture coordinate of the mesh, -1 for none; None where they follow the vertices."""
    uv: FloatArray | None
    """(k, 2) float32, origin at the upper left as in glTF."""
    faces: IntArray
    """(m, 3) over the glTF vertices."""
    split: bool
    """Whether glTF vertices and vertices of the mesh differ."""


def lay_out(mesh: Mesh) -> Layout:
    """Split vertices where a face corner needs another texture coordinate.

    Parameters
    ----------
    mesh : Mesh
        n vertices.

    Returns
    -------
    Layout
        Every vertex and every texture coordinate is kept, used or not, so that nothing is lost on the way
        back.
    """
    n = len(mesh.vertices)
    if mesh.uv is None or mesh.uv_faces is None:
        return Layout(np.arange(n), None, None if mesh.uv is None else _flipped(mesh.uv), mesh.faces, False)
    F, C = mesh.faces.astype(np.int64).ravel(), mesh.uv_faces.astype(np.int64).ravel()
    width = len(mesh.uv) + 1
    unused = np.setdiff1d(np.arange(n), F) * width
    spare = np.setdiff1d(np.arange(len(mesh.uv)), C) + 1
    corners = F * width + C + 1
    keys = np.unique(np.concatenate([corners, unused, spare]))
    vertex_of, uv_of = keys // width, keys % width - 1
    faces = np.searchsorted(keys, corners).reshape(-1, 3)
    uv = np.where(uv_of[:, None] < 0, [[0.0, 1.0]], mesh.uv[uv_of])
    split = not np.array_equal(vertex_of, np.arange(n))
    return Layout(vertex_of, uv_of, _flipped(uv), faces, split)


def _flipped(uv: FloatArray) -> FloatArray:
    return np.column_stack([uv[:, 0], 1.0 - uv[:, 1]]).astype(np.float32)


def mesh_extras(mesh: Mesh) -> dict[str, object]:
    """Polygons and groups as JSON, for `tempose.formats.glb_restore.read_extras`.

    Parameters
    ----------
    mesh : Mesh
        m triangles.

    Returns
    -------
    dict
        What glTF has no place for.
    """
    extras: dict[str, object] = {"triangles": len(mesh.faces)}
    if mesh.polygons is not None:
        extras["polygons"] = repeats(mesh.polygons)
    extras["groups"] = {name: gather(faces) for name, faces in mesh.groups.items()}
    return extras
