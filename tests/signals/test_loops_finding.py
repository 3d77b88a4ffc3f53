"""Loops of closed forms are found and graded; closing leaves no seam."""

import numpy as np
import pytest
from edit_clips import bending, signals_of
from numpy.testing import assert_allclose

from tempose.signals.loops import Loop, close_loop, find_loops


def cyclic(t: np.ndarray, period: float) -> np.ndarray:
    w = 2 * np.pi * np.asarray(t)[..., None] / period
    return np.sin(w * [1, 1, 2, 3] + [0.0, 1.5, 1.0, 2.0]) * [1.0, 0.7, 0.4, 0.2]


def test_a_stride_stored_twice_is_an_exact_loop():
    stride = cyclic(np.arange(20) + 0.3 * np.sin(np.arange(20)), 20.0)
    loops = find_loops(np.concatenate([stride, stride]))
    assert loops[0].period == 20
    assert loops[0].grade == "exact"
    assert loops[0].distance == loops[0].velocity == 0.0


def test_lags_of_more_than_half_the_clip_are_found():
    X = cyclic(np.arange(30), 25.0)
    assert find_loops(X)[0].period == 25


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_cost_is_free_of_units_and_axes(unit):
    X = cyclic(np.arange(40), 13.3)
    Q = np.linalg.qr(np.random.default_rng(1).normal(size=(60, 4)))[0]
    one, other = find_loops(X), find_loops(unit * (X @ Q.T) + 7 * unit)
    assert [(k.start, k.stop) for k in one] == [(k.start, k.stop) for k in other]
    assert_allclose([k.cost for k in one], [k.cost for k in other], rtol=1e-7, atol=1e-9)
    assert one[0].grade == "good" and one[0].period == 13


def test_a_pause_is_no_loop():
    t = np.arange(60.0)
    X = np.stack([np.where(t < 40, 0.01 * np.sin(t), t - 40), t * 0], axis=1)
    for loop in find_loops(X):
        part = X[loop.start : loop.stop]
        assert np.linalg.norm(part - part.mean(0), axis=1).max() > 0.3
    assert find_loops(np.zeros((30, 2))) == []
    assert find_loops(X[:4]) == []


def test_loops_that_are_nearly_the_same_are_given_once():
    loops = find_loops(cyclic(np.arange(60), 13.3))
    for i, a in enumerate(loops):
        for b in loops[:i]:
            assert max(abs(a.start - b.start), abs(a.stop - b.stop)) > 2


def test_distance_is_the_plain_windowed_one():
    X = cyclic(np.arange(25), 9.4) + 0.05 * np.random.default_rng(3).normal(size=(25, 4))
    step = np.linalg.norm(np.diff(X, axis=0), axis=1).mean()
    speeds = np.gradient(X, axis=0, edge_order=2)
    found = find_loops(X)
    assert len(found) > 3
    for loop in found:
        a, b = loop.start, loop.stop
        window = [k for k in range(-2, 3) if a + k >= 0 and b + k < 25]
        squares = [np.square(X[a + k] - X[b + k]).sum() for k in window]
        assert_allclose(loop.distance, np.sqrt(np.mean(squares)) / step, rtol=1e-7)
        apart = np.linalg.norm(speeds[a] - speeds[b]) / np.linalg.norm(speeds, axis=1).mean()
        assert_allclose(loop.velocity, apart, rtol=1e-7)


@pytest.mark.parametrize("times", [2, 5])
def test_what_is_a_good_loop_does_not_depend_on_how_densely_it_was_captured(times):
    one = find_loops(cyclic(np.arange(24), 13.3))[0]
    dense = find_loops(cyclic(np.arange(24 * times) / times, 13.3), fps=24.0 * times)
    assert dense[0].grade == one.grade == "good"
    assert dense[0].period == pytest.approx(13.3 * times, abs=1)
    assert min(loop.period for loop in dense) >= 6 * times
    for i, a in enumerate(dense):
        for b in dense[:i]:
            assert max(abs(a.start - b.start), abs(a.stop - b.stop)) > 2 * times


