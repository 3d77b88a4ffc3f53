"""Joints read off a surface: exact at rest, and wherever the surface moves as one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_zoo import sphere

from tempose.transfer.bodies.joint_regressor import apply_regressor, regress_points


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_points_follow_rigid_and_affine_motion_exactly(unit: float, rng) -> None:
    V = unit * (sphere().vertices + np.array([0, 3.0, 0]))
    points = unit * (rng.normal(size=(4, 3)) * 0.3 + np.array([0, 3.0, 0]))
    candidates = [np.arange(len(V)), np.arange(0, 162, 2), np.arange(60), rng.permutation(162)[:20]]
    vertices, weights = regress_points(V, points, candidates)
    assert_allclose(weights.sum(axis=1), 1, rtol=0, atol=1e-9)
    maps = [np.eye(3), Rotation.random(rng=rng).as_matrix(), rng.normal(size=(3, 3))]
    moves = unit * rng.normal(size=(3, 3))
    frames = np.stack([V @ A.T + b for A, b in zip(maps, moves)])
    expected = np.stack([points @ A.T + b for A, b in zip(maps, moves)])
    assert_allclose(apply_regressor(frames, vertices, weights), expected, rtol=0, atol=1e-8 * unit)


def test_only_near_candidates_are_used() -> None:
    V = np.array(sphere().vertices)
    mine = np.flatnonzero(V[:, 1] > 0)
    vertices, weights = regress_points(V, V[mine[:1]], [mine])
    used = vertices[weights != 0]
    assert np.isin(used, mine).all()
    gap = np.linalg.norm(V - V[mine[0]], axis=1)
    assert gap[used].max() <= np.sort(gap[mine])[47] + 1e-12


def test_weights_are_of_least_norm(rng) -> None:
    V = np.array(sphere().vertices)
    (vertices,), (weights,) = regress_points(V, np.array([[0.1, 0.2, 0.0]]), [np.arange(len(V))])
    A = np.vstack([V[vertices].T, np.ones(len(vertices))])
    null = np.linalg.svd(A)[2][4:]
    deviation = weights - 1 / len(weights)
    assert_allclose(null @ deviation, 0, atol=1e-9)


@pytest.mark.parametrize("k", [1, 2, 3])
def test_too_few_candidates_give_what_they_can(k: int) -> None:
    V = np.array(sphere().vertices)
    vertices, weights = regress_points(V, np.zeros((1, 3)), [np.arange(k)])
    frames = np.stack([V, V + np.array([1.0, 2, 3])])
    found = apply_regressor(frames, vertices, weights)
    assert np.isfinite(found).all()
    assert np.linalg.norm(found[0, 0] - V[:k].mean(axis=0)) < 2
