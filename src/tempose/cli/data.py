"""`tempose data`: real clips to try things on."""

from __future__ import annotations

from typing import Annotated

import typer

import tempose
from tempose.cli.console import note, progress_bar, show_json, show_table
from tempose.cli.options import Json

data = typer.Typer(
    name="data", help="Real clips to try things on: which there are, where they lie, how to get them."
)


@data.command("list")
def list_(json: Json = False) -> None:  # numpydoc ignore=PR01
    """List the data sets, their licences, and whether they are on this machine."""
    sets = [tempose.datasets.dataset(name) for name in tempose.datasets.dataset_names()]
    if json:
        show_json(
            [{"name": s.name, "about": s.about, "licence": s.licence, "here": _here(s.name)} for s in sets]
        )
        return
    rows = [(s.name, s.about, s.licence, "here" if _here(s.name) else "-") for s in sets]
    show_table(rows, ("name", "what", "licence", ""))


@data.command()
def fetch(  # numpydoc ignore=PR01
    names: Annotated[list[str], typer.Argument(metavar="NAME...", help="Data sets, or all.")],
) -> None:
    """Get data sets from the public repositories that publish them, and check every file."""
    if names == ["all"]:
        names = list(tempose.datasets.dataset_names())
    for name in names:
        tempose.datasets.dataset(name)
    for name in names:
        with progress_bar() as progress:
            folder = tempose.datasets.fetch(name, progress)
        note(f"{name}: licence: {tempose.datasets.dataset(name).licence}")
        typer.echo(folder)


@data.command()
def where(  # numpydoc ignore=PR01
    name: Annotated[
        str | None, typer.Argument(help="Data set; without it, the folder that fetch fills.")
    ] = None,
) -> None:
    """Print the folder of a data set, or the folder that holds them all."""
    typer.echo(tempose.datasets.cache_folder() if name is None else tempose.datasets.dataset_folder(name))


def _here(name: str) -> bool:
    try:
        tempose.datasets.dataset_folder(name)
    except tempose.datasets.DatasetMissing:
        return False
    return True
