"""Options that several commands share, and loading with them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import note, progress_bar

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, SkeletonClip

FromUp = Annotated[
    str | None, typer.Option(metavar="x|y|z", help="Up axis of the input, where it is other than guessed.")
]
FromUnit = Annotated[
    str | None,
    typer.Option(metavar="UNIT", help="Unit of the input: mm, cm, dm, m, in, ft, or metres per unit."),
]
FromFps = Annotated[
    float | None, typer.Option(metavar="F", help="Rate of the input, where it states none or a wrong one.")
]
Group = Annotated[str | None, typer.Option(metavar="NAME", help="Keep only this group of faces.")]
Clip = Annotated[
    str | None, typer.Option(metavar="NAME", help="Which animation, where the input holds several.")
]
Topology = Annotated[
    Path | None,
    typer.Option(metavar="MESH", help="Mesh whose faces belong to the input, where it holds positions only."),
]
OutClip = Annotated[
    Path,
    typer.Argument(
        metavar="OUT", help="Its ending chooses the format; a folder or name.####.obj takes frames."
    ),
]
Input = Annotated[str, typer.Argument(metavar="IN", help="File, folder of frames, glob, or name.####.obj.")]
Fps = Annotated[
    float | None,
    typer.Option(
        metavar="F",
        help="Rate of the output; frames are interpolated. An input without a rate takes it as its own.",
    ),
]
Tolerance = Annotated[
    float | None,
    typer.Option(
        metavar="P", help="Percent of the diagonal by which a compact GLB may be off; else lossless."
    ),
]
Start = Annotated[int | None, typer.Option(metavar="FRAME", help="First frame kept, 0-based.")]
Stop = Annotated[int | None, typer.Option(metavar="FRAME", help="First frame left out.")]
Step = Annotated[int | None, typer.Option(metavar="N", help="Keep every N-th frame, at the same speed.")]
Up = Annotated[str | None, typer.Option(metavar="x|y|z", help="Up axis of the output.")]
UnitOption = Annotated[
    str | None,
    typer.Option(metavar="UNIT", help="Unit of the output: mm, cm, dm, m, in, ft, or metres per unit."),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON for a machine to read.")]


def load(path: str, **options: Any) -> Mesh | MeshClip | SkeletonClip:
    """Load a file with a progress bar and say in one line on standard error what it is.

    Parameters
    ----------
    path : str
        As for `tempose.load`.
    **options
        As for `tempose.load`.

    Returns
    -------
    Mesh, MeshClip or SkeletonClip
        What the file holds.
    """
    with progress_bar() as progress:
        loaded = tempose.load(path, progress=progress, **options)
    note(tempose.formats.describe(loaded))
    return loaded


def check_out(path: Path, *, motion: bool = False) -> None:
    """Refuse an output that cannot be written before the work is done that makes it.

    Parameters
    ----------
    path : Path
        Where a clip shall go.
    motion : bool, default False
        Whether it may be the motion of a skeleton.

    Raises
    ------
    ValueError
        If its ending is no format that can be written.
    FileNotFoundError
        If its folder does not exist.
    """
    wanted = {"mesh", "clip"} | ({"skeleton"} if motion else set[str]())
    formats = {k: f for k, f in tempose.formats.FORMATS.items() if f.writes and wanted.intersection(f.reads)}
    suffix = path.suffix.lower()
    if suffix and suffix not in formats:
        known = ", ".join(formats)
        raise ValueError(f"{path}: cannot write {suffix!r}; known are {known}")
    folder = path.parent
    if not folder.is_dir() and not (folder.parent.is_dir() and "#" in path.name):
        raise FileNotFoundError(f"{folder}: no such folder to write {path.name!r} in; create it first")
