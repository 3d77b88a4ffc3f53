"""The node tree: local transforms, still or moving, to world transforms.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), section 3.5.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tempose.formats.conventions import y_up_rotation
from tempose.formats.glb_container import Document
from tempose.formats.glb_json import Item
from tempose.rotations import normalise, to_matrix
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Nodes:
    """All nodes of a file; transforms as the file leaves them."""

    items: tuple[Item, ...]
    """The JSON of each node."""
    names: tuple[str, ...]
    """Names, empty where there is none."""
    parents: tuple[int, ...]
    """Parent of each node, -1 for a root."""
    order: tuple[int, ...]
    """Every node once, parents first, depth first from the roots of the scene."""
    in_scene: frozenset[int]
    """Nodes of the default scene."""
    frame: FloatArray
    """(4, 4) transform from the axes and unit of the file to metres, Y up."""
    local: Mapping[int, FloatArray]
    """(4, 4) local matrix of the nodes that have one in place of a translation, rotation and scale."""


def read_nodes(doc: Document, frame: FloatArray) -> Nodes:
    """Read the node tree and check that it is one.

    Parameters
    ----------
    doc : Document
        The file.
    frame : (4, 4) float
        Put before every root.

    Returns
    -------
    Nodes
        The nodes.

    Raises
    ------
    FormatError
        If a node has two parents or is its own ancestor.
    """
    items = tuple(doc.top.items("nodes"))
    children = [item.integers("children", limit=len(items)) for item in items]
    parents = [-1] * len(items)
    for i, inner in enumerate(children):
        for c in inner:
            if parents[c] not in (-1, i):
                raise items[c].error(f"expected one parent, found nodes {parents[c]} and {i}")
            parents[c] = i
    roots = [i for i, p in enumerate(parents) if p < 0]
    reached = _depth_first(roots, children)
    if len(reached) < len(items):
        raise items[min(set(range(len(items))) - set(reached))].error("is its own ancestor")
    scene = _scene_roots(doc, len(items), parents)
    order = _depth_first(list(dict.fromkeys([*scene, *roots])), children)
    names = tuple(item.text("name") for item in items)
    local = {
        i: m.reshape(4, 4).T for i, item in enumerate(items) if (m := item.numbers("matrix", 16)) is not None
    }
    inside = frozenset(_depth_first(scene, children))
    return Nodes(items, names, tuple(parents), tuple(order), inside, frame, local)


def _scene_roots(doc: Document, n: int, parents: list[int]) -> list[int]:
    scenes = doc.top.items("scenes")
    if not scenes:
        return [i for i, p in enumerate(parents) if p < 0]
    scene = scenes[doc.top.integer("scene", 0, limit=len(scenes))]
    roots = list(dict.fromkeys(scene.integers("nodes", limit=n)))
    for root in roots:
        if parents[root] >= 0:
            raise scene.error(f"expected root nodes, found node {root} with parent {parents[root]}", "nodes")
    return roots


def _depth_first(roots: list[int], children: list[list[int]]) -> list[int]:
    order: dict[int, None] = {}
    stack = roots[::-1]
    while stack:
        i = stack.pop()
        if i not in order:
            order[i] = None
            stack.extend(reversed(children[i]))
    return list(order)


def world_matrices(nodes: Nodes, moving: Mapping[tuple[int, str], FloatArray]) -> list[FloatArray]:
    """World transform of every node.

    Parameters
    ----------
    nodes : Nodes
        The tree.
    moving : mapping of (node, path) to (T, width) float
        What an animation sets: ``translation``, ``rotation`` (wxyz) or ``scale`` over T frames.

    Returns
    -------
    list of (T or 1, 4, 4) ndarray
        ``T_world_node`` per node; one frame where nothing above it moves.
    """
    world: list[FloatArray] = [nodes.frame[None]] * len(nodes.items)
    for i in nodes.order:
        above = nodes.frame if nodes.parents[i] < 0 else world[nodes.parents[i]]
        world[i] = above @ _local(nodes, i, moving)
    return world


def _local(nodes: Nodes, i: int, moving: Mapping[tuple[int, str], FloatArray]) -> FloatArray:
    if i in nodes.local:
        return nodes.local[i][None]
    item = nodes.items[i]
    rest = {"translation": item.numbers("translation", 3), "scale": item.numbers("scale", 3)}
    xyzw = item.numbers("rotation", 4)
    rest["rotation"] = None if xyzw is None else xyzw[[3, 0, 1, 2]]
    usual = {"translation": np.zeros(3), "scale": np.ones(3), "rotation": np.array([1.0, 0, 0, 0])}
    parts: dict[str, FloatArray] = {}
    for path, value in rest.items():
        still = usual[path] if value is None else value
        parts[path] = moving.get((i, path), still[None])
    turn = to_matrix(normalise(parts["rotation"]))
    frames = max(len(part) for part in parts.values())
    matrix = np.zeros((frames, 4, 4))
    matrix[:, :3, :3] = turn * parts["scale"][:, None, :]
    matrix[:, :3, 3] = parts["translation"]
    matrix[:, 3, 3] = 1.0
    return matrix


def chain(nodes: Nodes, node: int) -> list[int]:
    """List a node and its ancestors.

    Parameters
    ----------
    nodes : Nodes
        The tree.
    node : int
        Where to start.

    Returns
    -------
    list of int
        From the node up to its root.
    """
    path = []
    while node >= 0:
        path.append(node)
        node = nodes.parents[node]
    return path


def file_frame(up: str, unit: float) -> FloatArray:
    """Transform from the axes and unit of a file to ours.

    Parameters
    ----------
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.

    Returns
    -------
    (4, 4) ndarray
        ``p_inside = frame @ p_file``.
    """
    frame = np.eye(4)
    frame[:3, :3] = y_up_rotation(up) * unit
    return frame
