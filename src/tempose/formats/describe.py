"""One line that tells a person what was loaded, what was guessed and what looks wrong."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import MarkerClip, Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh, Source
from tempose.formats.conventions import UNITS
from tempose.kinematics import forward_kinematics

_PLAUSIBLE_METRES = (0.3, 3.0)


def describe(thing: Mesh | MeshClip | SkeletonClip | SkinnedMesh | MarkerClip) -> str:
    """Say in one line what a thing is, where its axes and unit come from and what to check.

    Parameters
    ----------
    thing : Mesh, MeshClip, SkeletonClip, SkinnedMesh or MarkerClip
        Anything that `tempose.formats.load` returns.

    Returns
    -------
    str
        Kind, size, time, height, axes and unit; then what was guessed; then warnings.

    Examples
    --------
    >>> describe(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], name="tile"))
    'mesh tile: 3 vertices, 1 triangles, still, 1 m tall, from memory, y up, unit m'
    """
    if isinstance(thing, SkinnedMesh):
        kind, size, time = "skinned mesh", _size(thing.mesh, thing.skeleton), "still"
        name, source = thing.mesh.name, thing.mesh.source
    elif isinstance(thing, Mesh):
        kind, size, time, name, source = "mesh", _size(thing), "still", thing.name, thing.source
    else:
        kind, size = _moving_kind(thing)
        name, source = thing.name, thing.source
        time = _time(thing)
    height = _height(thing)
    title = f"{kind} {name}" if name else kind
    line = f"{title}: {size}, {time}, {height:.3g} m tall, {_origin(source)}"
    if source.guessed:
        line += f"; guessed: {', '.join(source.guessed)}"
    for warning in [*source.notes, *_warnings(height, source, getattr(thing, "n_frames", 1))]:
        line += f"; note: {warning.rstrip('.')}"
    return line


def _moving_kind(thing: Any) -> tuple[str, str]:
    if isinstance(thing, MeshClip):
        return "mesh clip", _size(thing.mesh)
    if isinstance(thing, SkeletonClip):
        return "skeleton clip", f"{thing.skeleton.n_joints} joints"
    return "marker clip", f"{len(thing.labels)} markers"


def _size(mesh: Mesh, skeleton: Skeleton | None = None) -> str:
    text = f"{len(mesh.vertices)} vertices, {len(mesh.faces)} triangles"
    if mesh.groups:
        text += f", {len(mesh.groups)} groups"
    return text if skeleton is None else f"{text}, {skeleton.n_joints} joints"


def _time(thing: Any) -> str:
    moving = "moving" if _moves(thing) else "still"
    T = len(thing.positions) if isinstance(thing, MarkerClip) else thing.n_frames
    frames = "1 frame" if T == 1 else f"{T} frames"
    return f"{frames} at {thing.fps:.4g} fps ({max(T - 1, 0) / thing.fps:.2f} s, {moving})"


def _moves(thing: Any) -> bool:
    """Whether anything changes by more than a millionth from the first frame."""
    if isinstance(thing, SkeletonClip):
        turned = np.abs(thing.rotations - thing.rotations[:1]).max(initial=0.0)
        return bool(
            max(turned, np.abs(thing.root_position - thing.root_position[:1]).max(initial=0.0)) > 1e-6
        )
    frames = thing.positions if isinstance(thing, MarkerClip) else thing.vertices
    limit = 1e-6 * (thing.mesh.diagonal if isinstance(thing, MeshClip) else 1.0)
    return any(np.nanmax(np.abs(f - frames[0]), initial=0.0) > limit for f in frames[1:])


def _height(thing: Any) -> float:
    """Extent along Y of the first frame, metres."""
    if isinstance(thing, SkinnedMesh):
        return thing.mesh.height
    if isinstance(thing, Mesh):
        return thing.height
    if isinstance(thing, SkeletonClip):
        if thing.n_frames == 0:
            return 0.0
        y = forward_kinematics(thing.skeleton, thing.rotations[:1], thing.root_position[:1])[1][..., 1]
    else:
        frames = thing.positions if isinstance(thing, MarkerClip) else thing.vertices
        y = frames[:1, :, 1]
    y = y[np.isfinite(y)]
    return float(np.ptp(y)) if y.size else 0.0


def _origin(source: Source) -> str:
    unit = next((name for name, metres in UNITS.items() if metres == source.unit), f"{source.unit:g} m")
    return f"from {source.format or 'memory'}, {source.up} up, unit {unit}"


def _warnings(height: float, source: Source, T: int) -> list[str]:
    found: list[str] = []
    low, high = _PLAUSIBLE_METRES
    if not low <= height <= high:
        found.append(f"{height:.3g} m tall is unusual for a body; if that is wrong, state up and unit")
    if "fps" in source.guessed and T > 1:
        found.append("the file states no frame rate; if it was not as assumed, state fps")
    return found
