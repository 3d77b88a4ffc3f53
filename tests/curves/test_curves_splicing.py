"""Spliced curves are C2 at every seam, and what lies beyond the reach of the seams is untouched."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tempose.curves import Seam, Spline, interpolating_spline, join_splines, slice_spline, splice_spline
from tempose.curves.bridge import bridge
from tempose.curves.offsets import damped_offset, window
from tempose.curves.splicing import REACH


def some_curve(n: int = 60, unit: float = 1.0) -> Spline:
    points = np.cumsum(np.random.default_rng(5).normal(size=(n, 3)), axis=0)
    return interpolating_spline(np.arange(float(n)), unit * points)


def jumps(curve: Spline, order: int) -> float:
    """The largest jump of a derivative at any knot, of the polynomials on either side."""
    breaks = curve.breaks
    worst = 0.0
    for left, at, right in zip(breaks[:-2], breaks[1:-1], breaks[2:]):
        sides = []
        for a, b in ((left, at), (at, right)):
            x = np.linspace(a, b, 6)[1:-1]  # four places determine a cubic
            p = np.polyfit(x - at, curve(x), 3)
            sides.append(p[3 - order])
        worst = max(worst, float(np.abs(sides[0] - sides[1]).max()))
    return worst


def assert_smooth(curve: Spline, scale: float) -> None:
    for order in range(3):
        assert jumps(curve, order) < 1e-8 * scale
    assert len(np.unique(curve.knots[4:-4])) == len(curve.controls) - 4  # every inner knot is a simple one


def test_the_whole_is_the_same_bit_for_bit():
    curve = some_curve()
    whole = splice_spline(curve, [(0.0, 59.0)], [])
    assert_array_equal(whole.controls, curve.controls)
    assert_array_equal(whole.knots, curve.knots)


@settings(max_examples=40)
@given(st.floats(0.5, 58.5))
def test_two_parts_of_the_whole_are_the_whole(at):
    curve = some_curve()
    joined = splice_spline(curve, [(0.0, at), (at, 59.0)], [Seam()])
    u = np.linspace(0, 59, 400)
    assert_allclose(joined(u), curve(u), atol=1e-9)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("seam", [Seam(1.5), Seam(gap=4.0), Seam(fade=6.0)])
def test_seams_are_smooth_whatever_the_pieces(seam, unit):
    curve = some_curve(unit=unit)
    pieces = [(0.0, 20.3), (44.0, 8.5), (8.0, 30.0), (12.0, 55.0)]
    joined = splice_spline(curve, pieces, [seam] * 3)
    length = sum(abs(b - a) for a, b in pieces) + 3 * seam.gap
    assert_allclose(joined.domain, (0.0, length))
    assert_smooth(joined, 10 * unit)


def test_short_pieces_are_smooth_too():
    joined = splice_spline(some_curve(), [(3.0, 3.4), (9.0, 9.9), (30.2, 30.0), (5.0, 25.0)], [Seam(2.0)] * 3)
    for order in range(3):
        assert jumps(joined, order) < 1e-4


def test_beyond_the_reach_of_a_seam_not_a_bit_changes():
    curve, half_life = some_curve(), 1.0
    joined = splice_spline(curve, [(0.0, 30.0), (10.0, 59.0)], [Seam(half_life)])
    before = np.arange(0, 30 - REACH * half_life - 2, 0.25)
    after = np.arange(30 + REACH * half_life + 2, 79, 0.25)
    assert_array_equal(joined(before), curve(before))
    assert_allclose(joined(after), curve(after - 20), atol=1e-12)
    assert np.abs(joined(28.0) - curve(28.0)).max() > 1e-3  # near it something does


def test_a_bridge_changes_no_piece():
    curve = some_curve()
    joined = splice_spline(curve, [(0.0, 30.0), (10.0, 59.0)], [Seam(gap=5.0)])
    u = np.arange(0, 30.01, 0.25)
    assert_allclose(joined(u), curve(u), atol=1e-12)
    u = np.arange(10, 59.01, 0.25)
    assert_allclose(joined(u + 25), curve(u), atol=1e-11)


def test_a_crossfade_plays_both_pieces_half_way():
    curve = some_curve()
    joined = splice_spline(curve, [(0.0, 30.0), (10.0, 59.0)], [Seam(fade=8.0)])
    assert_allclose(joined(30.0), 0.5 * (curve(30.0) + curve(10.0)), atol=1e-11)
    u = np.arange(0, 24.01, 0.5)
    assert_array_equal(joined(u), curve(u))
    quarter = window(np.array([2.0]), 8.0)[0]
    assert_allclose(joined(28.0), curve(28.0) + (1 - quarter) * (curve(8.0) - curve(28.0)), atol=0.2)


def test_backwards_twice_is_the_identity():
    curve = some_curve()
    twice = splice_spline(splice_spline(curve, [(59.0, 0.0)], []), [(59.0, 0.0)], [])
    u = np.linspace(0, 59, 200)
    assert_allclose(twice(u), curve(u), atol=1e-12)


@pytest.mark.parametrize("seam", [Seam(2.0), Seam(gap=3.0)])
def test_a_closed_curve_ends_as_it_begins(seam):
    joined = splice_spline(some_curve(), [(10.0, 31.5)], [seam], closed=True)
    first, last = joined.domain
    assert last - first == pytest.approx(21.5 + seam.gap)
    for order in range(3):
        assert_allclose(joined(first, order), joined(last, order), atol=1e-8)


def test_damped_offset_halves_in_its_half_life_and_ends_smoothly():
    state = np.array([[1.0, -2.0], [0.0, 0.0], [0.0, 0.0]])
    rest = damped_offset(state, 3.0, 1e6)  # next to no window
    assert_allclose(rest(np.array([0.0, 3.0]))[0], [[1.0, -2.0], [0.5, -1.0]], atol=1e-9)
    cut = damped_offset(np.random.default_rng(0).normal(size=(3, 2)), 2.0, 9.0)
    assert_allclose(cut(np.array([9.0, 12.0]))[:3], 0.0, atol=1e-12)


def test_damped_offset_starts_in_its_state_and_its_derivatives_are_its_own():
    state = np.random.default_rng(1).normal(size=(3, 4))
    offset = damped_offset(state, 2.0, 12.0)
    assert_allclose(offset(np.zeros(1))[:3, 0], state, atol=1e-12)
    q, h = np.linspace(0.5, 11.5, 30), 1e-5
    ahead, behind, here = offset(q + h), offset(q - h), offset(q)
    assert_allclose((ahead - behind)[:3] / (2 * h), here[1:], atol=1e-7)


def test_bridge_reaches_both_states():
    rng = np.random.default_rng(2)
    left, right = rng.normal(size=(3, 2)), rng.normal(size=(3, 2))
    curve = bridge(left, right, 4.0)
    for order in range(3):
        assert_allclose(curve(0.0, order), left[order], atol=1e-11)
        assert_allclose(curve(4.0, order), right[order], atol=1e-10)


def test_pieces_that_meet_are_joined_without_a_trace():
    curve = some_curve(30)
    cuts = [0.0, 4.2, 5.0, 17.7, 29.0]
    joined = join_splines([slice_spline(curve, a, b) for a, b in pairwise(cuts)])
    u = np.linspace(0, 29, 300)
    assert_allclose(joined(u), curve(u), atol=1e-11)
