"""Which tick of the captured clip a tick of the edited one comes from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tempose._validate import read_only
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Origin:
    """Pieces of the captured clip, one after another; cuts, loops and pastes make more of them."""

    starts: FloatArray
    """(K,) ticks where the pieces begin, ascending, the first 0."""
    sources: FloatArray
    """(K,) ticks of the captured clip at those starts."""
    directions: FloatArray
    """(K,) 1, or -1 where a piece runs backwards, or 0 where inserted frames hold a place."""

    def __post_init__(self) -> None:
        for name in ("starts", "sources", "directions"):
            object.__setattr__(self, name, read_only(np.array(getattr(self, name), dtype=np.float64)))

    def __call__(self, ticks: FloatArray) -> FloatArray:
        """Return the captured ticks.

        Parameters
        ----------
        ticks : (...) float
            Ticks of the edited clip.

        Returns
        -------
        (...) ndarray
            Ticks of the captured clip.
        """
        ticks = np.asarray(ticks, dtype=np.float64)
        i = np.maximum(np.searchsorted(self.starts, ticks, side="right") - 1, 0)
        return self.sources[i] + self.directions[i] * (ticks - self.starts[i])


def splice_origin(
    origin: Origin | None, pieces: Sequence[tuple[float, float]], gaps: Sequence[float]
) -> Origin | None:
    """Return the origin of pieces put one after another.

    Parameters
    ----------
    origin : Origin or None
        Of the clip that they are cut from.
    pieces : sequence of (start, stop)
        Ticks; a stop before the start runs backwards.
    gaps : sequence of float
        Ticks inserted after each piece, the last may have none; their first half belongs to the piece before.

    Returns
    -------
    Origin or None
        None where nothing but the end was cut off.
    """
    if origin is None and len(pieces) == 1 and pieces[0][0] == 0.0 and not any(gaps):
        return None
    whole = Origin(np.zeros(1), np.zeros(1), np.ones(1)) if origin is None else origin
    starts, sources, directions = (list[float]() for _ in range(3))
    clock = 0.0
    for i, (a, b) in enumerate(pieces):
        rows = _cut(whole, a, b)
        for start, source, direction in rows:
            starts.append(clock + start)
            sources.append(source)
            directions.append(direction)
        clock += abs(b - a)
        gap = gaps[i] if i < len(gaps) else 0.0
        if gap > 0:
            last = rows[-1][1] + rows[-1][2] * (abs(b - a) - rows[-1][0])
            following = pieces[(i + 1) % len(pieces)]
            starts += [clock, clock + 0.5 * gap]
            sources += [last, _cut(whole, *following)[0][1]]
            directions += [0.0, 0.0]
            clock += gap
    return Origin(np.array(starts), np.array(sources), np.array(directions))


def _cut(origin: Origin, a: float, b: float) -> list[tuple[float, float, float]]:
    # (start in the piece, source, direction) of what lies between two ticks
    low, high, way = min(a, b), max(a, b), 1.0 if b > a else -1.0
    inner = origin.starts[(origin.starts > low) & (origin.starts < high)]
    edges = np.concatenate([[low], inner, [high]])
    rows: list[tuple[float, float, float]] = []
    for left, right in pairwise(edges):
        i = max(int(np.searchsorted(origin.starts, left, side="right")) - 1, 0)
        start = left - low if way > 0 else high - right
        tick = left if way > 0 else right
        source = origin.sources[i] + origin.directions[i] * (tick - origin.starts[i])
        rows.append((float(start), float(source), way * float(origin.directions[i])))
    return rows if way > 0 else rows[::-1]
