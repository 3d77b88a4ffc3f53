"""The compiled loops of a frame against loops in Python."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_zoo import as_rotation, wxyz

from tempose.transfer.solver.frame_kernels import add_faces_1, add_faces_8, spread_1, spread_8, write_frames

XYZW = [1, 2, 3, 0]
DTYPES = pytest.mark.parametrize("dtype", [np.float32, np.float64])


def tolerance(dtype: type) -> float:
    return 1e-12 if dtype == np.float64 else 2e-5


def faces(rng: np.random.Generator, n: int, m: int) -> tuple[np.ndarray, np.ndarray]:
    F = np.stack([rng.permutation(n)[:3] for _ in range(m)]).astype(np.int32)
    F[-3:, 2] = n  # edges: their third corner is the spare row
    D = np.zeros((m, 2, 4))
    D[:, :, :3] = rng.normal(size=(m, 2, 3))
    D[-3:, 1] = -D[-3:, 0]
    return F, D


def slow_faces(q: np.ndarray, F: np.ndarray, D: np.ndarray, u: np.ndarray) -> None:
    """Frame by frame, q (n + 1, 4) in wxyz."""
    for f, (a, b) in zip(F, D[:, :, :3]):
        R = as_rotation(q[f].sum(axis=0))
        change = R.apply([a, b, -(a + b)]) - [a, b, -(a + b)]
        for corner, c in zip(f, change):
            u[corner] += c


@DTYPES
def test_faces_add_what_turning_them_changes(dtype, rng) -> None:
    n, m, K = 12, 30, 8
    F, D = faces(rng, n, m)
    q = rng.normal(size=(K, n + 1, 4))
    q[:, n] = 0
    start = rng.normal(size=(K, n + 1, 3))
    slow = start.copy()
    for t in range(K):
        slow_faces(q[t], F, D, slow[t])
    atol = tolerance(dtype)
    flat = D.astype(dtype).ravel()
    many = np.ascontiguousarray(start.transpose(1, 2, 0), dtype=dtype)
    add_faces_8(np.ascontiguousarray(q.transpose(1, 2, 0), dtype=dtype).ravel(), F, flat, K, many.ravel())
    assert_allclose(many.transpose(2, 0, 1), slow, rtol=0, atol=atol)
    for t in range(K):
        one = np.zeros((n + 1, 4), dtype=dtype)
        one[:, :3] = start[t]
        add_faces_1(np.ascontiguousarray(q[t][:, XYZW], dtype=dtype).ravel(), F, flat, one.ravel())
        assert_allclose(one[:, :3], slow[t], rtol=0, atol=atol)
        assert_array_equal(one[:, 3], 0)
        # what edges leave at the spare row is nothing at all
        assert_array_equal(one[n, :3], start[t, n].astype(dtype))


@DTYPES
def test_a_field_that_cancels_out_gives_numbers(dtype) -> None:
    """Opposite rotations whose sum is zero: no division by zero."""
    F, D = np.array([[0, 1, 2]], dtype=np.int32), np.ones(8, dtype=dtype)
    D[3::4] = 0
    q = np.zeros(16, dtype=dtype)
    q[0], q[4] = 1.0, -1.0
    u = np.zeros(16, dtype=dtype)
    add_faces_1(q, F, D, u)
    assert np.isfinite(u).all()
    many = np.zeros(4 * 3 * 8, dtype=dtype)
    add_faces_8(np.zeros(4 * 4 * 8, dtype=dtype), F, D, 8, many)
    assert np.isfinite(many).all()


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_the_length_of_the_quaternions_means_nothing(scale: float, rng) -> None:
    q = np.zeros((4, 4))
    q[:3] = wxyz(Rotation.random(3, rng=rng))
    F, D = faces(rng, 3, 4)
    expected, found = np.zeros((4, 3)), np.zeros((4, 4))
    slow_faces(q, F, D, expected)
    add_faces_1((scale * q[:, XYZW]).ravel(), F, D.ravel(), found.ravel())
    assert_allclose(found[:, :3], expected, rtol=0, atol=1e-12)


@DTYPES
@pytest.mark.parametrize("B", [1, 5])
def test_spreading_is_a_matrix_product(B: int, dtype, rng) -> None:
    n, k = 7, 32
    W, Q = rng.random((n, B)).astype(dtype), rng.normal(size=(B, k)).astype(dtype)
    many, one = np.zeros((n, k), dtype=dtype), np.zeros((n, 4), dtype=dtype)
    spread_8(W.ravel(), Q.ravel(), B, k, many.ravel())
    spread_1(W.ravel(), Q[:, :4].ravel(), B, one.ravel())
    assert_allclose(many, W @ Q, rtol=0, atol=tolerance(dtype))
    assert_allclose(one, W @ Q[:, :4], rtol=0, atol=tolerance(dtype))


@DTYPES
@pytest.mark.parametrize(("wide", "step", "K"), [(4, 1, 1), (24, 8, 5)])
def test_frames_are_turned_and_put_in_their_place(wide: int, step: int, K: int, dtype, rng) -> None:
    n = 6
    u = rng.normal(size=(n + 1, wide)).astype(dtype)
    rows, rest = rng.permutation(n)[[0, 1, 2, 3, 4, 5, 2]], rng.normal(size=(7, 3))
    R, to, weights = Rotation.random(K, rng=rng).as_matrix(), rng.normal(size=(K, 3)), rng.random(7)
    weights[2] = 0
    weights /= weights.sum()
    out = np.zeros((K, 7, 3))
    write_frames(u.ravel(), wide, step, rows, rest, R, weights, to.copy(), out)
    for t in range(K):
        moved = (rest + u[rows][:, [t, t + step, t + 2 * step]]) @ R[t].T
        assert_allclose(out[t], moved - weights @ moved + to[t], rtol=0, atol=1e-12)
