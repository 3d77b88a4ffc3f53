"""The joint that two bones would have: where they stay together in all frames."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.rigging.decomposition import Decomposition
from tempose.rotations import to_matrix
from tempose.typing import FloatArray

_WEAK = 0.15  # of the strongest: turns about an axis below it say little about the place along it
_SLIGHT = 0.01  # square radians, mean squared turn: below it, flesh that slides is taken for a joint far away


@dataclass(frozen=True)
class PairJoints:
    """Joints of all pairs of B bones; arrays are symmetric."""

    places: FloatArray
    """(B, B, 3) rest position of the joint, metres."""
    apart: FloatArray
    """(B, B) root mean square distance to which the two bones tear the joint over the frames, metres."""
    stray: FloatArray
    """(B, B) distance of the joint from the middle of the region that both bones hold, metres."""
    shared: FloatArray
    """(B, B) sum over vertices of the product of the two weights."""


def pair_joints(bones: Decomposition) -> PairJoints:
    """Solve for the joint of every pair of bones.

    Parameters
    ----------
    bones : Decomposition
        B bones.

    Returns
    -------
    PairJoints
        Joints and how well they hold.

    Notes
    -----
    Least squares over all frames of ``R_a c + t_a = R_b c + t_b``. Bones that turn about one axis only, or
    not at all, leave the joint open: along directions that the turns hardly tell, it stays in the middle of
    the region that both hold. Two bones that share no vertex have the middle between their nearest
    vertices in its place.
    """
    R, t = to_matrix(bones.rotations), bones.translations
    B = bones.n_bones
    shared = bones.weights.T @ bones.weights
    middles = _middles(bones, shared)
    places, apart = np.zeros((B, B, 3)), np.zeros((B, B))
    for a in range(B):
        D, d = R[:, a, None] - R, t[:, a, None] - t
        N = np.einsum("tbki,tbkj->bij", D, D) / len(R)
        off = np.einsum("tbki,tbk->bi", D, d) / len(R) + np.einsum("bij,bj->bi", N, middles[a])
        places[a] = middles[a] - _filtered(N, off)
        tear = np.einsum("tbki,bi->tbk", D, places[a]) + d
        apart[a] = np.sqrt((tear**2).sum(axis=2).mean(axis=0))
    return PairJoints(places, apart, np.linalg.norm(places - middles, axis=2), shared)


def _filtered(N: FloatArray, off: FloatArray) -> FloatArray:
    """Solve ``N x = off`` with directions faded out that N holds weakly."""
    values, axes = np.linalg.eigh(N)
    floor = _WEAK * values[..., -1:] + _SLIGHT
    part = np.einsum("bji,bj->bi", axes, off) * values / (values**2 + floor**2)
    return np.einsum("bij,bj->bi", axes, part)


def _middles(bones: Decomposition, shared: FloatArray) -> FloatArray:
    W, B = bones.weights, bones.n_bones
    middles = np.zeros((B, B, 3))
    nearest = _nearest_middles(bones)
    for a in range(B):
        sums = (W * W[:, [a]]).T @ bones.rest
        some = shared[a] > 1e-9
        middles[a] = np.where(some[:, None], sums / np.maximum(shared[a], 1e-12)[:, None], nearest[a])
    return middles


def _nearest_middles(bones: Decomposition, most: int = 200) -> FloatArray:
    """Middles between the nearest of some vertices that each bone holds most of all."""
    B, W = bones.n_bones, bones.weights
    held: list[FloatArray] = []
    for b in range(B):
        own = np.flatnonzero(W[:, b] >= 0.5 * W[:, b].max())
        held.append(bones.rest[own[:: max(1, len(own) // most)]])
    middles = np.zeros((B, B, 3))
    for a in range(B):
        for b in range(a):
            away = np.linalg.norm(held[a][:, None] - held[b][None], axis=2)
            i, j = np.unravel_index(int(away.argmin()), away.shape)
            middles[a, b] = middles[b, a] = 0.5 * (held[a][i] + held[b][j])
    return middles
