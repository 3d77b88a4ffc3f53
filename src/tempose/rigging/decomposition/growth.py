"""Bones one by one, each where the error is largest, and exchanged while that helps."""

from __future__ import annotations

import numpy as np

from tempose.rigging.decomposition.alternation import alternate
from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.seeds import best_seed, rigid_motions
from tempose.rigging.decomposition.steps import weight_step
from tempose.typing import FloatArray, IntArray

_IDLE = 20  # bones that may come to hold nothing before the clip counts as explained


def first_state(problem: Problem, influences: int) -> State:
    """One bone that carries everything.

    Parameters
    ----------
    problem : Problem
        The clip.
    influences : int
        Places K for bones at a vertex.

    Returns
    -------
    State
        With one bone.
    """
    n = len(problem.rest)
    motions = rigid_motions(problem, np.arange(n)[None])
    state = State(motions, np.zeros((n, influences), np.int64), np.zeros((n, influences)), np.zeros(n))
    weight_step(problem, state)
    return state


def with_bone(state: State, motion: FloatArray) -> State:
    """Return a state with one bone more, which holds nothing yet.

    Parameters
    ----------
    state : State
        Bones that stand.
    motion : (T, 1, 3, 4) float
        The new bone.

    Returns
    -------
    State
        Copies; `state` is not touched.
    """
    motions = np.concatenate([state.motions, motion], axis=1)
    return State(motions, state.bones.copy(), state.weights.copy(), state.left.copy())


def without_bone(state: State, bone: int) -> State:
    """Return a state without one bone; what it held is shared among the others at the next weight step.

    Parameters
    ----------
    state : State
        Bones that stand.
    bone : int
        Which one goes.

    Returns
    -------
    State
        Copies; `state` is not touched.
    """
    weights = np.where(state.bones == bone, 0.0, state.weights)
    total = weights.sum(axis=1, keepdims=True)
    weights = np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)
    bones = np.where(state.bones > bone, state.bones - 1, state.bones)
    return State(np.delete(state.motions, bone, axis=1), bones, weights, state.left.copy())


def grow(
    problem: Problem, B: int, influences: int, rng: np.random.Generator, exact: float
) -> tuple[State, bool]:
    """Add bones until there are B, or until nothing is left to explain.

    Parameters
    ----------
    problem : Problem
        The clip, perhaps on a part of its vertices.
    B : int
        Bones wanted.
    influences : int
        Bones a vertex may have.
    rng : Generator
        Draws where bones are tried.
    exact : float
        Root mean square distance below which the clip counts as explained.

    Returns
    -------
    state : State
        Up to B bones.
    explained : bool
        Whether it stopped because nothing was left.
    """
    state = first_state(problem, influences)
    size = max(8, len(problem.rest) // (4 * B))
    # where no bone helps any more each new one is dropped again: that must end
    for _ in range(B + _IDLE):
        if state.n_bones >= B:
            break
        if np.sqrt(state.left.mean() / problem.n_frames) <= exact:
            return state, True
        state = with_bone(state, best_seed(problem, state, rng, size))
        weight_step(problem, state)
        alternate(problem, state, 2)
        state = _used(state)
    return state, state.n_bones < B


def _used(state: State) -> State:
    """Drop bones that came to hold nothing."""
    held = np.bincount(state.bones.ravel(), state.weights.ravel(), minlength=state.n_bones)
    for bone in reversed(np.flatnonzero(held <= 0)):
        state = without_bone(state, int(bone))
    return state


def exchange(problem: Problem, state: State, rng: np.random.Generator, trials: int, rounds: int = 4) -> State:
    """Take out bones that hold little and put them where the error is large; what does not help is undone.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Bones that stand.
    rng : Generator
        Draws where bones are tried.
    trials : int
        How many bones are taken out, those that are missed least first.
    rounds : int, default 4
        Alternations before a trial is judged.

    Returns
    -------
    State
        At least as good.
    """
    if state.n_bones < 2:
        return state
    size = max(8, len(problem.rest) // (4 * state.n_bones))
    for bone in _missed_least(problem, state)[:trials][::-1]:
        trial = without_bone(state, int(bone))
        weight_step(problem, trial)
        trial = with_bone(trial, best_seed(problem, trial, rng, size))
        weight_step(problem, trial)
        alternate(problem, trial, rounds)
        if trial.left.sum() < state.left.sum():
            state = trial
    return state


def _missed_least(problem: Problem, state: State) -> IntArray:
    losses: list[float] = []
    for bone in range(state.n_bones):
        trial = without_bone(state, bone)
        weight_step(problem, trial)
        losses.append(float(trial.left.sum()))
    return np.argsort(losses, kind="stable")
