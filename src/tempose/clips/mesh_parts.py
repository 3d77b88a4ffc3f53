"""Parts of a mesh: a named group, or any choice of faces."""

from __future__ import annotations

import difflib
from dataclasses import replace

import numpy as np

from tempose.clips.mesh import Mesh
from tempose.clips.mesh_clip import MeshClip
from tempose.typing import BoolArray, IntArray


def keep_group(mesh: Mesh, name: str) -> tuple[Mesh, IntArray]:
    """Keep the faces of one group and the vertices that they use.

    Parameters
    ----------
    mesh : Mesh
        Mesh with groups.
    name : str
        Exact name of a group.

    Returns
    -------
    part : Mesh
        The faces of the group, in order; vertices keep their order.
    vertex_index : (k,) ndarray of int
        Vertex of `mesh` behind every vertex of the part.

    Raises
    ------
    ValueError
        If there is no such group; the message names the closest ones.
    """
    if name not in mesh.groups:
        raise ValueError(_unknown_group(name, list(mesh.groups)))
    chosen = np.zeros(len(mesh.faces), np.bool_)
    chosen[mesh.groups[name]] = True
    return keep_faces(mesh, chosen)


def keep_clip_group(clip: MeshClip, name: str) -> MeshClip:
    """Keep the faces of one group in every frame.

    Parameters
    ----------
    clip : MeshClip
        Clip of a mesh with groups.
    name : str
        Exact name of a group.

    Returns
    -------
    MeshClip
        The part, moving as before.

    Raises
    ------
    ValueError
        If there is no such group.
    """
    part, vertex_index = keep_group(clip.mesh, name)
    return MeshClip(clip.vertices[:, vertex_index], part, clip.fps, clip.source)


def keep_faces(mesh: Mesh, chosen: BoolArray) -> tuple[Mesh, IntArray]:
    """Keep some faces and the vertices and texture coordinates that they use.

    Parameters
    ----------
    mesh : Mesh
        Any mesh.
    chosen : (m,) bool
        Which faces to keep.

    Returns
    -------
    part : Mesh
        The part; a polygon that loses some of its triangles falls into triangles.
    vertex_index : (k,) ndarray of int
        Vertex of `mesh` behind every vertex of the part.
    """
    faces, vertex_index = _compact(mesh.faces[chosen], len(mesh.vertices))
    uv, uv_faces = mesh.uv, mesh.uv_faces
    if uv is not None and uv_faces is not None:
        uv_faces, uv_index = _compact(uv_faces[chosen], len(uv))
        uv = uv[uv_index]
    elif uv is not None:
        uv = uv[vertex_index]
    new_face = np.cumsum(chosen) - 1
    groups = {k: new_face[f[chosen[f]]] for k, f in mesh.groups.items() if chosen[f].any()}
    part = replace(
        mesh,
        vertices=mesh.vertices[vertex_index],
        faces=faces,
        uv=uv,
        uv_faces=uv_faces,
        colors=None if mesh.colors is None else mesh.colors[vertex_index],
        groups=groups,
        polygons=_kept_polygons(mesh.polygons, chosen),
    )
    return part, vertex_index


def _compact(F: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Renumber faces over the vertices that they use, order kept."""
    used = np.zeros(n, np.bool_)
    used[F] = True
    return (np.cumsum(used) - 1)[F], np.flatnonzero(used)


def _kept_polygons(polygons: IntArray | None, chosen: BoolArray) -> IntArray | None:
    if polygons is None:
        return None
    triangles = polygons - 2
    kept = np.add.reduceat(chosen.astype(np.int64), np.cumsum(triangles) - triangles)
    if ((kept != 0) & (kept != triangles)).any():
        return None
    result = polygons[kept > 0]
    return None if (result == 3).all() else result


def _unknown_group(name: str, known: list[str]) -> str:
    if not known:
        return f"no group named {name!r}: the mesh has no groups"
    close = difflib.get_close_matches(name, known, n=5, cutoff=0.4) or known[:5]
    return f"no group named {name!r} among {len(known)}; the closest: {', '.join(close)}"
