"""A fitted learner as named arrays and a tree of plain values, and back."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import Any

import numpy as np

from tempose.models import ValueTree
from tempose.typing import FloatArray

_HOMES = ("tempose.detail.", "tempose.regression.")
"""Where the classes live that a file may name; nothing else is ever made from it."""


class _LearnerTree(ValueTree):
    """Dataclasses of the learners, by module and name."""

    def label(self, kind: type[Any]) -> dict[str, str] | None:
        here = f"{kind.__module__}.".startswith(_HOMES)
        return {"class": kind.__name__, "module": kind.__module__} if here else None

    def kind_of(self, tree: Mapping[str, Any]) -> type[Any]:
        module, name = str(tree.get("module")), str(tree.get("class"))
        if f"{module}.".startswith(_HOMES):
            try:
                kind = vars(importlib.import_module(module)).get(name)
            except ImportError:
                kind = None
            if isinstance(kind, type) and is_dataclass(kind) and kind.__module__ == module:
                return kind
        raise ValueError(f"unknown part {module}.{name}")

    def to_arrays(self, value: Any, name: str, arrays: dict[str, FloatArray]) -> Any:
        plain = value.item() if isinstance(value, np.generic) else value
        return super().to_arrays(plain, name, arrays)


_TREE = _LearnerTree()
to_arrays, from_arrays = _TREE.to_arrays, _TREE.from_arrays
