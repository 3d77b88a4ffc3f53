"""Adjustments of a real walk on a real body: exact, local, and without tearing the surface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.formats import load_mesh, load_skeleton_clip, load_skin
from tempose.rotations import procrustes_rotation
from tempose.transfer import Adjustment, TransferResult, adjust, transfer_motion
from tempose.transfer.adjustments.parts import bone_basis, find_part

pytestmark = pytest.mark.real

KEY = 20


@pytest.fixture(scope="module")
def walked(data_folder: Callable[[str], Path]) -> TransferResult:
    clip = load_skeleton_clip(data_folder("mocap-cmu") / "cmu_12_01_walk.bvh")
    clip = replace(clip.frames(np.r_[0, np.arange(1, clip.n_frames, 12)]), fps=clip.fps / 12)
    folder = data_folder("makehuman-base")
    body = load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))
    return transfer_motion(clip, body, measure=False)


def doubles(result: TransferResult) -> np.ndarray:
    return np.asarray(result.clip.vertices, dtype=np.float64)


@pytest.mark.parametrize(
    ("part", "by", "still"),
    [
        ("left_hand", (0.0, 0.25, 0.0), ["right_hand", "head", "left_foot", "right_thigh", "spine"]),
        ("right_hand", (0.0, 0.2, 0.15), ["left_hand", "head", "left_foot", "right_foot"]),
        ("right_foot", (0.0, 0.12, 0.0), ["left_foot", "left_hand", "head", "chest"]),
        ("head", (0.05, 0.0, 0.03), ["left_foot", "right_shin"]),
    ],
)
def test_a_part_goes_where_it_is_asked_and_nothing_else_moves(
    walked: TransferResult, part: str, by: tuple[float, ...], still: list[str]
) -> None:
    assert walked.job is not None
    result = adjust(walked, [Adjustment(part, frame=KEY, move=by, axes="body")], measure=False)
    assert result.report["adjustments"]["unmet"] == []
    point = find_part(walked.job, part)
    step = point.points(doubles(result)) - point.points(doubles(walked))
    assert np.linalg.norm(step[KEY]) == pytest.approx(np.linalg.norm(by), abs=1e-6)
    basis = bone_basis(walked.job)
    for other in still:
        mine = np.flatnonzero(basis[:, find_part(walked.job, other).bone] > 0.95)
        assert_array_equal(result.clip.vertices[:, mine], walked.clip.vertices[:, mine], other)
    F = walked.clip.faces
    before, after = doubles(walked)[KEY], doubles(result)[KEY]
    lengths = [np.linalg.norm(V[F] - V[np.roll(F, 1, axis=1)], axis=-1) for V in (before, after)]
    low, high = np.quantile(lengths[1] / lengths[0], [0.01, 0.99])
    assert 0.8 < low and high < 1.2


def test_the_head_turns_and_the_hips_sink_on_their_feet(walked: TransferResult) -> None:
    assert walked.job is not None
    changes = [
        Adjustment("head", frame=KEY, turn=(0, 30, 0)),
        Adjustment("hips", frame=KEY, move=(0, -0.1, 0)),
    ]
    result = adjust(walked, changes, measure=False)
    assert result.report["adjustments"]["unmet"] == []
    head = bone_basis(walked.job)[:, find_part(walked.job, "head").bone] > 0.99
    turn = procrustes_rotation(doubles(walked)[KEY, head], doubles(result)[KEY, head])
    assert np.degrees(np.arccos((np.trace(turn) - 1) / 2)) == pytest.approx(30, abs=0.1)
    for foot in ("left_foot", "right_foot"):
        ankle = find_part(walked.job, foot)
        assert_allclose(ankle.points(doubles(result)), ankle.points(doubles(walked)), rtol=0, atol=1e-6)


def test_an_arm_that_reaches_too_far_says_by_how_much(walked: TransferResult) -> None:
    assert walked.job is not None
    place = find_part(walked.job, "left_hand").points(doubles(walked))[KEY] + np.array([0, 2.0, 0])
    result = adjust(walked, [Adjustment("left_hand", frame=KEY, to=place)], measure=False)
    [unmet] = result.report["adjustments"]["unmet"]
    assert 0.8 < unmet["distance_m"] < 1.6
    assert np.isfinite(result.clip.vertices).all()
