"""Learned detail: training and posing against plain numpy, in one run."""

from __future__ import annotations

import importlib
from typing import Any

PARTS = ("detail_training", "detail_posing")
"""Modules beside this one whose `rows` make up the table."""


def run() -> list[dict[str, Any]]:
    """Rows of the table."""
    found: list[dict[str, Any]] = []
    for name in PARTS:
        found += importlib.import_module(name).rows()
    return found


if __name__ == "__main__":
    for entry in run():
        print(entry["name"], entry["value"], entry.get("ratio"), entry.get("goal", ""))
