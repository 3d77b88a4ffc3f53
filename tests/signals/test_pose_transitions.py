"""Bad transitions are found where they are, and layouts are chosen that have none."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.interpolate import CubicSpline
from scipy.spatial.distance import pdist, squareform

from tempose.curves import interpolating_spline
from tempose.signals.pose import (
    PoseLayout,
    choose_layout,
    densified_pose_signal,
    find_bad_transitions,
    fit_pose_signal,
    order_sites,
)
from tempose.signals.pose.choose import pose_distances
from tempose.signals.pose.crossings import find_crossings
from tempose.signals.pose.fit import interpolating_pose_signal
from tempose.signals.pose.judge import aspect_ratio
from tempose.signals.pose.layout import stress_of
from tempose.signals.pose.middles import curve_through
from tempose.signals.pose.smoothing import _curve_matrix, _Smoothing, smooth_transitions
from tempose.signals.pose.time_graph import time_graph_distances

NONE = np.zeros(0, dtype=np.int64)


def gestures(n):
    """Four swings along four axes through nearly the same point, now on one side of it, now on the other."""
    keys = np.zeros((12, 5))
    for k in range(4):
        keys[3 * k : 3 * k + 3, k] = -1.0, 0.0, 1.0
        keys[3 * k : 3 * k + 3, 4] = 0.2 * (-1) ** k
    return CubicSpline(np.arange(12.0), keys, bc_type="natural")(np.linspace(0, 11, n))


def wave(n, turns=1.5):
    t = np.linspace(0, 1, n)
    return np.stack([t, np.sin(2 * np.pi * turns * t), 0.2 * np.cos(5 * t)], axis=1)


def test_errors_at_the_frames_are_not_counted_between_them():
    X = np.stack([np.arange(6.0) * 2, np.zeros(6)], axis=1)
    found = find_bad_transitions(lambda p, o: p + 5.0, interpolating_spline(np.arange(6.0), X), X)
    assert_allclose(found.deviation, 0.0, atol=1e-12)


def test_surface_that_follows_the_path_has_no_deviation():
    X = wave(20)
    time = interpolating_spline(np.arange(20.0), X[:, :2])
    g = fit_pose_signal(X[:, :2], X[:, :2], X[:, :2])
    found = find_bad_transitions(g, time, X[:, :2])
    assert found.deviation.shape == (19,) and found.worst < 1e-9 and not found.bad.any()


def test_deviation_is_the_distance_at_the_middle_in_steps():
    X = np.stack([np.arange(6.0) * 2, np.zeros(6)], axis=1)
    off = np.array([0.0, 0.5, 0.99, 1.01, 3.0])

    def shifted(p, origin):
        sideways = np.where(origin % 1 == 0.5, off[np.minimum(origin.astype(int), 4)], 0.0)
        return p + np.stack([np.zeros(len(p)), sideways], axis=1)

    found = find_bad_transitions(shifted, interpolating_spline(np.arange(6.0), X), X)
    assert_allclose(found.deviation, off / 2)
    assert_array_equal(found.bad, [False, False, False, True, True])
    assert found.worst == 1.5


def test_crossing_of_two_different_motions_is_bad():
    # two straight motions whose middles are one place of the plane but two poses
    X = np.array([[-1.5, 0, 1], [-0.5, 0, 1], [0.5, 0, 1], [1.5, 0, 1]] * 2, dtype=float)
    X[4:] = X[4:, [1, 0, 2]] * [1, 1, -1]
    P = X[:, :2]
    found = find_bad_transitions(interpolating_pose_signal(P, X), curve_through(P), X)
    assert found.bad[1] and found.bad[5]
    assert_allclose(interpolating_pose_signal(P, X)(np.zeros(2))[2], 0.0, atol=1e-9)


def test_held_frames_do_not_make_transitions_bad(rng):
    X = np.repeat(wave(8), 2, axis=0)
    X[1::2] += 1e-9 * rng.normal(size=(8, 3))
    choice = choose_layout(X)
    assert len(choice.bad) == 0


@pytest.mark.parametrize("n", [0, 1])
def test_without_transitions_none_is_bad(n):
    assert find_bad_transitions(lambda p, o=None: p, lambda t: t, np.zeros((n, 2))).worst == 0.0


def test_crossings_of_known_curves():
    assert len(find_crossings(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float))) == 0
    bow = np.array([[0, 0], [1, 1], [1, 0], [0, 1]], dtype=float)
    assert_array_equal(find_crossings(bow), [[0, 2]])
    # its line crosses the first segment's, not the segment itself
    beside = np.array([[0, 0], [1, 0], [5, -1], [5, 1]], dtype=float)
    assert len(find_crossings(beside)) == 0
    star = np.array([[np.cos(4 * np.pi * i / 5), np.sin(4 * np.pi * i / 5)] for i in range(6)])
    assert len(find_crossings(star)) == 5


def test_time_graph_lies_between_poses_and_motion():
    X = wave(25, 3.0)
    D = squareform(pdist(X))
    along = np.concatenate([[0.0], np.cumsum(np.diagonal(D, 1))])
    chain = np.abs(along[:, None] - along[None])
    assert_allclose(time_graph_distances(D, np.inf), D)
    assert_allclose(time_graph_distances(D, 0.0), chain, atol=1e-9)
    last = chain
    for reach in (1.5, 2.5, 4.0, 8.0):
        between = time_graph_distances(D, reach)
        assert_allclose(between, between.T)
        assert (between >= D - 1e-12).all() and (between <= last + 1e-9).all()
        last = between


def test_frames_are_joined_only_within_the_reach_of_both():
    # frames 0 and 4 lie 2 apart; steps beside frame 0 are 4, beside frame 4 1.41
    x = np.array([0.0, 4.0, 4.0, 3.0, 2.0])
    X = np.stack([x, [0.0, 0.0, 1.0, 1.0, 0.0]], axis=1)
    D = squareform(pdist(X))
    assert_allclose(time_graph_distances(D, 1.5)[0, 4], 2.0)
    assert time_graph_distances(D, 1.3)[0, 4] > 5.0


def test_time_graph_keeps_repeats_together():
    X = np.concatenate([wave(12), wave(12)])
    D = time_graph_distances(squareform(pdist(X)), 2.0)
    assert np.diagonal(D, 12).max() < 1e-6


def test_smoothing_gradient_is_the_central_difference(rng):
    X = gestures(25)
    D = squareform(pdist(X))
    P = PoseLayout(D).solve().positions
    search = _Smoothing(P, X, D, NONE)
    U = search.start + 0.01 * rng.normal(size=search.start.shape)
    search.curve = _curve_matrix(U, search.ticks)
    gradient = search.loss(U)[1]
    for _ in range(4):
        step = 1e-6 * rng.normal(size=U.shape)
        change = 0.5 * (search.loss(U + step)[0] - search.loss(U - step)[0])
        assert_allclose((gradient * step).sum(), change, rtol=1e-5)


def test_smoothing_of_a_clip_that_repeats_has_the_same_gradient(rng):
    X = np.concatenate([gestures(13), gestures(13)[::-1]])
    D = squareform(pdist(X))
    search = _Smoothing(PoseLayout(D).solve().positions, X, D, NONE)
    search.curve = _curve_matrix(search.start[search.group], search.ticks)
    step = 1e-6 * rng.normal(size=search.start.shape)
    change = 0.5 * (search.loss(search.start + step)[0] - search.loss(search.start - step)[0])
    assert len(search.start) == 13
    assert_allclose((search.loss(search.start)[1] * step).sum(), change, rtol=1e-5)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_smoothing_lowers_deviations_keeps_pins_and_scales(unit):
    X = gestures(33)
    D = squareform(pdist(X))
    P = PoseLayout(D).solve().positions
    fixed = np.array([5, 20])
    moved = smooth_transitions(P, X, D, fixed)
    assert_array_equal(moved[fixed], P[fixed])
    before, after = (
        find_bad_transitions(interpolating_pose_signal(Q, X), curve_through(Q), X) for Q in (P, moved)
    )
    assert np.log1p(after.deviation**2).mean() < 0.8 * np.log1p(before.deviation**2).mean()
    scaled = smooth_transitions(unit * P, unit * X, unit * D, fixed)
    again = find_bad_transitions(interpolating_pose_signal(scaled, unit * X), curve_through(scaled), unit * X)
    assert again.bad.sum() <= before.bad.sum()


def test_densified_signal_follows_the_path_between_frames():
    X = np.column_stack([wave(49, 2.5), np.sin(1.3 * np.arange(49.0))])
    P, path = X[:, :2].copy(), interpolating_spline(np.arange(49.0), X)
    time, ticks = curve_through(P), np.arange(0, 48.01, 0.25)
    plain, dense = interpolating_pose_signal(P, X), densified_pose_signal(P, X, time)
    off = [np.linalg.norm(g(time(ticks)) - path(ticks)) for g in (plain, dense)]
    assert off[1] < 0.25 * off[0]
    steps = np.linalg.norm(np.diff(X, axis=0), axis=1)
    assert np.abs(dense(P) - X).max() < 2e-3 * np.median(steps)
    assert len(dense.sites) <= 3 * 49


@pytest.mark.parametrize("n", [25, 33])
def test_passes_through_similar_poses_are_flagged_and_repaired(n):
    X = gestures(n)
    choice = choose_layout(X)
    assert choice.tried[0].name == "mds" and choice.tried[0].bad > 0
    assert len(choice.bad) == 0 and choice.deviation.max() <= 0.5 and choice.warnings == ()
    assert choice.aspect >= 0.2
    # judged anew from what the choice hands on
    g = order_sites(*choice.samples(X)).signal()
    found = find_bad_transitions(g, curve_through(choice.positions), X)
    assert_allclose(found.deviation, choice.deviation, atol=1e-6)
    # and closer to the finer motion between the frames
    fine, ticks = gestures(2 * n - 1)[1::2], np.arange(n - 1) + 0.5
    mds = choice.tried[0].positions
    plain = interpolating_pose_signal(mds, X)(curve_through(mds)(ticks))
    better = g(curve_through(choice.positions)(ticks))
    assert np.linalg.norm(better - fine) < 0.7 * np.linalg.norm(plain - fine)


def test_motion_in_a_plane_needs_plain_scaling_only():
    X = wave(30)[:, :2]
    choice = choose_layout(X)
    assert choice.name == "mds" and len(choice.tried) == 1 and len(choice.middles) == 0
    assert choice.stress < 1e-6
    assert_allclose(pdist(choice.positions), pdist(X), atol=1e-5)
    assert_allclose(choice.stress, stress_of(choice.positions, pose_distances(X)), atol=1e-9)


def test_chosen_layout_keeps_pins():
    X = gestures(25)
    pins = {0: (0.5, 0.25), 12: (0.1 + 1e-17, -1.0), 24: (-1.0, 0.7)}
    choice = choose_layout(X, pins)
    for frame, place in pins.items():
        assert_array_equal(choice.positions[frame], place)


def test_pins_that_exclude_a_good_layout_leave_a_warning_with_its_measure():
    X = gestures(25)
    rng = np.random.default_rng(3)
    choice = choose_layout(X, {i: rng.normal(size=2) for i in range(25)})
    strays = choice.tried[0].bad
    assert strays > 0
    assert len(choice.bad) == 0 or "steps" in choice.warnings[-1]


@pytest.mark.parametrize("n", [1, 2, 3])
def test_clips_of_few_frames(rng, n):
    X = rng.normal(size=(n, 2))
    choice = choose_layout(X)
    assert choice.positions.shape == (n, 2) and len(choice.bad) == 0
    assert_allclose(pdist(choice.positions), pdist(X), atol=1e-5)


@pytest.mark.parametrize("m", [0, 3])
def test_clip_that_stands_still(m):
    choice = choose_layout(np.ones((6, m)))
    assert_array_equal(choice.positions, np.zeros((6, 2)))
    assert len(choice.bad) == 0 and choice.deviation.max() == 0.0


def test_motion_along_a_line_is_laid_out_on_a_line():
    X = np.outer(np.sin(np.linspace(0, 3, 20)), [1.0, 2.0, 2.0])
    choice = choose_layout(X)
    assert len(choice.bad) == 0
    assert aspect_ratio(choice.positions) < 1e-6
    assert_allclose(pdist(choice.positions), pdist(X), atol=1e-5)


def test_poses_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="X must be finite"):
        choose_layout(np.array([[0.0], [np.nan], [1.0]]))


def test_pins_that_coincide_are_refused():
    with pytest.raises(ValueError, match="pinned at one place"):
        choose_layout(wave(12), {0: (0.0, 0.0), 6: (0.0, 0.0)})
