"""`tempose signals`: a clip as a curve that can be edited."""

from __future__ import annotations

import typer

from tempose.cli.signals_design import design
from tempose.cli.signals_edit import edit
from tempose.cli.signals_fit import fit
from tempose.cli.signals_loops import loops
from tempose.cli.signals_pictures import grid, plot
from tempose.cli.signals_sample import sample

signals = typer.Typer(
    name="signals",
    invoke_without_command=True,
)


@signals.callback()
def signals_(context: typer.Context) -> None:  # numpydoc ignore=PR01
    """Turn a clip into a curve through a plane of poses, edit the curve, play it again."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


signals.command()(fit)
signals.command()(sample)
signals.command()(edit)
signals.command()(loops)
signals.command()(plot)
signals.command()(grid)
signals.command()(design)
