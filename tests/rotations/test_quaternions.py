"""Quaternions are the group of rotations: axioms, conversions at the hard spots, agreement with scipy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.rotations import (
    IDENTITY,
    angle_between,
    conjugate,
    from_matrix,
    from_rotation_vector,
    multiply,
    normalise,
    rotate,
    slerp,
    to_matrix,
)

SHAPES = [(), (1,), (3, 1, 2), (0,), (7,)]
shapes = pytest.mark.parametrize("shape", SHAPES)


def random(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    q = rng.normal(size=(*shape, 4))
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def scipy_rotation(q: np.ndarray) -> Rotation:
    return Rotation.from_quat(q[..., [1, 2, 3, 0]])


def assert_same_rotation(p: np.ndarray, q: np.ndarray, atol: float = 1e-12) -> None:
    p, q = np.broadcast_arrays(p, q)
    sign = np.where(np.sum(p * q, axis=-1, keepdims=True) < 0, -1, 1)
    assert_allclose(p, sign * q, rtol=0, atol=atol)


@shapes
def test_products_of_unit_quaternions_are_unit_quaternions(rng, shape) -> None:
    p, q = random(rng, shape), random(rng, shape)
    product = multiply(p, q)
    assert product.shape == (*shape, 4)
    assert_allclose(np.linalg.norm(product, axis=-1), np.ones(shape), rtol=0, atol=1e-12)


@shapes
def test_the_identity_is_neutral_and_the_conjugate_inverse(rng, shape) -> None:
    q = random(rng, shape)
    assert_array_equal(multiply(IDENTITY, q), q)
    assert_array_equal(multiply(q, IDENTITY), q)
    one = np.broadcast_to(IDENTITY, q.shape)
    assert_allclose(multiply(q, conjugate(q)), one, rtol=0, atol=1e-15)
    assert_allclose(multiply(conjugate(q), q), one, rtol=0, atol=1e-15)
    assert_array_equal(conjugate(conjugate(q)), q)


@shapes
def test_multiplication_is_associative_and_reverses_under_the_conjugate(rng, shape) -> None:
    p, q, r = (random(rng, shape) for _ in range(3))
    assert_allclose(multiply(multiply(p, q), r), multiply(p, multiply(q, r)), rtol=0, atol=1e-14)
    assert_allclose(conjugate(multiply(p, q)), multiply(conjugate(q), conjugate(p)), rtol=0, atol=1e-15)


@shapes
def test_matrices_and_vectors_follow_the_product(rng, shape) -> None:
    p, q, x = random(rng, shape), random(rng, shape), rng.normal(size=(*shape, 3))
    assert_allclose(to_matrix(multiply(p, q)), to_matrix(p) @ to_matrix(q), rtol=0, atol=1e-14)
    assert_allclose(rotate(multiply(p, q), x), rotate(p, rotate(q, x)), rtol=0, atol=1e-13)
    assert_allclose(rotate(q, x), np.einsum("...ij,...j->...i", to_matrix(q), x), rtol=0, atol=1e-13)
    assert_allclose(np.linalg.norm(rotate(q, x), axis=-1), np.linalg.norm(x, axis=-1), rtol=1e-12)


@shapes
def test_matrices_are_rotations(rng, shape) -> None:
    R = to_matrix(random(rng, shape))
    assert R.shape == (*shape, 3, 3)
    assert_allclose(R @ np.swapaxes(R, -1, -2), np.broadcast_to(np.eye(3), R.shape), rtol=0, atol=1e-14)
    assert_allclose(np.linalg.det(R), np.ones(shape), rtol=0, atol=1e-13)


def test_leading_axes_broadcast(rng) -> None:
    p, q, x = random(rng, (5, 1)), random(rng, (3,)), rng.normal(size=(4, 1, 1, 3))
    product = multiply(p, q)
    assert product.shape == (5, 3, 4)
    assert rotate(q, x).shape == (4, 1, 3, 3)
    for i in range(5):
        for j in range(3):
            assert_allclose(product[i, j], multiply(p[i, 0], q[j]))


def test_agrees_with_scipy(rng) -> None:
    p, q, x = random(rng, (50,)), random(rng, (50,)), rng.normal(size=(50, 3))
    P, Q = scipy_rotation(p), scipy_rotation(q)
    assert_allclose(to_matrix(p), P.as_matrix(), rtol=0, atol=1e-14)
    assert_allclose(rotate(p, x), P.apply(x), rtol=0, atol=1e-13)
    assert_same_rotation(multiply(p, q), (P * Q).as_quat()[:, [3, 0, 1, 2]])
    assert_allclose(angle_between(p, q), (P.inv() * Q).magnitude(), rtol=0, atol=1e-12)


@shapes
def test_q_and_minus_q_are_one_rotation(rng, shape) -> None:
    p, q = random(rng, shape), random(rng, shape)
    assert_array_equal(to_matrix(-q), to_matrix(q))
    assert_array_equal(from_matrix(to_matrix(-q)), from_matrix(to_matrix(q)))
    assert_allclose(angle_between(p, -q), angle_between(p, q), rtol=0, atol=1e-15)
    assert_same_rotation(slerp(p, -q, np.full(shape, 0.3)), slerp(p, q, np.full(shape, 0.3)))


@shapes
def test_from_matrix_inverts_to_matrix_with_w_not_negative(rng, shape) -> None:
    q = random(rng, shape)
    back = from_matrix(to_matrix(q))
    assert back.shape == q.shape and (back[..., 0] >= 0).all()
    assert_same_rotation(back, q, atol=1e-14)


HARD = [1.0, 1e-3, 1e-8, 1e-12, 1e-16, 0.0]


@pytest.mark.parametrize("small", HARD)
@pytest.mark.parametrize("pivot", range(4))
def test_from_matrix_near_every_pivot(rng, pivot: int, small: float) -> None:
    q = small * rng.normal(size=(40, 4))
    q[:, pivot] = 1
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    assert_same_rotation(from_matrix(to_matrix(q)), q, atol=1e-15)


def test_from_matrix_where_pivots_tie() -> None:
    signs = np.array(np.meshgrid(*[[-1, 1]] * 4)).reshape(4, -1).T
    ties = [signs / 2.0]
    for a in range(4):
        for b in range(a):
            pair = np.zeros((len(signs), 4))
            pair[:, [a, b]] = signs[:, :2] / np.sqrt(2)
            ties.append(pair)
    q = np.concatenate(ties)
    assert_same_rotation(from_matrix(to_matrix(q)), q, atol=1e-15)


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [-1, 2, 0.1]])
@pytest.mark.parametrize("turn", [0, 1e-7, np.pi / 2, np.pi - 1e-7, np.pi, np.pi + 1e-7])
def test_from_matrix_at_hard_angles(axis: list[float], turn: float) -> None:
    v = turn * np.array(axis) / np.linalg.norm(axis)
    assert_same_rotation(
        from_matrix(Rotation.from_rotvec(v).as_matrix()), from_rotation_vector(v), atol=1e-15
    )


def test_normalise_scales_and_takes_zero_for_no_rotation(rng) -> None:
    q = random(rng, (6,))
    assert_allclose(normalise(q * np.array([1e-140, 1e-3, 1, 7, 1e3, 1e150])[:, None]), q, rtol=0, atol=1e-14)
    assert_array_equal(normalise(np.zeros((2, 4))), np.tile(IDENTITY, (2, 1)))


def test_the_identity_cannot_be_overwritten() -> None:
    with pytest.raises(ValueError, match="read-only"):
        IDENTITY[0] = 2


@pytest.mark.parametrize("angle", [0, 1e-9, 1e-7, 1e-3, 1, np.pi - 1e-7, np.pi])
def test_angle_between_is_exact_where_arccos_is_not(rng, angle: float) -> None:
    axis = rng.normal(size=(20, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    p = random(rng, (20,))
    q = multiply(p, from_rotation_vector(angle * axis))
    assert_allclose(angle_between(p, q), angle, atol=2e-15, rtol=1e-9)
    assert_allclose(angle_between(q, p), angle, atol=2e-15, rtol=1e-9)


@pytest.mark.parametrize("angle", [0, 1e-7, 1e-3, 1, 3, np.pi - 1e-7])
def test_slerp_turns_at_constant_speed(rng, angle: float) -> None:
    axis = rng.normal(size=3)
    p = random(rng, ())
    q = multiply(p, from_rotation_vector(angle * axis / np.linalg.norm(axis)))
    s = np.linspace(0, 1, 21)
    path = slerp(p, q, s)
    assert path.shape == (21, 4)
    assert_same_rotation(path[[0, -1]], np.stack([p, q]), atol=1e-15)
    assert_allclose(angle_between(path[:-1], path[1:]), angle / 20, rtol=1e-6, atol=4e-16)
    assert_allclose(np.linalg.norm(path, axis=1), 1, rtol=0, atol=1e-14)


def test_slerp_goes_on_beyond_its_ends(rng) -> None:
    p = random(rng, ())
    step = from_rotation_vector(np.array([0.1, 0.2, -0.3]))
    beyond = slerp(p, multiply(p, step), np.array([-1.0, 2.0]))
    assert_same_rotation(beyond[0], multiply(p, conjugate(step)), atol=1e-14)
    assert_same_rotation(beyond[1], multiply(p, multiply(step, step)), atol=1e-14)


def test_slerp_agrees_with_scipy_and_runs_the_same_both_ways(rng) -> None:
    p, q, s = random(rng, (30,)), random(rng, (30,)), rng.random(30)
    relative = (scipy_rotation(p).inv() * scipy_rotation(q)).as_rotvec()
    expected = scipy_rotation(p) * Rotation.from_rotvec(s[:, None] * relative)
    assert_same_rotation(slerp(p, q, s), expected.as_quat()[:, [3, 0, 1, 2]])
    assert_same_rotation(slerp(p, q, s), slerp(q, p, 1 - s))


def test_slerp_over_a_half_turn_takes_one_of_the_two_ways() -> None:
    q = np.array([0.0, 1, 0, 0])
    for end in (q, -q):
        assert_allclose(angle_between(IDENTITY, slerp(IDENTITY, end, 0.25)), np.pi / 4, rtol=0, atol=1e-12)


@shapes
def test_slerp_batches_equal_single_calls(rng, shape) -> None:
    p, q, s = random(rng, shape), random(rng, shape), rng.random(shape)
    batch = slerp(p, q, s)
    assert batch.shape == (*shape, 4)
    for index in np.ndindex(shape):
        assert_array_equal(batch[index], slerp(p[index], q[index], s[index]))
