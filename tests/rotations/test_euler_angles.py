"""Euler angles are the way back from composing turns about moving axes, everywhere."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.rotations import angle_between, continuous, from_euler_degrees, normalise, to_euler_degrees

ORDERS = ["".join(letters) for letters in permutations("xyz")]


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 40)])
def test_angles_compose_to_the_same_rotation(order, shape, rng):
    q = normalise(rng.normal(size=(*shape, 4)))
    assert angle_between(from_euler_degrees(to_euler_degrees(q, order), order), q).max() < 1e-12


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("middle", [90.0, -90.0, 90 - 1e-6, -90 + 1e-9, 89.99])
def test_middle_angle_near_a_right_angle_loses_nothing(order, middle):
    angles = np.array([[first, middle, last] for first in (-170.0, 0, 33) for last in (-120.0, 10)])
    q = from_euler_degrees(angles, order)
    assert angle_between(from_euler_degrees(to_euler_degrees(q, order), order), q).max() < 1e-11


@pytest.mark.parametrize("order", ORDERS)
def test_agrees_with_scipy(order, rng):
    q = normalise(rng.normal(size=(50, 4)))
    theirs = Rotation.from_quat(q[:, [1, 2, 3, 0]]).as_euler(order.upper(), degrees=True)
    assert_allclose(to_euler_degrees(q, order), theirs, atol=1e-9)


@pytest.mark.parametrize("order", ["xy", "xyx", "xyw", ""])
def test_other_orders_are_refused(order):
    with pytest.raises(ValueError, match="order must be the letters x, y and z"):
        to_euler_degrees(np.array([1.0, 0, 0, 0]), order)


def test_continuous_keeps_the_rotation_and_never_jumps(rng):
    axis = normalise(np.concatenate([[0.0], rng.normal(size=3)]))[1:]
    angle = np.linspace(0, 9 * np.pi, 200)
    q = np.concatenate([np.cos(angle / 2)[:, None], np.sin(angle / 2)[:, None] * axis], axis=1)
    mixed = q * rng.choice([-1.0, 1.0], size=(200, 1))
    mixed[0] = q[0]
    assert_allclose(continuous(mixed), q, atol=1e-14)
    assert continuous(mixed[:0]).shape == (0, 4) and continuous(mixed[:1, None]).shape == (1, 1, 4)
