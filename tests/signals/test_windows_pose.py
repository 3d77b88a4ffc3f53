"""A pose signal of windows is the plain one where one window suffices, and smooth where two meet."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.distance import cdist

from tempose.signals.pose.densified import densified_pose_signal
from tempose.signals.pose.layout import PoseLayout
from tempose.signals.pose.middles import curve_through
from tempose.signals.pose.sites import order_sites
from tempose.signals.pose.transitions import find_bad_transitions
from tempose.signals.time.path import time_path
from tempose.signals.windows import (
    WindowedFit,
    WindowedPose,
    cover,
    fit_dense_windows,
    fit_windowed_pose,
    fit_windows,
)
from tempose.typing import FloatArray


def pacing(T: int, unit: float = 1.0) -> FloatArray:
    """Shape coordinates of a gait whose stride changes slowly."""
    t = np.arange(T)
    stride, slow = 2 * np.pi * t / 23.7, np.sin(2 * np.pi * t / 400)
    columns = [(1 + 0.3 * slow) * np.sin(stride), np.cos(stride), 0.4 * np.sin(2 * stride + slow), 0.6 * slow]
    columns += [0.1 * np.sin(3 * stride + k * slow) for k in range(3)]
    return unit * np.stack(columns, axis=1)


@pytest.fixture(scope="module")
def fitted() -> WindowedFit:
    return fit_windows(pacing(400), 100, 30, limit=1e-4)


def test_one_window_is_the_plain_fit() -> None:
    X = pacing(90)
    found = fit_windows(X, 300, sites=20)
    P = PoseLayout(cdist(X, X)).solve().positions
    assert_array_equal(found.positions, P)
    plain = order_sites(P, X).signal(20)
    p = np.random.default_rng(0).standard_normal((50, 2))
    for origin in (None, np.linspace(-3, 95, 50)):
        assert_array_equal(found.pose(p, origin), plain(p))
        assert_array_equal(found.pose.jacobian(p, origin), plain.jacobian(p))
        assert_array_equal(found.pose.second_derivatives(p, origin), plain.second_derivatives(p))


def test_one_window_keeps_pins_as_the_plain_fit_does() -> None:
    X, pins = pacing(60), {3: (0.5, 0.2), 41: (-1.0, 0.0)}
    assert_array_equal(
        fit_windows(X, 300, pins=pins).positions, PoseLayout(cdist(X, X)).solve(pins).positions
    )


def test_frames_are_met_to_the_limit(fitted: WindowedFit) -> None:
    X = pacing(400)
    residual = np.square(fitted.pose(fitted.positions, np.arange(400.0)) - X).sum(axis=1)
    assert_allclose(fitted.errors, residual, atol=1e-15)
    for i in range(len(fitted.pose.cover)):
        frames = fitted.pose.cover.frames(i)
        alone = np.square(fitted.pose.windows[i](fitted.positions[frames]) - X[frames]).sum(axis=1)
        assert alone.mean() <= 1e-4 * (1 + 1e-9)
    assert residual.mean() <= 1e-4


def test_all_sites_give_every_frame_back() -> None:
    X = pacing(250)
    found = fit_windows(X, 100, 30)
    assert found.errors.max() < 1e-16


def test_where_windows_meet_value_slope_and_curvature_go_on(fitted: WindowedFit) -> None:
    windows = fitted.pose.cover
    p = fitted.positions[windows.frames(1).start] + [0.1, 0.2]
    for at in (windows.starts[1], windows.stops[0], windows.starts[2]):
        h = 0.02
        x = fitted.pose(np.tile(p, (9, 1)), at + h * np.arange(-4, 5))
        jumps = [np.abs(np.diff(x, order, axis=0)).max() / h**order for order in (1, 2)]
        size = np.abs(fitted.pose.windows[1](p) - fitted.pose.windows[0](p)).max()
        width = windows.stops[0] - windows.starts[1]
        # the fade's derivatives are at most 1.9 and 5.8 over the width; here, at its ends, they are nearly 0
        assert jumps[0] < 0.01 * size / width and jumps[1] < 0.5 * size / width**2


def test_blend_is_the_weighted_sum_of_the_two_windows(fitted: WindowedFit) -> None:
    random = np.random.default_rng(1)
    p, t = random.standard_normal((200, 2)), random.uniform(0, 399, 200)
    first, weight = fitted.pose.cover(t)
    pose = fitted.pose
    found = pose(p, t), pose.jacobian(p, t), pose.second_derivatives(p, t)
    for k in range(200):
        i, w = int(first[k]), weight[k]
        g, h = pose.windows[i], pose.windows[min(i + 1, len(pose.windows) - 1)]
        assert_allclose(found[0][k], (1 - w) * g(p[k]) + w * h(p[k]), atol=1e-13)
        assert_allclose(found[1][k], (1 - w) * g.jacobian(p[k]) + w * h.jacobian(p[k]), atol=1e-12)
        second = (1 - w) * g.second_derivatives(p[k]) + w * h.second_derivatives(p[k])
        assert_allclose(found[2][k], second, atol=1e-11)


@pytest.mark.parametrize("batch", [(), (1,), (3, 1, 2), (0,)])
def test_any_batch_gives_the_bits_of_single_places(fitted: WindowedFit, batch: tuple[int, ...]) -> None:
    random = np.random.default_rng(2)
    p, t = random.standard_normal((*batch, 2)), random.uniform(0, 399, batch)
    x = fitted.pose(p, t)
    assert x.shape == (*batch, 7) and fitted.pose.jacobian(p, t).shape == (*batch, 7, 2)
    for i in np.ndindex(batch):
        assert_array_equal(x[i], fitted.pose(p[i], t[i]))


def test_without_ticks_the_window_of_the_nearest_site_answers(fitted: WindowedFit) -> None:
    for i, g in enumerate(fitted.pose.windows):
        alone = [
            s for s in g.sites if sum((h.sites == s).all(axis=1).any() for h in fitted.pose.windows) == 1
        ][:3]
        for site in alone:
            assert fitted.pose.nearest_window(site) == i
            assert_array_equal(fitted.pose(site), g(site))


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_unit_does_not_matter(unit: float) -> None:
    one, other = (fit_windows(pacing(200, u), 80, 25, sites=20) for u in (1.0, unit))
    assert_allclose(other.positions, unit * one.positions, atol=1e-3 * unit)
    t = np.linspace(0, 199, 37)
    p = one.positions[t.astype(int)]
    assert_allclose(other.pose(unit * p, t), unit * one.pose(p, t), atol=0.02 * unit)


def test_windows_and_cover_must_go_together(fitted: WindowedFit) -> None:
    with pytest.raises(ValueError, match="one for each of the cover"):
        WindowedPose(fitted.pose.windows[:2], fitted.pose.cover)


def test_places_given_are_kept() -> None:
    X, P = pacing(150), np.random.default_rng(3).standard_normal((150, 2))
    pose = fit_windowed_pose(P, X, cover(150, 60, 20))
    assert_allclose(pose(P, np.arange(150.0)), X, atol=1e-9)


def test_no_transition_strays_where_the_number_of_sites_is_free() -> None:
    # a figure traced in many dimensions crosses itself in the plane: there g alone would be torn
    t = np.arange(300) / 11
    X = np.stack([np.sin(k * t + k * k) / k for k in range(1, 7)], axis=1)
    plain, free = fit_windows(X, 100, 30, sites=10_000), fit_windows(X, 100, 30)
    f = curve_through(free.positions)
    assert_array_equal(plain.positions, free.positions)
    before, after = (find_bad_transitions(fit.pose, f, X) for fit in (plain, free))
    assert before.bad.sum() > 5 and after.bad.sum() == 0
    assert len(plain.middles) == 0 and len(free.middles) >= 3 * 5
    assert free.errors.max() < 1e-10


def test_dense_windows_follow_the_smooth_motion_between_frames() -> None:
    X = pacing(150)
    fit = fit_windows(X, 60, 20)
    f, path = curve_through(fit.positions), time_path(X, None)
    dense = fit_dense_windows(f, X, fit.pose.cover)
    t = np.arange(0, 149.01, 0.25)
    at_frames = fit_windowed_pose(fit.positions, X, fit.pose.cover)
    step = np.linalg.norm(np.diff(X, axis=0), axis=1).mean()
    stray, before = (np.linalg.norm(g(f(t), t) - path(t), axis=1) / step for g in (dense, at_frames))
    # places where the curve crosses itself stay: there one surface cannot follow both ways
    assert np.median(stray) < 0.01 < 3 * np.median(before) and np.percentile(stray, 90) < 0.1
    one = cover(50, 60, 20)
    alone = fit_dense_windows(curve_through(fit.positions[:50]), X[:50], one)
    plain = densified_pose_signal(fit.positions[:50], X[:50], curve_through(fit.positions[:50]))
    assert_allclose(alone(f(t[:160]), t[:160]), plain(f(t[:160])), atol=1e-9)
