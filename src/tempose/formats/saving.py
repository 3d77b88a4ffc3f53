"""Writing meshes, clips and motions: the ending of the name chooses the format."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

from tempose.clips import Mesh, MeshClip, SkeletonClip
from tempose.formats._frames import SEQUENCE_SUFFIXES, split_counter
from tempose.formats._place import metres_per_unit
from tempose.formats._sequence_write import write_sequence, write_still
from tempose.formats._table import FORMATS, USD_SUFFIXES, PathLike, Unit, check_arguments
from tempose.formats.conventions import FormatError
from tempose.typing import Progress, silent


def save(
    path: PathLike,
    thing: Mesh | MeshClip | SkeletonClip,
    *,
    up: str | None = None,
    unit: Unit = None,
    progress: Progress = silent,
) -> None:
    """Write a mesh, a clip or a skeleton's motion; under the final name nothing stands until it is complete.

    Parameters
    ----------
    path : path-like
        The ending chooses the format. A clip also goes to a folder (no ending: ``frame_0000.obj`` and on)
        or to ``name.####.obj``, the motion of a skeleton to ``.bvh``.
    thing : Mesh, MeshClip or SkeletonClip
        What to write.
    up : str, optional
        Up axis of the file; by default that of ``thing.source``; GLB has no other than Y.
    unit : str or float, optional
        Unit of the file; by default that of ``thing.source``; GLB has no other than metres.
    progress : Progress
        Told about every frame.

    Raises
    ------
    FormatError
        If the ending is unknown or the format cannot hold it.
    ValueError
        If GLB is asked for other axes or another unit than its own.
    OSError
        If the place cannot be written.
    """
    check_arguments(up, unit, None)
    place = os.fspath(path)
    is_folder = place.endswith(("/", os.sep)) or Path(place).is_dir()
    suffix = "" if is_folder else Path(place).suffix.lower()
    if isinstance(thing, SkeletonClip):
        return _save_motion(place, suffix, thing, up, metres_per_unit(unit))
    if suffix == ".glb":
        metres = metres_per_unit(unit)
        import_module("tempose.formats.glb").write(place, thing, up=up, unit=metres, progress=progress)
        return None
    source = thing.source
    up, metres = up or source.up, metres_per_unit(unit) or source.unit
    is_pattern = split_counter(Path(place).name) is not None and suffix in SEQUENCE_SUFFIXES
    if isinstance(thing, MeshClip) and (suffix == "" or is_pattern):
        return write_sequence(place, thing, up, metres, progress)
    if suffix in USD_SUFFIXES:
        writer = import_module("tempose.formats.usd_write").write
        return writer(place, thing, up=up, unit=metres, progress=progress)
    if suffix in (".npz", ".npy"):
        return import_module("tempose.formats.npz").write(place, thing, up, metres)
    if suffix in SEQUENCE_SUFFIXES:
        return write_still(Path(place), _one_frame(place, thing), up, metres)
    known = ", ".join(k for k, f in FORMATS.items() if f.writes and "clip" in f.reads)
    raise FormatError(
        f"{place}: cannot write {suffix or 'a mesh to a name without ending'}; known are {known}"
    )


def _save_motion(place: str, suffix: str, motion: SkeletonClip, up: str | None, metres: float | None) -> None:
    if suffix != ".bvh":
        found = suffix or "a name without ending"
        raise FormatError(
            f"{place}: the motion of a skeleton goes into .bvh, got {found}; "
            "with the mesh that it moves it goes into .glb and .usda too (save_skin)"
        )
    import_module("tempose.formats.bvh_write").write_bvh(place, motion, up=up, unit=metres)


def _one_frame(place: str, thing: Mesh | MeshClip) -> Mesh:
    if isinstance(thing, Mesh):
        return thing
    if thing.n_frames == 1:
        return thing.mesh.with_vertices(thing.vertices[0])
    name = Path(place)
    raise FormatError(
        f"{place}: one {name.suffix} file holds one frame, the clip has {thing.n_frames}; "
        f"write to {name.stem}.####{name.suffix}, to a folder, or to {name.stem}.glb or .npz"
    )
