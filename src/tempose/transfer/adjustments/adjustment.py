"""One adjustment: a part, a moment, what shall be different there."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose._validate import as_floats
from tempose.rotations import from_rotation_vector, normalise
from tempose.typing import FloatArray, IntArray

AXES = ("world", "body", "part")
EASE = 0.4
"""Seconds in which an adjustment comes and goes unless told otherwise."""
_KEYS = (
    "part", "frame", "time", "move", "to", "turn", "axes", "ease_in", "ease_out", "hold", "follow", "swivel",
)  # fmt: skip


@dataclass(frozen=True)
class Adjustment:
    """Move or turn a part at one moment; the change comes and goes smoothly round it.

    Parameters
    ----------
    part : str or sequence of int
        Body role (``"left_hand"``), joint name of the source, ``"root"`` for the whole body, or 0-based
        vertices of the target.
    frame : int, optional
        Key frame of the result, 0-based; either this or `time`.
    time : float, optional
        Seconds; the nearest frame is the key.
    move : (3,) float, optional
        By how much the part's point is displaced, metres.
    to : (3,) float, optional
        Where the part's point shall be, metres, Y up; instead of `move`. The point is the joint at which the
        part starts (the wrist of a hand), or the mean of the vertices.
    turn : (3,) or (4,) float, optional
        Additional turn about that joint: axis times degrees, or a quaternion wxyz.
    axes : {"world", "body", "part"}, default "world"
        Axes of `move` and `turn`: of the world; of the body's heading at the key frame (X to its left, Z to
        the front); or fixed to the part, those of the world when the target is at rest.
    ease_in, ease_out : float, default 0.4
        Seconds before and after in which the change comes and goes; 0 for a jump.
    hold : float, default 0
        Seconds for which it stays in full force after the key frame; with `to` the part stands still there.
    follow : bool, optional
        Whether a hand or foot turns with the forearm or shin that is moved. Hands do, feet do not.
    swivel : float, optional
        Degrees by which the elbow or knee turns about the line from shoulder or hip to the hand or foot,
        which stays; positive outwards.

    Raises
    ------
    ValueError
        If a value is missing, contradicts another or is out of range; the message names it.

    Examples
    --------
    >>> Adjustment("left_hand", frame=40, move=(0, 0.25, 0)).record()
    {'part': 'left_hand', 'frame': 40, 'move': [0.0, 0.25, 0.0]}
    """

    part: str | Sequence[int] | IntArray
    frame: int | None = None
    time: float | None = None
    move: Sequence[float] | FloatArray | None = None
    to: Sequence[float] | FloatArray | None = None
    turn: Sequence[float] | FloatArray | None = None
    axes: str = "world"
    ease_in: float = EASE
    ease_out: float = EASE
    hold: float = 0.0
    follow: bool | None = None
    swivel: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "part", _part(self.part))
        if (self.frame is None) == (self.time is None):
            raise ValueError("an adjustment needs either frame or time")
        if self.frame is not None and (type(self.frame) is not int or self.frame < 0):
            raise ValueError(f"frame must be a whole number from 0, got {self.frame!r}")
        for name in ("time", "ease_in", "ease_out", "hold"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _seconds(getattr(self, name), name))
        if self.move is not None and self.to is not None:
            raise ValueError("move and to contradict each other; give one of them")
        if self.move is None and self.to is None and self.turn is None and self.swivel is None:
            raise ValueError("an adjustment needs move, to, turn or swivel")
        if self.swivel is not None:
            object.__setattr__(self, "swivel", float(as_floats(self.swivel, "swivel", ())))
        for name in ("move", "to", "turn"):
            value = getattr(self, name)
            if value is not None:
                size: Any = "3 or 4" if name == "turn" and np.shape(value) == (4,) else 3
                object.__setattr__(self, name, tuple(map(float, as_floats(value, name, (size,)))))
        if self.turn is not None and len(self.turn) == 4 and not 0.99 < np.linalg.norm(self.turn) < 1.01:
            raise ValueError(
                f"turn must be a unit quaternion wxyz, got length {np.linalg.norm(self.turn):.3g}"
            )
        if self.axes not in AXES:
            raise ValueError(f"axes must be one of {', '.join(AXES)}, got {self.axes!r}")
        if self.follow is not None and type(self.follow) is not bool:
            raise ValueError(f"follow must be true or false, got {self.follow!r}")

    @property
    def moves(self) -> bool:
        """Whether a point is moved, not only turned."""
        return self.move is not None or self.to is not None

    @property
    def rotation(self) -> FloatArray | None:
        """(4,) quaternion wxyz of `turn`."""
        if self.turn is None:
            return None
        if len(self.turn) == 4:
            return normalise(np.array(self.turn))
        return from_rotation_vector(np.radians(self.turn))

    def key(self, n_frames: int, fps: float) -> int:
        """Find the key frame in a clip.

        Parameters
        ----------
        n_frames : int
            Number of frames T.
        fps : float
            Frames per second.

        Returns
        -------
        int
            0 to T - 1.

        Raises
        ------
        ValueError
            If the clip has no such frame.
        """
        frame = self.frame if self.frame is not None else round((self.time or 0.0) * fps)
        if frame >= n_frames:
            what = f"frame {frame}" if self.time is None else f"time {self.time:g} s (frame {frame})"
            raise ValueError(f"{self.name}: {what} is not in the clip, whose last frame is {n_frames - 1}")
        return frame

    @property
    def name(self) -> str:
        """What to call it in a message."""
        part = self.part if isinstance(self.part, str) else f"{len(self.part)} vertices"
        return f"adjustment of {part!r}" if isinstance(self.part, str) else f"adjustment of {part}"

    def record(self) -> dict[str, Any]:
        """Return what is not at its default, ready for JSON.

        Returns
        -------
        dict
            Which `from_record` reads back.
        """
        out: dict[str, Any] = {}
        for name in _KEYS:
            value = getattr(self, name)
            if name == "part" or value != getattr(type(self), name):
                out[name] = list(value) if isinstance(value, tuple) else value
        return out

    @staticmethod
    def from_record(data: Any) -> Adjustment:
        """Make an adjustment from what JSON holds.

        Parameters
        ----------
        data : dict
            Names and values of the fields.

        Returns
        -------
        Adjustment
            The same.

        Raises
        ------
        ValueError
            If it is no table, has no part, an unknown key, or a value that cannot be.
        """
        if not isinstance(data, dict):
            raise ValueError(f'expected a table such as {{"part": ..., "frame": ...}}, found {data!r:.60}')
        for key in data:
            if key not in _KEYS:
                near = difflib.get_close_matches(str(key), _KEYS, 1)
                hint = f"; did you mean {near[0]!r}?" if near else ""
                raise ValueError(f"unknown key {key!r}; known are {', '.join(_KEYS)}{hint}")
        if "part" not in data:
            raise ValueError("an adjustment needs a part")
        return Adjustment(**data)


def _part(part: Any) -> str | tuple[int, ...]:
    if isinstance(part, str) and part:
        return part
    if isinstance(part, Sequence | np.ndarray) and not isinstance(part, str) and len(part):
        values = np.asarray(part)
        if values.ndim == 1 and values.dtype.kind in "iu" and values.min() >= 0:
            return tuple(dict.fromkeys(int(v) for v in values))
    raise ValueError(f"part must be a name or a list of vertices from 0, got {part!r:.60}")


def _seconds(value: Any, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < float("inf"):
        raise ValueError(f"{name} must be seconds, 0 or more, got {value!r}")
    return float(value)
