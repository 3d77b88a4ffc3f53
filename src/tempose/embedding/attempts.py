"""Several readings of what is joined inside a mesh; the most human one counts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tempose.embedding.cells import Cells, make_cells
from tempose.embedding.doubt import whole_penalty
from tempose.embedding.extremities import find_extremities
from tempose.embedding.limbs import Limbs, cut_limbs
from tempose.embedding.pinch import pinch_walls, sphere_regions
from tempose.embedding.search import Ends, choose_ends
from tempose.embedding.solid import Solid
from tempose.embedding.spheres import pack_spheres

_GOOD = 0.85
_HOPELESS = 3
_NECKS, _CUT = (0.5, 0.75), 1.25


@dataclass(frozen=True)
class Attempt:
    """One reading of a body."""

    cells: Cells
    """The inside."""
    reading: str
    """``"surface"``: limbs that touch are apart; ``"volume"``: what touches is joined; ``"necks"``: cut at
    narrow necks."""
    n_ends: int
    """Number of ends that stand out."""
    ends: Ends | None = None
    """Head, hands, feet; None when fewer than five ends stand out."""
    limbs: Limbs | None = None
    """The parts of the body."""
    penalty: float = float("inf")
    """1 where doubt begins."""
    terms: dict[str, float] | None = None
    """Terms of the penalty, in standard deviations."""


def read_body(solid: Solid) -> Attempt:
    """Read a body in ways that are tried one after the other until one is human.

    Parameters
    ----------
    solid : Solid
        The inside of a mesh.

    Returns
    -------
    Attempt
        The first that is clearly human, else that of least penalty.
    """
    best: Attempt | None = None
    for cells, reading in _readings(solid):
        attempt = _attempt(cells, reading)
        if best is None or attempt.penalty < best.penalty:
            best = attempt
        if best.penalty < _GOOD or (reading == "volume" and best.n_ends < _HOPELESS):
            break
    assert best is not None
    return best


def _readings(solid: Solid) -> Iterator[tuple[Cells, str]]:
    apart = make_cells(solid, solid.walls)
    if apart is not None:
        yield apart, "surface"
    joined = make_cells(solid, None)
    assert joined is not None
    yield joined, "volume"
    spheres = pack_spheres(joined)
    owner = sphere_regions(joined, spheres)
    for narrow in _NECKS:
        cut = make_cells(solid, pinch_walls(joined, spheres, owner, narrow))
        if cut is not None:
            yield cut, "necks"


def _attempt(cells: Cells, reading: str) -> Attempt:
    found = find_extremities(cells)
    ends = choose_ends(cells, found)
    if ends is None:
        return Attempt(cells, reading, len(found.cells))
    limbs = cut_limbs(cells, ends)
    penalty, terms = whole_penalty(ends, limbs)
    # what had to be cut to look human is trusted less
    penalty *= _CUT if reading == "necks" else 1.0
    return Attempt(cells, reading, len(found.cells), ends, limbs, penalty, terms)
