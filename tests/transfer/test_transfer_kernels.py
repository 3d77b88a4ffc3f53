"""The two compiled loops against loops in Python."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_zoo import as_rotation, wxyz

from tempose.transfer._kernels import add_edge_fragments, add_face_fragments


@pytest.mark.parametrize("K", [1, 5])
def test_faces_add_their_turned_edges(K: int, rng) -> None:
    n, m = 12, 30
    q, F = rng.normal(size=(n, 4, K)), np.stack([rng.permutation(n)[:3] for _ in range(m)])
    edges, weights = rng.normal(size=(m, 2, 3)), rng.normal(size=(m, 3))
    start = rng.normal(size=(n, 3, K))
    fast, slow = start.copy(), start.copy()
    add_face_fragments(q, F, edges, weights, fast)
    for t in range(K):
        for (i, j, k), (a, b), (wi, wj, wk) in zip(F, edges, weights):
            R = as_rotation(q[i, :, t] + q[j, :, t] + q[k, :, t])
            # each edge from p to o weighs by its opposite corner: p gets w (x_p - x_o)
            for p, o, vector, w in ((i, j, a, wk), (j, k, b, wi), (k, i, -(a + b), wj)):
                slow[p, :, t] -= w * R.apply(vector)
                slow[o, :, t] += w * R.apply(vector)
    assert_allclose(fast, slow, rtol=0, atol=1e-12)
    assert_allclose(fast.sum(axis=0), start.sum(axis=0), rtol=0, atol=1e-12)


@pytest.mark.parametrize("K", [1, 5])
def test_extra_edges_turn_by_the_mean_of_their_ends(K: int, rng) -> None:
    n, e = 9, 20
    q, pairs = rng.normal(size=(n, 4, K)), np.stack([rng.permutation(n)[:2] for _ in range(e)])
    vectors, weights = rng.normal(size=(e, 3)), rng.random(e)
    start = rng.normal(size=(n, 3, K))
    fast, slow = start.copy(), start.copy()
    add_edge_fragments(q, pairs, vectors, weights, fast)
    for t in range(K):
        for (i, j), v, w in zip(pairs, vectors, weights):
            turned = w * as_rotation(q[i, :, t] + q[j, :, t]).apply(v)
            slow[i, :, t] += turned
            slow[j, :, t] -= turned
    assert_allclose(fast, slow, rtol=0, atol=1e-12)


def test_a_field_that_cancels_out_gives_numbers() -> None:
    """Opposite rotations whose sum is zero turn nothing: no division by zero."""
    q = np.zeros((3, 4, 1))
    F, edges, weights = np.array([[0, 1, 2]]), np.ones((1, 2, 3)), np.ones((1, 3))
    rhs = np.zeros((3, 3, 1))
    add_face_fragments(q, F, edges, weights, rhs)
    assert np.isfinite(rhs).all()
    q[0, 0], q[1, 0] = 1.0, -1.0
    add_edge_fragments(q, np.array([[0, 1]]), np.ones((1, 3)), np.ones(1), rhs)
    assert np.isfinite(rhs).all()


def test_the_length_of_the_quaternions_means_nothing(rng) -> None:
    q = np.ascontiguousarray(wxyz(Rotation.random(3, rng=rng))[:, :, None])
    F, edges, weights = np.array([[0, 1, 2]]), rng.normal(size=(1, 2, 3)), np.ones((1, 3))
    results = []
    for scale in (1e-6, 1.0, 1e6):
        rhs = np.zeros((3, 3, 1))
        add_face_fragments(scale * q, F, edges, weights, rhs)
        results.append(rhs)
    assert_allclose(results[0], results[1], rtol=0, atol=1e-12)
    assert_allclose(results[2], results[1], rtol=0, atol=1e-12)
