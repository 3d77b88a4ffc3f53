"""Signals as named arrays and a tree of plain values, and back: what a model file holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tempose.clips import Mesh
from tempose.clips.source import Source
from tempose.curves import MonotoneMap, Spline
from tempose.models import ValueTree
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


class _SignalTree(ValueTree):
    """Frozen data of `CLASSES`, mappings and shape spaces."""

    def label(self, kind: type[Any]) -> dict[str, str] | None:
        return {"class": kind.__name__} if kind.__name__ in CLASSES else None

    def kind_of(self, tree: Mapping[str, Any]) -> type[Any]:
        if tree.get("class") not in CLASSES:
            raise ValueError(f"unknown part {tree.get('class')!r}")
        return CLASSES[tree["class"]]

    def to_arrays(self, value: Any, name: str, arrays: dict[str, FloatArray]) -> Any:
        if isinstance(value, Mapping):
            items = enumerate(value.items())
            return {"map": [[k, self.to_arrays(v, f"{name}.{i}", arrays)] for i, (k, v) in items]}
        # a shape space tells its state itself; frozen data may have a name, too
        if type(value).__name__ not in CLASSES and getattr(value, "name", None) in SPACES:
            return {"space": value.name, "state": self.to_arrays(value.state(), name, arrays)["map"]}
        return super().to_arrays(value, name, arrays)

    def from_arrays(self, tree: Any, arrays: Mapping[str, FloatArray]) -> Any:
        if isinstance(tree, dict) and "array" not in tree:
            if "map" in tree:
                return {k: self.from_arrays(v, arrays) for k, v in tree["map"]}
            if "space" in tree:
                state = {k: self.from_arrays(v, arrays) for k, v in tree["state"]}
                return space_from_state(tree["space"], state)
        return super().from_arrays(tree, arrays)


_TREE = _SignalTree()
to_arrays, from_arrays = _TREE.to_arrays, _TREE.from_arrays
