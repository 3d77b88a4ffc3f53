"""Signals as named arrays and a tree of plain values, and back: what a model file holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from tempose.clips import Mesh
from tempose.clips.source import Source
from tempose.curves import MonotoneMap, Spline
from tempose.shape_spaces import SPACES, space_from_state
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.signals import Signals
from tempose.signals.time.origin import Origin
from tempose.signals.time.signal import TimeSignal
from tempose.signals.windows import Cover, WindowedPose
from tempose.typing import FloatArray

CLASSES: dict[str, type[Any]] = {
    c.__name__: c
    for c in (
        Cover,
        Mesh,
        MonotoneMap,
        Origin,
        PoseSignal,
        ShapeSignal,
        Signals,
        Source,
        Spline,
        TimeSignal,
        WindowedPose,
    )
}
"""What a file may name; nothing else is ever made from it."""


def to_arrays(value: Any, name: str, arrays: dict[str, FloatArray]) -> Any:
    """Take a value apart.

    Parameters
    ----------
    value : object
        Frozen data of `CLASSES`, shape spaces, arrays, tuples, mappings, numbers, text or None.
    name : str
        What its arrays are called, or their names begin with.
    arrays : dict of str to ndarray
        Filled with the arrays found.

    Returns
    -------
    object
        What JSON can hold: the value without its arrays.
    """
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, np.ndarray):
        arrays[name] = value
        return {"array": name}
    if isinstance(value, tuple | list):
        return [to_arrays(v, f"{name}.{i}", arrays) for i, v in enumerate(value)]
    if isinstance(value, Mapping):
        return {"map": [[k, to_arrays(v, f"{name}.{i}", arrays)] for i, (k, v) in enumerate(value.items())]}
    if type(value).__name__ in CLASSES and is_dataclass(value):
        parts = {
            f.name: to_arrays(getattr(value, f.name), f"{name}.{f.name}", arrays)
            for f in fields(value)
            if f.init
        }
        return {"class": type(value).__name__, "fields": parts}
    if getattr(value, "name", None) in SPACES:
        return {"space": value.name, "state": to_arrays(value.state(), name, arrays)["map"]}
    raise TypeError(f"{name}: a {type(value).__name__} cannot be saved")


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
    if "map" in tree:
        return {k: from_arrays(v, arrays) for k, v in tree["map"]}
    if "space" in tree:
        return space_from_state(tree["space"], {k: from_arrays(v, arrays) for k, v in tree["state"]})
    if tree.get("class") not in CLASSES:
        raise ValueError(f"unknown part {tree.get('class')!r}")
    return CLASSES[tree["class"]](**{k: from_arrays(v, arrays) for k, v in tree["fields"].items()})
