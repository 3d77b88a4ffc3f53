"""`tempose render`: a clip as a picture or a film."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import note, progress_bar, writing
from tempose.cli.options import Clip, FromFps, FromUnit, FromUp, Group, Topology, load

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, SkeletonClip


def render(  # numpydoc ignore=PR01
    clips: Annotated[
        list[str], typer.Argument(metavar="CLIP...", help="What to show; several stand side by side.")
    ],
    out: Annotated[
        Path,
        typer.Option(
            "-o", "--out", metavar="OUT", help="OUT.png is a contact sheet, OUT.gif and OUT.mp4 are films."
        ),
    ],
    view: Annotated[
        list[str] | None,
        typer.Option(
            metavar="VIEW",
            help="front, side, left, right, back, top or three-quarter; may be repeated for PNG.",
        ),
    ] = None,
    frames: Annotated[
        int, typer.Option(metavar="N", min=1, help="Moments shown in a contact sheet, spread over the clip.")
    ] = 8,
    size: Annotated[
        int | None, typer.Option(metavar="PIXELS", min=16, max=4096, help="Height of a cell or of the film.")
    ] = None,
    theme: Annotated[str, typer.Option(metavar="light|dark", help="Background.")] = "light",
    group: Group = None,
    clip: Clip = None,
    topology: Topology = None,
    from_up: FromUp = None,
    from_unit: FromUnit = None,
    from_fps: FromFps = None,
) -> None:
    """Draw a mesh, a clip or a moving skeleton: a sheet of moments, or a film."""
    suffix = out.suffix.lower()
    if suffix not in (".png", ".gif", ".mp4"):
        raise ValueError(f"{out}: pictures are written as .png, .gif or .mp4")
    if view and len(view) > 1 and suffix != ".png":
        raise ValueError(f"{out}: a film has one view, got {len(view)}")
    options = {"group": group, "clip": clip, "topology": topology}
    shown = [_surface(load(path, up=from_up, unit=from_unit, fps=from_fps, **options)) for path in clips]
    with progress_bar() as progress, writing(out):
        tempose.render.render(shown, out, progress=progress, theme=theme, **_look(suffix, view, frames, size))
    note(f"wrote {out}")


def _surface(thing: Mesh | MeshClip | SkeletonClip) -> Mesh | MeshClip:
    if isinstance(thing, tempose.SkeletonClip):
        return tempose.transfer.skeleton_mesh(thing)
    return thing


def _look(suffix: str, view: list[str] | None, frames: int, size: int | None) -> dict[str, Any]:
    if suffix == ".png":
        look: dict[str, Any] = {"frames": frames}
        return look | ({"views": view} if view else {}) | ({"cell": size} if size else {})
    look = {"view": view[0]} if view else {}
    return look | ({"size": (size, size)} if size else {})
