"""What `tempose transfer` is told about feet and ground."""

from __future__ import annotations

import math
from pathlib import Path

from tempose._tables import read_table


def load_contacts(path: Path | None, hold: bool) -> bool | dict[str, list[list[int]]]:
    """Load the contacts that the user states.

    Parameters
    ----------
    path : Path or None
        JSON or TOML: foot name to a list of intervals [first frame, first frame after it].
    hold : bool
        What ``--contacts`` was given.

    Returns
    -------
    bool or dict
        As `tempose.transfer.transfer_motion` takes them; `hold` without a file.

    Raises
    ------
    ValueError
        If the file holds anything else, or contacts are stated and not wanted.
    """
    if path is None:
        return hold
    if not hold:
        raise ValueError("--no-contacts and --contact-frames contradict each other; give one of them")
    table = read_table(path)
    if not all(isinstance(value, list) for value in table.values()):
        raise ValueError(f'{path}: expected one table such as {{"left_foot": [[0, 24], [51, 78]]}}')
    return table


def parse_ground(text: str | None) -> float | None:
    """Read the height of the ground plane.

    Parameters
    ----------
    text : str or None
        Metres, or ``none``.

    Returns
    -------
    float or None
        Metres; None for no plane.

    Raises
    ------
    ValueError
        If it is neither.
    """
    if text is None or text.strip().lower() == "none":
        return None
    try:
        height = float(text)
    except ValueError:
        height = math.nan
    if not math.isfinite(height):
        raise ValueError(f"--ground must be a height in metres or none, got {text!r}")
    return height
