"""Edit lists: read from a file, checked and applied in their order. Undo is leaving out the last entry."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tempose._tables import read_table
from tempose.signals.edits.operations import OPERATIONS
from tempose.signals.signals import Signals


def load_edits(path: str | os.PathLike[str]) -> list[dict[str, Any]]:
    """Read an edit list from a file.

    Parameters
    ----------
    path : path-like
        JSON or TOML: ``{"operations": [{"op": "move", "control": 12, "by": [0.1, 0.0]}, ...]}``.

    Returns
    -------
    list of dict
        The operations, their names, keys and kinds of values checked.

    Raises
    ------
    ValueError
        If the file holds anything else; the message names the file and the entry.
    OSError
        If it cannot be opened.
    """
    path = Path(path)
    data = read_table(path)
    if list(data) != ["operations"] or not isinstance(data["operations"], list):
        raise ValueError(f'{path}: expected {{"operations": [...]}} and no other key')
    try:
        check_edits(data["operations"])
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return data["operations"]


def check_edits(operations: Sequence[Mapping[str, Any]]) -> None:
    """Check names, keys and kinds of values of all operations, before the first is applied.

    Parameters
    ----------
    operations : sequence of mapping
        As in a file.

    Raises
    ------
    ValueError
        If an operation is none; the message says which, counted from 0.
    """
    for i, entry in enumerate(operations):
        _arguments(i, entry)


def apply_edits(
    signals: Signals,
    operations: Sequence[Mapping[str, Any]],
    folder: str | os.PathLike[str] | None = None,
    notes: list[str] | None = None,
) -> Signals:
    """Apply edits one after another.

    Parameters
    ----------
    signals : Signals
        A fitted clip; stays as it is, whatever happens.
    operations : sequence of mapping
        As in a file: the name under ``op``, and the keys of `OPERATIONS`. Frames count from 0 in what is
        played at that point of the list.
    folder : path-like, optional
        Where file names count from; the working folder by default.
    notes : list of str, optional
        Gets what a person should know of what was done: the share of a motion that examples cannot show.

    Returns
    -------
    Signals
        The edited clip.

    Raises
    ------
    ValueError
        If an operation cannot be applied; the message says which, counted from 0.
    """
    check_edits(operations)
    i = 0
    while i < len(operations):
        name, operation, arguments = _arguments(i, operations[i])
        here, said = f"operation {i} ({name})", list[str]()
        i += 1
        if operation.together is not None:
            run = [arguments]
            while i < len(operations) and operations[i]["op"] == name:
                run.append(_arguments(i, operations[i])[2])
                i += 1
            arguments = operation.together(run)
        if operation.reads_files:
            arguments |= {"folder": Path(folder or "."), "notes": said}
        try:
            signals = operation.function(signals, **arguments)
        except (ValueError, OSError) as error:
            raise ValueError(f"{here}: {error}") from error
        if notes is not None:
            notes += [f"{here}: {note}" for note in said]
    return signals


def _arguments(i: int, entry: Any) -> tuple[str, Any, dict[str, Any]]:
    if not isinstance(entry, Mapping) or not isinstance(entry.get("op"), str):
        raise ValueError(f'operation {i} must be a table with a key "op", got {entry!r}')
    name = entry["op"]
    if name not in OPERATIONS:
        raise ValueError(f"operation {i}: unknown op {name!r}; known are {', '.join(OPERATIONS)}")
    operation = OPERATIONS[name]
    try:
        values = {str(key): value for key, value in entry.items() if key != "op"}
        return name, operation, operation.arguments(values)
    except ValueError as error:
        raise ValueError(f"operation {i} ({name}): {error}") from None
