"""Accelerations: closed forms, and a ratio of 1 for who moves alike."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.metrics import accelerations, foot_acceleration


@pytest.mark.parametrize("fps", [24, 30, 60, 100, 120, 240])
def test_a_falling_stone_has_its_acceleration(fps: float) -> None:
    t = np.arange(60) / fps
    points = np.outer(t, [1.0, 2, 3]) - np.outer(t * t / 2, [0, 9.81, 0])
    a = accelerations(points[:, None], fps)
    assert_allclose(a, np.broadcast_to([0, -9.81, 0], a.shape), rtol=0, atol=1e-8)


def test_frames_without_a_full_window_are_left_out() -> None:
    assert accelerations(np.zeros((10, 2, 3)), 30.0).shape == (8, 2, 3)
    assert accelerations(np.zeros((10, 2, 3)), 120.0).shape == (6, 2, 3)
    assert accelerations(np.zeros((2, 2, 3)), 30.0).shape == (0, 2, 3)
    assert accelerations(np.zeros((10, 0, 3)), 30.0).shape == (8, 0, 3)


def test_noise_of_fast_cameras_is_damped() -> None:
    jitter = 0.001 * (-1.0) ** np.arange(60)[:, None, None] * np.ones(3)
    assert_allclose(accelerations(jitter, 120.0), 0, rtol=0, atol=1e-9)
    assert np.abs(accelerations(jitter, 120.0, window=1e-3)).max() == pytest.approx(0.004 * 120**2)


def test_the_ratio_of_scaled_motion_is_one() -> None:
    rng = np.random.default_rng(0)
    feet = rng.normal(size=(50, 2, 3)).cumsum(axis=0)
    shift = np.outer(np.arange(50), [1.0, 0, 2])[:, None]
    ratio = foot_acceleration(0.7 * feet + shift, feet, 0.7, 30.0)
    assert ratio is not None
    assert ratio.rms == pytest.approx(1) and ratio.p99 == pytest.approx(1) and ratio.max == pytest.approx(1)


def test_a_pop_is_seen() -> None:
    t = np.arange(200) / 60
    feet = np.stack([np.sin(3 * t), 0 * t, t], axis=1)[:, None]
    popped = feet.copy()
    popped[100:] += [0, 0.02, 0]
    ratio = foot_acceleration(popped, feet, 1.0, 60.0)
    assert ratio is not None and ratio.rms > 1.3 and ratio.max > 4


def test_who_does_not_accelerate_cannot_be_compared_with() -> None:
    feet = np.outer(np.arange(20), [1.0, 0, 0])[:, None]
    rng = np.random.default_rng(1)
    assert foot_acceleration(rng.normal(size=(20, 1, 3)), 0 * feet, 1.0, 30.0) is None
    assert foot_acceleration(feet[:2], feet[:2], 1.0, 30.0) is None


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"fps": 0.0}, "fps must be positive"),
        ({"scale": -1.0}, "scale must be positive"),
        ({"source": np.zeros((5, 2, 3))}, "source must"),
        ({"feet": np.full((5, 1, 3), np.nan)}, "feet must"),
    ],
)
def test_what_makes_no_sense_is_refused(change: dict[str, object], said: str) -> None:
    good: dict[str, object] = {"feet": np.zeros((5, 1, 3)), "source": np.zeros((5, 1, 3)), "scale": 1.0}
    with pytest.raises(ValueError, match=said):
        foot_acceleration(**(good | {"fps": 30.0} | change))  # type: ignore[arg-type]
