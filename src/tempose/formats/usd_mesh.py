"""Everything a USD stage draws as polygons, joined into one mesh."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.clips import Mesh
from tempose.formats._polygons import fan, triangles_of_polygons
from tempose.formats.usd_stage import Stage, modules
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Part:
    """One mesh of the stage."""

    prim: Any
    """The ``pxr.Usd.Prim``."""
    start: int
    """Where its vertices start in the joined mesh."""
    n: int
    """How many it has."""
    counts: IntArray
    """(p,) corners of its polygons."""
    corners: IntArray
    """Corners of its polygons, all in a row, wound counter-clockwise."""
    order: IntArray | None
    """Where each corner stood in the file; None if all stand as they stood."""

    @property
    def name(self) -> str:
        """Name of the mesh."""
        own = self.prim.GetCustomDataByKey("name")
        return str(self.prim.GetName() if own is None else own)


def read_parts(stage: Stage) -> list[Part]:
    """Find the meshes that are drawn.

    Parameters
    ----------
    stage : Stage
        The file.

    Returns
    -------
    list of Part
        In the order of the file; hidden ones, guides and proxies are left out.

    Raises
    ------
    FormatError
        If there is none, or one is broken.
    """
    parts: list[Part] = []
    start = 0
    for prim in _drawn(stage):
        part = _part(stage, prim, start)
        if part.n and len(part.counts):
            parts.append(part)
            start += part.n
    if not parts:
        raise stage.error("expected a mesh, found none that is drawn")
    return parts


def _drawn(stage: Stage) -> Iterator[Any]:
    geom = modules(stage.place).UsdGeom
    for prim in stage.usd.Traverse():
        if not prim.IsA(geom.Mesh):
            continue
        image = geom.Imageable(prim)
        if image.ComputeVisibility() == "invisible" or image.ComputePurpose() in ("guide", "proxy"):
            continue
        yield prim


def _part(stage: Stage, prim: Any, start: int) -> Part:
    mesh = modules(stage.place).UsdGeom.Mesh(prim)
    if mesh.GetFaceVertexIndicesAttr().GetNumTimeSamples() > 1:
        raise stage.error(f"expected faces that stay the same, {prim.GetPath()} has other faces over time")
    points = points_at(mesh.GetPointsAttr(), None)
    earliest = modules(stage.place).Usd.TimeCode.EarliestTime()
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(earliest) or [], dtype=np.int64)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(earliest) or [], dtype=np.int64)
    n = len(points)
    if int(counts.sum()) != len(corners) or (counts < 0).any():
        found = f"{len(corners)} corners for faces that want {int(counts.sum())}"
        raise stage.error(f"{prim.GetPath()}: expected one index a corner, found {found}")
    if len(corners) and not (0 <= corners.min() and corners.max() < n):
        worst = corners.min() if corners.min() < 0 else corners.max()
        raise stage.error(f"{prim.GetPath()}: expected indices below {n}, found {worst}")
    order = np.arange(len(corners))
    keep = np.repeat(counts >= 3, counts)
    order, counts = order[keep], counts[counts >= 3]
    if mesh.GetOrientationAttr().Get() == "leftHanded":
        order = _reversed(order, counts)
    same = len(order) == len(corners) and bool((order == np.arange(len(corners))).all())
    return Part(prim, start, n, counts, corners[order], None if same else order)


def _reversed(order: IntArray, counts: IntArray) -> IntArray:
    """Corners of every polygon the other way round, the first one staying first."""
    first = np.repeat(np.cumsum(counts) - counts, counts)
    within = np.arange(len(order)) - first
    return order[first + (-within) % np.repeat(counts, counts)]


def points_at(attribute: Any, code: float | None) -> FloatArray:
    """Positions of a points attribute.

    Parameters
    ----------
    attribute : pxr.Usd.Attribute
        Points.
    code : float or None
        Time code; None for the value that holds where nothing is sampled, else the earliest sample.

    Returns
    -------
    (n, 3) ndarray of float64
        In the space of their prim.
    """
    values = attribute.Get() if code is None else attribute.Get(code)
    if values is None and code is None:
        samples = attribute.GetTimeSamples()
        values = attribute.Get(samples[0]) if samples else None
    return np.zeros((0, 3)) if values is None else np.array(values, dtype=np.float64).reshape(-1, 3)


def join(stage: Stage, parts: list[Part], vertices: FloatArray) -> Mesh:
    """Join the parts.

    Parameters
    ----------
    stage : Stage
        The file.
    parts : list of Part
        From `read_parts`.
    vertices : (n, 3) float
        Their positions, metres.

    Returns
    -------
    Mesh
        Groups by the names of meshes, where there are several, and of their subsets.
    """
    counts = np.concatenate([part.counts for part in parts])
    corners = np.concatenate([part.corners + part.start for part in parts])
    faces = fan(corners, counts)
    groups: dict[str, IntArray] = {}
    begin = 0
    for part in parts:
        own = np.arange(begin, begin + len(part.counts))
        begin += len(part.counts)
        if len(parts) > 1:
            groups[_free(part.name, groups)] = triangles_of_polygons(own, counts)
        for name, chosen in _subsets(stage, part):
            groups[_free(name, groups)] = triangles_of_polygons(own[chosen], counts)
    uv, uv_faces = _texture(stage, parts, counts)
    above = stage.usd.GetDefaultPrim()
    name = parts[0].name if len(parts) == 1 else str(above.GetName()) if above else "scene"
    polygons = None if (counts == 3).all() else counts
    return Mesh(
        vertices,
        faces,
        uv=uv,
        uv_faces=uv_faces,
        groups=groups,
        polygons=polygons,
        name=name,
        source=stage.source,
    )


def _free(name: str, taken: dict[str, IntArray]) -> str:
    k = 2
    while name in taken:
        name, k = f"{name.removesuffix(f'_{k - 1}')}_{k}", k + 1
    return name


def _subsets(stage: Stage, part: Part) -> Iterator[tuple[str, IntArray]]:
    geom = modules(stage.place).UsdGeom
    if len(part.counts) != len(geom.Mesh(part.prim).GetFaceVertexCountsAttr().Get() or []):
        return
    for subset in geom.Subset.GetAllGeomSubsets(geom.Imageable(part.prim)):
        chosen = np.array(subset.GetIndicesAttr().Get() or [], dtype=np.int64)
        if subset.GetElementTypeAttr().Get() == "face" and len(chosen):
            if 0 <= chosen.min() and chosen.max() < len(part.counts):
                name = subset.GetPrim().GetCustomDataByKey("name") or subset.GetPrim().GetName()
                yield str(name), chosen


def _texture(stage: Stage, parts: list[Part], counts: IntArray) -> tuple[FloatArray | None, IntArray | None]:
    """Texture coordinates ``st`` a corner; None unless every part has them."""
    coordinates: list[FloatArray] = []
    indices: list[IntArray] = []
    start = 0
    for part in parts:
        primvar = modules(stage.place).UsdGeom.PrimvarsAPI(part.prim).GetPrimvar("st")
        values = primvar.Get() if primvar else None
        if values is None or primvar.GetInterpolation() not in ("faceVarying", "vertex", "varying"):
            return None, None
        uv = np.array(values, dtype=np.float64).reshape(-1, 2)
        index = primvar.GetIndices()
        index = np.array(index, dtype=np.int64) if index else np.arange(len(uv))
        if primvar.GetInterpolation() != "faceVarying":
            if len(index) != part.n:
                return None, None
            index = index[part.corners]
        elif part.order is not None:
            index = index[part.order] if len(index) > part.order.max(initial=-1) else index
        if len(index) != len(part.corners) or index.min(initial=0) < 0 or index.max(initial=-1) >= len(uv):
            return None, None
        coordinates.append(uv)
        indices.append(index + start)
        start += len(uv)
    return np.concatenate(coordinates), fan(np.concatenate(indices), counts)
