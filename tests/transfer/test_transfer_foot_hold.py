"""A rolling foot stands still: by the measure of skate itself, without a jump, whatever the rate."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.metrics import accelerations, skate
from tempose.transfer.feet.foot_hold import hold_feet
from tempose.transfer.feet.soles import find_sole

HEIGHT, GROUND = 1.7, -0.3


def stepping(fps: float, slip: float = 0.1, seconds: float = 3.0) -> tuple[np.ndarray, np.ndarray]:
    """A foot that rolls from heel to toe while it should stand, slips, floats and sinks a little."""
    rng = np.random.default_rng(5)
    sole = np.column_stack(
        [rng.uniform(-0.05, 0.05, 60), rng.uniform(0, 0.08, 60), rng.uniform(-0.1, 0.17, 60)]
    )
    sole[:30, 1] = 0
    t = np.arange(round(seconds * fps)) / fps
    phase = t % 1.0
    contact = (phase > 0.2) & (phase < 0.75)
    swing = np.clip((phase - 0.75) / 0.45, 0, 1) + np.clip((phase + 0.25) / 0.45, 0, 1) - 5 / 9
    pitch = 0.35 * np.cos(np.pi * (phase - 0.2) / 0.55)
    R = Rotation.from_euler("yx", np.column_stack([0.2 + 0 * t, -pitch])).as_matrix()
    forward = np.floor(t) + 0.9 * (swing - swing[0])
    place = np.column_stack([0.03 * np.sin(2 * t), 0.02 * np.sin(5 * t) + 0.1 * (~contact), forward])
    place[:, 2] += slip * np.sin(9 * t)
    kernel = np.hanning(max(3, round(fps / 15)) + 2)
    pad = len(kernel) // 2
    smooth = [
        np.convolve(np.pad(x, pad, mode="edge"), kernel / kernel.sum(), "valid")[: len(t)] for x in place.T
    ]
    return np.einsum("tij,kj->tki", R, sole) + np.column_stack(smooth)[:, None], contact


def held(foot: np.ndarray, contact: np.ndarray, fps: float, height: float = HEIGHT) -> np.ndarray:
    sole = find_sole(foot, contact, height, fps)
    path = hold_feet([sole], np.zeros((len(foot), 3)), GROUND * height / HEIGHT, fps)[:, 0]
    return foot + path[:, None]


@pytest.mark.parametrize("fps", [24, 30, 60, 100, 120, 240])
def test_skate_is_zero_and_the_sole_is_on_the_ground(fps: float) -> None:
    foot, contact = stepping(fps)
    every = [np.arange(foot.shape[1])]
    before = skate(foot, every, contact[:, None], HEIGHT, fps)
    V = held(foot, contact, fps)
    after = skate(V, every, contact[:, None], HEIGHT, fps)
    assert before is not None and after is not None
    assert before > 5 and after < 1e-7
    low = V[..., 1].min(axis=1)
    assert_allclose(low[contact], GROUND, rtol=0, atol=1e-9)
    assert low.min() > GROUND - 1e-9


def test_what_stands_already_is_left_alone() -> None:
    foot, contact = stepping(60.0)
    V = held(foot, contact, 60.0)
    again = held(V, contact, 60.0)
    assert_allclose(again, V, rtol=0, atol=1e-9)


def test_without_contact_only_sinking_is_cured() -> None:
    foot, contact = stepping(60.0)
    free = np.zeros_like(contact)
    high = foot + np.array([0, 1.0, 0])
    assert_allclose(held(high, free, 60.0), high, rtol=0, atol=0)
    V = held(foot - [0, 0.4, 0], free, 60.0)
    assert_allclose((V - foot)[..., [0, 2]], 0, rtol=0, atol=0)
    assert V[..., 1].min() > GROUND - 1e-9


@pytest.mark.parametrize("fps", [30, 120])
def test_the_foot_does_not_accelerate_more_than_it_did(fps: float) -> None:
    foot, contact = stepping(fps, slip=0.03)
    V = held(foot + np.array([0, GROUND - foot[contact, :, 1].min(), 0]), contact, fps)
    ours, theirs = (np.linalg.norm(accelerations(x[:, :1], fps), axis=-1) for x in (V, foot))
    assert np.percentile(ours, 99) < 1.2 * np.percentile(theirs, 99)
    # and nowhere is there a jump: steps stay near those of the foot as it was
    assert np.abs(np.diff(V, axis=0)).max() < 1.2 * np.abs(np.diff(foot, axis=0)).max()


@pytest.mark.parametrize("degrees", [90, -33])
def test_a_turned_foot_is_held_turned(degrees: float) -> None:
    R = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
    foot, contact = stepping(60.0)
    expected = held(foot, contact, 60.0) @ R.T
    assert_allclose(held(foot @ R.T, contact, 60.0), expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("unit", [0.01, 100.0])
def test_units_mean_nothing(unit: float) -> None:
    foot, contact = stepping(60.0)
    expected = unit * held(foot, contact, 60.0)
    assert_allclose(held(unit * foot, contact, 60.0, unit * HEIGHT), expected, rtol=0, atol=1e-9 * unit)


def test_a_foot_on_a_step_stands_on_it() -> None:
    foot, contact = stepping(60.0)
    sole = find_sole(foot, contact, HEIGHT, 60.0, 0.25)
    path = hold_feet([sole], np.zeros((len(foot), 3)), GROUND, 60.0)[:, 0]
    low = (foot + path[:, None])[..., 1].min(axis=1)
    assert_allclose(low[contact], GROUND + 0.25, rtol=0, atol=1e-9)
    assert low.min() > GROUND - 1e-9


def test_slip_counts_what_the_body_does() -> None:
    foot, contact = stepping(60.0)
    sole = find_sole(foot, contact, HEIGHT, 60.0)
    walk = np.outer(np.arange(len(foot)), [0.01, 0.0, -0.02])
    moved = find_sole(foot + walk[:, None], contact, HEIGHT, 60.0)
    assert_allclose(moved.travel, sole.slip(walk), rtol=0, atol=1e-12)


@pytest.mark.parametrize("frames", [1, 2, 3, 5])
def test_clips_of_a_few_frames_that_stand_throughout(frames: int) -> None:
    foot = stepping(30.0)[0][8 : 8 + frames]
    V = held(foot, np.ones(frames, dtype=bool), 30.0)
    assert np.isfinite(V).all()
    assert_allclose(V[..., 1].min(axis=1), GROUND, rtol=0, atol=1e-9)
