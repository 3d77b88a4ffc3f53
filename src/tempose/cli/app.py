"""The table of commands."""

from __future__ import annotations

from typing import Annotated

import typer

import tempose
from tempose.cli.compare import compare
from tempose.cli.convert import convert
from tempose.cli.data import data
from tempose.cli.demo import demo
from tempose.cli.detail import detail
from tempose.cli.info import info
from tempose.cli.pairs import pairs
from tempose.cli.render import render
from tempose.cli.rig import rig
from tempose.cli.signals import signals
from tempose.cli.transfer import transfer

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command()(demo)
app.command()(transfer)
app.command()(pairs)
app.add_typer(signals)
app.add_typer(rig)
app.add_typer(detail)
app.command()(info)
app.command()(convert)
app.command()(compare)
app.command()(render)
app.add_typer(data)


@app.callback(invoke_without_command=True)
def tempose_(  # numpydoc ignore=PR01
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and leave.")] = False,
) -> None:
    """Take hold of mesh animations."""
    if version:
        typer.echo(f"tempose {tempose.__version__}")
    elif context.invoked_subcommand is None:
        typer.echo(context.get_help())


command = typer.main.get_command(app)
