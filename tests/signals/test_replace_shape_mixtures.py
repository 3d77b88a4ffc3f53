"""Frames as mixtures of poses: least squares, and the choice of the poses."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from tempose.signals.replace_shape import Products, best_mixtures
from tempose.signals.replace_shape.local import fit_local_map
from tempose.typing import FloatArray


def products_of(Q: FloatArray, Z: FloatArray) -> Products:
    variation = float(np.square(Z - Z.mean(axis=0)).sum())
    return Products(Q @ Q.T, Z @ Q.T, np.square(Z).sum(axis=1), variation)


def poses(seed: int, N: int = 6, d: int = 20) -> FloatArray:
    return np.random.default_rng(seed).normal(size=(N, d))


@settings(max_examples=20)
@given(st.integers(0, 1000), st.floats(-5, 5))
def test_mixtures_are_least_squares(seed: int, away: float) -> None:
    Q = poses(seed)
    Z = poses(seed + 1, 9) + away
    mixed = products_of(Q, Z).mix((1, 3, 4))
    H = (Q[[3, 4]] - Q[1]).T
    x = np.linalg.lstsq(H, (Z - Q[1]).T, rcond=None)[0]
    assert_allclose(mixed.coordinates, x.T, atol=1e-9)
    left = Z - Q[1] - x.T @ H.T
    spread = np.square(Z - Z.mean(axis=0)).sum()
    assert_allclose(mixed.residual, np.sqrt(np.square(left).sum() / spread), rtol=1e-6)


def test_which_pose_is_the_reference_does_not_matter() -> None:
    Q, Z = poses(0), poses(1, 9)
    shown = []
    for order in ([0, 1, 2, 3], [2, 0, 3, 1]):
        mixed = products_of(Q[order], Z).mix((0, 1, 2, 3))
        shown.append(Q[order[0]] + mixed.coordinates @ (Q[order[1:]] - Q[order[0]]))
    assert_allclose(shown[0], shown[1], atol=1e-9)


def test_frames_that_are_poses_are_those_poses() -> None:
    Q = poses(2)
    mixed = products_of(Q, Q).mix(tuple(range(6)))
    assert_allclose(mixed.coordinates, np.eye(6)[:, 1:], atol=1e-9)
    assert mixed.residual < 1e-6


@pytest.mark.parametrize("count", [2, 3, 5])
def test_the_best_poses_are_those_of_brute_force(count: int) -> None:
    Q, Z = poses(3), poses(4, 12)
    products = products_of(Q, Z)
    errors = {used: products.mix(used).residual for used in combinations(range(6), count)}
    best = best_mixtures(products, count)
    assert best.used == min(errors, key=lambda used: errors[used])
    assert_allclose(best.residual, min(errors.values()))


def test_many_poses_are_left_out_one_at_a_time() -> None:
    """Frames made of three of thirty poses: those three are found."""
    Q = poses(5, 30, 60)
    Z = np.random.default_rng(0).dirichlet(np.ones(3), 10) @ Q[[4, 11, 23]]
    best = best_mixtures(products_of(Q, Z), 3)
    assert best.used == (4, 11, 23)
    assert best.residual < 1e-6


def test_a_ridge_pulls_towards_the_first_pose() -> None:
    Q, Z = poses(6), poses(7, 9)
    plain, damped = products_of(Q, Z).mix((0, 1, 2)), products_of(Q, Z).mix((0, 1, 2), ridge=0.5)
    assert np.linalg.norm(damped.coordinates) < np.linalg.norm(plain.coordinates)
    assert damped.residual > plain.residual
    assert damped.condition < plain.condition


def three_limbs(N: int, seed: int) -> tuple[FloatArray, FloatArray]:
    """Three regions that move independently, in other coordinates and another order in the target."""
    rng = np.random.default_rng(seed)
    a, b, c = rng.normal(size=(3, N, 3))
    turn = np.linalg.qr(rng.normal(size=(5, 5)))[0][:, :3]
    source = np.stack([x @ x.T for x in (a, b, c)])
    target = np.stack([(x @ turn.T) @ (x @ turn.T).T for x in (b, c, a)])
    return source, target


def test_regions_that_move_alike_are_found_and_predict_pairs_left_out() -> None:
    source, target = three_limbs(8, 0)
    found = fit_local_map(source, target)
    assert found.sharpness > 0
    assert (found.weights.argmax(axis=1) == [1, 2, 0]).all()
    assert found.error < 0.5 * found.plain


def test_multiples_sum_to_one_and_give_poses_back() -> None:
    source, target = three_limbs(8, 1)
    found = fit_local_map(source, target)
    a = found.multiples(source)
    assert_allclose(a.sum(axis=2), 1.0, atol=1e-9)
    shown = np.einsum("lti,lij->ltj", a, target)
    assert np.abs(shown - target).max() < 0.15 * np.abs(target).max()
