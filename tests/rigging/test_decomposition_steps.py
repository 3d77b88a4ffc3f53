"""The steps of the decomposition against brute force and against vertices one by one."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from bone_cases import chain
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from tempose.rigging.decomposition import growth
from tempose.rigging.decomposition._weight_kernel import convex_weights, mixing_energy, weights_of_block
from tempose.rigging.decomposition.alternation import alternate, carried_on
from tempose.rigging.decomposition.growth import exchange, first_state, grow, with_bone, without_bone
from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.seeds import best_seed, gains, rigid_motions
from tempose.rigging.decomposition.steps import bone_step, predicted, weight_step
from tempose.rotations import from_rotation_vector, procrustes_rotation, to_matrix


def random_problem(rng, n=40, T=5, B=3, K=2):
    rest = rng.standard_normal((n, 3))
    problem = Problem.of(rest, rng.standard_normal((T, n, 3)))
    R = to_matrix(from_rotation_vector(rng.standard_normal((T, B, 3))))
    motions = np.concatenate([R, rng.standard_normal((T, B, 3, 1))], axis=-1)
    state = State(motions, np.zeros((n, K), np.int64), np.zeros((n, K)), np.zeros(n))
    weight_step(problem, state)
    return problem, state


def distances(problem, state):
    return ((predicted(problem, state) - problem.targets) ** 2).sum(axis=1)


def qp(E):
    """Convex weights by a general solver."""
    k = len(E)
    found = minimize(
        lambda w: w @ E @ w,
        np.full(k, 1 / k),
        jac=lambda w: 2 * E @ w,
        bounds=[(0, 1)] * k,
        constraints={"type": "eq", "fun": lambda w: w.sum() - 1},
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 500},
    )
    return found.fun


@pytest.mark.parametrize("k", [1, 2, 3, 4])
def test_convex_weights_equal_a_general_solver(rng, k):
    for _ in range(20):
        G, y = rng.standard_normal((k, 6)) + rng.standard_normal(6), rng.standard_normal(6)
        bones, weights = np.zeros((1, k), np.int64), np.zeros((1, k))
        pairs = (G @ G.T)[np.tril_indices(k)][None]
        left = weights_of_block(pairs, (G @ y)[None], np.array([y @ y]), bones, weights)[0]
        assert (weights >= 0).all() and weights.sum() == pytest.approx(1)
        assert left == pytest.approx(qp((G - y) @ (G - y).T), rel=1e-6, abs=1e-9)


def test_bones_whose_weight_vanishes_leave(rng):
    E, S, w = (
        np.diag([1.0, 1, 1]) + np.array([[0, 2, 0], [2, 0, 0], [0, 0, 0.0]]),
        np.arange(3),
        np.full(3, 1 / 3),
    )
    E[0, 0] = 9.0
    left = convex_weights(E, S, 3, w, np.zeros((3, 3)), np.zeros(3))
    assert S[:left].tolist() == [1, 2]
    assert_allclose(w[:left], 0.5)
    assert mixing_energy(E, S, left, w) == pytest.approx(0.5)


def test_no_exchange_of_one_bone_is_better(rng):
    B, K = 7, 3
    for _ in range(10):
        G = rng.standard_normal((B, 9))
        y = rng.standard_normal(9)
        rows = np.tril_indices(B)
        bones, weights = np.zeros((1, K), np.int64), np.zeros((1, K))
        pairs = (G @ G.T)[rows][None]
        left = weights_of_block(pairs, (G @ y)[None], np.array([y @ y]), bones, weights)[0]
        assert_allclose(((weights[0] @ G[bones[0]] - y) ** 2).sum(), left, rtol=1e-9)
        E = (G - y) @ (G - y).T
        used = set(bones[0][weights[0] > 0].tolist())
        for S in combinations(range(B), K):
            if len(used - set(S)) <= 1:
                assert qp(E[np.ix_(S, S)]) >= left * (1 - 1e-6)


def test_what_is_left_is_the_distance_of_what_is_predicted(rng):
    problem, state = random_problem(rng)
    assert_allclose(state.left, distances(problem, state), rtol=1e-9)
    assert_allclose(state.weights.sum(axis=1), 1, atol=1e-12)


def test_one_bone_moves_by_weighted_procrustes(rng):
    problem, state = random_problem(rng, B=1, K=1)
    bone_step(problem, state, sweeps=1)
    Y = problem.targets.reshape(len(problem.rest), -1, 3)
    for t in range(problem.n_frames):
        R = procrustes_rotation(problem.rest, Y[:, t])
        assert_allclose(state.motions[t, 0, :, :3], R, atol=1e-5)
        assert_allclose(state.motions[t, 0, :, 3], Y[:, t].mean(0) - R @ problem.rest.mean(0), atol=1e-5)


def test_neither_step_ever_raises_the_distance(rng):
    problem, state = random_problem(rng, n=60, B=4, K=3)
    before = state.left.sum()
    for _ in range(5):
        bone_step(problem, state)
        between = distances(problem, state).sum()
        assert between <= before * (1 + 1e-6)
        weight_step(problem, state)
        assert state.left.sum() <= between * (1 + 1e-9)
        before = state.left.sum()
    R = state.motions[..., :3]
    assert_allclose(R @ R.swapaxes(-1, -2), np.broadcast_to(np.eye(3), R.shape), atol=1e-9)
    assert_allclose(np.linalg.det(R), 1)


def test_rounds_with_momentum_never_get_worse(rng):
    problem, state = random_problem(rng, n=60, B=4, K=3)
    seen = [state.left.sum()]
    alternate(problem, state, 25, progress=lambda *_: seen.append(state.left.sum()))
    assert (np.diff(seen) <= 1e-9 * seen[0]).all()
    assert_allclose(state.left, distances(problem, state), rtol=1e-7, atol=1e-9)


def test_momentum_carries_a_steady_turn_on(rng):
    axis, centres = rng.standard_normal(3), rng.standard_normal((1, 3))
    axis *= 1e-3 / np.linalg.norm(axis)
    at = [to_matrix(from_rotation_vector(k * axis)) for k in range(3)]
    poses = [
        np.concatenate([R, (k * axis - R @ centres[0] + centres[0])[:, None]], 1) for k, R in enumerate(at)
    ]
    on = carried_on(poses[0][None, None], poses[1][None, None], 1.0, centres)
    assert_allclose(on[0, 0], poses[2], atol=1e-6)


def test_gain_is_what_mixing_the_best_part_takes_away(rng):
    problem, state = random_problem(rng, B=2)
    motion = rigid_motions(problem, np.arange(10)[None])
    now = predicted(problem, state)
    new = problem.lifted @ motion.transpose(1, 3, 0, 2).reshape(4, -1)
    parts = np.linspace(0, 1, 2001)[:, None, None]
    mixed = (((1 - parts) * now + parts * new - problem.targets) ** 2).sum(axis=2).min(axis=0)
    assert_allclose(gains(problem, state, motion), (state.left - mixed).sum(), rtol=1e-4)


def test_bones_leave_and_come_without_touching_the_others(rng):
    problem, state = random_problem(rng, B=4, K=2)
    fewer = without_bone(state, 1)
    assert_allclose(fewer.motions, np.delete(state.motions, 1, axis=1))
    weight_step(problem, fewer)
    assert fewer.left.sum() >= state.left.sum() * (1 - 1e-9)
    more = with_bone(state, best_seed(problem, state, rng, 8))
    weight_step(problem, more)
    assert (more.left <= state.left * (1 + 1e-9)).all()
    assert state.n_bones == 4 and more.n_bones == 5


def test_growth_ends_where_nothing_is_left(rng):
    _, _, clip = chain(3, 6, rng)
    problem = Problem.of(clip.rest, clip.vertices.astype(float))
    state, explained = grow(problem, 12, 2, np.random.default_rng(0), 1e-3)
    assert explained and state.n_bones < 12
    assert np.sqrt(state.left.mean() / 6) <= 1e-3
    assert first_state(problem, 2).n_bones == 1


def test_exchange_never_makes_it_worse(rng):
    problem, state = random_problem(rng, n=60, B=4, K=2)
    assert exchange(problem, state, rng, 3).left.sum() <= state.left.sum()


def test_bones_that_hold_nothing_are_not_tried_for_ever(rng, monkeypatch):
    problem, _ = random_problem(rng)
    # as if every new bone were dropped again
    monkeypatch.setattr(growth, "with_bone", lambda state, _: state)
    state, explained = grow(problem, 4, 2, rng, 1e-9)
    assert explained and state.n_bones == 1


def test_bones_that_carry_alone_have_the_least_of_both_errors(rng):
    problem, state = random_problem(rng)
    problem = replace(problem, alone=0.3)
    P, Y = problem.rest, problem.targets.reshape(len(problem.rest), -1, 3)

    def energy(motions):
        each = np.einsum("tbij,nj->ntbi", motions[..., :3], P) + motions[None, ..., 3]
        W = np.zeros((len(P), state.n_bones))
        np.add.at(W, (np.arange(len(P))[:, None], state.bones), state.weights)
        blend = ((np.einsum("nb,ntbi->nti", W, each) - Y) ** 2).sum()
        return blend + problem.alone * np.einsum("nb,ntbi->", W, (each - Y[:, :, None]) ** 2)

    start = energy(state.motions)
    bone_step(problem, state, sweeps=200)
    least = energy(state.motions)
    assert least < start
    for _ in range(20):
        turn = to_matrix(from_rotation_vector(1e-3 * rng.standard_normal((*state.motions.shape[:2], 3))))
        near = np.einsum("tbij,tbjk->tbik", turn, state.motions)
        near[..., 3] += 1e-3 * rng.standard_normal(near.shape[:-1])
        assert energy(near) > least


def test_a_part_of_a_clip_keeps_what_bones_carry_alone(rng):
    problem, _ = random_problem(rng)
    assert replace(problem, alone=0.3).part(np.arange(5)).alone == 0.3
