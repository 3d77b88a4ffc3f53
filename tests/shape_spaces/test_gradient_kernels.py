"""The compiled loops over faces against loops in numpy and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from gradient_meshes import ball, deformed, pieces, sheet
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.shape_spaces.gradient import polynomials
from tempose.shape_spaces.gradient.branches import follow_branch
from tempose.shape_spaces.gradient.decode_kernels import decode_faces
from tempose.shape_spaces.gradient.encode_kernels import BLOCK, LOG, SCRATCH, TURNED, log_between
from tempose.shape_spaces.gradient.faces import FaceGradients, padded
from tempose.shape_spaces.gradient.place_kernels import centres, write_vertices
from tempose.shape_spaces.gradient.references import as_axes


def slow_gradients(V: np.ndarray, W: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Deformation gradients (m, 3, 3), the normal over the root of its length as a third edge."""

    def edges(X: np.ndarray) -> np.ndarray:
        a, b = X[F[:, 1]] - X[F[:, 0]], X[F[:, 2]] - X[F[:, 0]]
        n = np.cross(a, b)
        return np.stack([a, b, n / np.sqrt(np.linalg.norm(n, axis=1, keepdims=True))], axis=2)

    return edges(W) @ np.linalg.inv(edges(V))


def encoded(gradients: FaceGradients, V: np.ndarray, frames: np.ndarray) -> np.ndarray:
    z = np.zeros(9 * gradients.n_faces + 3 * gradients.n_pieces)
    gradients.encode(V, frames, z)
    return z[: 9 * gradients.n_faces].reshape(9, -1) / gradients.scale


@pytest.mark.parametrize("make", [ball, sheet, pieces])
def test_rotation_and_stretch_are_those_of_a_singular_value_decomposition(make, rng) -> None:
    V, F = make()
    W = deformed(V, rng, 3, size=0.6)[2]
    gradients = FaceGradients(V, F)
    z = encoded(gradients, W, gradients.frames())
    U, s, Vt = np.linalg.svd(slow_gradients(V, W, F))
    assert np.linalg.det(U @ Vt).min() > 0
    axes = as_axes(gradients.frames())
    w = Rotation.from_matrix(axes.swapaxes(1, 2) @ (U @ Vt) @ axes).as_rotvec()
    S = axes.swapaxes(1, 2) @ (Vt.swapaxes(1, 2) * s[:, None]) @ Vt @ axes
    assert_allclose(z[:3].T, w, atol=1e-10)
    assert_allclose(z[3:6].T, np.einsum("mii->mi", S) - 1, atol=1e-11)
    beside = np.stack([S[:, 0, 1], S[:, 0, 2], S[:, 1, 2]])
    assert_allclose(z[6:], np.sqrt(2) * beside, atol=1e-11)


def test_rotation_vectors_agree_with_scipy_at_every_angle(rng) -> None:
    limit = np.arccos(polynomials.LEAST_COSINE)
    special = [0, 1e-300, 1e-12, 1e-7, 1e-3, limit - 1e-9, limit + 1e-9, 3.1, np.pi - 1e-8, np.pi - 1e-14]
    angles = np.concatenate([special, rng.uniform(0, np.pi, BLOCK - len(special))])
    axis = rng.normal(size=(BLOCK, 3))
    axis[:20] = np.eye(3)[np.arange(20) % 3]
    w = angles[:, None] * axis / np.linalg.norm(axis, axis=1, keepdims=True)
    N = Rotation.random(BLOCK, rng=rng).as_matrix()
    R = N @ Rotation.from_rotvec(w).as_matrix()
    work = np.ones(SCRATCH)
    work[TURNED : TURNED + 9 * BLOCK] = R.transpose(2, 1, 0).reshape(-1)
    log_between(padded(N.transpose(2, 1, 0).reshape(9, -1)), 0, BLOCK, work)
    found = work[LOG : LOG + 3 * BLOCK].reshape(3, BLOCK).T
    expected = Rotation.from_matrix(N.swapaxes(1, 2) @ R).as_rotvec()
    # exactly half a turn may be found about either direction of the axis
    sign = np.where((found * expected).sum(axis=1) < 0, -1.0, 1.0)
    assert (sign[angles < np.pi - 1e-7] > 0).all()
    assert_allclose(sign[:, None] * found, expected, atol=2e-13)
    assert_allclose(Rotation.from_rotvec(found).as_matrix(), Rotation.from_rotvec(w).as_matrix(), atol=1e-13)


