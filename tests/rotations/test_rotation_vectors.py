"""The exponential map and Euler angles, at 0, at tiny angles and at half turns."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.rotations import (
    IDENTITY,
    conjugate,
    from_euler_degrees,
    from_rotation_vector,
    multiply,
    to_matrix,
    to_rotation_vector,
)

ANGLES = [0, 1e-300, 1e-16, 1e-12, 1e-7, 1e-5, 1e-3, 1, np.pi / 2, 3, np.pi - 1e-7, np.pi - 1e-12]
SHAPES = [(), (1,), (3, 1, 2), (0,)]


def axes(rng: np.random.Generator, count: int = 30) -> np.ndarray:
    a = np.concatenate([np.eye(3), -np.eye(3), rng.normal(size=(count, 3))])
    return a / np.linalg.norm(a, axis=1, keepdims=True)


@pytest.mark.parametrize("angle", ANGLES)
def test_log_inverts_exp(rng, angle: float) -> None:
    v = angle * axes(rng)
    assert_allclose(to_rotation_vector(from_rotation_vector(v)), v, rtol=1e-12, atol=1e-15 * angle)


@pytest.mark.parametrize("angle", [*ANGLES, np.pi])
def test_exp_inverts_log_for_both_signs(rng, angle: float) -> None:
    q = from_rotation_vector(angle * axes(rng))
    for sign in (1, -1):
        back = from_rotation_vector(to_rotation_vector(sign * q))
        assert_allclose(to_matrix(back), to_matrix(q), rtol=0, atol=4e-15)
        assert_allclose(
            to_rotation_vector(sign * q), to_rotation_vector(q), rtol=0, atol=2e-15 if angle < 3.1 else 7
        )
    assert (np.linalg.norm(to_rotation_vector(q), axis=1) <= np.pi + 1e-15).all()


@pytest.mark.parametrize("angle", [*ANGLES, np.pi, 4.0, 2 * np.pi, 7.0])
def test_agrees_with_scipy(rng, angle: float) -> None:
    v = angle * axes(rng)
    assert_allclose(
        to_matrix(from_rotation_vector(v)), Rotation.from_rotvec(v).as_matrix(), rtol=0, atol=2e-15
    )


def test_the_derivative_at_zero_is_half_the_vector(rng) -> None:
    v = rng.normal(size=(10, 3))
    step = (from_rotation_vector(1e-6 * v) - from_rotation_vector(-1e-6 * v)) / 2e-6
    assert_allclose(step[:, 1:], v / 2, rtol=1e-9)
    assert_array_equal(step[:, 0], 0)


def test_turns_about_one_axis_add(rng) -> None:
    a, s, t = axes(rng), rng.normal(size=(36, 1)), rng.normal(size=(36, 1))
    both = multiply(from_rotation_vector(s * a), from_rotation_vector(t * a))
    assert_allclose(both, from_rotation_vector((s + t) * a), rtol=0, atol=1e-14)
    assert_allclose(conjugate(from_rotation_vector(s * a)), from_rotation_vector(-s * a), rtol=0, atol=1e-15)


@pytest.mark.parametrize("shape", SHAPES)
def test_batches_equal_single_calls(rng, shape) -> None:
    v = rng.normal(size=(*shape, 3))
    q = from_rotation_vector(v)
    assert q.shape == (*shape, 4) and to_rotation_vector(q).shape == v.shape
    for index in np.ndindex(shape):
        assert_array_equal(q[index], from_rotation_vector(v[index]))
        assert_array_equal(to_rotation_vector(q)[index], to_rotation_vector(q[index]))


@pytest.mark.parametrize("order", ["x", "yz", "xyz", "zxy", "zyx", "yxz", "xyx", "zxz"])
def test_euler_angles_are_turns_about_moving_axes_first_letter_outermost(rng, order: str) -> None:
    angles = rng.uniform(-400, 400, size=(20, len(order)))
    expected = np.broadcast_to(np.eye(3), (20, 3, 3))
    for k, letter in enumerate(order):
        turn = np.radians(angles[:, k, None]) * np.eye(3)["xyz".index(letter)]
        expected = expected @ Rotation.from_rotvec(turn).as_matrix()
    assert_allclose(to_matrix(from_euler_degrees(angles, order)), expected, rtol=0, atol=1e-14)
    assert_array_equal(from_euler_degrees(angles, order.upper()), from_euler_degrees(angles, order))
    if len(order) == 3:
        scipys = Rotation.from_euler(order.upper(), angles, degrees=True).as_matrix()
        assert_allclose(to_matrix(from_euler_degrees(angles, order)), scipys, rtol=0, atol=1e-14)


def test_no_angles_are_no_rotation() -> None:
    assert_array_equal(from_euler_degrees(np.zeros((2, 0)), ""), np.tile(IDENTITY, (2, 1)))
    assert_array_equal(from_euler_degrees(np.zeros(3), "zxy"), IDENTITY)


@pytest.mark.parametrize(
    ("angles", "order", "message"),
    [
        (np.zeros((5, 3)), "zx", r"angles must have one column for each letter of 'zx', got shape \(5, 3\)"),
        (np.zeros((5, 2)), "zxy", "one column for each letter of 'zxy'"),
        (np.zeros((5, 3)), "zxw", "order must be letters out of 'xyz', got 'zxw'"),
    ],
)
def test_channels_that_do_not_fit_are_refused(angles, order: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        from_euler_degrees(angles, order)
