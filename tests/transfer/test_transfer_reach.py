"""A leg reaches as far as it is long: displacements are met exactly within, drawn back smoothly beyond."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.transfer.feet.reach import within_reach

LENGTH = 0.9


def leg(seed: int, shorter: float = 0.9) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    hip = rng.normal(size=(200, 3))
    along = rng.normal(size=(200, 3))
    along *= shorter * LENGTH * rng.random((200, 1)) / np.linalg.norm(along, axis=1, keepdims=True)
    return hip, hip + along, rng.normal(size=(200, 3)) * rng.choice([0.01, 0.3, 2.0], (200, 1))


def test_within_reach_a_displacement_is_met_to_rounding() -> None:
    hip, ankle, path = leg(0)
    reached = np.linalg.norm(ankle + path - hip, axis=1) < 1.05 * LENGTH
    got = within_reach(hip, ankle, LENGTH, path)
    assert 20 < reached.sum() < 180
    assert_allclose(got[reached], path[reached], rtol=0, atol=1e-15)


@pytest.mark.parametrize("seed", range(3))
def test_beyond_reach_the_foot_lies_on_the_line_to_its_place(seed: int) -> None:
    hip, ankle, path = leg(seed)
    got = ankle + within_reach(hip, ankle, LENGTH, path) - hip
    assert np.linalg.norm(got, axis=1).max() < 1.08 * LENGTH + 1e-12
    wanted = ankle + path - hip
    assert_allclose(np.cross(got, wanted), 0, rtol=0, atol=1e-12)
    assert (np.sum(got * wanted, axis=1) > 0).all()


def test_a_leg_that_is_already_longer_is_not_shortened() -> None:
    hip, ankle, path = leg(4, shorter=1.5)
    got = within_reach(hip, ankle, LENGTH, np.zeros_like(path))
    assert_allclose(got, 0, rtol=0, atol=1e-15)


def test_a_foot_drawn_away_steadily_slows_down_smoothly() -> None:
    away = np.linspace(0, 0.5, 2001)[:, None] * [0, -1.0, 0]
    hip, ankle = np.zeros((2001, 3)), np.tile([0, -0.8, 0], (2001, 1))
    got = within_reach(hip, ankle, LENGTH, away)[:, 1]
    speed = -np.diff(got) / np.diff(-away[:, 1])
    assert (speed >= 0).all() and (speed <= 1 + 1e-9).all()
    assert np.abs(np.diff(speed)).max() < 0.02


def test_turned_and_scaled_alike() -> None:
    hip, ankle, path = leg(5)
    R = Rotation.random(rng=np.random.default_rng(1)).as_matrix()
    got = within_reach(100 * hip @ R.T, 100 * ankle @ R.T, 100 * LENGTH, 100 * path @ R.T)
    assert_allclose(got, 100 * within_reach(hip, ankle, LENGTH, path) @ R.T, rtol=0, atol=1e-10)
