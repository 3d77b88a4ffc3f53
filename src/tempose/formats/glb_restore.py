"""What our own writer left in a file so that reading gives back the mesh that was written.

A glTF vertex has one texture coordinate and all faces are triangles. The writer splits vertices at UV seams
and keeps the original indices in the attributes ``_VERTEX`` and ``_UV``, polygons and groups in the extras.
A tool that edited the file may have broken any of it, so nothing is used that does not fit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.formats.glb_container import Document
from tempose.formats.glb_influences import vertex_attribute
from tempose.formats.glb_json import Item
from tempose.formats.glb_parts import Geometry
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Order:
    """Which glTF vertex stands for which vertex of the mesh."""

    first: IntArray
    """(n,) a glTF vertex for each vertex of the mesh."""
    vertex_of: IntArray
    """(k,) vertex of the mesh for each glTF vertex."""
    uv_of: IntArray | None
    """(k,) texture coordinate of each glTF vertex, -1 for none; None where all are their own."""
    split: bool
    """Whether the two differ."""


def read_order(doc: Document, geometry: Geometry) -> Order:
    """Find the original vertex order, or take the one of the file.

    Parameters
    ----------
    doc : Document
        The file.
    geometry : Geometry
        What the scene draws.

    Returns
    -------
    Order
        The identity unless the file has a usable ``_VERTEX`` in every part.
    """
    n = geometry.n
    same = np.arange(n)
    vertex_of = _indices(doc, geometry, "_VERTEX", 0)
    uv_of = _indices(doc, geometry, "_UV", -1)
    if vertex_of is None:
        return Order(same, same, uv_of, False)
    count = int(vertex_of.max()) + 1
    first = np.zeros(count, np.int64)
    first[vertex_of[::-1]] = same[::-1]
    base = np.concatenate([part.base for part in geometry.parts])
    complete = len(np.unique(vertex_of)) == count
    if not complete or not np.array_equal(base[first[vertex_of]], base) or len(geometry.parts) > 1:
        return Order(same, same, None, False)
    return Order(first, vertex_of, uv_of, True)


def _indices(doc: Document, geometry: Geometry, name: str, low: int) -> IntArray | None:
    found: list[FloatArray] = []
    for part in geometry.parts:
        values = vertex_attribute(doc, part.item.child("attributes"), name, len(part.base), "SCALAR")
        if values is None:
            return None
        found.append(values[:, 0])
    all_ = np.concatenate(found)
    fits = (all_ == np.rint(all_)) & (all_ >= low) & (all_ < geometry.n)
    return all_.astype(np.int64) if fits.all() else None


def read_extras(mesh: Item, m: int) -> tuple[IntArray | None, dict[str, IntArray] | None]:
    """Polygons and groups from the extras of a mesh.

    Parameters
    ----------
    mesh : Item
        The glTF mesh.
    m : int
        Number of triangles.

    Returns
    -------
    polygons : (p,) ndarray or None
        Corner counts, None if there are none that fit.
    groups : dict or None
        Face indices by name, None if the writer left none that fit.
    """
    extras = mesh.fields.get("extras")
    ours: Any = extras.get("tempose") if isinstance(extras, dict) else None
    if not isinstance(ours, dict) or ours.get("triangles") != m:
        return None, None
    polygons = _runs(ours.get("polygons"), 3, m + 3, m)
    sizes = None if polygons is None else np.repeat(polygons[:, 0], polygons[:, 1])
    if sizes is not None and int((sizes - 2).sum()) != m:
        sizes = None
    named = ours.get("groups")
    if not isinstance(named, dict):
        return sizes, None
    groups: dict[str, IntArray] = {}
    for name, value in named.items():
        runs = _runs(value, 0, m, m)
        if runs is None or (runs.sum(axis=1) > m).any():
            return sizes, None
        groups[name] = spread(runs)
    return sizes, groups


def _runs(value: Any, low: int, limit: int, total: int) -> IntArray | None:
    """(k, 2) pairs of a number and a count; None if it is anything else or the counts pass `total`."""
    if not isinstance(value, list):
        return None
    for pair in value:
        if not isinstance(pair, list) or len(pair) != 2 or any(type(v) is not int for v in pair):
            return None
        if not low <= pair[0] < limit or not 0 < pair[1] <= total:
            return None
    runs = np.array(value, dtype=np.int64).reshape(-1, 2)
    return runs if runs[:, 1].sum() <= total else None


def spread(runs: IntArray) -> IntArray:
    """Turn ranges into indices.

    Parameters
    ----------
    runs : (k, 2) int
        Start and length of each range.

    Returns
    -------
    (sum of lengths,) ndarray
        The indices in order.

    Examples
    --------
    >>> spread(np.array([[5, 2], [0, 1]])).tolist()
    [5, 6, 0]
    """
    starts, counts = runs[:, 0], runs[:, 1]
    before = np.cumsum(counts) - counts
    return np.repeat(starts - before, counts) + np.arange(counts.sum())


def gather(indices: IntArray) -> list[list[int]]:
    """Turn indices into ranges, the inverse of `spread`.

    Parameters
    ----------
    indices : (k,) int
        Indices in any order.

    Returns
    -------
    list of [start, length]
        Ranges in the same order.

    Examples
    --------
    >>> gather(np.array([5, 6, 0]))
    [[5, 2], [0, 1]]
    """
    if not len(indices):
        return []
    heads = np.flatnonzero(np.diff(indices, prepend=indices[0] - 2) != 1)
    counts = np.diff(heads, append=len(indices))
    return [[int(i), int(c)] for i, c in zip(indices[heads], counts)]


def repeats(values: IntArray) -> list[list[int]]:
    """Run-length code: each value and how often it stands there in a row.

    Parameters
    ----------
    values : (k,) int
        Numbers.

    Returns
    -------
    list of [value, count]
        Runs in order.

    Examples
    --------
    >>> repeats(np.array([4, 4, 3]))
    [[4, 2], [3, 1]]
    """
    if not len(values):
        return []
    heads = np.flatnonzero(np.diff(values, prepend=values[0] - 1) != 0)
    counts = np.diff(heads, append=len(values))
    return [[int(v), int(c)] for v, c in zip(values[heads], counts)]
