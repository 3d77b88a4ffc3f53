"""Faces, texture coordinates, colours and groups of a scene: everything of a mesh but its positions."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tempose.clips import Mesh, Source
from tempose.formats.glb_container import Document
from tempose.formats.glb_influences import vertex_attribute
from tempose.formats.glb_nodes import Nodes
from tempose.formats.glb_parts import Geometry
from tempose.formats.glb_restore import Order, read_extras
from tempose.typing import FloatArray, IntArray


def assemble(
    doc: Document,
    nodes: Nodes,
    geometry: Geometry,
    order: Order,
    V: FloatArray,
    mirrored: set[int],
    source: Source,
) -> Mesh:
    """Build the mesh round given positions.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.
    geometry : Geometry
        What the scene draws.
    order : Order
        Original vertices.
    V : (n, 3) float
        Positions of the vertices of the mesh, metres.
    mirrored : set of int
        Parts whose transform turns triangles inside out.
    source : Source
        What the file said.

    Returns
    -------
    Mesh
        In metres, Y up.
    """
    F = np.concatenate(
        [faces[:, [0, 2, 1]] if part in mirrored else faces for part, _, faces in geometry.primitives]
    )
    uv, notes = _texture(doc, geometry)
    uv_faces: IntArray | None = None
    if uv is not None and (order.uv_of is not None or order.split):
        uv, uv_faces = _listed(uv, order.uv_of, F)
    polygons, groups = _extras(nodes, geometry, len(F), doc)
    return Mesh(
        V,
        order.vertex_of[F],
        uv=uv,
        uv_faces=uv_faces,
        colors=_colors(doc, geometry, order),
        groups=_groups(doc, nodes, geometry) if groups is None else groups,
        # turned inside out the triangles are no fans any more
        polygons=None if mirrored else polygons,
        name=_name(doc, nodes, geometry),
        source=Source(
            source.path,
            source.format,
            source.up,
            source.unit,
            source.fps,
            source.guessed,
            source.notes + notes,
        ),
    )


def _texture(doc: Document, geometry: Geometry) -> tuple[FloatArray | None, tuple[str, ...]]:
    found = [
        vertex_attribute(doc, part.item.child("attributes"), "TEXCOORD_0", len(part.base), "VEC2")
        for part in geometry.parts
    ]
    if all(uv is None for uv in found):
        return None, ()
    rows = [np.zeros((len(p.base), 2)) if uv is None else uv for p, uv in zip(geometry.parts, found)]
    uv = np.concatenate(rows).astype(np.float64)
    uv[:, 1] = 1.0 - uv[:, 1]
    missing = sum(uv is None for uv in found)
    return uv, (f"{missing} parts have no texture coordinates.",) if missing else ()


def _listed(uv: FloatArray, uv_of: IntArray | None, F: IntArray) -> tuple[FloatArray, IntArray]:
    """Texture coordinates as a list of their own and the corners into it."""
    if uv_of is None or (uv_of[F] < 0).any() or len(np.unique(uv_of[uv_of >= 0])) != uv_of.max() + 1:
        return uv, F
    values = np.zeros((int(uv_of.max()) + 1, 2))
    values[uv_of[uv_of >= 0]] = uv[uv_of >= 0]
    return values, uv_of[F]


def _colors(doc: Document, geometry: Geometry, order: Order) -> FloatArray | None:
    found = [
        vertex_attribute(doc, part.item.child("attributes"), "COLOR_0", len(part.base), "VEC3", "VEC4")
        for part in geometry.parts
    ]
    if all(colors is None for colors in found):
        return None
    rows = [np.ones((len(p.base), 3)) if c is None else c[:, :3] for p, c in zip(geometry.parts, found)]
    return np.concatenate(rows).astype(np.float64)[order.first]


def _extras(
    nodes: Nodes, geometry: Geometry, m: int, doc: Document
) -> tuple[IntArray | None, dict[str, IntArray] | None]:
    if len(geometry.primitives) > 1:
        return None, None
    node = nodes.items[geometry.parts[0].node]
    return read_extras(doc.top.items("meshes")[node.integer("mesh")], m)


def _groups(doc: Document, nodes: Nodes, geometry: Geometry) -> dict[str, IntArray]:
    """Faces by the names of their node, mesh and material."""
    meshes, materials = doc.top.items("meshes"), doc.top.items("materials")
    groups: dict[str, list[IntArray]] = {}
    start = 0
    for part, primitive, faces in geometry.primitives:
        node = geometry.parts[part].node
        names = [nodes.names[node], meshes[nodes.items[node].integer("mesh")].text("name")]
        if primitive.has("material"):
            names.append(materials[primitive.integer("material", limit=len(materials))].text("name"))
        for name in dict.fromkeys(filter(None, names)):
            groups.setdefault(name, []).append(np.arange(start, start + len(faces)))
        start += len(faces)
    return {name: np.concatenate(ranges) for name, ranges in groups.items()}


def _name(doc: Document, nodes: Nodes, geometry: Geometry) -> str:
    node = geometry.parts[0].node
    mesh = doc.top.items("meshes")[nodes.items[node].integer("mesh")]
    return nodes.names[node] or mesh.text("name") or Path(doc.path).stem
