"""Resampling keeps the speed: what moves evenly or turns evenly is reproduced at any rate."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip
from tempose.clips.resample import resample, select_frames
from tempose.rotations import angle_between, from_rotation_vector

TRIANGLE = Mesh(np.eye(3), np.array([[0, 1, 2]]))
SPEED = np.array([0.3, -0.2, 1.0])
TURN = np.array([0.4, 2.0, -0.7])


def gliding(T: int, fps: float) -> MeshClip:
    times = np.arange(T) / fps
    return MeshClip(TRIANGLE.vertices + times[:, None, None] * SPEED, TRIANGLE, fps)


def turning(T: int, fps: float) -> SkeletonClip:
    skeleton = Skeleton(("root", "tip"), np.array([-1, 0]), np.array([[0.0, 1, 0], [0, 1, 0]]))
    times = np.arange(T)[:, None, None] / fps
    rotations = from_rotation_vector(times * np.stack([TURN, -TURN]))
    return SkeletonClip(skeleton, rotations, times[:, 0] * SPEED, fps)


@given(st.integers(1, 40), st.sampled_from([24.0, 29.97, 30, 120, 119.88]), st.floats(3, 300))
def test_even_motion_is_reproduced_at_any_rate(T: int, old: float, new: float) -> None:
    glided, turned = resample(gliding(T, old), new), resample(turning(T, old), new)
    assert glided.n_frames == turned.n_frames
    assert_allclose(glided.vertices, gliding(glided.n_frames, new).vertices, atol=1e-5)
    truth = turning(turned.n_frames, new)
    assert_allclose(turned.root_position, truth.root_position, atol=1e-9)
    assert angle_between(turned.rotations, truth.rotations).max() < 1e-6
    assert glided.duration <= gliding(T, old).duration + 1e-6 < glided.duration + 1 / new + 1e-6


@pytest.mark.parametrize(
    ("T", "factor", "count"), [(5, 2, 9), (48, 2, 95), (5, 0.5, 3), (4, 0.5, 2), (1, 3, 1)]
)
def test_frame_count(T: int, factor: float, count: int) -> None:
    clip = resample(gliding(T, 30), 30 * factor)
    assert (clip.n_frames, clip.fps) == (count, 30 * factor)


@pytest.mark.parametrize("rate", [23.976, 29.97, 30.0, 120.0])
@pytest.mark.parametrize("factor", [2, 3, 7])
def test_old_frames_stay_bit_identical(rate: float, factor: int, rng: np.random.Generator) -> None:
    clip = MeshClip(rng.normal(size=(300, 3, 3)), TRIANGLE, rate)
    assert_array_equal(resample(clip, factor * rate).vertices[::factor], clip.vertices)
    motion = turning(300, rate)
    assert_array_equal(resample(motion, factor * rate).rotations[::factor], motion.rotations)


def test_slerp_takes_the_shorter_way() -> None:
    motion = turning(6, 30)
    flipped = motion.rotations * np.array([1, -1, 1, -1, 1, -1])[:, None, None]
    other = resample(replace(motion, rotations=flipped), 77.0)
    assert angle_between(other.rotations, resample(motion, 77.0).rotations).max() < 1e-7


def test_selected_frames_keep_their_speed(rng: np.random.Generator) -> None:
    clip, motion = gliding(20, 30), turning(20, 30)
    shorter, fewer = select_frames(clip, 3, 17, 4), select_frames(motion, 3, 17, 4)
    assert_array_equal(shorter.vertices, clip.vertices[[3, 7, 11, 15]])
    assert_array_equal(fewer.rotations, motion.rotations[[3, 7, 11, 15]])
    assert shorter.fps == fewer.fps == 7.5
    assert_allclose(np.diff(shorter.vertices, axis=0) * shorter.fps, SPEED * np.ones((3, 3, 3)), atol=1e-4)


def test_results_are_frozen() -> None:
    clip = resample(gliding(3, 30), 60)
    with pytest.raises(FrozenInstanceError):
        clip.fps = 1  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        clip.vertices[0] = 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((20,), "start must be a frame from 0 to 19, got 20"),
        ((-1,), "start must be a frame from 0 to 19, got -1"),
        ((5, 5), r"stop must be after start \(5\) and at most 20, got 5"),
        ((0, 21), "at most 20, got 21"),
        ((0, None, 0), "step must be at least 1, got 0"),
    ],
)
def test_frames_that_do_not_exist_are_refused(arguments: tuple[int, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        select_frames(gliding(20, 30), *arguments)


@pytest.mark.parametrize("fps", [0.0, -24.0, float("nan"), float("inf")])
def test_rate_that_is_none_is_refused(fps: float) -> None:
    with pytest.raises(ValueError, match="fps must be positive"):
        resample(gliding(3, 30), fps)
