"""Pieces of a walk, put one after another, walk on over the ground."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.curves import Seam, Spline
from tempose.rotations import angle_between, from_rotation_vector, multiply
from tempose.signals.placement import (
    GroundMotion,
    ground_motions,
    placement_at,
    placement_spline,
    splice_placement,
)
from tempose.typing import FloatArray

UP = np.array([0.0, 1.0, 0.0])


def circling(T: int, angle: float, radius: float = 2.0) -> FloatArray:
    """A body on a circle about a point off the origin, facing ahead, nodding and bobbing, `angle` in all."""
    s = np.linspace(0, 1, T)
    yaw = from_rotation_vector((angle * s)[:, None] * UP)
    nod = from_rotation_vector(np.stack([0.3 * np.sin(2 * np.pi * s), 0 * s, 0.1 + 0 * s], axis=1))
    place = np.stack(
        [3 + radius * np.cos(-angle * s), 1 + 0.05 * np.cos(4 * np.pi * s), radius * np.sin(-angle * s) - 5],
        axis=1,
    )
    return np.concatenate([multiply(yaw, nod), place], axis=1)


def ends(spline: Spline, pieces: list[tuple[float, float]]) -> tuple[FloatArray, FloatArray]:
    motions = ground_motions(spline, pieces)
    starts = np.array([m(placement_at(spline, a)) for m, (a, _) in zip(motions, pieces)])
    stops = np.array([m(placement_at(spline, b)) for m, (_, b) in zip(motions, pieces)])
    return starts, stops


@pytest.mark.parametrize("n", [3, 4, 7])
def test_a_loop_of_a_circle_walk_closes_after_whole_turns(n: int) -> None:
    spline = placement_spline(circling(41, 2 * np.pi / n))
    starts, stops = ends(spline, [(0.0, 40.0)] * n)
    assert_allclose(stops[-1, 4:], starts[0, 4:], atol=1e-9)
    assert angle_between(stops[-1, :4], starts[0, :4]) < 1e-7
    assert np.linalg.norm(stops[0, 4:] - starts[0, 4:]) > 0.5


def test_every_piece_starts_where_the_last_ended_and_heights_never_drift() -> None:
    spline = placement_spline(circling(60, 1.3))
    pieces = [(0.0, 20.0), (7.5, 31.0), (40.0, 12.0), (3.0, 59.0), (59.0, 58.0), (10.0, 10.5)] * 5
    starts, stops = ends(spline, pieces)
    assert_allclose(starts[1:, [4, 6]], stops[:-1, [4, 6]], atol=1e-9)
    for rows, k in ((starts, 0), (stops, 1)):
        heights = placement_at(spline, np.array([piece[k] for piece in pieces]))[:, 5]
        assert_allclose(rows[:, 5], heights, atol=1e-12)
    assert (np.sum(starts[1:, :4] * stops[:-1, :4], axis=1) > 0).all()


def test_what_is_left_at_a_seam_of_a_rotation_is_no_turn_about_the_vertical() -> None:
    spline = placement_spline(circling(60, 1.3))
    starts, stops = ends(spline, [(0.0, 20.0), (33.0, 50.0)])
    w, _, y, _ = multiply(starts[1, :4], stops[0, :4] * [1, -1, -1, -1])
    assert abs(y) < 1e-12 and w > 0


def test_the_first_piece_and_seamless_pieces_are_not_moved() -> None:
    spline = placement_spline(circling(30, 0.8))
    for motion in ground_motions(spline, [(4.0, 11.0), (11.0, 20.0), (20.0, 13.0)]):
        assert_allclose(motion.turn, [1, 0, 0, 0], atol=1e-9)
        assert_allclose(motion.shift, 0, atol=1e-9)


def test_moving_the_controls_moves_the_curve() -> None:
    spline = placement_spline(circling(30, 0.8))
    motion = GroundMotion(from_rotation_vector(1.1 * UP), np.array([3.0, 0.0, -2.0]))
    moved = Spline(spline.knots, motion(spline.controls))
    t = np.linspace(0, 29, 77)
    assert_allclose(moved(t), motion(spline(t)), atol=1e-12)


def test_the_clip_turned_on_the_ground_has_its_pieces_turned_too() -> None:
    clip, whole = circling(30, 0.8), GroundMotion(from_rotation_vector(-2.0 * UP), np.array([1.0, 0.0, 4.0]))
    pieces = [(0.0, 20.0), (5.0, 9.0), (28.0, 3.0)]
    plain = ends(placement_spline(clip), pieces)
    moved = ends(placement_spline(whole(clip)), pieces)
    for a, b in zip(plain, moved):
        assert_allclose(b, whole(a), atol=1e-9)


def test_a_body_that_goes_straight_on_goes_straight_on() -> None:
    clip = np.tile([1.0, 0, 0, 0, 0, 0, 0], (11, 1))
    clip[:, 4] = np.arange(11)
    _, stops = ends(placement_spline(clip), [(2.0, 8.0)] * 4)
    assert_allclose(stops[:, 4:], [[8, 0, 0], [14, 0, 0], [20, 0, 0], [26, 0, 0]], atol=1e-9)


def steady_circle(T: int, angle: float, strides: int = 4) -> FloatArray:
    """Walking round at a steady pace, `strides` nods in all: every stride is the one before, moved."""
    s = np.linspace(0, 1, T)
    beat = 2 * np.pi * strides * s
    nod = from_rotation_vector(np.stack([0.3 * np.sin(beat), 0 * s, 0.1 * np.cos(beat)], axis=1))
    turn = from_rotation_vector((angle * s)[:, None] * UP)
    there = np.stack([3 + 2 * np.cos(angle * s), 1 + 0.05 * np.cos(beat), -2 * np.sin(angle * s) - 5], axis=1)
    return np.concatenate([multiply(turn, nod), there], axis=1)


def apart(a: FloatArray, b: FloatArray) -> float:
    """Greatest angle and distance between placements."""
    return float(max(angle_between(a[..., :4], b[..., :4]).max(), np.abs(a[..., 4:] - b[..., 4:]).max()))


def test_looping_a_stride_goes_on_round_the_circle() -> None:
    clip = placement_spline(steady_circle(161, 2 * np.pi))
    looped = splice_placement(clip, [(0.0, 80.0), *[(40.0, 80.0)] * 6], [Seam()] * 6)
    t = np.linspace(10, 150, 561)  # the ends of a natural spline bend less than the circle does
    assert apart(placement_at(looped, t), placement_at(clip, t)) < 2e-5
    assert apart(placement_at(looped, t + 160), placement_at(clip, t)) < 2e-5


def test_seams_of_a_placement_are_twice_differentiable() -> None:
    clip = placement_spline(circling(60, 1.3))
    for closed in (False, True):
        pieces, h = [(0.0, 20.0), (40.0, 12.0), (30.0, 59.0)], 1e-6
        seams = [Seam(), Seam(fade=4.0), Seam()][: 3 if closed else 2]
        spliced = splice_placement(clip, pieces, seams, closed=closed)
        for at in (20.0, 48.0):
            for order in range(3):
                jump = spliced(at + h, order) - spliced(at - h, order)
                assert np.abs(jump).max() < 1e-4


def test_beyond_the_reach_of_seams_pieces_are_only_moved() -> None:
    clip, pieces = placement_spline(circling(200, 1.3)), [(0.0, 100.0), (190.0, 110.0), (20.0, 90.0)]
    spliced = splice_placement(clip, pieces, [Seam(half_life=2.0)] * 2)
    motions = ground_motions(clip, pieces)
    inside = np.linspace(20, 50, 61)
    starts = np.array([0.0, 100.0, 180.0])
    for (a, b), motion, start in zip(pieces, motions, starts):
        there = clip(a + np.sign(b - a) * inside)
        assert_allclose(spliced(start + inside), motion(there), atol=1e-9)


def test_a_closed_walk_played_round_and_round_is_smooth_and_walks_on() -> None:
    clip = placement_spline(circling(60, 1.3))
    closed = splice_placement(clip, [(5.0, 50.0)], [Seam()], closed=True)
    assert np.linalg.norm(closed(45.0)[4:] - closed(0.0)[4:]) > 1.5
    again = ground_motions(closed, [(0.0, 45.0), (0.0, 45.0)])[1]
    assert_allclose(again(closed(0.0)), closed(45.0), atol=1e-9)
    for order in (1, 2):
        rate = again(closed(0.0) + closed(0.0, order)) - again(closed(0.0))
        assert_allclose(rate, closed(45.0, order), atol=1e-9)


def test_through_a_gap_the_body_goes_on() -> None:
    straight = np.tile([1.0, 0, 0, 0, 0, 0, 0], (21, 1))
    straight[:, 4] = np.arange(21)
    spliced = splice_placement(placement_spline(straight), [(2.0, 8.0), (4.0, 10.0)], [Seam(gap=3.0)])
    t = np.linspace(0, 15, 61)
    assert_allclose(spliced(t)[:, 4], 2 + t, atol=1e-9)
    clip = placement_spline(steady_circle(161, 2 * np.pi))
    gap = 40.0
    skipped = splice_placement(clip, [(0.0, 40.0), (80.0, 120.0)], [Seam(gap=gap)])
    # nods differ in rate inside the gap, so only where the body gets to is compared
    assert apart(placement_at(skipped, 80.0), placement_at(clip, 80.0)) < 0.6
    short = splice_placement(clip, [(0.0, 40.0), (42.0, 80.0)], [Seam(gap=2.0)])
    assert apart(placement_at(short, 60.0), placement_at(clip, 60.0)) < 2e-2


def test_pieces_that_run_backwards_go_on_backwards() -> None:
    straight = np.tile([1.0, 0, 0, 0, 0, 0, 0], (21, 1))
    straight[:, 4] = np.arange(21)
    spliced = splice_placement(placement_spline(straight), [(8.0, 2.0), (10.0, 4.0)], [Seam(gap=2.0)])
    t = np.linspace(0, 14, 41)
    assert_allclose(spliced(t)[:, 4], 8 - t, atol=1e-9)
