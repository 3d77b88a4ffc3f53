"""Writing a mesh together with the joints that move it."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.formats._place import metres_per_unit
from tempose.formats._table import USD_SUFFIXES, PathLike, Unit, check_arguments
from tempose.formats.conventions import FormatError
from tempose.kinematics import rest_motion
from tempose.typing import Progress, silent


def save_skin(
    path: PathLike,
    skin: SkinnedMesh,
    motion: SkeletonClip | None = None,
    *,
    blending: str = "linear",
    up: str | None = None,
    unit: Unit = None,
    progress: Progress = silent,
) -> None:
    """Write a skinned mesh, moving or still, for any animation package.

    Parameters
    ----------
    path : path-like
        ``.glb``, or ``.usda``, ``.usdc``, ``.usd`` with usd-core installed.
    skin : SkinnedMesh
        n vertices, J joints.
    motion : SkeletonClip, optional
        Frames on the joints of `skin`; by default one frame at rest.
    blending : str, default "linear"
        ``"linear"`` or ``"dual-quaternion"``: how weights blend; only USD can say it.
    up : str, optional
        Up axis of a USD file; by default that of the mesh's source. GLB has no other than Y.
    unit : str or float, optional
        Unit of a USD file; by default that of the mesh's source. GLB has no other than metres.
    progress : Progress
        Told about every array.

    Raises
    ------
    FormatError
        If the ending is unknown or usd-core is missing.
    ValueError
        If the joints differ or the format cannot hold it.
    OSError
        If the place cannot be written.
    """
    check_arguments(up, unit, None)
    place = os.fspath(path)
    suffix = Path(place).suffix.lower()
    if blending not in ("linear", "dual-quaternion"):
        raise ValueError(f"blending must be 'linear' or 'dual-quaternion', got {blending!r}")
    if motion is None:
        motion = rest_motion(skin.skeleton, skin.mesh.name)
    if motion.skeleton.names != skin.skeleton.names:
        raise ValueError("motion must move the joints of the skin, got other joint names")
    if suffix == ".glb":
        if up not in (None, "y") or metres_per_unit(unit) not in (None, 1.0):
            raise ValueError(f"a GLB is always Y up and in metres, got up {up!r} and unit {unit}")
        import_module("tempose.formats.glb_skin_write").write_skin(place, skin, motion, progress=progress)
    elif suffix in USD_SUFFIXES:
        metres = metres_per_unit(unit) or skin.mesh.source.unit
        writer = import_module("tempose.formats.usd_write").write_skin
        writer(place, skin, motion, up=up or skin.mesh.source.up, unit=metres, blending=blending)
    else:
        known = ", ".join((".glb", *USD_SUFFIXES))
        found = suffix or "a name without ending"
        raise FormatError(f"{place}: a mesh with its joints goes into {known}, got {found}")
