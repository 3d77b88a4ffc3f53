"""USD: meshes, point caches and skeletons in.

References
----------
.. [1] Pixar, "UsdSkel: USD Skeleton Schema and API", openusd.org.
"""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np

from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.formats._joint_moves import reduce_moves, rigid
from tempose.formats._place import inside
from tempose.formats._skin_notes import weight_notes
from tempose.formats.usd_mesh import Part, join, points_at, read_parts
from tempose.formats.usd_skel import (
    Rigged,
    bind_skeleton,
    joint_transforms,
    place_of,
    read_rigged,
    sample_times,
    skin_weights,
    stated_weights,
)
from tempose.formats.usd_stage import Stage, frame_times, modules, open_stage
from tempose.typing import FloatArray, IntArray

__all__ = ["read_clip", "read_mesh", "read_skeleton_clip", "read_skin"]


def read_mesh(path: str | os.PathLike[str], *, up: str | None = None, unit: float | None = None) -> Mesh:
    """Read everything that is drawn as one mesh.

    Parameters
    ----------
    path : path-like
        A USD file.
    up : str, optional
        Up axis, where it is other than stated.
    unit : float, optional
        Metres per unit, where it is other than stated.

    Returns
    -------
    Mesh
        World positions; what has a skin stands in its bind pose.

    Raises
    ------
    FormatError
        If there is no mesh in it, or it is broken.
    """
    stage = open_stage(path, up, unit)
    parts = read_parts(stage)
    return join(stage, parts, _rest(stage, parts, _skeleton_of(stage)))


def read_clip(
    path: str | os.PathLike[str],
    fps: float | None = None,
    *,
    up: str | None = None,
    unit: float | None = None,
) -> MeshClip:
    """Read everything that is drawn as a clip: sampled points, moving prims, skins and blend shapes.

    Parameters
    ----------
    path : path-like
        A USD file.
    fps : float, optional
        Rate to sample at; by default that of the samples.
    up : str, optional
        Up axis, where it is other than stated.
    unit : float, optional
        Metres per unit, where it is other than stated.

    Returns
    -------
    MeshClip
        One frame where nothing moves; its mesh is that of `read_mesh`.

    Raises
    ------
    FormatError
        If there is no mesh in it, or it is broken.
    """
    stage = open_stage(path, up, unit)
    parts = read_parts(stage)
    mesh = join(stage, parts, _rest(stage, parts, _skeleton_of(stage)))
    _bake_skins(stage)
    geom = modules(stage.place).UsdGeom
    attributes = [geom.Mesh(part.prim).GetPointsAttr() for part in parts]
    samples = {t for attribute in attributes for t in attribute.GetTimeSamples()}
    samples |= {t for part in parts for t in _travel(stage, part)}
    times = frame_times(stage, samples, fps)
    V = np.zeros((len(times.codes), len(mesh.vertices), 3), np.float32)
    for t, code in enumerate(times.codes):
        for part, attribute in zip(parts, attributes):
            points = points_at(attribute, float(code) if len(samples) else None)
            if len(points) != part.n:
                found = f"expected {part.n} points, found {len(points)} at time code {code:g}"
                raise stage.error(f"{part.prim.GetPath()}: {found}")
            place = place_of(stage, part.prim, float(code) if len(samples) else None)
            V[t, part.start : part.start + part.n] = _checked(stage, points @ place[:3, :3].T + place[:3, 3])
    return MeshClip(V, mesh, times.fps, replace(stage.source, fps=times.found))


def read_skeleton_clip(
    path: str | os.PathLike[str],
    fps: float | None = None,
    *,
    up: str | None = None,
    unit: float | None = None,
) -> SkeletonClip:
    """Read the motion of a skeleton (UsdSkel).

    Parameters
    ----------
    path : path-like
        A USD file.
    fps : float, optional
        Rate to sample at; by default that of the samples.
    up : str, optional
        Up axis, where it is other than stated.
    unit : float, optional
        Metres per unit, where it is other than stated.

    Returns
    -------
    SkeletonClip
        At rest in the bind pose. As for glTF, translations other than the root's are held at their mean.

    Raises
    ------
    FormatError
        If there is no skeleton in it, or it is broken.
    """
    stage = open_stage(path, up, unit)
    rigged = read_rigged(stage)
    times = frame_times(stage, sample_times(rigged), fps)
    rotations, positions = rigid(joint_transforms(stage, rigged, times.codes))
    carrying = _carrying(stage, rigged)
    moves = reduce_moves(bind_skeleton(stage, rigged), rotations, positions, carrying)
    source = replace(stage.source, fps=times.found, notes=moves.notes)
    name = str(rigged.prim.GetName())
    return SkeletonClip(moves.skeleton, moves.rotations, moves.root, times.fps, name, source)


