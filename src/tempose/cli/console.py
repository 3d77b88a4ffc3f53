"""What a person sees: notes and progress on standard error, results on standard output."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from tempose.cli.interrupts import stop_if_interrupted
from tempose.typing import Progress


def note(text: str) -> None:
    """Say something beside the result, in one line on standard error.

    Parameters
    ----------
    text : str
        What to say.
    """
    sys.stderr.write(" ".join(text.split()) + "\n")
    sys.stderr.flush()


@contextmanager
def progress_bar() -> Generator[Progress, None, None]:
    """Show the progress of long work on standard error while the block runs.

    Yields
    ------
    Progress
        Callback for library functions; shows nothing where standard error is not a terminal.
    """
    if not sys.stderr.isatty():
        yield lambda done, total, stage: stop_if_interrupted()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        tasks: dict[str, Any] = {}

        def show(done: int, total: int, stage: str) -> None:
            stop_if_interrupted()
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=total or None)
            bars.update(tasks[stage], completed=done, total=total or None)

        yield show


def show_table(rows: Sequence[Sequence[str]], header: Sequence[str] = (), *, numbers: bool = False) -> None:
    """Print a table to standard output.

    Parameters
    ----------
    rows : sequence of sequence of str
        Cells.
    header : sequence of str, optional
        Titles of the columns.
    numbers : bool, default False
        Whether all columns but the first hold numbers, which stand to the right.
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD if header else None, show_header=bool(header), pad_edge=False)
    for i in range(max(map(len, rows), default=0)):
        title = header[i] if header else ""
        table.add_column(title, justify="right" if numbers and i else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    width = None if sys.stdout.isatty() else 160
    Console(width=width, highlight=False).print(table)


def plain(value: Any) -> Any:
    """Turn a value into what JSON can hold; numbers that are not finite become null.

    Parameters
    ----------
    value : object
        Dictionaries, sequences, numpy scalars and arrays, paths, text.

    Returns
    -------
    object
        The same in plain types.
    """
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if value is None or isinstance(value, bool | int | str) else str(value)


def show_json(value: Any) -> None:
    """Print a value as JSON to standard output.

    Parameters
    ----------
    value : object
        As for `plain`.
    """
    typer.echo(json.dumps(plain(value), indent=2, allow_nan=False))


def tell(report: dict[str, Any], rows: Sequence[Sequence[str]], json: bool) -> None:
    """Say what a command found and wrote.

    Parameters
    ----------
    report : dict
        With ``warnings`` and, under ``inputs``, ``out``.
    rows : sequence of (str, str)
        What a person wants to read of it.
    json : bool
        Whether the whole report is printed as JSON instead.
    """
    for warning in report["warnings"]:
        note(f"note: {warning}")
    if json:
        show_json(report)
        return
    show_table(rows)
    note(f"wrote {report['inputs']['out']}")


@contextmanager
def writing(path: Path) -> Generator[None, None, None]:
    """Name the output in whatever the system says while it is written.

    Parameters
    ----------
    path : Path
        Final name of the output.

    Yields
    ------
    None
        Nothing.

    Raises
    ------
    OSError
        What the block raised, with the output named.
    """
    try:
        yield
    except OSError as error:
        if error.errno is not None:
            raise OSError(error.errno, error.strerror, str(path)) from None
        if path.name in str(error):
            raise
        raise OSError(f"{path}: cannot be written, is the disk full? ({error})") from None
