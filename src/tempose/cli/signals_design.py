"""`tempose signals design`: poses placed by hand and a drawn curve become a clip."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import tempose
from tempose.cli.console import note, writing
from tempose.cli.signals_files import check_folder, check_model_out, describe, write_plots
from tempose.cli.signals_options import OutModel, Plot

DesignFile = Annotated[
    Path,
    typer.Argument(
        metavar="DESIGN.json",
        help='JSON or TOML: {"poses": ["smile.obj", ...], "places": [[x, y], ...], "curve": [[x, y], ...], '
        '"fps": 30, "seconds": 2}; also "space", "closed", "align".',
    ),
]


def design(design_file: DesignFile, out: OutModel, plot: Plot = None) -> None:  # numpydoc ignore=PR01
    """Make a clip from nothing but poses, places for them, and a curve drawn through the plane."""
    from tempose.signals.design import load_design

    check_model_out(out)
    if plot is not None:
        check_folder(plot)
    model = tempose.SignalModel.from_signals(load_design(design_file))
    with writing(out):
        model.save(out)
    if plot is not None:
        write_plots(model, plot)
    note(f"wrote {out}: {describe(model)}")
