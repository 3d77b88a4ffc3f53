"""`tempose convert`: a clip in another format, at another rate, in another unit."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import tempose
from tempose.cli.console import note, progress_bar, writing
from tempose.cli.options import Clip, FromFps, FromUnit, FromUp, Group, Topology, check_out, load

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip
    from tempose.typing import Progress


def convert(  # numpydoc ignore=PR01
    source: Annotated[
        str, typer.Argument(metavar="IN", help="File, folder of frames, glob, or name.####.obj.")
    ],
    out: Annotated[
        Path,
        typer.Argument(
            metavar="OUT", help="Its ending chooses the format; a folder or name.####.obj takes frames."
        ),
    ],
    fps: Annotated[
        float | None,
        typer.Option(
            metavar="F",
            help="Rate of the output; frames are interpolated. An input without a rate takes it as its own.",
        ),
    ] = None,
    start: Annotated[int | None, typer.Option(metavar="FRAME", help="First frame kept, 0-based.")] = None,
    stop: Annotated[int | None, typer.Option(metavar="FRAME", help="First frame left out.")] = None,
    step: Annotated[
        int | None, typer.Option(metavar="N", help="Keep every N-th frame, at the same speed.")
    ] = None,
    up: Annotated[str | None, typer.Option(metavar="x|y|z", help="Up axis of the output.")] = None,
    unit: Annotated[
        str | None,
        typer.Option(metavar="UNIT", help="Unit of the output: mm, cm, dm, m, in, ft, or metres per unit."),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(
            metavar="P", help="Percent of the diagonal by which a compact GLB may be off; else lossless."
        ),
    ] = None,
    group: Group = None,
    clip: Clip = None,
    topology: Topology = None,
    from_up: FromUp = None,
    from_unit: FromUnit = None,
    from_fps: FromFps = None,
) -> None:
    """Write a mesh or a clip in another format, rate, unit or up axis."""
    check_out(out)
    loaded = load(
        source,
        up=from_up,
        unit=from_unit,
        fps=from_fps,
        group=group,
        clip=clip,
        topology=topology,
    )
    if isinstance(loaded, tempose.SkeletonClip):
        raise ValueError(
            f"{source}: holds a skeleton's motion, and no format for that can be written yet; "
            "`tempose transfer` puts it on a mesh"
        )
    if isinstance(loaded, tempose.MeshClip):
        loaded = _retimed(loaded, fps, start, stop, step)
    elif any(value is not None for value in (fps, start, stop, step)):
        raise ValueError(f"{source}: is still, so --fps, --start, --stop and --step do not apply")
    if tolerance is not None and out.suffix.lower() != ".glb":
        raise ValueError(f"{out}: --tolerance is for .glb")
    with progress_bar() as progress, writing(out):
        if tolerance is None:
            tempose.save(out, loaded, up=up, unit=unit, progress=progress)
        else:
            _write_compact(out, loaded, tolerance, progress)
    note(f"wrote {out}: {_size(loaded)}")


def _write_compact(out: Path, thing: Mesh | MeshClip, tolerance: float, progress: Progress) -> None:
    from tempose.formats.glb import write

    write(out, thing, tolerance=tolerance, progress=progress)


def _retimed(
    clip: MeshClip, fps: float | None, start: int | None, stop: int | None, step: int | None
) -> MeshClip:
    from dataclasses import replace

    from tempose.clips.resample import resample, select_frames

    if fps is not None and "fps" in clip.source.guessed:
        clip = replace(clip, fps=fps * (step or 1))
    clip = select_frames(clip, start or 0, stop, 1 if step is None else step)
    return clip if fps is None else resample(clip, fps)


def _size(thing: Mesh | MeshClip) -> str:
    if isinstance(thing, tempose.MeshClip):
        return f"{thing.n_frames} frames at {thing.fps:.6g} fps, {len(thing.rest)} vertices"
    return f"{len(thing.vertices)} vertices"
