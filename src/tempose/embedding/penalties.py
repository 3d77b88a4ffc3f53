"""How unlike a human's the ends of a body are."""

from __future__ import annotations

import numpy as np

from tempose.embedding.cells import Cells
from tempose.embedding.extremities import Extremities
from tempose.typing import FloatArray, IntArray

TERMS = ("head-hand", "hands", "feet", "hand-foot", "arms alike", "legs alike", "upright", "head", "hand")
"""What is compared, in the order of `penalty_terms`."""
_USUAL = np.log([0.60, 0.87, 1.03, 1.13])
_SPREAD = np.array([0.07, 0.09, 0.045, 0.06])
_ALIKE = np.array([0.06, 0.09])
_STRAIGHT, _BENT = 0.92, 0.06
_THICK, _THICK_SPREAD = np.log([0.040, 0.014]), 0.45
_THICK_REACH = 0.13


def penalty_terms(found: Extremities, thickness: FloatArray, choices: IntArray) -> FloatArray:
    """Compare choices of head, hands and feet with the human body, in standard deviations.

    Parameters
    ----------
    found : Extremities
        K ends of a body.
    thickness : (K,) float
        From `thickness_at_ends`.
    choices : (C, 5) int
        Which end is head, hand, hand, foot, foot.

    Returns
    -------
    (C, 9) ndarray
        See `TERMS`. Lengths are ways through the inside, as shares of the way from head to feet, which no
        pose changes much; only ``upright`` depends on the pose.
    """
    head, a, b, f, g = choices.T
    D = found.between
    size = (D[head, f] + D[head, g]) / 2
    lengths = [
        (D[head, a] + D[head, b]) / 2,
        D[a, b],
        D[f, g],
        (D[a, f] + D[a, g] + D[b, f] + D[b, g]) / 4,
    ]
    ratios = np.log(np.array(lengths) / size)
    terms = list((ratios - _USUAL[:, None]) / _SPREAD[:, None])
    terms.append(np.log(D[head, a] / D[head, b]) / _ALIKE[0])
    terms.append(np.log(D[head, f] / D[head, g]) / _ALIKE[1])
    X = found.points
    chord = [np.linalg.norm(X[head] - X[foot], axis=1) / D[head, foot] for foot in (f, g)]
    terms.append(np.maximum(_STRAIGHT - np.mean(chord, axis=0), 0) / _BENT)
    thick = np.log(np.maximum(np.array([thickness[head], (thickness[a] + thickness[b]) / 2]) / size, 1e-6))
    terms += list((thick - _THICK[:, None]) / _THICK_SPREAD)
    return np.array(terms).T


def thickness_at_ends(cells: Cells, found: Extremities) -> FloatArray:
    """Radius of the largest sphere near each end.

    Parameters
    ----------
    cells : Cells
        The inside of a mesh.
    found : Extremities
        Its K ends.

    Returns
    -------
    (K,) ndarray
        In the unit of the mesh; near means within 13 % of a typical way from end to end.
    """
    reach = _THICK_REACH * float(np.median(found.between[found.between > 0])) if len(found.cells) > 1 else 0.0
    return np.array([cells.depth[D <= reach].max() for D in found.distances])
