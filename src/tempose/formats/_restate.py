"""Overrule what a file states about its axes, unit or rate."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh, Source
from tempose.formats.conventions import y_up_rotation
from tempose.rotations import from_matrix, multiply
from tempose.typing import FloatArray


def restate(thing: Any, up: str | None, unit: float | None, fps: float | None) -> Any:
    """Read a loaded thing as if its file had stated other axes, another unit or another rate.

    Parameters
    ----------
    thing : Mesh, MeshClip, SkeletonClip or SkinnedMesh
        As loaded, with its `Source`.
    up : str or None
        Up axis; None keeps what the file stated.
    unit : float or None
        Metres per unit; None keeps what the file stated.
    fps : float or None
        Frames per second; None keeps what the file stated.

    Returns
    -------
    same type as `thing`
        The thing itself when nothing changes.
    """
    if isinstance(thing, SkinnedMesh):
        mesh = restate(thing.mesh, up, unit, None)
        return replace(
            thing, mesh=mesh, skeleton=_turned(thing.skeleton, *_change(thing.mesh.source, up, unit))
        )
    said = tuple(k for k, v in (("up", up), ("unit", unit), ("fps", fps)) if v is not None)
    if not said:
        return thing
    source = thing.source
    R, scale = _change(source, up, unit)
    source = replace(
        source,
        up=up or source.up,
        unit=unit or source.unit,
        guessed=tuple(k for k in source.guessed if k not in said),
    )
    if isinstance(thing, Mesh):
        return replace(thing, vertices=thing.vertices @ R.T * scale, source=source)
    if isinstance(thing, MeshClip):
        mesh = restate(thing.mesh, up, unit, None)
        vertices = thing.vertices @ (R.T * scale).astype(np.float32)
        return MeshClip(vertices, mesh, fps or thing.fps, source)
    return SkeletonClip(
        _turned(thing.skeleton, R, scale),
        np.concatenate([multiply(from_matrix(R), thing.rotations[:, :1]), thing.rotations[:, 1:]], axis=1),
        thing.root_position @ R.T * scale,
        fps or thing.fps,
        thing.name,
        source,
    )


def _change(source: Source, up: str | None, unit: float | None) -> tuple[FloatArray, float]:
    """Rotation and scale from the stated to the overruled inside."""
    R = np.eye(3)
    if up is not None:
        R = y_up_rotation(up) @ y_up_rotation(source.up).T
    return R, (unit or source.unit) / source.unit


def _turned(skeleton: Skeleton, R: FloatArray, scale: float) -> Skeleton:
    """Skeleton turned as a whole: only the root feels the rotation, children are relative to it."""
    offsets, rest = skeleton.offsets * scale, skeleton.rest_rotations.copy()
    offsets[0] = offsets[0] @ R.T
    rest[0] = multiply(from_matrix(R), rest[0])
    return Skeleton(skeleton.names, skeleton.parents, offsets, rest, skeleton.tips * scale)
