"""`tempose convert`: a clip or a motion in another format, at another rate, in another unit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import tempose
from tempose.cli import options as given
from tempose.cli.console import note, progress_bar, writing
from tempose.cli.options import check_out, load

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, SkeletonClip
    from tempose.typing import Progress

Moving = TypeVar("Moving", "MeshClip", "SkeletonClip")


def convert(  # numpydoc ignore=PR01
    source: given.Input,
    out: given.OutClip,
    fps: given.Fps = None,
    start: given.Start = None,
    stop: given.Stop = None,
    step: given.Step = None,
    up: given.Up = None,
    unit: given.UnitOption = None,
    tolerance: given.Tolerance = None,
    group: given.Group = None,
    clip: given.Clip = None,
    topology: given.Topology = None,
    from_up: given.FromUp = None,
    from_unit: given.FromUnit = None,
    from_fps: given.FromFps = None,
) -> None:
    """Write a mesh or a clip in another format, rate, unit or up axis."""
    check_out(out, motion=True)
    loaded = load(
        source,
        up=from_up,
        unit=from_unit,
        fps=from_fps,
        group=group,
        clip=clip,
        topology=topology,
    )
    _check_kind(source, loaded, out)
    if isinstance(loaded, tempose.MeshClip):
        loaded = _retimed(loaded, fps, start, stop, step)
    elif isinstance(loaded, tempose.SkeletonClip):
        loaded = _retimed(loaded, fps, start, stop, step)
    elif any(value is not None for value in (fps, start, stop, step)):
        raise ValueError(f"{source}: is still, so --fps, --start, --stop and --step do not apply")
    if tolerance is not None and out.suffix.lower() != ".glb":
        raise ValueError(f"{out}: --tolerance is for .glb")
    with progress_bar() as progress, writing(out):
        if tolerance is None or isinstance(loaded, tempose.SkeletonClip):
            tempose.save(out, loaded, up=up, unit=unit, progress=progress)
        else:
            _write_compact(out, loaded, tolerance, progress)
    note(f"wrote {out}: {_size(loaded)}")


def _check_kind(source: str, loaded: Mesh | MeshClip | SkeletonClip, out: Path) -> None:
    """Refuse meshes in a BVH, and motions anywhere else."""
    moves, takes = isinstance(loaded, tempose.SkeletonClip), out.suffix.lower() == ".bvh"
    if moves and not takes:
        raise ValueError(
            f"{source}: holds a skeleton's motion, which goes into .bvh; `tempose transfer` puts it on a mesh"
        )
    if takes and not moves:
        raise ValueError(f"{out}: a BVH holds the motion of a skeleton, {source} is a mesh")


def _write_compact(out: Path, thing: Mesh | MeshClip, tolerance: float, progress: Progress) -> None:
    from tempose.formats.glb import write

    write(out, thing, tolerance=tolerance, progress=progress)


def _retimed(
    clip: Moving, fps: float | None, start: int | None, stop: int | None, step: int | None
) -> Moving:
    from dataclasses import replace

    from tempose.clips.resample import resample, select_frames

    if fps is not None and "fps" in clip.source.guessed:
        clip = replace(clip, fps=fps * (step or 1))
    clip = select_frames(clip, start or 0, stop, 1 if step is None else step)
    return clip if fps is None else resample(clip, fps)


def _size(thing: Mesh | MeshClip | SkeletonClip) -> str:
    if isinstance(thing, tempose.SkeletonClip):
        return f"{thing.n_frames} frames at {thing.fps:.6g} fps, {thing.skeleton.n_joints} joints"
    if isinstance(thing, tempose.MeshClip):
        return f"{thing.n_frames} frames at {thing.fps:.6g} fps, {len(thing.rest)} vertices"
    return f"{len(thing.vertices)} vertices"
