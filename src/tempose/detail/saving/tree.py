"""A fitted learner as named arrays and a tree of plain values, and back."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from tempose.typing import FloatArray

_HOMES = ("tempose.detail.", "tempose.regression.")
"""Where the classes live that a file may name; nothing else is ever made from it."""


def to_arrays(value: Any, name: str, arrays: dict[str, FloatArray]) -> Any:
    """Take a value apart.

    Parameters
    ----------
    value : object
        Dataclasses of the learners, arrays, sequences, numbers, text or None. Fields that a class makes
        itself (``init=False``) are left out.
    name : str
        What its arrays are called, or their names begin with.
    arrays : dict of str to ndarray
        Filled with the arrays found.

    Returns
    -------
    object
        What JSON can hold: the value without its arrays.

    Raises
    ------
    TypeError
        If a value is of another kind.
    """
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        arrays[name] = value
        return {"array": name}
    if isinstance(value, tuple | list):
        return [to_arrays(v, f"{name}.{i}", arrays) for i, v in enumerate(value)]
    kind = type(value)
    if is_dataclass(value) and f"{kind.__module__}.".startswith(_HOMES):
        parts = {
            f.name: to_arrays(getattr(value, f.name), f"{name}.{f.name}", arrays)
            for f in fields(value)
            if f.init
        }
        return {"class": kind.__name__, "module": kind.__module__, "fields": parts}
    raise TypeError(f"{name}: a {kind.__name__} cannot be saved")


def from_arrays(tree: Any, arrays: Mapping[str, FloatArray]) -> Any:
    """Put a value together again.

    Parameters
    ----------
    tree : object
        As `to_arrays` returned it.
    arrays : mapping of str to ndarray
        The arrays it filled in.

    Returns
    -------
    object
        The same value; lists have become tuples.

    Raises
    ------
    ValueError
        If the tree names what does not exist, or the parts do not fit.
    """
    if isinstance(tree, list):
        return tuple(from_arrays(part, arrays) for part in tree)
    if not isinstance(tree, dict):
        return tree
    if "array" in tree:
        return arrays[tree["array"]]
    kind = _class(str(tree.get("module")), str(tree.get("class")))
    return kind(**{k: from_arrays(v, arrays) for k, v in tree["fields"].items()})


def _class(module: str, name: str) -> type[Any]:
    if f"{module}.".startswith(_HOMES):
        try:
            kind = vars(importlib.import_module(module)).get(name)
        except ImportError:
            kind = None
        if isinstance(kind, type) and is_dataclass(kind) and kind.__module__ == module:
            return kind
    raise ValueError(f"unknown part {module}.{name}")
