"""Tables out of files that a person writes by hand."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any


def read_table(path: Path) -> dict[str, Any]:
    """Read a JSON or TOML file.

    Parameters
    ----------
    path : Path
        ``.toml`` is read as TOML, anything else as JSON.

    Returns
    -------
    dict
        What it holds.

    Raises
    ------
    ValueError
        If it is broken or holds no table; the message names the file.
    OSError
        If it cannot be opened.
    """
    suffix = path.suffix.lower()
    try:
        text = path.read_text(encoding="utf-8-sig")
        data: Any = tomllib.loads(text) if suffix == ".toml" else json.loads(text)
    except RecursionError:
        raise ValueError(f"{path}: expected a table, but its brackets are nested too deep") from None
    except ValueError as error:
        kind = {".toml": "TOML", ".json": "JSON"}.get(suffix, "JSON or TOML")
        raise ValueError(f"{path}: expected {kind}: {error}") from None
    if not isinstance(data, dict):
        raise ValueError(f"{path}: expected a table in braces, found {type(data).__name__}")
    return data
