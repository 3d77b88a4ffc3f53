"""Where each bone holds the surface, how far bones are apart along it, and bones that hold two limbs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.sparse.csgraph import connected_components, dijkstra

from tempose._validate import read_only
from tempose.rigging.decomposition import Decomposition
from tempose.typing import BoolArray, FloatArray

_PART = 0.15  # of what a bone holds: pieces that hold less are strays
_LIMBS = 0.1  # of the diagonal: pieces of a bone so far apart along the surface are limbs that move alike


def surface_gaps(weights: FloatArray, links: Any) -> FloatArray:
    """Measure the shortest ways along the surface between what bones hold.

    Parameters
    ----------
    weights : (n, B) float
        Weights of B bones.
    links : (n, n) sparse array
        Lengths of ways between vertices, see `surface_links`.

    Returns
    -------
    (B, B) ndarray
        Metres, symmetric; 0 where regions share vertices or an edge joins them.
    """
    B = weights.shape[1]
    regions = [np.logical_or.reduce(held_pieces(weights, links, b)) for b in range(B)]
    rims = [region | (links @ region > 0) for region in regions]
    gaps = np.zeros((B, B))
    for a in range(B):
        away = _away(links, regions[a])
        gaps[a] = [away[rims[b]].min() for b in range(B)]
    return np.minimum(gaps, gaps.T)


def held_pieces(weights: FloatArray, links: Any, bone: int) -> list[BoolArray]:
    """Find the connected pieces of surface that follow a bone first of all.

    Parameters
    ----------
    weights : (n, B) float
        Weights of B bones.
    links : (n, n) sparse array
        Lengths of ways between vertices.
    bone : int
        Which.

    Returns
    -------
    list of (n,) ndarray of bool
        At least one; those that hold less than 15 % of the region are left out as strays.
    """
    w = weights[:, bone]
    held = np.flatnonzero((w > 0) & ((w >= weights.max(axis=1)) | (w >= 0.5 * w.max())))
    count, labels = connected_components(links[held][:, held], directed=False)
    masses = np.bincount(labels, w[held], minlength=count)
    pieces: list[BoolArray] = []
    for k in np.flatnonzero(masses >= min(_PART * masses.sum(), masses.max())):
        piece = np.zeros(len(w), dtype=bool)
        piece[held[labels == k]] = True
        pieces.append(piece)
    return pieces


def part_limbs(bones: Decomposition, links: Any) -> tuple[Decomposition, BoolArray]:
    """Make two bones of one that holds two limbs.

    Parameters
    ----------
    bones : Decomposition
        B bones.
    links : (n, n) sparse array
        Lengths of ways between vertices.

    Returns
    -------
    parted : Decomposition
        At least B bones; it makes the same frames. Limbs that move alike, as the front legs in a gallop, may
        follow one free bone, but hang in different places.
    allowed : (n, bones) ndarray of bool
        Which bones each vertex may follow: of those made of one, that of the nearest limb.
    """
    reach = _LIMBS * float(np.linalg.norm(np.ptp(bones.rest, axis=0)))
    sides: list[BoolArray] = []
    of: list[int] = []
    for b in range(bones.n_bones):
        fields = _limbs(held_pieces(bones.weights, links, b), links, reach)
        nearest = np.argmin(fields, axis=0)
        for k in range(len(fields)):
            sides.append(nearest == k)
            of.append(b)
    allowed = np.column_stack(sides)
    if len(of) == bones.n_bones:
        return bones, allowed
    parted = replace(
        bones,
        weights=read_only(np.where(allowed, bones.weights[:, of], 0.0)),
        rotations=read_only(bones.rotations[:, of]),
        translations=read_only(bones.translations[:, of]),
    )
    return parted, allowed


def _limbs(pieces: list[BoolArray], links: Any, reach: float) -> FloatArray:
    """Return (k, n) distances from groups of pieces; pieces nearer than the reach are one group."""
    if len(pieces) == 1:
        return np.zeros((1, links.shape[0]))
    fields = np.array([_away(links, piece) for piece in pieces])
    near = np.array([[field[piece].min() <= reach for piece in pieces] for field in fields])
    count, groups = connected_components(near, directed=False)
    return np.array([fields[groups == k].min(axis=0) for k in range(count)])


def _away(links: Any, region: BoolArray) -> FloatArray:
    return np.asarray(dijkstra(links, indices=np.flatnonzero(region), min_only=True))
