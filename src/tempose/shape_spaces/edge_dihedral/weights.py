"""How much edges and hinges count."""

from __future__ import annotations

import numpy as np

from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.shape_spaces.edge_dihedral.reference import Reference
from tempose.shape_spaces.edge_dihedral.triangles import areas_from_lengths
from tempose.typing import FloatArray

_DOUBT = 0.02
_THINNEST = 0.05
"""Least area that counts for an edge, as a share of its length squared: slivers would outweigh all else."""


def edge_areas(hinges: Hinges, lengths: FloatArray) -> FloatArray:
    """Share of the surface that belongs to each edge: a third of each of its faces.

    Parameters
    ----------
    hinges : Hinges
        Of the faces.
    lengths : (E,) float
        Lengths of the edges.

    Returns
    -------
    (E,) ndarray
        Areas, never less than 5 % of the length squared.
    """
    areas = areas_from_lengths(lengths[hinges.face_edges])
    summed = np.bincount(hinges.face_edges.ravel(), np.repeat(areas / 3, 3), minlength=len(lengths))
    return np.maximum(summed, _THINNEST * lengths**2)


def hinge_stiffness(hinges: Hinges, reference: Reference) -> FloatArray:
    """How much the angle of each hinge counts when faces are turned.

    Parameters
    ----------
    hinges : Hinges
        Of the faces.
    reference : Reference
        With the spread of the angles over a clip.

    Returns
    -------
    (H,) ndarray
        Weights, positive: low for slivers, and where the angle swings to and fro over the clip, so that
        its mean with another pose says little about where the faces shall turn.
    """
    area, length = edge_areas(hinges, reference.lengths)[hinges.edge], reference.lengths[hinges.edge]
    return area / length**2 / (_DOUBT + reference.spread[hinges.slot])
