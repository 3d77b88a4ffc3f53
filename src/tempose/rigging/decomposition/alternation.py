"""Bones and weights in turn, with momentum."""

from __future__ import annotations

import numpy as np

from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.steps import bone_step, weight_step
from tempose.rotations import polar_rotation
from tempose.typing import FloatArray, Progress, silent

_MOST_MOMENTUM = 0.95


def alternate(
    problem: Problem,
    state: State,
    most: int,
    tolerance: float = 0.0,
    progress: Progress = silent,
) -> tuple[int, bool]:
    """Set bones and weights in turn; `state` is edited and never gets worse.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Where to start.
    most : int
        Largest number of rounds.
    tolerance : float, default 0.0
        A round that lowers the root mean square distance by a smaller part than this is the last.
    progress : Progress
        Told about every round.

    Returns
    -------
    rounds : int
        How many were made.
    converged : bool
        Whether the tolerance was met.

    Notes
    -----
    Plain alternation creeps. Bones are therefore carried past their best place by a part of their last step,
    k / (k + 3) in the k-th round, as in [1]_; a round that this makes worse is done again without it and
    k starts anew.

    References
    ----------
    .. [1] O'Donoghue and Candes, "Adaptive Restart for Accelerated Gradient Schemes", Foundations of
       Computational Mathematics 15, 2015.
    """
    left, last, k = float(state.left.sum()), state.motions.copy(), 0
    for done in range(1, most + 1):
        bone_step(problem, state)
        plain, momentum = state.motions.copy(), min(k / (k + 3), _MOST_MOMENTUM)
        bones, weights = state.bones.copy(), state.weights.copy()
        if momentum > 0:
            state.motions = carried_on(last, plain, momentum, _centres(problem, state))
        weight_step(problem, state)
        k += 1
        if state.left.sum() > left and momentum > 0:
            state.motions, state.bones, state.weights, k = plain.copy(), bones, weights, 0
            weight_step(problem, state)
        now = float(state.left.sum())
        progress(done, most, "bones and weights")
        if now >= left * (1 - tolerance) ** 2:
            return done, True
        left, last = now, plain
    return most, False


def carried_on(before: FloatArray, after: FloatArray, part: float, centres: FloatArray) -> FloatArray:
    """Rigid motions that go on from `after` by a part of the way that they came from `before`.

    Parameters
    ----------
    before, after : (T, B, 3, 4) float
        Rotation and translation of each bone.
    part : float
        Part of the way.
    centres : (B, 3) float
        Rest position about which each bone turns.

    Returns
    -------
    (T, B, 3, 4) ndarray
        Rigid again.
    """
    R = polar_rotation(after[..., :3] + part * (after[..., :3] - before[..., :3]))
    there = np.einsum("tbij,bj->tbi", after[..., :3], centres) + after[..., 3]
    here = np.einsum("tbij,bj->tbi", before[..., :3], centres) + before[..., 3]
    shift = there + part * (there - here) - np.einsum("tbij,bj->tbi", R, centres)
    return np.concatenate([R, shift[..., None]], axis=-1)


def _centres(problem: Problem, state: State) -> FloatArray:
    B, bones = state.n_bones, state.bones.ravel()
    held = np.bincount(bones, state.weights.ravel(), minlength=B)
    sums = [
        np.bincount(bones, (state.weights * problem.rest[:, [axis]]).ravel(), minlength=B)
        for axis in range(3)
    ]
    return np.column_stack(sums) / np.maximum(held, 1e-12)[:, None]
