"""Designs as files that a person writes by hand."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from tempose._tables import read_table
from tempose.signals.design.design import design
from tempose.signals.edits import keys as check
from tempose.signals.replace_shape.poses import load_poses
from tempose.signals.signals import Signals

NEEDED = {"poses": check.texts, "places": check.pairs, "curve": check.pairs}
"""Keys that must be there, and what checks their values."""

OPTIONAL = {
    "fps": check.number,
    "seconds": check.number,
    "space": check.text,
    "closed": check.flag,
    "align": check.flag,
}
"""Keys that may be there: the arguments of `design`."""


def load_design(path: str | os.PathLike[str]) -> Signals:
    """Make the clip that a file describes.

    Parameters
    ----------
    path : path-like
        JSON or TOML: ``{"poses": ["1.obj", ...], "places": [[x, y], ...], "curve": [[x, y], ...], "fps": 30,
        "seconds": 2}``; file names count from the folder of this file. ``space``, ``closed`` and ``align``
        are as for `design`.

    Returns
    -------
    Signals
        The clip.

    Raises
    ------
    ValueError
        If the file holds anything else or a pose cannot be read; the message names the file.
    OSError
        If it cannot be opened.
    """
    path = Path(path)
    table = read_table(path)
    try:
        values = _checked(table)
        poses = load_poses(values.pop("poses"), path.parent, "poses")
        return design(poses, **values)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error


def _checked(table: dict[str, Any]) -> dict[str, Any]:
    known = {**NEEDED, **OPTIONAL}
    for key in table:
        if key not in known:
            raise ValueError(f"unknown key {key!r}; known are {', '.join(known)}")
    for key in NEEDED:
        if key not in table:
            raise ValueError(f"needs the key {key!r}; known are {', '.join(known)}")
    return {key: known[key](value, key) for key, value in table.items()}
