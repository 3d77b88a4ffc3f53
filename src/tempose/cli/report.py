"""The report that every method writes with `--report`."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tempose
from tempose._files import atomic_path
from tempose.cli.console import plain, writing


def make_report(
    command: str,
    inputs: Mapping[str, Any],
    options: Mapping[str, Any],
    found: Mapping[str, Any],
    start: float,
) -> dict[str, Any]:
    """Put what a method found under the keys that all reports share.

    Parameters
    ----------
    command : str
        Name of the command.
    inputs : mapping
        Files it was given.
    options : mapping
        Options it was given, also those left at their defaults.
    found : mapping
        What the method says: ``seconds`` a stage, ``errors``, ``warnings`` and its own measures.
    start : float
        `time.perf_counter` when the command began.

    Returns
    -------
    dict
        ``command``, ``version``, ``inputs``, ``options``, ``seconds`` with ``total``, ``errors``,
        ``baselines``, ``heldout``, ``warnings``, then what the method adds.
    """
    rest = {key: value for key, value in found.items() if key not in ("seconds", "warnings")}
    return {
        "command": command,
        "version": tempose.__version__,
        "inputs": dict(inputs),
        "options": dict(options),
        "seconds": {**found.get("seconds", {}), "total": time.perf_counter() - start},
        "errors": {},
        "baselines": {},
        "heldout": {},
        "warnings": list(found.get("warnings", ())),
        **rest,
    }


def write_report(path: Path, report: Mapping[str, Any]) -> None:
    """Write a report as JSON, whole or not at all.

    Parameters
    ----------
    path : Path
        Final name.
    report : mapping
        As `make_report` gives it.

    Raises
    ------
    OSError
        If the place cannot be written; the message names it.
    """
    text = json.dumps(plain(dict(report)), indent=2, allow_nan=False) + "\n"
    with writing(path), atomic_path(path) as part:
        part.write_text(text, encoding="utf-8")
