"""Which file is read and written by whom: one table, one `load`."""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any

from tempose.clips import Mesh, MeshClip, SkeletonClip
from tempose.clips.mesh_parts import keep_clip_group, keep_group
from tempose.formats._frames import SEQUENCE_SUFFIXES, find_frames
from tempose.formats._place import metres_per_unit
from tempose.formats._sequence import read_sequence, read_still
from tempose.formats._table import (
    FORMATS,
    GLTF_SUFFIXES,
    USD_SUFFIXES,
    PathLike,
    Unit,
    check_arguments,
    known_suffix,
)
from tempose.formats.conventions import FormatError
from tempose.formats.motion_files import load_skeleton_clip, load_skin
from tempose.formats.saving import save
from tempose.typing import Progress, silent

__all__ = ["FORMATS", "load", "load_clip", "load_mesh", "load_skeleton_clip", "load_skin", "save"]


def load(
    path: PathLike,
    *,
    up: str | None = None,
    unit: Unit = None,
    fps: float | None = None,
    group: str | None = None,
    clip: str | None = None,
    topology: PathLike | Mesh | None = None,
    progress: Progress = silent,
) -> Mesh | MeshClip | SkeletonClip:
    """Load whatever a file holds: a clip if it moves, else a mesh.

    Parameters
    ----------
    path : path-like
        A file, a folder of frames, a glob, ``name.####.obj`` or ``name.%04d.obj``.
    up : str, optional
        Up axis of the file, ``"x"``, ``"y"`` or ``"z"``, where it is other than stated or assumed.
    unit : str or float, optional
        Unit of the file: a name of `tempose.formats.conventions.UNITS` or metres per unit.
    fps : float, optional
        Frames per second, where the file states none or a wrong rate.
    group : str, optional
        Keep only the faces of this group.
    clip : str, optional
        Name of the animation, where a file holds several.
    topology : path-like or Mesh, optional
        Faces for formats that hold positions only.
    progress : Progress
        Told about every frame.

    Returns
    -------
    Mesh, MeshClip or SkeletonClip
        Metres, Y up; what the file said is in ``source``.

    Raises
    ------
    FormatError
        If the file is missing, unknown or broken; one line that names it.
    ValueError
        If an argument is wrong.
    """
    check_arguments(up, unit, fps)
    place = os.fspath(path)
    frames = find_frames(place)
    if frames is not None:
        return _grouped(read_sequence(frames, place, up, unit, fps, progress), group, place)
    suffix = known_suffix(place)
    if suffix in SEQUENCE_SUFFIXES:
        return _grouped(read_still(place, suffix, up, unit), group, place)
    if suffix in (".npz", ".npy"):
        return _grouped(_read_array(place, suffix, up, unit, fps, topology), group, place)
    if suffix in GLTF_SUFFIXES:
        return _grouped(_load_glb(place, up, unit, fps, clip), group, place)
    if suffix in USD_SUFFIXES:
        return _grouped(_load_usd(place, up, unit, fps), group, place)
    if suffix in (".bvh", ".amc"):
        return load_skeleton_clip(place, up=up, unit=unit, fps=fps)
    raise FormatError(f"{place}: holds skin weights, which need a mesh; use load_skin(path, mesh=...)")


def load_mesh(
    path: PathLike,
    *,
    up: str | None = None,
    unit: Unit = None,
    group: str | None = None,
    topology: PathLike | Mesh | None = None,
) -> Mesh:
    """Load a still mesh; of a moving one its rest pose, which for frame sequences is the first frame.

    Parameters
    ----------
    path : path-like
        As for `load`.
    up, unit, group, topology
        As for `load`.

    Returns
    -------
    Mesh
        Metres, Y up.

    Raises
    ------
    FormatError
        If there is no mesh in it.
    """
    check_arguments(up, unit, None)
    place = os.fspath(path)
    frames = find_frames(place)
    if frames is not None:
        place = str(frames.paths[0])
    suffix = known_suffix(place)
    if suffix in GLTF_SUFFIXES:
        mesh = import_module("tempose.formats.glb").read_mesh(place, up=up, unit=metres_per_unit(unit))
        return _grouped(mesh, group, place)
    loaded = load(place, up=up, unit=unit, group=group, topology=topology)
    if isinstance(loaded, MeshClip):
        return loaded.mesh
    if isinstance(loaded, SkeletonClip):
        raise FormatError(f"{place}: expected a mesh, found a skeleton's motion, which has no surface")
    return loaded