@pytest.mark.parametrize("faces", [1, 2, 3, 4, 5, 127, 128, 129, 131])
def test_the_right_hand_side_is_that_of_a_loop(faces: int, rng) -> None:
    """Any number of faces, rotations of many turns, stretches of no face."""
    z = rng.normal(size=(2, 9, faces))
    frames = Rotation.random(2 * faces, rng=rng).as_matrix().reshape(2, faces, 3, 3)
    z[:, :3] *= rng.uniform(0, 30, faces)
    z[:, :3, 0] = 0
    pull, weigh = rng.normal(size=(4, faces)), rng.uniform(0.5, 2, faces)
    # nearly a whole turn, and nearly one and a half
    lengths = np.linalg.norm(z[:, :3, -1], axis=1, keepdims=True) * weigh[-1]
    z[:, :3, -1] *= np.array([[1.99 * np.pi], [2.99 * np.pi]]) / np.where(lengths > 0, lengths, 1)
    n, wide = 20, 8
    rows = rng.integers(0, n, size=(3, faces))
    start = rng.normal(size=(n + 1, wide))
    flat = np.stack([padded(axes.transpose(2, 1, 0).reshape(9, -1)) for axes in frames])
    vectors, constants = (
        np.stack([padded(row) for row in z]).ravel(),
        (padded(weigh), padded(pull), rows.ravel()),
    )
    for step, of_second in ((flat.shape[1], 1), (0, 0)):
        X, slow = start.copy(), start.copy()
        decode_faces(vectors, flat.shape[1], flat.ravel(), step, *constants, wide, X.reshape(-1))
        for t, N in enumerate((frames[0], frames[of_second])):
            add_slowly(weigh * z[t], N, pull, rows, slow[:, 3 * t : 3 * t + 3])
        assert_allclose(X, slow, rtol=0, atol=2e-13)


def add_slowly(z: np.ndarray, N: np.ndarray, pull: np.ndarray, rows: np.ndarray, X: np.ndarray) -> None:
    r = np.sqrt(0.5)
    for f, (w, (xx, yy, zz, xy, xz, yz)) in enumerate(zip(z[:3].T, z[3:].T)):
        S = np.eye(3) + np.array([[xx, r * xy, r * xz], [r * xy, yy, r * yz], [r * xz, r * yz, zz]])
        T = N[f] @ Rotation.from_rotvec(w).as_matrix() @ S
        a, b = T @ [*pull[:2, f], 0], T @ [*pull[2:, f], 0]
        for row, change in zip(rows[:, f], (-(a + b), a, b)):
            X[row] += change


def test_the_nearest_branch_is_found_among_all(rng) -> None:
    m = 300
    w = rng.normal(size=(3, m))
    w *= rng.uniform(0, np.pi, m) / np.linalg.norm(w, axis=0)
    w[:, :5] = 0
    before = 6 * rng.normal(size=(3, m))
    weigh = rng.uniform(0.2, 3, m)
    found = w / weigh
    follow_branch(before / weigh, weigh, found)
    found *= weigh
    expected = Rotation.from_rotvec(w.T).as_matrix()
    assert_allclose(Rotation.from_rotvec(found.T).as_matrix(), expected, atol=1e-12)
    angle = np.linalg.norm(w, axis=0)
    turned = w / np.where(angle > 0, angle, 1)
    turned[:, :5] = before[:, :5] / np.linalg.norm(before[:, :5], axis=0)
    choices = np.stack([(angle + 2 * np.pi * k) * turned for k in range(-6, 7)])
    best = np.linalg.norm(choices - before, axis=1).min(axis=0)
    assert_allclose(np.linalg.norm(found - before, axis=0), best, atol=1e-10)


def test_centres_and_vertices_are_those_of_numpy(rng) -> None:
    component = np.array([0, 1, 0, 2, 1, 0])
    weights = rng.uniform(0.1, 1, 6)
    weights /= np.bincount(component, weights)[component]
    V, out = rng.normal(size=(6, 3)), np.ones((3, 3))
    centres(V.ravel(), component, weights, out)
    expected = np.stack([(weights[:, None] * V)[component == c].sum(axis=0) for c in range(3)])
    assert_allclose(out, expected, atol=1e-15)
    row, X, to, W = rng.permutation(6), rng.normal(size=(7, 8)), rng.normal(size=(3, 6)), np.zeros((2, 6, 3))
    write_vertices(X, row, component, weights, to, W)
    for t in range(2):
        columns = slice(3 * t, 3 * t + 3)
        centres(W[t].ravel(), component, weights, out)
        assert_allclose(out, to[:, columns], atol=1e-14)
        shift = W[t] - X[row, columns]
        assert_allclose(shift, shift[[0, 1, 0, 3, 1, 0]], atol=1e-14)


def test_polynomials_are_exact_to_rounding() -> None:
    y = np.linspace(1e-9, np.sqrt(polynomials._QUARTER), 2001)
    r = np.linspace(1e-9, np.pi / 2, 2001)
    for coefficients, x, expected in (
        (polynomials.ARCTANGENT, y, np.arctan(y) / y),
        (polynomials.SINE, r, np.sin(r) / r),
        (polynomials.COSINE, r, np.cos(r)),
    ):
        found = np.polynomial.polynomial.polyval(x * x, coefficients)
        assert_allclose(found, expected, rtol=0, atol=1e-15)
