"""Where a further bone would help most: rigid motions of small patches, judged on the whole mesh."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.steps import predicted
from tempose.rotations import polar_rotation
from tempose.typing import FloatArray, IntArray


def rigid_motions(problem: Problem, patches: IntArray) -> FloatArray:
    """Best rigid motion of patches of vertices, in every frame.

    Parameters
    ----------
    problem : Problem
        The clip.
    patches : (C, k) int
        Vertices of each patch.

    Returns
    -------
    (T, C, 3, 4) ndarray
        Rotation and translation, rest to frame.
    """
    P = problem.rest[patches]
    Q = problem.targets[patches].reshape(*patches.shape, -1, 3)
    p, q = P.mean(axis=1), Q.mean(axis=1)
    cross = np.einsum("cktr,ckp->tcrp", Q - q[:, None], P - p[:, None], optimize=True)
    R = polar_rotation(cross)
    shift = q.transpose(1, 0, 2) - np.einsum("tcrp,cp->tcr", R, p)
    return np.concatenate([R, shift[..., None]], axis=-1)


def gains(problem: Problem, state: State, motions: FloatArray) -> FloatArray:
    """Squared distance that each of several bones would take away, mixed in at every vertex as it likes.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Bones and weights that stand.
    motions : (T, C, 3, 4) float
        Candidates.

    Returns
    -------
    (C,) ndarray
        Gain of each candidate alone, over all vertices and frames.
    """
    T, C = motions.shape[:2]
    columns = motions.transpose(1, 3, 0, 2).reshape(4 * C, 3 * T)
    now, u1 = predicted(problem, state), problem.lifted
    missing = problem.targets - now
    forms = np.einsum("cpx,cqx->cpq", *(2 * [columns.reshape(C, 4, -1)]))
    towards = np.einsum("ncp,np->nc", (missing @ columns.T).reshape(-1, C, 4), u1)
    along = np.einsum("ncp,np->nc", (now @ columns.T).reshape(-1, C, 4), u1)
    size = np.einsum("np,cpq,nq->nc", u1, forms, u1, optimize=True)
    towards -= np.einsum("nx,nx->n", missing, now)[:, None]
    length = size - 2 * along + np.einsum("nx,nx->n", now, now)[:, None]
    part = np.clip(towards / np.maximum(length, 1e-30), 0.0, 1.0)
    return np.asarray((2 * part * towards - part**2 * length).sum(axis=0))


def best_seed(
    problem: Problem, state: State, rng: np.random.Generator, size: int, count: int = 24
) -> FloatArray:
    """Motion of the patch that helps most, of several drawn where the error is largest.

    Parameters
    ----------
    problem : Problem
        The clip.
    state : State
        Bones and weights that stand.
    rng : Generator
        Draws the centres.
    size : int
        Vertices of a small patch; every other patch is three times as large.
    count : int, default 24
        How many patches are judged.

    Returns
    -------
    (T, 1, 3, 4) ndarray
        Rotation and translation of the new bone.
    """
    n = len(problem.rest)
    drawn = rng.choice(n, size=min(count, n), replace=False, p=_chances(state.left))
    tree = KDTree(problem.rest)
    found: list[FloatArray] = []
    for k, centres in ((min(size, n), drawn[::2]), (min(3 * size, n), drawn[1::2])):
        if len(centres):
            patches = np.asarray(tree.query(problem.rest[centres], k)[1]).reshape(len(centres), k)
            found.append(rigid_motions(problem, patches))
    motions = np.concatenate(found, axis=1)
    best = int(np.argmax(gains(problem, state, motions)))
    return motions[:, best : best + 1]


def _chances(left: FloatArray) -> FloatArray:
    floor = 1e-6 * left.mean() + 1e-300
    return (left + floor) / (left + floor).sum()
