"""MakeHuman: skin weights (``.mhw``) and skeleton (``.mhskel``), both JSON, for a mesh of its topology."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.formats._input import read_bytes
from tempose.formats._sequence import read_still
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray, IntArray


def read_skin(
    weights_path: str | os.PathLike[str],
    mesh: Mesh,
    skeleton_path: str | os.PathLike[str] | None = None,
    *,
    base: Mesh | None = None,
) -> SkinnedMesh:
    """Bind a mesh to the MakeHuman skeleton.

    Parameters
    ----------
    weights_path : path-like
        The ``.mhw`` file.
    mesh : Mesh
        The base mesh, or what is left of it when it is restricted to its first group (``body``).
    skeleton_path : path-like, optional
        The ``.mhskel`` file; if not given, the one beside the weights.
    base : Mesh, optional
        The whole mesh with its joint helpers, placed as `mesh` is; if not given and needed, it is read from
        where `mesh` came from.

    Returns
    -------
    SkinnedMesh
        J joints, each at the head of its bone; tips are the tails of all bones. Rest rotations are the
        identity, rows of weights sum to 1.

    Raises
    ------
    FormatError
        If a file is not what it should be, or the files do not fit the mesh or one another.

    Notes
    -----
    A joint is the mean of helper vertices of the base mesh, most of which do not belong to its skin.
    """
    weights_path = Path(weights_path)
    weights = _mapping(weights_path, _json(weights_path, "MakeHuman weights"), "weights")
    path = _find_skeleton(weights_path) if skeleton_path is None else Path(skeleton_path)
    content = _json(path, "a MakeHuman skeleton")
    bones, joints = _mapping(path, content, "bones"), _mapping(path, content, "joints")
    parents = _parents(path, bones)
    needed = _joint_vertices(path, bones, joints)
    V = _with_helpers(path, mesh, base, 1 + max(int(v.max()) for pair in needed.values() for v in pair))
    names = _parents_first(path, parents)
    heads, tails = (np.array([V[needed[name][k]].mean(axis=0) for name in names]) for k in (0, 1))
    index = np.array([-1 if (parent := parents[name]) is None else names.index(parent) for name in names])
    offsets = heads - np.where(index[:, None] >= 0, heads[index], 0.0)
    skeleton = Skeleton(tuple(names), index, offsets, tips=tails - heads)
    return SkinnedMesh(mesh, skeleton, _weights(weights_path, weights, names, len(mesh.vertices)))


def _json(path: Path, expected: str) -> Any:
    try:
        return json.loads(read_bytes(path, expected).decode("utf-8-sig"))
    except json.JSONDecodeError as error:
        where = f"{path}, line {error.lineno}"
        raise FormatError(f"{where}: expected {expected} in JSON: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        if isinstance(error, FormatError):
            raise
        raise FormatError(f"{path}: expected {expected} in JSON: {error}") from None


def _mapping(path: Path, content: Any, key: str) -> dict[str, Any]:
    value = content.get(key) if isinstance(content, dict) else None
    if not isinstance(value, dict) or not value:
        raise FormatError(f"{path}: expected an object {key!r} in the JSON, found {_kind(value)}")
    return value


def _kind(value: Any) -> str:
    return "nothing" if value is None else repr(value)[:40]


def _find_skeleton(weights_path: Path) -> Path:
    named = weights_path.with_name(weights_path.stem.removesuffix("_weights") + ".mhskel")
    if named.is_file():
        return named
    beside = sorted(weights_path.parent.glob("*.mhskel"))
    if len(beside) == 1:
        return beside[0]
    found = ", ".join(p.name for p in beside) or "no .mhskel file at all"
    raise FormatError(f"{weights_path}: expected {named.name} beside it, found {found}; pass the skeleton")


def _parents(path: Path, bones: dict[str, Any]) -> dict[str, str | None]:
    parents: dict[str, str | None] = {}
    for name, bone in bones.items():
        parent = bone.get("parent") if isinstance(bone, dict) else name
        if parent is not None and (not isinstance(parent, str) or parent == name or parent not in bones):
            raise FormatError(
                f"{path}: expected the parent of {name[:40]!r} among the other bones, found {_kind(parent)}"
            )
        parents[name] = parent
    return parents


def _parents_first(path: Path, parents: dict[str, str | None]) -> list[str]:
    children: dict[str | None, list[str]] = {}
    for name, parent in parents.items():
        children.setdefault(parent, []).append(name)
    roots = children.get(None, [])
    if len(roots) != 1:
        raise FormatError(f"{path}: expected one bone without parent, found {', '.join(roots[:5]) or 'none'}")
    order, stack = list[str](), list(roots)
    while stack:
        order.append(stack.pop())
        stack += reversed(children.get(order[-1], []))
    if len(order) < len(parents):
        lost = next(name for name in parents if name not in order)
        raise FormatError(
            f"{path}: expected every bone under {roots[0]!r}, found a circle of parents at {lost!r}"
        )
    return order


def _joint_vertices(
    path: Path, bones: dict[str, Any], joints: dict[str, Any]
) -> dict[str, tuple[IntArray, IntArray]]:
    def vertices(name: str, end: str) -> IntArray:
        joint = bones[name].get(end)
        listed = joints.get(joint) if isinstance(joint, str) else None
        try:
            indices = np.array(listed)
        except (ValueError, OverflowError):
            indices = np.zeros(0, np.int64)
        if indices.ndim != 1 or indices.dtype.kind != "i" or indices.size == 0 or indices.min() < 0:
            raise FormatError(
                f"{path}: expected vertex indices for the {end} of bone {name[:40]!r}, found {_kind(listed)}"
            )
        return indices

    return {name: (vertices(name, "head"), vertices(name, "tail")) for name in bones}


def _with_helpers(path: Path, mesh: Mesh, base: Mesh | None, count: int) -> FloatArray:
    """Vertices of the whole base mesh, of which `mesh` holds the first ones."""
    if base is None and len(mesh.vertices) >= count:
        return mesh.vertices
    if base is None:
        place = Path(mesh.source.path)
        if place.suffix.lower() != ".obj" or not place.is_file():
            raise FormatError(
                f"{path}: joints need {count} vertices, the mesh has {len(mesh.vertices)} and comes from no "
                "OBJ file that could be read again; pass the whole mesh as base"
            )
        base = read_still(str(place), ".obj", mesh.source.up, mesh.source.unit)
    n = len(mesh.vertices)
    if len(base.vertices) < max(count, n):
        raise FormatError(f"{path}: joints need {count} vertices, the base mesh has {len(base.vertices)}")
    if np.abs(base.vertices[:n] - mesh.vertices).max(initial=0.0) > 1e-6 * max(base.diagonal, 1e-9):
        raise FormatError(f"{path}: expected a mesh of the first {n} vertices of the base mesh, found others")
    return base.vertices


def _weights(path: Path, weights: dict[str, Any], names: list[str], n: int) -> FloatArray:
    result = np.zeros((n, len(names)))
    column = {name: j for j, name in enumerate(names)}
    for name, listed in weights.items():
        if name not in column:
            raise FormatError(f"{path}: expected bones of the skeleton, found {name[:40]!r}")
        v, w = _pairs(path, name, listed)
        np.add.at(result[:, column[name]], v[v < n], w[v < n])
    sums = result.sum(axis=1, keepdims=True)
    return result / np.where(sums > 0, sums, 1.0)


def _pairs(path: Path, name: str, listed: Any) -> tuple[IntArray, FloatArray]:
    try:
        pairs = np.array(listed, dtype=np.float64).reshape(-1, 2)
        good = len(pairs) == len(listed) and bool(((pairs >= 0) & (pairs < 1e9)).all())
        v = pairs[:, 0].astype(np.int64) if good else np.zeros(0, np.int64)
        good = good and np.array_equal(v, pairs[:, 0])
    except (TypeError, ValueError, OverflowError):
        good, pairs, v = False, np.zeros((0, 2)), np.zeros(0, np.int64)
    if not good:
        raise FormatError(
            f"{path}: expected pairs [vertex, weight >= 0] for bone {name!r}, found {_kind(listed)}"
        )
    return v, pairs[:, 1]