def test_the_seam_lies_where_least_moves():
    # round and round, each time a little farther out, now fast, now slow
    t = np.arange(50.0)
    angle = 2 * np.pi * t / 16 + 0.6 * np.sin(2 * np.pi * t / 16)
    X = (1 + 0.008 * t)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    speed = np.linalg.norm(np.gradient(X, axis=0), axis=1)
    best = find_loops(X)[0]
    assert best.period == 16 and best.grade == "good"
    assert speed[best.start] < 0.6 * speed.mean()


def test_a_coarse_clip_that_ends_as_it_begins_is_an_exact_loop():
    X = cyclic(np.arange(11), 10.0)
    best = find_loops(X)[0]
    assert (best.start, best.stop, best.grade) == (0, 10, "exact")
    # it comes back to the pose, but another way
    angle = np.linspace(0, np.pi, 21)
    drop = np.stack([np.sin(2 * angle), np.sin(angle)], axis=1)
    whole = [loop for loop in find_loops(drop) if (loop.start, loop.stop) == (0, 20)]
    assert whole and whole[0].grade == "needs a transition"


def test_going_away_is_no_loop():
    t = np.arange(30.0)
    assert find_loops(np.stack([t, 0.02 * t**2], axis=1)) == []


def test_grades():
    assert Loop(0, 8, 0.0, 0.0).grade == "exact"
    assert Loop(0, 8, 0.5, 0.4).grade == "good"
    assert Loop(0, 8, 0.5, 0.6).grade == Loop(0, 8, 0.8, 0.1).grade == "needs a transition"


@pytest.mark.parametrize("options", [{"shortest": 0}, {"most": 0}, {"fps": 0.0}])
def test_options_out_of_range_are_refused(options):
    with pytest.raises(ValueError, match=r"must be (1 or more|positive)"):
        find_loops(np.zeros((9, 2)), **options)


@pytest.mark.parametrize("insert", [0, 3, None])
def test_closing_leaves_no_seam(insert):
    signals = signals_of(bending(40))
    x = signals.coordinates(signals.times)
    steps = np.linalg.norm(np.diff(x, axis=0), axis=1)
    stop = 20 + int(np.argmax(np.linalg.norm(x[20:] - x[5], axis=1)))
    closed = close_loop(signals, 5, stop, insert)
    z = closed.coordinates(closed.times)
    assert_allclose(z[0], z[-1], atol=1e-9 * np.abs(x).max())
    assert np.linalg.norm(x[stop] - x[5]) > 3 * np.median(steps)
    bends = np.linalg.norm(np.diff(np.concatenate([z[:-1], z[:3]]), 2, axis=0), axis=1)
    raw = np.linalg.norm(np.diff(np.concatenate([x[5:stop], x[5:8]]), 2, axis=0), axis=1)
    assert bends.max() < 0.5 * raw.max()
    if insert != 0:
        assert_allclose(z[: stop - 4], x[5 : stop + 1], atol=1e-9 * np.abs(x).max())


@pytest.mark.parametrize(("start", "stop", "insert"), [(5, 5, None), (9, 5, None), (0, 99, None), (0, 9, -1)])
def test_loops_that_cannot_be_are_refused(start, stop, insert):
    with pytest.raises(ValueError, match=r"a loop goes from|insert must be"):
        close_loop(signals_of(bending(20)), start, stop, insert)


@pytest.mark.real
def test_the_gallop_is_one_stride_twice(data_folder):
    import tempose

    V = np.asarray(tempose.load(data_folder("horse-gallop")).vertices, dtype=np.float64)
    loops = find_loops(V.reshape(len(V), -1))
    periods = {loop.period: loop for loop in reversed(loops)}
    assert loops[0].period == 24 and loops[0].grade == "exact"
    assert periods[12].grade == "good"


@pytest.mark.real
def test_the_seam_of_two_unlike_strides_is_no_larger_than_the_median_step(data_folder):
    import tempose

    clip = tempose.load(data_folder("horse-gallop"))
    signals = tempose.SignalModel(layout="mds", tolerance=0.1).fit(clip).signals_
    found = find_loops(signals.coordinates(signals.times), fps=signals.fps)
    loop = next(loop for loop in found if loop.period == 12)
    closed = close_loop(signals, loop.start, loop.stop)
    steps = np.linalg.norm(np.diff(closed.coordinates(closed.times), axis=0), axis=1)
    assert len(steps) == 12
    assert max(steps[0], steps[-1]) <= np.median(steps)
