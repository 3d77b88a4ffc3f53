"""Splicing clips: the whole is the identity, durations add up, seams are smooth, clocks are cut exactly."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from edit_clips import bending, signals_of
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tempose.curves import interpolating_spline, monotone_map
from tempose.signals import Signals
from tempose.signals.time.origin import Origin, splice_origin
from tempose.signals.time.splice import Join, splice

FPS = 24.0


@cache
def plain() -> Signals:
    return signals_of(bending(32))


@cache
def edited() -> Signals:
    """Two clocks, one with a pose held, and a curve that was moved."""
    s = plain()
    controls = s.time.curve.controls.copy()
    controls[12] += 0.1 * np.ptp(controls, axis=0)
    clocks = (
        monotone_map([0.0, 20.0, 45.0], [0.0, 12.0, 40.0]),
        monotone_map([0, 10, 18, 40.0], [0, 9, 9, 31.0]),
    )
    return replace(s, time=replace(s.time, curve=s.time.curve.with_controls(controls)), retimings=clocks)


def frames_as_pieces(signals: Signals, pieces: list[tuple[float, float]]) -> list[tuple[float, float]]:
    return [(a / signals.fps, b / signals.fps) for a, b in pieces]


def seen(signals: Signals, first: int = 0, last: int | None = None) -> np.ndarray:
    return signals.coordinates(signals.times)[first:last]


def size(signals: Signals) -> float:
    return float(np.ptp(seen(plain()), axis=0).max())


@pytest.mark.parametrize("make", [plain, edited])
def test_the_whole_is_the_identity(make):
    s = make()
    assert_allclose(seen(splice(s, [(0, s.duration)])), seen(s), atol=1e-11 * size(s))
    parts = splice(s, [(0, 0.3), (0.3, 0.71), (0.71, s.duration)])
    assert_allclose(seen(parts), seen(s), atol=1e-11 * size(s))


def test_the_whole_of_a_clip_nobody_edited_has_the_same_bits():
    s = plain()
    assert_array_equal(seen(splice(s, [(0, s.duration)])), seen(s))


@pytest.mark.parametrize("make", [plain, edited])
def test_backwards_twice_is_the_identity(make):
    s = make()
    once = splice(s, [(s.duration, 0)])
    assert_allclose(seen(once)[::-1], seen(s), atol=1e-10 * size(s))
    twice = splice(once, [(s.duration, 0)])
    assert_allclose(seen(twice), seen(s), atol=1e-10 * size(s))


@settings(max_examples=25)
@given(
    st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1)), min_size=1, max_size=4),
    st.sampled_from([Join(), Join(half_life=1.0), Join(insert=2), Join(fade=4.0)]),
    st.booleans(),
)
def test_durations_add_up(cuts, join, closed):
    s = edited()
    pieces = [(a * s.duration, b * s.duration) for a, b in cuts if abs(a - b) > 0.02]
    if not pieces:
        return
    whole = splice(s, pieces, join, closed=closed)
    met = sum(
        abs(pieces[i][1] - pieces[(i + 1) % len(pieces)][0]) >= 0
        for i in range(len(pieces) if closed else len(pieces) - 1)
    )
    gap = (join.insert + 1) / FPS if join.insert else 0.0
    assert_allclose(whole.duration, sum(abs(b - a) for a, b in pieces) + met * gap, atol=1e-9)
    assert np.isfinite(seen(whole)).all()


def test_frames_away_from_a_seam_are_those_cut_out():
    s = plain()
    spliced = splice(s, frames_as_pieces(s, [(0, 20), (8, 31)]), Join(half_life=0.5))
    assert spliced.n_frames == 44
    assert_array_equal(seen(spliced, 0, 14), seen(s, 0, 14))
    assert_allclose(seen(spliced, 27), seen(s, 15), atol=1e-12 * size(s))


def test_frames_beside_a_seam_of_clocks_are_those_cut_out():
    s = edited()
    spliced = splice(s, [(0, 30 / FPS), (4 / FPS, s.duration)], Join(insert=3))
    assert_allclose(seen(spliced, 0, 29), seen(s, 0, 29), atol=1e-11 * size(s))
    assert_allclose(seen(spliced, 36), seen(s, 6), atol=1e-10 * size(s))


@pytest.mark.parametrize("join", [Join(), Join(insert=2), Join(fade=6.0)])
def test_path_and_curve_have_two_continuous_derivatives(join):
    s = plain()
    spliced = splice(s, frames_as_pieces(s, [(0, 20), (29, 9), (5.5, 31)]), join)
    for curve in (spliced.path, spliced.time.curve, spliced.time.unedited):
        assert curve is not None
        breaks = curve.breaks[1:-1]
        h = 1e-4 * np.diff(curve.breaks).min()
        for order in range(3):
            jump = curve(breaks + h, order) - curve(breaks - h, order)
            assert np.abs(jump).max() < 10 * h * np.abs(curve(curve.breaks, order + 1)).max() + 1e-9


def test_what_nobody_edited_is_the_path_also_when_spliced():
    s = plain()
    spliced = splice(s, frames_as_pieces(s, [(0, 20), (29, 9)]))
    assert_array_equal(spliced.time.curve.controls, spliced.time.unedited.controls)
    assert spliced.path is not None
    assert_allclose(seen(spliced), spliced.path(spliced.ticks(spliced.times)), atol=1e-13 * size(s))


def test_a_held_pose_stays_held():
    s = replace(plain(), retimings=(monotone_map([0.0, 10, 20, 41], [0.0, 10, 10, 31]),))
    held = splice(s, [(12 / FPS, 19 / FPS)])
    assert held.n_frames == 8
    assert_allclose(seen(held), np.broadcast_to(seen(s)[15], (8, seen(s).shape[1])), atol=1e-12 * size(s))
    longer = splice(s, [(0, 15 / FPS), (11 / FPS, s.duration)])
    assert_allclose(seen(longer)[:11], seen(s)[:11], atol=1e-12 * size(s))
    assert_allclose(seen(longer)[10:25], np.broadcast_to(seen(s)[10], (15, seen(s).shape[1])), atol=1e-11)
    assert_allclose(seen(longer)[26:], seen(s)[22:], atol=1e-10 * size(s))


def test_a_hold_between_what_comes_before_and_after_it_lasts_as_long_as_is_asked():
    s = replace(plain(), retimings=(monotone_map([0.0, 10, 20, 41], [0.0, 10, 10, 31]),))
    spliced = splice(s, frames_as_pieces(s, [(0, 11), (13, 16), (19, 41)]))
    x = seen(s)
    assert spliced.n_frames == 37
    assert_allclose(seen(spliced), np.concatenate([x[:11], x[[10] * 5], x[21:42]]), atol=1e-10 * size(s))
    only = splice(s, frames_as_pieces(s, [(13, 16), (19, 41)]))
    assert_allclose(seen(only), np.concatenate([x[[10] * 5], x[21:42]]), atol=1e-10 * size(s))


def test_a_held_pose_put_before_another_one_is_left_smoothly():
    s = replace(plain(), retimings=(monotone_map([0.0, 10, 20, 41], [0.0, 10, 10, 31]),))
    spliced = splice(s, [(12 / FPS, 18 / FPS), (0, 8 / FPS)])
    x = seen(spliced)
    assert spliced.n_frames == 15
    assert_allclose(x[-1], seen(s)[8], atol=1e-3 * size(s))
    assert np.linalg.norm(np.diff(x, axis=0), axis=1).max() < 0.6 * np.linalg.norm(x[-1] - x[0]) + size(s)


@pytest.mark.parametrize("insert", [0, 3])
def test_a_closed_clip_ends_as_it_begins(insert):
    closed = splice(plain(), frames_as_pieces(plain(), [(4, 25)]), Join(insert=insert), closed=True)
    assert closed.n_frames == 22 + (insert + 1 if insert else 0)
    x = seen(closed)
    assert_allclose(x[0], x[-1], atol=1e-10 * size(closed))
    assert closed.path is not None
    first, last = closed.path.domain
    for order in range(3):
        assert_allclose(closed.path(first, order), closed.path(last, order), atol=1e-8 * size(closed))


def test_origin_knows_where_pieces_come_from():
    origin = splice_origin(None, [(0.0, 10.0), (8.0, 4.0), (2.0, 6.0)], [0.0, 2.0])
    assert origin is not None
    t = np.array([0.0, 5, 10.5, 13, 14.5, 15.5, 16, 18])
    assert_allclose(origin(t), [0, 5, 7.5, 5, 4, 2, 2, 4])
    again = splice_origin(origin, [(12.0, 18.0)], [])
    assert again is not None
    assert_allclose(again(t[:3] * 0.5), origin(12 + t[:3] * 0.5))
    back = splice_origin(splice_origin(origin, [(20.0, 0.0)], []), [(20.0, 0.0)], [])
    assert back is not None
    inside = np.array([1.0, 9.5, 12.2, 17.9, 19.0])
    assert_allclose(back(inside), origin(inside))


def test_origin_of_the_whole_is_none():
    assert splice_origin(None, [(0.0, 10.0)], []) is None
    whole = Origin(np.zeros(1), np.zeros(1), np.ones(1))
    assert_allclose(whole(np.arange(4.0)), np.arange(4.0))


def test_a_placement_walks_on():
    s = plain()
    t = np.arange(32.0)
    q = np.stack([np.ones(32), *np.zeros((3, 32)), 0.1 * t, 0 * t, 0 * t], axis=1)
    s = replace(s, placement=interpolating_spline(t, q))
    spliced = splice(s, frames_as_pieces(s, [(0, 31), (0, 31)]))
    assert spliced.placement is not None
    assert_allclose(spliced.placement(62.0)[4:], [6.2, 0, 0], atol=1e-9)


@pytest.mark.parametrize(
    ("pieces", "joins", "message"),
    [
        ([], None, "one piece or more"),
        ([(0.0, 0.0)], None, "must have a length"),
        ([(-0.1, 0.5)], None, "must have a length and lie in"),
        ([(0.0, 99.0)], None, "must have a length and lie in"),
        ([(0.0, 0.5), (0.2, 0.4)], [Join(), Join()], "meet at 1 seams"),
    ],
)
def test_pieces_that_cannot_be_are_refused(pieces, joins, message):
    with pytest.raises(ValueError, match=message):
        splice(plain(), pieces, joins)
