"""The two alternating steps: weights for given bones, bones for given weights."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix

from tempose.rigging.decomposition._bone_kernel import shared_moments, sweep_bones
from tempose.rigging.decomposition._weight_kernel import weights_of_block
from tempose.rigging.decomposition.problem import Problem, State
from tempose.typing import FloatArray

_ROW, _COLUMN = np.tril_indices(4)
_BLOCK = 1024  # vertices whose bone pairs are held at a time


def weight_step(problem: Problem, state: State) -> None:
    """Give every vertex the best weights on at most K bones; `state` is edited.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Bones to blend, weights to start from.

    Notes
    -----
    Products of two bones at a vertex are quadratic in its rest position: ten coefficients a pair, so a frame
    is met only once, in the product with the targets.
    """
    B, columns = state.n_bones, state.columns
    products = (columns @ columns.T).reshape(B, 4, B, 4)
    j, k = np.tril_indices(B)
    forms = products[j, :, k, :]
    forms = forms + forms.transpose(0, 2, 1)
    coefficients = forms[:, _ROW, _COLUMN] * np.where(_ROW == _COLUMN, 0.5, 1.0)
    u1 = problem.lifted
    for start in range(0, len(u1), _BLOCK):
        block = slice(start, start + _BLOCK)
        own = (problem.targets[block] @ columns.T).reshape(-1, B, 4)
        state.left[block] = weights_of_block(
            (u1[block][:, _ROW] * u1[block][:, _COLUMN]) @ coefficients.T,
            np.einsum("nbp,np->nb", own, u1[block]),
            problem.squares[block],
            state.bones[block],
            state.weights[block],
        )


def lifted_weights(problem: Problem, state: State) -> csr_matrix:
    """Return the sparse matrix that turns `State.columns` into vertices.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Bones and weights.

    Returns
    -------
    (n, 4 B) sparse matrix
        Weights times lifted rest positions.
    """
    n, K = state.bones.shape
    values = state.weights[:, :, None] * problem.lifted[:, None, :]
    places = 4 * state.bones[:, :, None] + np.arange(4)
    starts = np.arange(0, 4 * n * K + 1, 4 * K)
    matrix = csr_matrix((values.ravel(), places.ravel(), starts), shape=(n, 4 * state.n_bones))
    return matrix


def predicted(problem: Problem, state: State) -> FloatArray:
    """Return where the blended bones carry the vertices.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Bones and weights.

    Returns
    -------
    (n, 3 T) ndarray
        Positions in all frames.
    """
    return lifted_weights(problem, state) @ state.columns


def bone_step(problem: Problem, state: State, sweeps: int = 3) -> None:
    """Give every bone its best motion, the weights held; `state` is edited.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Weights to keep, bones to start from.
    sweeps : int, default 3
        How often every bone is set with the others held.

    Notes
    -----
    Nothing in the blend tells where a bone is that only ever has small weights: it may lie far from the mesh
    and turn wildly. With ``problem.alone = a``, ``a sum_i w_ij |R_j x_i + t_j - y_i|^2`` is added for every
    bone j.
    """
    T, B = state.motions.shape[:2]
    moments = (lifted_weights(problem, state).T.tocsr() @ problem.targets).reshape(B, 4, T, 3)
    shared = shared_moments(problem.lifted, state.bones, state.weights, B)
    if problem.alone > 0:
        each = np.arange(B)
        shared[each, each] += problem.alone * shared.sum(
            axis=1
        )  # weights sum to one: over k, w_ij w_ik is w_ij
        moments = (1 + problem.alone) * moments
    sweep_bones(shared, np.ascontiguousarray(moments.transpose(2, 0, 1, 3)), state.motions, 1e-7, sweeps)
