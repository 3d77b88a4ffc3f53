"""A mesh as a USD prim: polygons, texture coordinates, colours, groups."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import Mesh
from tempose.formats._polygons import polygon_of_triangle, unfan
from tempose.formats.conventions import to_file
from tempose.formats.usd_stage import modules
from tempose.typing import IntArray


def add_mesh(stage: Any, path: Any, mesh: Mesh, up: str, unit: float) -> Any:
    """Define a mesh prim.

    Parameters
    ----------
    stage : pxr.Usd.Stage
        Being written.
    path : pxr.Sdf.Path
        Where.
    mesh : Mesh
        What.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.

    Returns
    -------
    pxr.UsdGeom.Mesh
        Points hold the rest pose.

    Notes
    -----
    Groups become subsets of polygons; a group that cuts a polygon in half takes the whole of it.
    """
    pxr = modules(str(path))
    prim = pxr.UsdGeom.Mesh.Define(stage, path)
    V = np.ascontiguousarray(to_file(mesh.vertices, up, unit), dtype=np.float32)
    corners, counts = unfan(mesh.faces, mesh.polygons)
    prim.GetPrim().SetCustomDataByKey("name", mesh.name)
    prim.CreatePointsAttr(pxr.Vt.Vec3fArray.FromNumpy(V))
    prim.CreateFaceVertexIndicesAttr(_integers(pxr, corners))
    prim.CreateFaceVertexCountsAttr(_integers(pxr, counts))
    prim.CreateSubdivisionSchemeAttr("none")
    if len(V):
        prim.CreateExtentAttr(pxr.Vt.Vec3fArray.FromNumpy(np.stack([V.min(axis=0), V.max(axis=0)])))
    _add_primvars(pxr, prim, mesh)
    polygon = polygon_of_triangle(counts)
    for k, (name, faces) in enumerate(mesh.groups.items()):
        subset = pxr.UsdGeom.Subset.Define(stage, path.AppendChild(f"group_{k}"))
        subset.CreateElementTypeAttr("face")
        subset.CreateIndicesAttr(_integers(pxr, np.unique(polygon[faces])))
        subset.GetPrim().SetCustomDataByKey("name", name)
    return prim


def _add_primvars(pxr: Any, prim: Any, mesh: Mesh) -> None:
    primvars, types, kinds = pxr.UsdGeom.PrimvarsAPI(prim), pxr.Sdf.ValueTypeNames, pxr.UsdGeom.Tokens
    if mesh.uv is not None:
        kind = kinds.vertex if mesh.uv_faces is None else kinds.faceVarying
        st = primvars.CreatePrimvar("st", types.TexCoord2fArray, kind)
        st.Set(pxr.Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(mesh.uv, dtype=np.float32)))
        if mesh.uv_faces is not None:
            st.SetIndices(_integers(pxr, unfan(mesh.uv_faces, mesh.polygons)[0]))
    if mesh.colors is not None:
        colors = primvars.CreatePrimvar("displayColor", types.Color3fArray, kinds.vertex)
        colors.Set(pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(mesh.colors, dtype=np.float32)))


def _integers(pxr: Any, values: IntArray) -> Any:
    return pxr.Vt.IntArray.FromNumpy(np.ascontiguousarray(values, dtype=np.int32))
