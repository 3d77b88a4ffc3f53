"""Which ends of a body are head, hands and feet: every choice is tried."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from tempose.embedding.cells import Cells
from tempose.embedding.extremities import Extremities
from tempose.embedding.penalties import TERMS, penalty_terms, thickness_at_ends
from tempose.typing import FloatArray, IntArray

WAY_PER_STATURE = 1.075
"""Way from the top of the head through the body to the tip of the toes, in statures."""


@dataclass(frozen=True)
class Ends:
    """The five ends of a human body."""

    cells: IntArray
    """(5,) cells of head, hand, hand, foot, foot; the sides are not told apart yet."""
    distances: FloatArray
    """(5, N) way from each of them to every cell."""
    size: float
    """Mean way from the head to the feet: about 1.075 of the stature."""
    penalty: float
    """Root mean square of the terms, in standard deviations of the human body."""
    terms: dict[str, float]
    """Each term of the penalty."""


def choose_ends(cells: Cells, found: Extremities) -> Ends | None:
    """Choose head, hands and feet by the least penalty.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    found : Extremities
        Its ends.

    Returns
    -------
    Ends or None
        None with fewer than five ends.
    """
    if len(found.cells) < 5:
        return None
    choices = _choices(len(found.cells))
    terms = penalty_terms(found, thickness_at_ends(cells, found), choices)
    penalties = np.sqrt(np.mean(terms**2, axis=1))
    best = int(penalties.argmin())
    chosen = choices[best]
    return Ends(
        found.cells[chosen],
        found.distances[chosen],
        float(found.between[chosen[0], chosen[3:]].mean()),
        float(penalties[best]),
        {name: float(term) for name, term in zip(TERMS, terms[best])},
    )


def _choices(K: int) -> IntArray:
    rows: list[tuple[int, ...]] = []
    for head in range(K):
        others = [i for i in range(K) if i != head]
        for hands in combinations(others, 2):
            rest = [i for i in others if i not in hands]
            rows += [(head, *hands, *feet) for feet in combinations(rest, 2)]
    return np.array(rows)
