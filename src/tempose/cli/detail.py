"""`tempose detail`: cloth and flesh that follow a skeleton as they were captured."""

from __future__ import annotations

import typer

from tempose.cli.detail_fit import fit
from tempose.cli.detail_pose import pose

detail = typer.Typer(
    name="detail",
    invoke_without_command=True,
)


@detail.callback()
def detail_(context: typer.Context) -> None:  # numpydoc ignore=PR01
    """Learn the cloth and flesh that a skeleton alone does not carry, and pose them with it."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


detail.command()(fit)
detail.command()(pose)
