"""Velocities over a fixed window, and contacts that the numbers of the definition decide."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.metrics import detect_contacts, velocities

RATES = [24, 25, 30, 50, 60, 90, 100, 120, 240]


@pytest.mark.parametrize("fps", RATES)
def test_steady_motion_has_its_speed_in_every_frame(fps: float) -> None:
    t = np.arange(40) / fps
    points = t[:, None, None] * [[1.0, -2, 3], [0, 0, 5]]
    assert_allclose(
        velocities(points, fps), np.tile([[1.0, -2, 3], [0, 0, 5]], (40, 1, 1)), rtol=0, atol=1e-9
    )


@pytest.mark.parametrize("fps", [60, 120, 240])
def test_the_window_has_its_duration_whatever_the_rate(fps: int) -> None:
    # sin(a t) over a window w has the derivative times sinc(a w / 2)
    a, t = 50.0, np.arange(2 * fps) / fps
    points = np.sin(a * t)[:, None, None] * [1.0, 0, 0]
    expected = a * np.cos(a * t) * np.sin(a / 60) / (a / 60)
    inside = slice(fps // 10, -fps // 10)
    assert_allclose(velocities(points, fps)[inside, 0, 0], expected[inside], rtol=0, atol=1e-9 * a)


def test_camera_noise_at_120_fps_is_not_read_as_speed() -> None:
    jitter = 0.001 * (-1.0) ** np.arange(60)
    points = jitter[:, None, None] * [1.0, 0, 0]
    assert np.abs(np.diff(points, axis=0) * 120).max() == pytest.approx(0.24)
    assert_allclose(velocities(points, 120)[2:-2], 0, rtol=0, atol=1e-12)


def test_slow_twin_of_the_interpolated_window(rng) -> None:
    points, fps = rng.normal(size=(12, 2, 3)), 100
    for t in range(12):
        before, after = max(t - 100 / 60, 0), min(t + 100 / 60, 11)
        for j in range(2):
            for k in range(3):
                a, b = (np.interp(s, np.arange(12), points[:, j, k]) for s in (before, after))
                expected = (b - a) / (after - before) * fps
                assert velocities(points, fps)[t, j, k] == pytest.approx(expected, rel=1e-9)


def test_time_backwards_gives_velocities_backwards(rng) -> None:
    points = rng.normal(size=(9, 2, 3))
    assert_allclose(velocities(points[::-1], 100), -velocities(points, 100)[::-1], rtol=1e-9)


@pytest.mark.parametrize("T", [0, 1])
def test_without_a_second_frame_nothing_moves(T: int) -> None:
    points = np.ones((T, 2, 3))
    assert_array_equal(velocities(points, 30), np.zeros((T, 2, 3)))
    assert_array_equal(detect_contacts(points, 1.7, 30), np.ones((T, 2), dtype=bool))


def test_two_frames_are_enough() -> None:
    assert_allclose(velocities([[[0, 0, 0]], [[0, 0, 1]]], 30), [[[0, 0, 30]]] * 2)


def step_cycle(fps: int, height: float = 1.0) -> np.ndarray:
    """Stand half a second at 0, travel half a second along Z at a height of 0.2, 8 times."""
    phase = (np.arange(8 * fps) / fps) % 1
    y = np.where(phase < 0.5, 0.0, 0.2)
    z = np.floor(np.arange(8 * fps) / fps) + np.clip(2 * phase - 1, 0, 1)
    return height * np.stack([0 * y, y, z], axis=-1)[:, None]


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_a_standing_foot_is_in_contact_and_a_swinging_one_is_not(fps: int) -> None:
    contact = detect_contacts(step_cycle(fps), 1.0, fps)[:, 0]
    phase = (np.arange(8 * fps) / fps) % 1
    well_inside = np.abs((phase % 0.5) - 0.25) < 0.25 - 2.1 / 30
    assert_array_equal(contact[well_inside], (phase < 0.5)[well_inside])


@pytest.mark.parametrize(("lift", "expected"), [(0.0299, True), (0.0301, False)])
def test_height_is_judged_above_the_own_5th_percentile(lift: float, expected: bool) -> None:
    # the floor of this foot is at 4 m and one frame in a hundred digs 1 m deeper: the percentile ignores it
    feet = np.full((100, 1, 3), 4.0)
    feet[50, 0, 1] = 3.0
    feet[70:90, 0, 1] += 2 * lift
    assert detect_contacts(feet, 2.0, 30)[80, 0] == expected


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize(("speed", "expected"), [(0.249, True), (0.251, False)])
def test_speed_limit_counts_every_direction(axis: int, speed: float, expected: bool) -> None:
    feet = np.zeros((3, 1, 3))
    feet[:, 0, axis] = 2.0 * speed * np.arange(3) / 240
    assert_array_equal(detect_contacts(feet, 2.0, 240), np.full((3, 1), expected))


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_contacts_know_neither_unit_nor_place_nor_heading_nor_direction_of_time(rng, unit: float) -> None:
    feet = np.cumsum(rng.normal(scale=0.004, size=(200, 3, 3)), axis=0)
    contact = detect_contacts(feet, 1.7, 60)
    assert 0.05 < contact.mean() < 0.95
    turned = feet[..., [2, 1, 0]] * [1, 1, -1] + [3.0, 8, 1]
    assert_array_equal(detect_contacts(unit * turned, 1.7 * unit, 60), contact)
    assert_array_equal(detect_contacts(feet[::-1], 1.7, 60)[::-1], contact)


@pytest.mark.parametrize("k", [0, 1, 2, 4, 6])
def test_any_number_of_feet_each_judged_alone(rng, k: int) -> None:
    feet = np.cumsum(rng.normal(scale=0.004, size=(100, k, 3)), axis=0)
    together = detect_contacts(feet, 1.7, 60)
    assert together.shape == (100, k) and together.dtype == np.bool_
    for j in range(k):
        assert_array_equal(detect_contacts(feet[:, [j]], 1.7, 60)[:, 0], together[:, j])


@pytest.mark.parametrize(
    ("feet", "height", "fps", "message"),
    [
        (np.zeros((4, 3)), 1.7, 30, r"feet must have shape \(T, k, 3\), got \(4, 3\)"),
        (np.full((4, 1, 3), np.nan), 1.7, 30, "feet must be finite"),
        (np.zeros((4, 1, 3)), 0, 30, "height must be positive, got 0"),
        (np.zeros((4, 1, 3)), np.nan, 30, "height must be positive, got nan"),
        (np.zeros((4, 1, 3)), 1.7, 0, "fps must be positive, got 0"),
        (np.zeros((4, 1, 3)), 1.7, np.inf, "fps must be positive, got inf"),
    ],
)
def test_bad_input_is_refused(feet, height: float, fps: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        detect_contacts(feet, height, fps)