def load_clip(
    path: PathLike,
    *,
    up: str | None = None,
    unit: Unit = None,
    fps: float | None = None,
    group: str | None = None,
    clip: str | None = None,
    topology: PathLike | Mesh | None = None,
    progress: Progress = silent,
) -> MeshClip:
    """Load a moving mesh; a still one becomes a clip of one frame.

    Parameters
    ----------
    path : path-like
        As for `load`.
    up, unit, fps, group, clip, topology, progress
        As for `load`.

    Returns
    -------
    MeshClip
        Metres, Y up.

    Raises
    ------
    FormatError
        If there is no mesh in it.
    """
    loaded = load(
        path, up=up, unit=unit, fps=fps, group=group, clip=clip, topology=topology, progress=progress
    )
    if isinstance(loaded, Mesh):
        kept = {} if fps is None else {"fps": fps}
        return MeshClip(loaded.vertices[None], loaded, source=loaded.source, **kept)
    if isinstance(loaded, SkeletonClip):
        raise FormatError(
            f"{os.fspath(path)}: expected a mesh, found a skeleton's motion, which has no surface"
        )
    return loaded


def _grouped(thing: Any, group: str | None, place: str) -> Any:
    if group is None:
        return thing
    if isinstance(thing, SkeletonClip):
        raise FormatError(f"{place}: has no groups: it is a skeleton's motion")
    try:
        return keep_group(thing, group)[0] if isinstance(thing, Mesh) else keep_clip_group(thing, group)
    except ValueError as error:
        raise FormatError(f"{place}: {error}") from None


def _read_array(
    place: str,
    suffix: str,
    up: str | None,
    unit: Unit,
    fps: float | None,
    topology: PathLike | Mesh | None,
) -> Mesh | MeshClip:
    module = import_module("tempose.formats.npz")
    if suffix == ".npz":
        return module.read_npz(place, up, unit, fps)
    if topology is None:
        raise FormatError(f"{place}: holds positions without faces; give the mesh they belong to as topology")
    mesh = topology if isinstance(topology, Mesh) else load_mesh(topology)
    return module.read_npy(place, mesh, up, unit, fps)


def _load_glb(
    place: str, up: str | None, unit: Unit, fps: float | None, clip: str | None
) -> Mesh | MeshClip | SkeletonClip:
    """Read the mesh if there is one, moving if it moves; else the motion of the joints."""
    glb, metres = import_module("tempose.formats.glb"), metres_per_unit(unit)
    try:
        moving = glb.read_clip(place, clip, fps, up=up, unit=metres)
    except FormatError as error:
        try:
            return glb.read_skeleton_clip(place, clip, fps, up=up, unit=metres)
        except FormatError:
            raise error from None
    return moving if moving.n_frames > 1 else moving.mesh.with_vertices(moving.vertices[0])


def _load_usd(place: str, up: str | None, unit: Unit, fps: float | None) -> Mesh | MeshClip | SkeletonClip:
    """Read the mesh if there is one, moving if it moves; else the motion of the joints."""
    usd, metres = import_module("tempose.formats.usd"), metres_per_unit(unit)
    try:
        moving = usd.read_clip(place, fps, up=up, unit=metres)
    except FormatError as error:
        try:
            return usd.read_skeleton_clip(place, fps, up=up, unit=metres)
        except FormatError:
            raise error from None
    return moving if moving.n_frames > 1 else moving.mesh.with_vertices(moving.vertices[0])
