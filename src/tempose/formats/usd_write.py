"""Write USD: still meshes, clips as time samples, skins as UsdSkel.

References
----------
.. [1] Pixar, "UsdSkel: USD Skeleton Schema and API", openusd.org.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.formats.conventions import to_file
from tempose.formats.usd_mesh_write import add_mesh
from tempose.formats.usd_skel_write import JOINTS, add_skin
from tempose.formats.usd_stage import identifier, modules
from tempose.typing import Progress, silent


def write(
    path: str | os.PathLike[str],
    thing: Mesh | MeshClip,
    *,
    up: str = "y",
    unit: float = 1.0,
    progress: Progress = silent,
) -> None:
    """Write a mesh, or a clip as points sampled over time.

    Parameters
    ----------
    path : path-like
        Final name, ending in ``.usda``, ``.usdc`` or ``.usd``.
    thing : Mesh or MeshClip
        What to write.
    up : str, default "y"
        Up axis of the file, ``"y"`` or ``"z"``.
    unit : float, default 1.0
        Metres per unit of the file.
    progress : Progress
        Told about every frame.

    Raises
    ------
    FormatError
        If usd-core is missing.
    ValueError
        If USD cannot hold it.
    OSError
        If the place cannot be written.
    """
    mesh = thing.mesh if isinstance(thing, MeshClip) else thing
    stage = _new(path, up, unit)
    pxr = modules(os.fspath(path))
    name = identifier(mesh.name or "mesh")
    root = pxr.UsdGeom.Xform.Define(stage, f"/{name}")
    stage.SetDefaultPrim(root.GetPrim())
    written = add_mesh(stage, root.GetPath().AppendChild(name), mesh, up, unit)
    if isinstance(thing, MeshClip):
        _set_range(stage, thing.n_frames, thing.fps)
        points = written.GetPointsAttr()
        for t, frame in enumerate(thing.vertices):
            points.Set(_vectors(pxr, to_file(frame.astype(np.float64), up, unit)), float(t))
            progress(t + 1, thing.n_frames, "writing")
    _export(path, stage)


def write_skin(
    path: str | os.PathLike[str],
    skin: SkinnedMesh,
    motion: SkeletonClip,
    *,
    up: str = "y",
    unit: float = 1.0,
    blending: str = "linear",
) -> None:
    """Write a skinned mesh and its motion as UsdSkel.

    Parameters
    ----------
    path : path-like
        Final name, ending in ``.usda``, ``.usdc`` or ``.usd``.
    skin : SkinnedMesh
        n vertices, J joints, any number of weights a vertex.
    motion : SkeletonClip
        T >= 1 frames on the joints of `skin`.
    up : str, default "y"
        Up axis of the file, ``"y"`` or ``"z"``.
    unit : float, default 1.0
        Metres per unit of the file.
    blending : str, default "linear"
        ``"linear"`` or ``"dual-quaternion"``.

    Raises
    ------
    FormatError
        If usd-core is missing.
    ValueError
        If there is no frame, or USD cannot hold it.
    OSError
        If the place cannot be written.
    """
    if not motion.n_frames:
        raise ValueError("a USD motion needs at least one frame, got none")
    stage = _new(path, up, unit)
    pxr = modules(os.fspath(path))
    name = identifier(skin.mesh.name or "mesh")
    name = f"{name}_" if name == JOINTS else name
    root = pxr.UsdSkel.Root.Define(stage, f"/{name}")
    stage.SetDefaultPrim(root.GetPrim())
    mesh = add_mesh(stage, root.GetPath().AppendChild(name), skin.mesh, up, unit)
    add_skin(stage, root.GetPath(), mesh, skin, motion, up, unit, blending)
    _set_range(stage, motion.n_frames, motion.fps)
    _export(path, stage)


def _new(path: str | os.PathLike[str], up: str, unit: float) -> Any:
    pxr = modules(os.fspath(path))
    if up not in ("y", "z"):
        raise ValueError(f"USD is Y or Z up, got up {up!r}")
    stage = pxr.Usd.Stage.CreateInMemory()
    pxr.UsdGeom.SetStageUpAxis(stage, up.upper())
    pxr.UsdGeom.SetStageMetersPerUnit(stage, unit)
    return stage


def _set_range(stage: Any, frames: int, fps: float) -> None:
    stage.SetTimeCodesPerSecond(fps)
    stage.SetFramesPerSecond(fps)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(frames - 1)


def _vectors(pxr: Any, V: Any) -> Any:
    return pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(V, dtype=np.float32))


def _export(path: str | os.PathLike[str], stage: Any) -> None:
    with atomic_path(path) as part:
        if not stage.GetRootLayer().Export(str(part)):
            raise OSError(f"{os.fspath(path)}: cannot be written")
