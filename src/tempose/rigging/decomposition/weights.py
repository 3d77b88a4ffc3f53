"""Weights for bones whose motion is known."""

from __future__ import annotations

import numpy as np

from tempose.rigging.decomposition.decompose import arranged, dense
from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.steps import weight_step
from tempose.rotations import rotate, to_matrix
from tempose.typing import BoolArray, FloatArray


def weights_for(
    frames: FloatArray,
    rest: FloatArray,
    rotations: FloatArray,
    translations: FloatArray,
    *,
    weights: FloatArray | None = None,
    influences: int = 4,
    allowed: BoolArray | None = None,
) -> FloatArray:
    """Solve for sparse convex weights of given bones.

    Parameters
    ----------
    frames : (T, n, 3) float
        Vertices in every frame.
    rest : (n, 3) float
        Vertices at rest.
    rotations : (T, B, 4) float
        Rotations wxyz of each bone, rest to frame.
    translations : (T, B, 3) float
        A bone takes rest position x to ``R x + t``.
    weights : (n, B) float, optional
        Weights to start from; the largest of each row are kept.
    influences : int, default 4
        Most bones that a vertex may follow.
    allowed : (n, B) bool, optional
        Which bones each vertex may follow, at least one; by default all.

    Returns
    -------
    (n, B) ndarray
        Rows >= 0 that sum to 1.

    Notes
    -----
    The least squared distance over the choice of bones is sought by exchanging one bone at a time, from the
    given weights or the bone that fits best alone: no exchange of one bone makes the answer better.
    """
    problem, (centre, centres, scale) = arranged(frames, rest)
    B, n = rotations.shape[1], len(rest)
    shift = (rotate(rotations, centre) + translations - centres[:, None]) / scale
    motions = np.concatenate([to_matrix(rotations), shift[..., None]], axis=-1)
    start = np.zeros((n, B)) if weights is None else weights
    if allowed is None:
        return _solved(problem, motions, start, influences)
    solved = np.zeros((n, B))
    choices, of = np.unique(allowed, axis=0, return_inverse=True)
    for k, choice in enumerate(choices):
        own, may = np.flatnonzero(of.ravel() == k), np.flatnonzero(choice)
        part = _solved(problem.part(own), motions[:, may], start[np.ix_(own, may)], influences)
        solved[np.ix_(own, may)] = part
    return solved


def _solved(problem: Problem, motions: FloatArray, start: FloatArray, influences: int) -> FloatArray:
    n, B = start.shape
    K = min(influences, B)
    state = State(motions, np.zeros((n, K), np.int64), np.zeros((n, K)), np.zeros(n))
    state.bones[:] = np.argsort(-start, axis=1, kind="stable")[:, :K]
    kept = np.take_along_axis(start, state.bones, axis=1)
    total = kept.sum(axis=1, keepdims=True)
    state.weights[:] = np.divide(kept, total, out=np.zeros_like(kept), where=total > 0)
    if not start.any():
        state.bones[:] = 0
    weight_step(problem, state)
    return dense(state)
