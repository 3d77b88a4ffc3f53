"""Skate of feet that slide by a known speed, and depth of feet that sink by a known one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.metrics import detect_contacts, ground_depths, penetration, skate, sole_velocities


def sliding(speeds: np.ndarray, fps: float, T: int = 20) -> np.ndarray:
    """Two feet of three vertices, each foot moving steadily."""
    foot = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.05, 0.2, 0]])
    t = np.arange(T)[:, None, None, None] / fps
    return (foot + t * np.asarray(speeds)[:, None, :]).reshape(T, -1, 3)


FEET = [np.array([0, 1, 2]), np.array([3, 4, 5])]


@pytest.mark.parametrize("fps", [30, 60, 120])
def test_skate_is_the_horizontal_speed_in_percent_of_height(fps: float) -> None:
    V = sliding(np.array([[0.3, 0.0, 0.4], [0, 0, 0]]), fps)
    both = np.ones((20, 2), dtype=bool)
    assert skate(V, FEET, both, height=2.0, fps=fps) == pytest.approx(100 * 0.5 / 2.0 / 2)
    assert skate(V, FEET[:1], both[:, :1], height=2.0, fps=fps) == pytest.approx(100 * 0.5 / 2.0)


def test_vertical_motion_is_no_skate() -> None:
    V = sliding(np.array([[0, 5.0, 0], [0, -5.0, 0]]), 30)
    assert skate(V, FEET, np.ones((20, 2), dtype=bool), 1.7, 30) == pytest.approx(0, abs=1e-9)


def test_only_frames_in_contact_count_each_once() -> None:
    V = sliding(np.array([[1.0, 0, 0], [0, 0, 3.0]]), 30)
    contact = np.zeros((20, 2), dtype=bool)
    contact[3:6, 0] = contact[10, 1] = True
    assert skate(V, FEET, contact, 2.0, 30) == pytest.approx(100 * (3 * 1 + 1 * 3) / 4 / 2)


def test_without_contact_there_is_no_skate_to_measure() -> None:
    V = sliding(np.zeros((2, 3)), 30)
    assert skate(V, FEET, np.zeros((20, 2), dtype=bool), 1.7, 30) is None


def test_a_heel_that_rolls_over_standing_toes_does_not_skate() -> None:
    # toes stand, the heel lifts and travels: the mean of the foot moves, its lowest part does not
    t = np.linspace(0, 1, 30)
    toe = np.zeros((30, 1, 3))
    heel = np.stack([0 * t, 0.02 + 0.2 * t, -0.2 + 0.1 * t], axis=-1)[:, None]
    V = np.concatenate([toe, heel], axis=1)
    assert skate(V, [np.array([0, 1])], np.ones((30, 1), dtype=bool), 1.7, 30) == pytest.approx(0, abs=1e-9)


def test_sole_is_within_half_a_percent_of_the_height() -> None:
    still, moving = np.zeros((5, 1, 3)), np.zeros((5, 1, 3))
    moving[:, 0, 0] = np.arange(5) / 30
    for lift, expected in [(0.0099, 0.5), (0.0101, 0.0)]:
        foot = np.concatenate([still, moving + np.array([0, lift, 0])], axis=1)
        assert_allclose(sole_velocities(foot, 2.0, 30), np.tile([expected, 0, 0], (5, 1)), rtol=0, atol=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_skate_knows_neither_unit_nor_place_nor_heading(rng, unit: float) -> None:
    V = np.cumsum(rng.normal(scale=0.01, size=(30, 6, 3)), axis=0)
    contact = rng.random((30, 2)) < 0.5
    turned = V[..., [2, 1, 0]] * [1, 1, -1] + [3.0, 8, 1]
    assert skate(unit * turned, FEET, contact, 1.7 * unit, 60) == pytest.approx(
        skate(V, FEET, contact, 1.7, 60), rel=1e-9
    )


def test_slow_twin(rng) -> None:
    V = np.cumsum(rng.normal(scale=0.01, size=(30, 6, 3)), axis=0)
    contact = rng.random((30, 2)) < 0.5
    speeds = []
    for t in range(30):
        before, after = max(t - 1, 0), min(t + 1, 29)
        for f, foot in enumerate(FEET):
            if contact[t, f]:
                floor = min(V[t, v, 1] for v in foot)
                low = [v for v in foot if V[t, v, 1] <= floor + 0.005 * 1.7]
                mean = sum((V[after, v] - V[before, v]) / (after - before) * 60 for v in low) / len(low)
                speeds.append(np.hypot(mean[0], mean[2]))
    assert skate(V, FEET, contact, 1.7, 60) == pytest.approx(100 * np.mean(speeds) / 1.7, rel=1e-9)


def test_the_source_itself_skates_little_by_its_own_contacts() -> None:
    # one joint a foot; contacts need less than 25 % of the height per second, so skate is below that
    t = np.arange(240) / 120
    x, y = np.cumsum(np.maximum(np.sin(2 * np.pi * t), 0)) / 120, 0.2 * np.maximum(np.sin(2 * np.pi * t), 0)
    V = np.stack([x, y, 0 * x], axis=-1)[:, None]
    contact = detect_contacts(V, 1.7, 120)
    value = skate(V, [np.array([0])], contact, 1.7, 120)
    assert contact.any() and value is not None and 0 < value < 25


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"contact": np.ones((20, 1), bool)},
            r"contact must be bool of shape \(20, 2\), got bool of shape \(20, 1\)",
        ),
        ({"contact": np.ones((20, 2))}, "contact must be bool"),
        ({"feet": [FEET[0], np.array([6])]}, r"feet\[1\] must hold indices from 0 and below 6, got 6"),
        ({"feet": [FEET[0], np.array([], int)]}, "foot must hold at least one vertex"),
        ({"height": -1.0}, "height must be positive, got -1.0"),
        ({"fps": 0.0}, "fps must be positive, got 0.0"),
        ({"V": np.full((20, 6, 3), np.nan)}, "finite"),
    ],
)
def test_bad_input_is_refused(change, message: str) -> None:
    given = {
        "V": sliding(np.zeros((2, 3)), 30),
        "feet": FEET,
        "contact": np.ones((20, 2), dtype=bool),
        "height": 1.7,
        "fps": 30.0,
    }
    assert skate(**given) == 0
    with pytest.raises(ValueError, match=message):
        skate(**(given | change))


def test_depths_below_ground_have_the_closed_form() -> None:
    V = np.zeros((4, 3, 3))
    V[..., 1] = [[0.0, 1, 2], [-0.02, 1, 2], [0.5, 1, 2], [-0.06, -0.01, 2]]
    assert_allclose(ground_depths(V), [0, 0.02, 0, 0.06])
    found = penetration(V, height=2.0)
    assert (found.max_cm, found.mean_cm) == (pytest.approx(6), pytest.approx(2))
    assert (found.max_percent, found.mean_percent) == (pytest.approx(3), pytest.approx(1))
    assert_allclose(ground_depths(V - [0, 5, 0], ground=-5.0), ground_depths(V), rtol=0, atol=1e-12)


def test_a_clip_above_ground_does_not_penetrate(rng) -> None:
    V = np.abs(rng.normal(size=(5, 7, 3)))
    assert not any(vars(penetration(V, 1.0)).values())


@pytest.mark.parametrize(
    ("V", "height"), [(np.zeros((0, 3, 3)), 1), (np.full((1, 1, 3), np.nan), 1), (np.zeros((1, 1, 3)), 0)]
)
def test_penetration_refuses_bad_input(V, height: float) -> None:
    with pytest.raises(ValueError):
        penetration(V, height)
