"""Numpy archives: ``vertices`` (T, n, 3) or (n, 3), ``faces``, ``fps``; ours also hold axes, unit and more.

A foreign archive needs only ``vertices`` and ``faces``. What `write` adds makes the way back exact: ``up``,
``unit``, ``rest``, ``source_fps``, ``name``, ``uv``, ``uv_faces``, ``colors``, ``polygons``, ``group:NAME``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.clips import Mesh, MeshClip
from tempose.formats._npz_members import FrameBlocks, read_members, read_single, write_array, write_members
from tempose.formats._place import DEFAULT_FPS, inside, metres_per_unit, outside, settle
from tempose.formats._table import Unit
from tempose.formats.conventions import FormatError

_GROUP = "group:"
_BLOCK_VALUES = 500_000
_MESH_KEYS = ("uv", "uv_faces", "colors", "polygons")
_KEYS = ("vertices", "faces", "fps", "up", "unit", "rest", "source_fps", "name", *_MESH_KEYS)


def read_npz(path: str, up: str | None, unit: Unit, fps: float | None) -> Mesh | MeshClip:
    """Read a ``.npz`` archive.

    Parameters
    ----------
    path : str
        File to read.
    up, unit, fps : see `tempose.formats.load`
        What the user states; goes before what the file states.

    Returns
    -------
    Mesh or MeshClip
        A clip if ``vertices`` has frames.

    Raises
    ------
    FormatError
        If an array is missing, broken or of another shape.
    """
    arrays, names = read_members(path, _KEYS, _GROUP)
    for key in ("vertices", "faces"):
        if key not in arrays:
            raise FormatError(f"{path}: expected arrays 'vertices' and 'faces', found {_listing(names)}")
    try:
        return _assemble(path, arrays, up, unit, fps)
    except FormatError:
        raise
    except (ValueError, TypeError, OverflowError) as error:
        raise FormatError(f"{path}: {error}") from None


def read_npy(path: str, topology: Mesh, up: str | None, unit: Unit, fps: float | None) -> Mesh | MeshClip:
    """Read positions without faces from a ``.npy`` file.

    Parameters
    ----------
    path : str
        File to read.
    topology : Mesh
        The mesh they belong to; its rest pose is kept.
    up, unit, fps : see `tempose.formats.load`
        What the user states; axes and unit are otherwise those that `topology` came in.

    Returns
    -------
    Mesh or MeshClip
        A clip if the array has frames.

    Raises
    ------
    FormatError
        If it is broken or has another number of vertices than `topology`.
    """
    vertices = _positions(path, read_single(path))
    n = len(topology.vertices)
    if vertices.shape[-2] != n:
        raise FormatError(f"{path}: has {vertices.shape[-2]} vertices, the topology given has {n}")
    metres, stated = metres_per_unit(unit), topology.source
    guessed = tuple(k for k, v in (("up", up), ("unit", metres)) if v is None and k in stated.guessed)
    source = replace(stated, path=path, format="npy", guessed=guessed, fps=None)
    source = replace(source, up=up or stated.up, unit=metres or stated.unit)
    placed = inside(vertices, source, path)
    if placed.ndim == 2:
        return replace(topology, vertices=placed, source=source)
    if fps is None:
        source = replace(source, guessed=(*source.guessed, "fps"))
    return MeshClip(placed, topology, fps or DEFAULT_FPS, source)


def write(path: str, thing: Mesh | MeshClip, up: str, unit: float) -> None:
    """Write a ``.npz`` archive, or positions alone to ``.npy``.

    Parameters
    ----------
    path : str
        File to write.
    thing : Mesh or MeshClip
        Metres, Y up.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.
    """
    vertices: Any = outside(thing.vertices, up, unit) if isinstance(thing, Mesh) else _Frames(thing, up, unit)
    with atomic_path(path) as part, part.open("wb") as stream:
        if path.lower().endswith(".npy"):
            write_array(stream, vertices)
        else:
            write_members(stream, {"vertices": vertices} | _extras(thing, up, unit))


class _Frames(FrameBlocks):
    """Frames in the file's axes and unit, some at a time: a clip may be larger than memory."""

    def __init__(self, clip: MeshClip, up: str, unit: float) -> None:
        # scaled positions need float64 to come back as the same float32
        self.dtype = np.dtype(np.float32 if unit == 1.0 else np.float64)
        self.shape = clip.vertices.shape
        self._clip, self._up, self._unit = clip, up, unit

    def blocks(self) -> Iterator[Any]:
        step = max(1, _BLOCK_VALUES // max(self.shape[1], 1))
        for start in range(0, self.shape[0], step):
            frames = self._clip.vertices[start : start + step]
            yield outside(frames, self._up, self._unit).astype(self.dtype)


def _extras(thing: Mesh | MeshClip, up: str, unit: float) -> dict[str, Any]:
    mesh = thing.mesh if isinstance(thing, MeshClip) else thing
    arrays: dict[str, Any] = {"faces": mesh.faces, "up": np.array(up), "unit": np.array(unit)}
    if isinstance(thing, MeshClip):
        arrays |= {"fps": np.array(thing.fps), "rest": outside(mesh.vertices, up, unit)}
        if thing.source.fps is not None:
            arrays["source_fps"] = np.array(thing.source.fps)
    for key in _MESH_KEYS:
        if getattr(mesh, key) is not None:
            arrays[key] = getattr(mesh, key)
    if mesh.name:
        arrays["name"] = np.array(mesh.name)
    return arrays | {_GROUP + name: members for name, members in mesh.groups.items()}


def _assemble(
    path: str, arrays: dict[str, Any], up: str | None, unit: Unit, fps: float | None
) -> Mesh | MeshClip:
    vertices = _positions(path, arrays["vertices"])
    rest = _positions(path, arrays.get("rest", vertices if vertices.ndim == 2 else vertices[0]))
    optional = {k: arrays[k] for k in _MESH_KEYS if k in arrays}
    groups = {k.removeprefix(_GROUP): v for k, v in arrays.items() if k.startswith(_GROUP)}
    name = str(arrays["name"]) if "name" in arrays else Path(path).stem
    raw = Mesh(rest, arrays["faces"], **optional, groups=groups, name=name)
    if len(raw.faces) == 0:
        raise FormatError(f"{path}: expected faces, found none")
    up = up if up is not None or "up" not in arrays else str(arrays["up"])
    unit = unit if unit is not None or "unit" not in arrays else _number(path, arrays, "unit")
    mesh = settle(raw, path, "npz", up, unit)
    if vertices.ndim == 2:
        return mesh
    stated = _number(path, arrays, "fps") if "fps" in arrays else None
    guessed = mesh.source.guessed if fps or stated else (*mesh.source.guessed, "fps")
    found = _number(path, arrays, "source_fps") if "source_fps" in arrays else stated
    source = replace(mesh.source, fps=found, guessed=guessed)
    return MeshClip(inside(vertices, source, path), mesh, fps or stated or DEFAULT_FPS, source)


def _positions(path: str, array: Any) -> Any:
    shape = array.shape
    if array.dtype.kind not in "fiu" or array.ndim not in (2, 3) or shape[-1] != 3 or 0 in shape:
        raise FormatError(
            f"{path}: expected 'vertices' of shape (T, n, 3) or (n, 3), at least one frame and vertex, "
            f"found {array.dtype} of shape {shape}"
        )
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise FormatError(f"{path}: expected finite vertices, found {array[where]} at index {where}")
    return array


def _number(path: str, arrays: dict[str, Any], key: str) -> float:
    array = arrays[key]
    if array.size != 1 or array.dtype.kind not in "fiu" or not 0 < float(array.reshape(())) < float("inf"):
        raise FormatError(f"{path}: expected one positive number as {key!r}, found {str(array)[:40]}")
    return float(array.reshape(()))


def _listing(names: list[str]) -> str:
    return ", ".join(repr(name) for name in names[:8]) or "no array"
