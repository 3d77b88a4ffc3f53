"""The implicit surface of a character: parts blended along a tree, never between limbs.

Inside a node parts unite by a polynomial smooth minimum. A node then unites with its parent; of several
children only the one that lowers the field most is felt, so that thighs, arms and fingers stay apart however
close they come. The derivative of the field with respect to a part is that part's influence: influences are
non-negative, sum to one, and are what skinning weights and charts are made from.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numba import njit

from tempose.samples.parts import SWELL, Node, Part
from tempose.samples.primitives import TABLE_ROWS, solid, swell
from tempose.typing import FloatArray, IntArray

FAR = 1.0
"""Value of the field where no part is near, metres."""
WIDEN = 1.6
"""Largest factor on fillet radii that influences may be asked with."""


class Field(NamedTuple):
    """Parts and nodes as arrays, for the compiled code."""

    kind: IntArray
    """(P,) which solid."""
    node: IntArray
    """(P,) node of each part; parts are sorted by it."""
    carve: IntArray
    """(P,) 1 where the part is taken away."""
    blend: FloatArray
    """(P,) fillet radii, metres."""
    bounds: FloatArray
    """(P, 2, 3) boxes outside which a part is not felt."""
    data: FloatArray
    """(P, 18) parameters."""
    tables: FloatArray
    """(P, TABLE_ROWS, 8) cross-sections, zero for other solids than lofts."""
    parent: IntArray
    """(N,) parent of each node, parents first, -1 for the trunk."""
    node_blend: FloatArray
    """(N,) fillet radius with the parent, metres."""
    web: FloatArray
    """(N,) fillet radius between the children, metres."""


def pack(nodes: Sequence[Node], parts: Sequence[Part]) -> Field:
    """Arrange nodes and parts for the compiled code.

    Parameters
    ----------
    nodes : sequence of Node
        Parents first.
    parts : sequence of Part
        Blended in this order within their node.

    Returns
    -------
    Field
        The arrays; parts keep their order.
    """
    names = [node.name for node in nodes]
    # a part is felt as far as the widest fillet in its node, with its parent and with its children
    felt = {node.name: node.blend for node in nodes}
    for name, parent, blend in [(node.name, node.parent, node.blend) for node in nodes]:
        felt[name] = max(felt[name], *(part.blend for part in parts if part.node == name))
        if parent:
            felt[parent] = max(felt[parent], blend)
    margin = [0.0 if part.kind == SWELL else WIDEN * felt[part.node] + 0.02 for part in parts]
    bounds = np.array([part.bounds for part in parts])
    bounds += np.array([-1.0, 1.0])[:, None] * np.array(margin)[:, None, None]
    blank = np.zeros((TABLE_ROWS, 8))
    return Field(
        kind=np.array([part.kind for part in parts]),
        node=np.array([names.index(part.node) for part in parts]),
        carve=np.array([int(part.carve) for part in parts]),
        blend=np.array([part.blend for part in parts]),
        bounds=bounds,
        data=np.array([np.pad(part.data, (0, 18 - len(part.data))) for part in parts]),
        tables=np.array([blank if part.table is None else part.table for part in parts]),
        parent=np.array([names.index(node.parent) if node.parent else -1 for node in nodes]),
        node_blend=np.array([node.blend for node in nodes]),
        web=np.array([node.web for node in nodes]),
    )


@njit(cache=True, error_model="numpy")
def parts_near(field: Field, x: float, y: float, z: float, reach: float, near: IntArray) -> int:
    """List the parts that are felt somewhere in a cube.

    Parameters
    ----------
    field : Field
        P parts.
    x, y, z : float
        Centre of the cube, metres.
    reach : float
        Half its side, metres.
    near : (P,) int
        Receives the indices, in order.

    Returns
    -------
    int
        How many there are.
    """
    count = 0
    for i in range(len(field.kind)):
        b = field.bounds[i]
        if (
            b[0, 0] - reach < x < b[1, 0] + reach
            and b[0, 1] - reach < y < b[1, 1] + reach
            and b[0, 2] - reach < z < b[1, 2] + reach
        ):
            near[count] = i
            count += 1
    return count


@njit(cache=True, error_model="numpy")
def value(
    field: Field, near: IntArray, x: float, y: float, z: float, core: FloatArray, drop: FloatArray
) -> float:
    """Field at a point.

    Parameters
    ----------
    field : Field
        P parts, N nodes.
    near : (k,) int
        Parts that may be felt here.
    x, y, z : float
        The point, metres.
    core : (N + 8,) float
        Scratch.
    drop : (N,) float
        Scratch.

    Returns
    -------
    float
        Negative inside; near the surface about the distance from it, metres.
    """
    N = len(field.parent)
    row = core[N:]
    core[:N] = FAR
    drop[:N] = 0.0
    for i in near:
        n, k = field.node[i], field.blend[i]
        if field.kind[i] == SWELL:
            core[n] -= swell(field.data[i], x, y, z)
            continue
        d = solid(field.kind[i], field.data[i], field.tables[i], row, x, y, z)
        if field.carve[i]:
            h = max(k - abs(core[n] + d), 0.0)
            core[n] = max(core[n], -d) + h * h / (4.0 * k)
        else:
            h = max(k - abs(core[n] - d), 0.0)
            core[n] = min(core[n], d) - h * h / (4.0 * k)
    for c in range(N - 1, 0, -1):
        p, k = field.parent[c], field.node_blend[c]
        total = core[c] - drop[c]
        h = max(k - abs(core[p] - total), 0.0)
        down = core[p] - min(core[p], total) + h * h / (4.0 * k)
        # what both children must have before a web joins them, so that it adds nothing to the parent alone
        web = min(field.web[p], drop[p], down)
        h = max(web - abs(drop[p] - down), 0.0)
        drop[p] = max(drop[p], down)
        if h > 0.0:
            drop[p] += h * h / (4.0 * web)
    return core[0] - drop[0]
