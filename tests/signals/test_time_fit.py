"""Time signals: every k is determined, exact where it can be, closed where asked; paths of cyclic clips."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.interpolate import BSpline

from tempose.curves import determines, interpolating_spline, least_squares_spline
from tempose.signals.time.fit import fit_time_signal
from tempose.signals.time.parameters import averaged_knots, centripetal_parameters
from tempose.signals.time.path import SAME_PHASE, cycle_spline, time_path, unrolled


def wandering(n: int, seed: int = 0, held: bool = False) -> np.ndarray:
    steps = np.random.default_rng(seed).normal(size=(n, 2))
    if held:
        steps[n // 3 : n // 2] = 0.0
    return np.cumsum(steps, axis=0)


def cyclic(t: np.ndarray, period: float) -> np.ndarray:
    w = 2 * np.pi * np.asarray(t)[..., None] / period
    return np.sin(w * [1, 1, 2] + [0.0, 1.5, 1.0]) * [1.0, 0.7, 0.4]


@settings(max_examples=60)
@given(st.integers(2, 90), st.floats(0, 1), st.integers(0, 99), st.booleans())
def test_every_k_is_fully_determined(n, share, seed, held):
    P = wandering(n, seed, held)
    k = min(4 + round(share * (n - 2)), n + 2)
    f = fit_time_signal(P, k)
    t = f.pace.values
    B = BSpline.design_matrix(t, f.curve.knots, 3).toarray()
    assert len(f.curve.controls) == k
    if k <= n:
        assert determines(f.curve.knots, t)
        assert np.linalg.matrix_rank(B) == k
        # no other controls come nearer: the residual is orthogonal to every B-spline
        assert_allclose(B.T @ (f(np.arange(n)) - P), 0.0, atol=1e-8 * np.abs(P).max() * n)
    if k >= n:
        assert_allclose(f(np.arange(float(n))), P, atol=1e-11 * (1 + np.abs(P).max()))


def test_evenly_placed_controls_keep_the_condition_low():
    t = centripetal_parameters(wandering(204))
    for k in (204, 200, 150):
        B = BSpline.design_matrix(t, averaged_knots(t, k), 3).toarray()
        assert np.linalg.cond(B) < 300  # with knots at j (n - 1) / (k - 3): 1e15 at k = n


def test_as_many_controls_as_frames_and_two_is_the_natural_spline():
    P = wandering(15)
    f = fit_time_signal(P, 17)
    u = np.linspace(*f.curve.domain, 90)
    assert_allclose(f.curve(u), interpolating_spline(f.pace.values, P)(u), atol=1e-14)
    assert_allclose(f.curve(np.array(f.curve.domain), 2), 0.0, atol=1e-10)


def test_one_control_less_is_natural_at_the_end_and_free_of_the_second_knot():
    P = wandering(15)
    f = fit_time_signal(P, 16)
    assert_allclose(f.curve(f.curve.domain[1], 2), 0.0, atol=1e-10)
    assert not np.isin(f.pace.values[1], f.curve.knots)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_the_fit_scales_with_the_pose_plane(unit):
    P = wandering(20)
    scaled, plain = fit_time_signal(unit * P, 11), fit_time_signal(P, 11)
    t = np.linspace(0, 19, 70)
    assert_allclose(scaled(t), unit * plain(t), rtol=1e-9, atol=1e-10 * unit)


def test_held_poses_keep_their_parameters_apart():
    t = centripetal_parameters(np.repeat(wandering(5), 3, axis=0))
    assert np.diff(t).min() > 0
    assert np.diff(t).min() >= 0.9e-3 * np.diff(t).mean()
    assert_allclose(np.diff(centripetal_parameters(np.zeros((4, 2)))), 1.0)


@given(st.integers(3, 40), st.floats(0, 1))
def test_a_closed_curve_closes_with_two_derivatives(n, share):
    P = wandering(n)
    k = min(4 + round(share * (n - 1)), n + 3)
    f = fit_time_signal(P, k, periodic=True)
    first, last = f.curve.domain
    size = np.abs(P).max()
    for order in range(3):
        jump = f.curve(first, order) - f.curve(last, order)
        assert np.abs(jump).max() < 1e-9 * (1 + np.abs(f.curve(np.linspace(first, last, 50), order)).max())
    assert f.pace.domain == (0.0, float(n))
    if k == n + 3:
        assert_allclose(f(np.arange(float(n))), P, atol=1e-11 * size)


def test_a_closed_fit_is_the_best_one():
    P = wandering(20)
    f = fit_time_signal(P, 12, periodic=True)
    off = f(np.arange(20.0)) - P
    # moving the whole closed curve is free, so the mean residual is zero
    assert_allclose(off.mean(0), 0.0, atol=1e-10)


@pytest.mark.parametrize(
    ("n", "k", "periodic"), [(8, 3, False), (8, 11, False), (8, 12, True), (1, 4, False)]
)
def test_k_out_of_range_and_one_frame_are_refused(n, k, periodic):
    with pytest.raises(ValueError, match=r"k must be 4 to|2 frames or more"):
        fit_time_signal(np.zeros((n, 2)), k, periodic=periodic)


def test_parameters_that_do_not_determine_the_controls_are_refused():
    knots = np.array([0.0] * 4 + [1, 2, 3] + [4.0] * 4)
    u = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 4.0])
    assert not determines(knots, u)
    with pytest.raises(ValueError, match="do not determine"):
        least_squares_spline(knots, u, np.zeros((7, 1)))
    assert determines(knots, np.array([0, 0.5, 1, 2, 3, 3.5, 4.0]))


def test_least_squares_agrees_with_the_dense_solution():
    rng = np.random.default_rng(2)
    u = np.sort(rng.random(50)) * 4
    u[[0, -1]] = 0, 4
    knots, points = np.array([0.0] * 4 + [1, 2, 3] + [4.0] * 4), rng.normal(size=(50, 3))
    B = BSpline.design_matrix(u, knots, 3).toarray()
    expected = np.linalg.lstsq(B, points, rcond=None)[0]
    assert_allclose(least_squares_spline(knots, u, points).controls, expected, atol=1e-12)


@pytest.mark.parametrize(("n", "period"), [(10, 4.8), (30, 7.3), (48, 24.0), (60, 12.4)])
def test_paths_go_through_every_frame(n, period):
    X = cyclic(np.arange(n), period) + 0.01 * np.random.default_rng(0).normal(size=(n, 3))
    assert_allclose(time_path(X)(np.arange(n)), X, atol=1e-13)
    assert_allclose(time_path(X, period)(np.arange(n)), X, atol=1e-12)


def test_cycles_tell_what_lies_between_the_frames_of_one():
    t, period = np.arange(31), 5.2
    between = np.linspace(0, 30, 301)
    errors = [
        np.abs(time_path(cyclic(t, period), p)(between) - cyclic(between, period)).max()
        for p in (None, period)
    ]
    assert errors[1] < 0.05 * errors[0]


def test_cycles_that_show_the_same_phases_change_nothing():
    X = cyclic(np.arange(48), 24.0)
    u = np.linspace(0, 47, 200)
    assert_allclose(time_path(X, 24.0)(u), time_path(X)(u), atol=1e-13)


def test_an_unrolled_cycle_is_the_cycle_again_and_again():
    cycle = cycle_spline(np.arange(20.0), cyclic(np.arange(20), 6.3), 6.3)
    rolled = unrolled(cycle, 0.0, 19.0)
    first, last = cycle.domain
    u = np.linspace(0, 19, 300)
    assert last - first == pytest.approx(6.3)
    assert_allclose(rolled(u), cycle(first + (u - first) % 6.3), atol=1e-12)
    gaps = np.diff(cycle.breaks)
    assert gaps.min() > 0.5 * SAME_PHASE


def test_a_period_longer_than_the_clip_is_refused():
    with pytest.raises(ValueError, match="period must be shorter"):
        time_path(np.zeros((5, 2)), 4.0)
    with pytest.raises(ValueError, match="2 frames or more"):
        time_path(np.zeros((1, 2)))
