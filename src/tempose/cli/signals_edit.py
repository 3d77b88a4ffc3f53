"""`tempose signals edit`: a list of operations turns one model into another."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from tempose.cli.console import note, show_json, show_table, writing
from tempose.cli.options import Json
from tempose.cli.report import make_report, write_report
from tempose.cli.signals_files import check_folder, check_model_out, describe, load_signals, write_plots
from tempose.cli.signals_options import ModelFile, OutModel, Plot, ReportFile

EditFile = Annotated[
    Path,
    typer.Argument(
        metavar="EDIT.json",
        help='A list of operations, JSON or TOML: {"operations": [{"op": "loop", "from": 24, "to": 48, '
        '"times": 3}, ...]}. Leaving out the last one is undo.',
    ),
]


def _show_operations(wanted: bool) -> None:
    if not wanted:
        return
    from tempose.signals.edits import OPERATIONS

    rows = [
        (name, ", ".join([*op.needed, *(f"[{key}]" for key in op.optional)]), op.help)
        for name, op in OPERATIONS.items()
    ]
    show_table(rows, ("op", "keys, [optional]", "what it does"))
    raise typer.Exit


ListOption = Annotated[
    bool,
    typer.Option(
        "--list",
        callback=_show_operations,
        is_eager=True,
        help="List operations and their keys, and leave.",
    ),
]


def edit(  # numpydoc ignore=PR01
    model_file: ModelFile,
    edit_file: EditFile,
    out: OutModel,
    plot: Plot = None,
    report: ReportFile = None,
    list_: ListOption = False,
    json: Json = False,
) -> None:
    """Apply a list of edits to a model; MODEL itself stays as it is."""
    from tempose.signals.edits import load_edits

    began = time.perf_counter()
    check_model_out(out)
    for path in (report, plot):
        if path is not None:
            check_folder(path)
    operations = load_edits(edit_file)
    model = load_signals(model_file)
    loaded = time.perf_counter()
    try:
        edited = model.edited(operations, edit_file.parent)
    except ValueError as error:
        raise ValueError(f"{edit_file}: {error}") from None
    done = time.perf_counter()
    with writing(out):
        edited.save(out)
    signals = edited.signals_
    found = {
        "seconds": {"load": loaded - began, "edit": done - loaded, "save": time.perf_counter() - done},
        "frames": signals.n_frames,
        "fps": signals.fps,
        "duration": signals.duration,
        "operations": len(operations),
        "warnings": edited.report_.get("edit_notes", []),
    }
    inputs = {"model": str(model_file), "edit": str(edit_file), "out": str(out)}
    full = make_report("signals edit", inputs, {}, found, began)
    if report is not None:
        write_report(report, full)
    if plot is not None:
        write_plots(edited, plot)
    for warning in full["warnings"]:
        note(f"note: {warning}")
    if json:
        show_json(full)
    note(f"wrote {out}: {describe(edited)}")
