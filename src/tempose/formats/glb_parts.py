"""Mesh primitives of the scene as the file stores them: base positions, morph targets, skin weights.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), section 3.7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.formats import glb_accessors as accessors
from tempose.formats._skin_notes import held_notes, weight_notes
from tempose.formats.glb_container import Document
from tempose.formats.glb_influences import influences, vertex_attribute
from tempose.formats.glb_json import Item
from tempose.formats.glb_nodes import Nodes
from tempose.typing import FloatArray, IntArray

_MOST_VERTICES = 100_000_000


@dataclass(frozen=True)
class Part:
    """Vertices that one node draws from one set of attributes."""

    item: Item
    """The primitive."""
    node: int
    """Node that draws it."""
    start: int
    """Index of its first vertex among all."""
    base: FloatArray
    """(n, 3) float64 positions in the space of the mesh."""
    targets: tuple[int | None, ...]
    """Accessor of the position offsets of each morph target."""
    morph: FloatArray
    """(K,) weights of the targets at rest."""
    skin: int | None
    """Skin that moves it."""
    joints: IntArray
    """(n, k) indices into the joints of the skin; k = 0 without a skin."""
    weights: FloatArray
    """(n, k) float64, rows sum to 1."""
    sums: FloatArray
    """(n,) what the weights summed to in the file; 1 without a skin."""


@dataclass(frozen=True)
class Geometry:
    """All parts and the triangles over them."""

    parts: tuple[Part, ...]
    """Parts in the order in which the scene is walked."""
    primitives: tuple[tuple[int, Item, IntArray], ...]
    """Part index, primitive and (m, 3) faces over all vertices."""
    n: int
    """Number of vertices."""
    notes: tuple[str, ...]
    """What was left out."""


def read_geometry(doc: Document, nodes: Nodes) -> Geometry:
    """Collect the triangles of all mesh nodes of the default scene.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.

    Returns
    -------
    Geometry
        Parts and faces.

    Raises
    ------
    FormatError
        If there is none, or something points beyond what is there.
    """
    meshes, skins = doc.top.items("meshes"), doc.top.items("skins")
    parts: list[Part] = []
    primitives: list[tuple[int, Item, IntArray]] = []
    known: dict[str, int] = {}
    skipped = 0
    for node in nodes.order:
        item = nodes.items[node]
        if node not in nodes.in_scene or not item.has("mesh"):
            continue
        mesh = meshes[item.integer("mesh", limit=len(meshes))]
        skin = item.integer("skin", limit=len(skins)) if item.has("skin") else None
        for primitive in mesh.items("primitives"):
            mode = primitive.integer("mode", 4, limit=7)
            if mode < 4 or not primitive.child("attributes").has("POSITION"):
                skipped += 1
                continue
            # primitives that differ only in their triangles share their vertices
            key = f"{node} {primitive.fields['attributes']} {primitive.fields.get('targets')}"
            if key not in known:
                known[key] = len(parts)
                parts.append(_part(doc, nodes, node, mesh, primitive, skin, parts))
            part = parts[known[key]]
            primitives.append(
                (known[key], primitive, part.start + _faces(doc, primitive, mode, len(part.base)))
            )
    if not primitives:
        raise doc.top.error("expected a mesh with triangles in the scene, found none")
    n = parts[-1].start + len(parts[-1].base)
    notes = (f"{skipped} primitives without triangles are left out.",) if skipped else ()
    sums = np.concatenate([part.sums for part in parts])
    notes += weight_notes(sums) + held_notes(sums)
    return Geometry(tuple(parts), tuple(primitives), n, notes)


def _part(
    doc: Document,
    nodes: Nodes,
    node: int,
    mesh: Item,
    primitive: Item,
    skin: int | None,
    before: list[Part],
) -> Part:
    start = before[-1].start + len(before[-1].base) if before else 0
    attributes = primitive.child("attributes")
    base = vertex_attribute(doc, attributes, "POSITION", None, "VEC3")
    assert base is not None
    if start + len(base) > _MOST_VERTICES:
        raise primitive.error(f"expected at most {_MOST_VERTICES} vertices in the scene, found more")
    targets = tuple(_target(doc, item, len(base)) for item in primitive.items("targets"))
    K = len(targets)
    morph = nodes.items[node].numbers("weights")
    morph = mesh.numbers("weights") if morph is None else morph
    morph = np.zeros(K) if morph is None else morph
    if len(morph) != K:
        raise mesh.error(f"expected {K} weights, one a morph target, found {len(morph)}", "weights")
    joints, weights, sums = np.zeros((len(base), 0), np.int64), np.zeros((len(base), 0)), np.ones(len(base))
    if skin is not None:
        size = len(doc.top.items("skins")[skin].integers("joints"))
        joints, weights, sums = influences(doc, primitive, len(base), size)
    held = skin if joints.shape[1] else None
    return Part(primitive, node, start, base.astype(np.float64), targets, morph, held, joints, weights, sums)


def _target(doc: Document, target: Item, n: int) -> int | None:
    if not target.has("POSITION"):
        return None
    index = target.integer("POSITION", limit=len(doc.accessors))
    if accessors.accessor_count(doc, index) != n:
        raise target.error(f"expected {n} offsets, found {accessors.accessor_count(doc, index)}", "POSITION")
    return index


def _faces(doc: Document, primitive: Item, mode: int, n: int) -> IntArray:
    if primitive.has("indices"):
        index = primitive.integer("indices", limit=len(doc.accessors))
        corners = accessors.integers(doc, index, "SCALAR")[:, 0]
        if corners.max() >= n:
            raise primitive.error(f"expected indices below {n}, found {corners.max()}", "indices")
    else:
        corners = np.arange(n)
    if mode == 4:
        if len(corners) % 3:
            raise primitive.error(
                f"expected three corners a triangle, found {len(corners)} corners", "indices"
            )
        return corners.reshape(-1, 3)
    i = np.arange(max(len(corners) - 2, 0))
    if mode == 5:
        # every second triangle of a strip turns the other way, section 3.7.2.1
        return corners[np.column_stack([i, i + 1 + i % 2, i + 2 - i % 2])]
    return corners[np.column_stack([i + 1, i + 2, np.zeros_like(i)])]
