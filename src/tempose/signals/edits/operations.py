"""The edits by name, with the keys of each, as they stand in an edit list."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tempose.signals.edits import keys as check
from tempose.signals.edits.bridge import blend, insert_curve
from tempose.signals.edits.controls import insert_control, move_control, place_control
from tempose.signals.edits.from_files import add_pose_from, replace_shape_from
from tempose.signals.edits.keys import Check
from tempose.signals.edits.layout import pin_frames, repair_transitions
from tempose.signals.edits.pieces import close_loop, cut, keep, loop, paste, reverse
from tempose.signals.edits.timing import retime, set_fps, set_speed
from tempose.signals.signals import Signals

PYTHON_NAMES = {"from": "start", "to": "stop"}
"""Keys that are no names in Python, and what the functions call them."""


@dataclass(frozen=True)
class Operation:
    """An entry of an edit list."""

    function: Callable[..., Signals]
    """Takes signals, then the keys as arguments; `from` is `start` there and `to` is `stop`."""
    needed: Mapping[str, Check]
    """Keys that must be there, and what checks their values."""
    help: str
    """One line for a person to read."""
    optional: Mapping[str, Check] = field(default_factory=dict[str, Check])
    """Keys that may be there."""
    reads_files: bool = False
    """Whether the function takes `folder`, where file names count from, and a list `notes` to add to."""
    together: Callable[[list[dict[str, Any]]], dict[str, Any]] | None = None
    """Makes the arguments of one call out of those of entries that follow one another directly."""

    def arguments(self, entry: Mapping[str, Any]) -> dict[str, Any]:
        """Check an entry and return the arguments of the function.

        Parameters
        ----------
        entry : mapping
            From the file, without ``op``.

        Returns
        -------
        dict of str to object
            By the function's names.

        Raises
        ------
        ValueError
            If a key is missing or unknown, or its value is of another kind.
        """
        known = {**self.needed, **self.optional}
        unknown = [key for key in entry if key not in known]
        if unknown:
            raise ValueError(f"unknown key {unknown[0]!r}; known are {', '.join(known)}")
        missing = [key for key in self.needed if key not in entry]
        if missing:
            raise ValueError(f"needs the key {missing[0]!r}; its keys are {', '.join(known)}")
        return {PYTHON_NAMES.get(key, key): known[key](value, key) for key, value in entry.items()}


_SPAN = {"from": check.number, "to": check.number}

OPERATIONS: dict[str, Operation] = {
    "move": Operation(
        move_control, {"control": check.whole, "by": check.place}, "move a control point of the curve"
    ),
    "place": Operation(
        place_control, {"control": check.whole, "at": check.place}, "put a control point somewhere"
    ),
    "insert_control": Operation(
        insert_control, {"at": check.number}, "one control point more at a frame; nothing played changes"
    ),
    "loop": Operation(loop, {**_SPAN, "times": check.whole}, "play a part so many times in all"),
    "close_loop": Operation(
        close_loop, _SPAN, "keep a part that repeats without a seam", {"insert": check.whole}
    ),
    "cut": Operation(cut, _SPAN, "take a part out"),
    "keep": Operation(keep, _SPAN, "keep a part, drop the rest"),
    "paste": Operation(paste, {**_SPAN, "at": check.number}, "copy a part to another moment"),
    "reverse": Operation(reverse, _SPAN, "play a part backwards"),
    "blend": Operation(
        blend, {**_SPAN, "frames": check.number}, "let one place of the curve run over into another"
    ),
    "insert_curve": Operation(
        insert_curve,
        {"at": check.number, "points": check.pairs, "frames": check.number},
        "leave the curve at a frame, run through drawn points and come back",
    ),
    "retime": Operation(
        retime,
        {},
        "change which moment is played when",
        {"times": check.numbers, "keys": check.pairs},
    ),
    "speed": Operation(
        set_speed, {**_SPAN, "factor": check.number}, "play a part faster or slower", {"ease": check.number}
    ),
    "fps": Operation(set_fps, {"value": check.number}, "frames played a second"),
    "pin": Operation(
        pin_frames,
        {"frame": check.number, "at": check.place},
        "give a frame its place in the plane; pins that follow one another directly hold together",
        together=lambda run: {"pins": {entry["frame"]: entry["at"] for entry in run}},
    ),
    "repair": Operation(repair_transitions, {}, "lay the plane out anew where transitions are bad"),
    "add_pose": Operation(
        add_pose_from,
        {"file": check.text, "at": check.place},
        "give a sculpted mesh a place",
        reads_files=True,
    ),
    "replace_shape": Operation(
        replace_shape_from,
        {"source": check.texts, "target": check.texts},
        "play another mesh, by pairs of poses",
        {
            "space": check.text,
            "use": check.whole,
            "ridge": check.number,
            "scale": check.scale,
            "regions": check.whole,
        },
        reads_files=True,
    ),
}
"""Operation of each name, in the order in which the guide explains them."""
