"""Monotone maps never fall, go through their keys, and are cut and inverted exactly."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import CubicHermiteSpline

from tempose.curves import MonotoneMap, join_maps, monotone_map


def some_map(seed: int = 0, n: int = 9, power: float = 3.0) -> MonotoneMap:
    rng = np.random.default_rng(seed)
    rises = rng.random(n) ** power * (rng.random(n) > 0.15)
    return monotone_map(np.cumsum(rng.random(n) + 0.05), np.cumsum(rises))


@given(st.integers(0, 500), st.sampled_from([0.5, 3.0, 9.0]))
def test_never_falls_and_goes_through_its_keys(seed, power):
    clock = some_map(seed, power=power)
    t = np.linspace(*clock.domain, 500)
    assert np.diff(clock(t)).min() >= -1e-14
    assert clock(t, 1).min() >= -1e-12
    assert_allclose(clock(clock.keys), clock.values, atol=1e-14)


def test_agrees_with_scipy():
    clock = some_map()
    t = np.linspace(clock.domain[0] - 1, clock.domain[1] + 1, 200)
    twin = CubicHermiteSpline(clock.keys, clock.values, clock.slopes)
    inside = np.clip(t, *clock.domain)
    assert_allclose(clock(t), twin(inside), atol=1e-14)
    assert_allclose(clock(t, 1), twin(inside, nu=1), atol=1e-12)


def test_slopes_where_nothing_turns_are_three_point_differences():
    x = np.array([0.0, 1.0, 3.0, 4.0])  # parabola: three-point differences are its slopes
    clock = monotone_map(x, (x + 1) ** 2)
    assert_allclose(clock.slopes, 2 * (x + 1), atol=1e-13)
    t = np.linspace(0, 4, 50)
    assert_allclose(clock(t), (t + 1) ** 2, atol=1e-13)


def test_slopes_that_would_turn_are_drawn_into_the_circle_of_radius_three():
    clock = monotone_map([0.0, 1.0, 2.0, 3.0], [0.0, 1e-3, 10.0, 10.1])
    secants = np.diff(clock.values)
    radius = np.hypot(clock.slopes[:-1], clock.slopes[1:]) / secants
    assert radius.max() <= 3 + 1e-12
    assert radius.max() > 2.9  # the circle is reached: nothing is damped more than needed


def test_flat_parts_stay_flat():
    clock = monotone_map([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 1.0, 2.0])
    assert_array_equal(clock(np.linspace(1, 2, 20)), np.ones(20))


@given(st.integers(0, 200))
def test_inverse_gives_the_place_back(seed):
    clock = some_map(seed)
    y = np.linspace(clock.values[0], clock.values[-1], 101)
    assert_allclose(clock(clock.inverse(y)), y, atol=1e-13)
    t = clock.inverse(y)
    assert np.diff(t).min() >= 0


def test_inverse_outside_the_range_gives_the_ends():
    clock = monotone_map([1.0, 2.0, 3.0], [0.0, 1.0, 4.0])
    assert_array_equal(clock.inverse([-5.0, 9.0]), [1.0, 3.0])
    assert clock.inverse(2.0).shape == ()


@given(st.integers(0, 100), st.floats(0, 0.9), st.floats(0.05, 1))
def test_a_piece_is_the_map(seed, begin, length):
    clock = some_map(seed)
    first, last = clock.domain
    a = first + begin * (last - first)
    b = a + length * (last - a)
    t = np.linspace(a, b, 60)
    assert_allclose(clock.slice(a, b)(t), clock(t), atol=1e-13)
    assert_allclose(clock.with_keys(t)(t), clock(t), atol=1e-13)


def test_backwards_twice_is_forwards():
    clock = some_map(4)
    first, last = clock.domain
    t = np.linspace(first, last, 60)
    low, high = clock.values[0], clock.values[-1]
    assert_allclose(clock.reversed()(first + last - t), low + high - clock(t), atol=1e-13)
    assert_allclose(clock.reversed().reversed()(t), clock(t), atol=1e-13)


def test_joined_halves_are_the_whole():
    clock = some_map(7)
    middle = 0.4 * clock.domain[0] + 0.6 * clock.domain[1]
    joined = join_maps([clock.slice(clock.domain[0], middle), clock.slice(middle, clock.domain[1])])
    t = np.linspace(*clock.domain, 300)
    assert_allclose(joined(t), clock(t), atol=1e-13)


def test_joined_maps_never_fall_and_take_the_slower_pace_at_the_seam():
    slow, fast = monotone_map([0.0, 1.0], [0.0, 1.0]), monotone_map([5.0, 7.0], [3.0, 11.0])
    joined = join_maps([slow, fast])
    assert joined.domain == (0.0, 3.0)
    assert_allclose(joined(3.0), 9.0)
    assert_allclose(joined(1.0, 1), 1.0)
    assert np.diff(joined(np.linspace(0, 3, 200))).min() > 0


@pytest.mark.parametrize(
    ("keys", "values"), [([0.0], [1.0]), ([0.0, 0.0], [0.0, 1.0]), ([0.0, 1.0], [1.0, 0.0])]
)
def test_keys_that_are_no_map_are_refused(keys, values):
    with pytest.raises(ValueError, match="keys must ascend"):
        monotone_map(keys, values)


@pytest.mark.parametrize(("a", "b"), [(1.0, 1.0), (-1.0, 1.0), (1.0, 9.0)])
def test_pieces_that_are_none_are_refused(a, b):
    with pytest.raises(ValueError, match="a piece must lie in"):
        monotone_map([0.0, 2.0], [0.0, 1.0]).slice(a, b)
