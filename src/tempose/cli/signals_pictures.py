"""`tempose signals grid` and `plot`: what a model looks like."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from tempose.cli.console import note, progress_bar, writing
from tempose.cli.signals_files import check_folder, load_signals, write_plots
from tempose.cli.signals_options import ModelFile, parse_numbers

OutPicture = Annotated[Path, typer.Option("-o", "--out", metavar="GRID.png", help="Where the picture goes.")]
RegionOption = Annotated[
    str | None,
    typer.Option(
        metavar="X0,Y0,X1,Y1", help="Part of the pose plane; a small one is shown finer. All without it."
    ),
]
Columns = Annotated[int, typer.Option(metavar="N", help="Small pictures along the longer side.")]
View = Annotated[
    str | None,
    typer.Option(
        metavar="NAME|DEGREES",
        help="front, side, back, top... or an azimuth; else where motion is seen.",
    ),
]
Dark = Annotated[bool, typer.Option("--dark", help="Light on dark.")]
OutFolder = Annotated[
    Path, typer.Option("-o", "--out", metavar="FOLDER", help="Where the pictures go, PNG and SVG.")
]


def grid(  # numpydoc ignore=PR01
    model_file: ModelFile,
    out: OutPicture,
    region: RegionOption = None,
    columns: Columns = 9,
    view: View = None,
    dark: Dark = False,
) -> None:
    """Show what every place of the pose plane means; faint poses are far from all frames."""
    from tempose.render import save_png
    from tempose.signals.pictures import pose_grid

    if out.suffix.lower() != ".png":
        raise ValueError(f"{out}: the grid is written as .png")
    check_folder(out)
    box = None if region is None else parse_numbers(region, 4, "--region")
    direction = None if view is None else _direction(view)
    model = load_signals(model_file)
    with progress_bar() as progress, writing(out):
        picture = pose_grid(
            model,
            None if box is None else (box[0], box[1], box[2], box[3]),
            columns=columns,
            view=direction,
            theme="dark" if dark else "light",
            progress=progress,
        )
        save_png(picture, out)
    note(f"wrote {out}")


def plot(model_file: ModelFile, out: OutFolder) -> None:  # numpydoc ignore=PR01
    """Draw a model: pose plane, grid of poses, error of every frame, modes, clock."""
    check_folder(out)
    write_plots(load_signals(model_file), out)


def _direction(view: str) -> tuple[float, float]:
    from tempose.render.views import NAMED_VIEWS

    if view in NAMED_VIEWS:
        return NAMED_VIEWS[view]
    try:
        return math.radians(float(view)), math.radians(6.0)
    except ValueError:
        known = ", ".join(NAMED_VIEWS)
        raise ValueError(f"--view must be degrees or one of {known}, got {view!r}") from None
