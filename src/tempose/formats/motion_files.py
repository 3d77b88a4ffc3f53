"""Skeletons in motion, and meshes bound to them, from files."""

from __future__ import annotations

import os
from importlib import import_module

from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.formats._place import metres_per_unit
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


def load_skeleton_clip(
    path: PathLike,
    *,
    up: str | None = None,
    unit: Unit = None,
    fps: float | None = None,
    clip: str | None = None,
    skeleton: PathLike | None = None,
) -> SkeletonClip:
    """Load the motion of a skeleton.

    Parameters
    ----------
    path : path-like
        A BVH, AMC, GLB, glTF or USD file.
    up, unit, fps, clip
        As for `load`.
    skeleton : path-like, optional
        The ``.asf`` that belongs to an AMC file, where it is not found by itself.

    Returns
    -------
    SkeletonClip
        Metres, Y up.

    Raises
    ------
    FormatError
        If there is no skeleton in it.
    """
    check_arguments(up, unit, fps)
    place, metres = os.fspath(path), metres_per_unit(unit)
    suffix = known_suffix(place)
    if suffix == ".bvh":
        return import_module("tempose.formats.bvh").read_bvh(place, up=up, unit=metres, fps=fps)
    if suffix == ".amc":
        reader = import_module("tempose.formats.asf_amc").read_amc
        return reader(place, asf=skeleton, up=up, unit=metres, fps=fps)
    if suffix in GLTF_SUFFIXES:
        reader = import_module("tempose.formats.glb").read_skeleton_clip
        return reader(place, clip, fps, up=up, unit=metres)
    if suffix in USD_SUFFIXES:
        return import_module("tempose.formats.usd").read_skeleton_clip(place, fps, up=up, unit=metres)
    raise FormatError(f"{place}: expected a skeleton's motion ({_known('skeleton')}), found a {suffix} file")


def load_skin(
    path: PathLike,
    *,
    mesh: Mesh | None = None,
    base: Mesh | None = None,
    skeleton: PathLike | None = None,
    up: str | None = None,
    unit: Unit = None,
) -> SkinnedMesh:
    """Load a mesh bound to a skeleton.

    Parameters
    ----------
    path : path-like
        A GLB, glTF or USD file with a skin, or MakeHuman weights (``.mhw``).
    mesh : Mesh, optional
        The mesh that MakeHuman weights are for; used for nothing else.
    base : Mesh, optional
        The whole MakeHuman mesh, where `mesh` is a part of it that does not come from a file.
    skeleton : path-like, optional
        The ``.mhskel`` that belongs to MakeHuman weights, where it is not found by itself.
    up, unit
        As for `load`; not for MakeHuman weights.

    Returns
    -------
    SkinnedMesh
        Metres, Y up.

    Raises
    ------
    FormatError
        If there is no skin in it.
    ValueError
        If weights come without their mesh.
    """
    check_arguments(up, unit, None)
    place = os.fspath(path)
    suffix = known_suffix(place)
    if suffix in GLTF_SUFFIXES:
        return import_module("tempose.formats.glb").read_skin(place, up=up, unit=metres_per_unit(unit))
    if suffix in USD_SUFFIXES:
        return import_module("tempose.formats.usd").read_skin(place, up=up, unit=metres_per_unit(unit))
    if suffix == ".mhw":
        if mesh is None:
            raise ValueError(f"{place} holds skin weights only: give the mesh they are for as mesh=...")
        return import_module("tempose.formats.makehuman").read_skin(place, mesh, skeleton, base=base)
    raise FormatError(f"{place}: expected a mesh with a skin ({_known('skin')}), found a {suffix} file")


def _known(kind: str) -> str:
    return ", ".join(suffix for suffix, row in FORMATS.items() if kind in row.reads)