def read_skin(
    path: str | os.PathLike[str], *, up: str | None = None, unit: float | None = None
) -> SkinnedMesh:
    """Read a mesh with the skeleton in it and the weights between them (UsdSkel).

    Parameters
    ----------
    path : path-like
        A USD file.
    up : str, optional
        Up axis, where it is other than stated.
    unit : float, optional
        Metres per unit, where it is other than stated.

    Returns
    -------
    SkinnedMesh
        Bind pose; the same mesh as `read_mesh`, the same joints as `read_skeleton_clip`. What the skeleton
        does not move has a row of zeros.

    Raises
    ------
    FormatError
        If there is no skin in it, or it is broken.
    """
    stage = open_stage(path, up, unit)
    rigged, parts = read_rigged(stage), read_parts(stage)
    if not rigged.skinned:
        raise stage.error("expected a mesh with a skin, found a skeleton that moves none")
    mesh = join(stage, parts, _rest(stage, parts, rigged))
    notes = weight_notes(stated_weights(stage, rigged, parts).sum(axis=1))
    mesh = replace(mesh, source=replace(mesh.source, notes=(*mesh.source.notes, *notes)))
    return SkinnedMesh(mesh, bind_skeleton(stage, rigged), skin_weights(stage, rigged, parts))


def _skeleton_of(stage: Stage) -> Rigged | None:
    skel = modules(stage.place).UsdSkel
    # a skeleton without joints only carries blend shapes
    jointed = (p for p in stage.usd.Traverse() if p.IsA(skel.Skeleton))
    return read_rigged(stage) if any(skel.Skeleton(p).GetJointsAttr().Get() for p in jointed) else None


def _rest(stage: Stage, parts: list[Part], rigged: Rigged | None) -> FloatArray:
    """Points of the parts at rest; what has a skin where its bind transform puts it."""
    geom = modules(stage.place).UsdGeom
    V = np.zeros((parts[-1].start + parts[-1].n, 3))
    for part in parts:
        points = points_at(geom.Mesh(part.prim).GetPointsAttr(), None)
        place = place_of(stage, part.prim, None)
        query = rigged.skinned.get(str(part.prim.GetPath())) if rigged is not None else None
        if rigged is not None and query is not None and query.HasJointInfluences():
            bind = np.array(query.GetGeomBindTransform(), dtype=np.float64).reshape(4, 4).T
            place = place_of(stage, rigged.prim, None) @ bind
        V[part.start : part.start + part.n] = _checked(stage, points @ place[:3, :3].T + place[:3, 3])
    return V


def _checked(stage: Stage, points: FloatArray) -> FloatArray:
    if not np.isfinite(points).all():
        raise stage.error("expected finite positions, found NaN or infinity")
    return inside(points, replace(stage.source, up="y", unit=1.0), stage.place)


def _bake_skins(stage: Stage) -> None:
    """Have usd-core turn skins and blend shapes into points, in memory only."""
    pxr = modules(stage.place)
    roots = [prim for prim in stage.usd.Traverse() if prim.IsA(pxr.UsdSkel.Root)]
    if roots:
        session = stage.usd.GetSessionLayer()
        # layers of other rates stretch one another's time
        session.timeCodesPerSecond = stage.usd.GetTimeCodesPerSecond()
        stage.usd.SetEditTarget(session)
        for root in roots:
            pxr.UsdSkel.BakeSkinning(pxr.UsdSkel.Root(root))


def _travel(stage: Stage, part: Part) -> set[float]:
    """Time codes at which a prim or one above it moves."""
    geom = modules(stage.place).UsdGeom
    codes: set[float] = set()
    prim = part.prim
    while prim and not prim.IsPseudoRoot():
        if prim.IsA(geom.Xformable):
            codes |= set(geom.Xformable(prim).GetTimeSamples())
        prim = prim.GetParent()
    return codes


def _carrying(stage: Stage, rigged: Rigged) -> IntArray | None:
    if not rigged.skinned:
        return None
    weights = skin_weights(stage, rigged, read_parts(stage))
    found = np.flatnonzero(weights.any(axis=0))
    return found if len(found) else np.arange(weights.shape[1])
