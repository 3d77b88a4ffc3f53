"""Adjustments to and from files that a person can edit."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tempose._files import atomic_path
from tempose._tables import read_table
from tempose.transfer.adjustments.adjustment import Adjustment


def load_adjustments(path: str | os.PathLike[str]) -> tuple[Adjustment, ...]:
    """Read adjustments from a file.

    Parameters
    ----------
    path : path-like
        JSON or TOML with a list ``adjustments`` of tables whose keys are the parameters of `Adjustment`.

    Returns
    -------
    tuple of Adjustment
        In their order.

    Raises
    ------
    ValueError
        If the file holds anything else; the message names the file and the entry.
    OSError
        If it cannot be opened.
    """
    path = Path(path)
    data = read_table(path)
    if list(data) != ["adjustments"] or not isinstance(data["adjustments"], list):
        raise ValueError(f'{path}: expected {{"adjustments": [...]}} and no other key')
    return tuple(_entry(path, i, entry) for i, entry in enumerate(data["adjustments"]))


def _entry(path: Path, i: int, data: Any) -> Adjustment:
    try:
        return Adjustment.from_record(data)
    except ValueError as error:
        raise ValueError(f"{path}: adjustment {i}: {error}") from None


def save_adjustments(path: str | os.PathLike[str], adjustments: Sequence[Adjustment]) -> None:
    """Write adjustments as JSON, one a line.

    Parameters
    ----------
    path : path-like
        Where to write.
    adjustments : sequence of Adjustment
        What to write.
    """
    rows = ",\n  ".join(json.dumps(a.record()) for a in adjustments)
    body = f"[\n  {rows}\n ]" if rows else "[]"
    with atomic_path(path) as part:
        part.write_text(f'{{"adjustments": {body}}}\n', encoding="utf-8")
