"""`tempose rig`: a skeleton for a mesh or a clip."""

from __future__ import annotations

import typer

from tempose.cli.rig_export import export
from tempose.cli.rig_fit import fit

rig = typer.Typer(
    name="rig",
    invoke_without_command=True,
)


@rig.callback()
def rig_(context: typer.Context) -> None:  # numpydoc ignore=PR01
    """Find a skeleton for a mesh or a clip, which any animation package can pose."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


rig.command()(fit)
rig.command()(export)
