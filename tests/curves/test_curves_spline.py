"""Splines agree with scipy's; pieces, reversals and added knots are the same curve."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import BSpline, CubicSpline

from tempose.curves import Spline, insert_knots, interpolating_spline, periodic_spline, slice_spline


def some_spline(seed: int = 0, n: int = 12) -> Spline:
    rng = np.random.default_rng(seed)
    return interpolating_spline(np.cumsum(rng.random(n) + 0.05), rng.normal(size=(n, 3)))


@pytest.mark.parametrize("order", [0, 1, 2, 3])
@pytest.mark.parametrize("shape", [(), (1,), (7,), (3, 1, 2)])
def test_values_and_derivatives_agree_with_scipy(order, shape):
    spline = some_spline()
    u = np.random.default_rng(1).uniform(*spline.domain, size=shape)
    expected = BSpline(spline.knots, spline.controls, 3)(u, nu=order)
    assert spline(u, order).shape == (*shape, 3)
    assert_allclose(spline(u, order), expected, rtol=1e-11, atol=1e-10)


def test_repeated_inner_knots_are_evaluated_as_scipy_does():
    knots = np.array([0, 0, 0, 0, 1, 2, 2, 2, 3, 3, 3, 3.0])
    spline = Spline(knots, np.random.default_rng(0).normal(size=(8, 2)))
    u = np.array([0, 0.5, 1, 1.9, 2, 2.1, 2.999, 3])
    assert_allclose(spline(u), BSpline(knots, spline.controls, 3)(u), atol=1e-14)


def test_beyond_the_domain_the_ends_are_kept():
    spline = some_spline()
    first, last = spline.domain
    assert_array_equal(spline(first - 5), spline(first))
    assert_array_equal(spline(last + 5), spline(last))
    assert_allclose(spline(last), spline.controls[-1], atol=1e-14)


def test_moving_a_control_changes_no_bit_outside_its_support():
    spline = some_spline()
    u = np.linspace(*spline.domain, 999)
    for j in range(len(spline.controls)):
        controls = spline.controls.copy()
        controls[j] += 1.0
        low, high = spline.support(j)
        outside = (u < low) | (u > high)
        moved = spline.with_controls(controls)
        assert_array_equal(moved(u[outside]), spline(u[outside]))
        inside = (u > low) & (u < high)
        assert (moved(u[inside]) != spline(u[inside])).any(axis=1).all()


@pytest.mark.parametrize("j", [-1, 14])
def test_support_of_a_control_that_does_not_exist_is_refused(j):
    with pytest.raises(ValueError, match="control must be 0 to 13"):
        some_spline().support(j)


@given(st.integers(0, 99), st.floats(0, 0.98), st.floats(0.01, 1))
def test_a_piece_is_the_curve(seed, begin, length):
    spline = some_spline(seed, 8)
    first, last = spline.domain
    a = first + begin * (last - first)
    b = a + max(length * (last - a), 1e-3 * (last - first))
    b = min(b, last)
    piece = slice_spline(spline, a, b)
    u = np.linspace(a, b, 50)
    assert piece.domain == (a, b)
    assert_allclose(piece(u), spline(u), atol=1e-12)
    assert_allclose(piece(u, 1), spline(u, 1), atol=1e-9 * (1 + np.abs(spline(u, 1)).max()))


def test_the_whole_as_a_piece_has_the_same_bits():
    spline = some_spline()
    whole = slice_spline(spline, *spline.domain)
    assert_array_equal(whole.controls, spline.controls)
    assert_array_equal(whole.knots, spline.knots)


def test_a_piece_keeps_the_controls_whose_knots_it_keeps():
    spline = some_spline(n=20)
    a, b = spline.knots[8], spline.knots[16]
    piece = slice_spline(spline, a, b)
    # three knots of each end are new triples; those between stand in both
    assert_array_equal(piece.controls[3:-3], spline.controls[8:13])


@pytest.mark.parametrize(("a", "b"), [(5.0, 5.0), (6.0, 5.0), (-1.0, 5.0), (1.0, 99.0)])
def test_pieces_that_are_none_are_refused(a, b):
    with pytest.raises(ValueError, match="a piece must lie in"):
        slice_spline(interpolating_spline(np.arange(10.0), np.zeros((10, 1))), a, b)


def test_knots_are_inserted_without_a_trace():
    spline = some_spline()
    u = np.linspace(*spline.domain, 300)
    first, last = spline.domain
    at = [0.3 * first + 0.7 * last, 0.5 * (first + last), 0.5 * (first + last)]
    finer = insert_knots(spline, at)
    assert len(finer.controls) == len(spline.controls) + 3
    assert_allclose(finer(u), spline(u), atol=1e-13)
    assert_array_equal(insert_knots(spline, []).controls, spline.controls)


def test_a_knot_outside_is_refused():
    with pytest.raises(ValueError, match="new knots must lie inside"):
        insert_knots(some_spline(), [99.0])


def test_backwards_twice_is_forwards():
    spline = some_spline()
    first, last = spline.domain
    u = np.linspace(first, last, 50)
    assert_allclose(spline.reversed()(first + last - u), spline(u), atol=1e-13)
    assert_allclose(spline.reversed().reversed()(u), spline(u), atol=1e-13)


def test_shifted_along():
    spline = some_spline()
    u = np.linspace(*spline.domain, 50)
    assert_allclose(spline.shifted(2.5)(u + 2.5), spline(u), atol=1e-13)


def test_natural_spline_agrees_with_scipy():
    rng = np.random.default_rng(3)
    u, points = np.cumsum(rng.random(9) + 0.1), rng.normal(size=(9, 2))
    x = np.linspace(u[0], u[-1], 200)
    expected = CubicSpline(u, points, bc_type="natural")
    assert_allclose(interpolating_spline(u, points)(x), expected(x), atol=1e-13)
    free = interpolating_spline(u, points, natural_start=False)
    assert len(free.controls) == 10
    assert_allclose(free(u), points, atol=1e-13)
    assert_allclose(free(u[-1], 2), 0.0, atol=1e-10)


def test_periodic_spline_closes_with_two_derivatives():
    rng = np.random.default_rng(3)
    u, points = np.cumsum(rng.random(9) + 0.1), rng.normal(size=(9, 2))
    spline = periodic_spline(u, points, 9.0)
    assert spline.domain == (u[0], u[0] + 9.0)
    assert_allclose(spline(u), points, atol=1e-13)
    for order in range(3):
        assert_allclose(spline(u[0], order), spline(u[0] + 9.0, order), atol=1e-10)


@pytest.mark.parametrize(
    "make",
    [
        lambda: interpolating_spline([0.0], [[1.0]]),
        lambda: interpolating_spline([0.0, 0.0], [[1.0], [2.0]]),
        lambda: interpolating_spline([0.0, 1.0], [[1.0], [2.0]], natural_start=False),
        lambda: periodic_spline([0.0, 1.0], [[1.0], [2.0]], 1.0),
        lambda: Spline(np.arange(8.0)[::-1], np.zeros((4, 1))),
        lambda: Spline(np.zeros(8), np.zeros((4, 1))),
    ],
)
def test_what_is_no_spline_is_refused(make):
    with pytest.raises(ValueError, match=r"u must hold|knots must not fall"):
        make()
