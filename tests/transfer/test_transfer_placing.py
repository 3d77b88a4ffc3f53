"""Feet held from end to end: what the report promises is measured on the frames themselves."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import about, clip_of, human_body, t_body, turned

from tempose.clips import SkeletonClip
from tempose.metrics import skate
from tempose.samples.skeletons import human_skeleton
from tempose.samples.walk import walk
from tempose.transfer import Pairs, TransferResult, pairs_from_skin, transfer_motion
from tempose.transfer.from_skeleton import prepare_skeleton


@lru_cache
def walking(seconds: float = 2.5, fps: float = 30.0) -> SkeletonClip:
    clip = walk(human_skeleton(), duration=seconds, fps=fps)
    return SkeletonClip(clip.skeleton, clip.rotations, clip.root_position, clip.fps)


@lru_cache
def walked() -> TransferResult:
    return transfer_motion(walking(), t_body())


def feet_of(clip: SkeletonClip) -> list[np.ndarray]:
    body = t_body()
    return list(prepare_skeleton(clip, body.mesh, pairs_from_skin(clip.skeleton, body)).feet.vertices)


def doubles(result: TransferResult) -> np.ndarray:
    return np.asarray(result.clip.vertices, dtype=np.float64)


def test_a_walk_on_another_body_does_not_skate_sink_or_pop() -> None:
    report = walked().report
    free = transfer_motion(walking(), t_body(), contacts=False).report
    assert free["skate"] > 1 and free["penetration_cm"] > 0.3
    assert report["skate"] < 0.01 and report["penetration_cm"] < 1e-3
    for key in ("rms", "p99", "max"):
        assert report["foot_acceleration"][key] < 1.2 * max(1.0, free["foot_acceleration"][key])
    assert report["bone_direction_deg"]["mean"] < free["bone_direction_deg"]["mean"] + 0.5
    assert report["warnings"] == []
    for foot in report["contacts"].values():
        assert len(foot["intervals"]) >= 2 and foot["unmet_frames"] == [] and foot["unmet_cm"] < 0.1
        assert foot["frames"] == sum(b - a for a, b in foot["intervals"])
        assert 0 < foot["largest_cm"] < 6 and 0.9 < foot["stretch"] < 1.05
    for foot in free["contacts"].values():
        assert foot["intervals"] == [] and foot["largest_cm"] == 0


def test_only_legs_differ_from_the_free_transfer() -> None:
    """Held or free, the trunk is the same but for where it is."""
    body = t_body()
    held, free = doubles(walked()), doubles(transfer_motion(walking(), body, contacts=False, measure=False))
    trunk = body.mesh.vertices[:, 1] > 0.6 * body.mesh.height
    moved = held[:, trunk] - free[:, trunk]
    assert_allclose(moved - moved.mean(axis=1, keepdims=True), 0, rtol=0, atol=1e-6)


def test_a_turned_walk_is_held_turned() -> None:
    other = transfer_motion(turned(walking(), about("y", 70)), t_body())
    for name, foot in walked().report["contacts"].items():
        assert other.report["contacts"][name]["intervals"] == foot["intervals"]
        assert other.report["contacts"][name]["largest_cm"] == pytest.approx(foot["largest_cm"], abs=1e-3)


def test_contacts_of_the_user_are_held_instead() -> None:
    clip = walking()
    # a sole that is just being carried forward shall stand for a moment
    stated = {"left_foot": [[20, 26]], "right_foot": [[0, 8], [50, 60]]}
    result = transfer_motion(clip, t_body(), contacts=stated)
    first = result.report["first_frame"]
    V, feet = doubles(result), feet_of(clip)
    mask = np.zeros((clip.n_frames, 2), dtype=bool)
    for f, name in enumerate(("left_foot", "right_foot")):
        assert result.report["contacts"][name]["intervals"] == stated[name]
        for a, b in stated[name]:
            mask[a:b, f] = True
    assert first == 0
    assert skate(V, feet, mask, t_body().mesh.height, clip.fps) < 0.01  # type: ignore[operator]
    low = np.stack([V[:, foot, 1].min(axis=1) for foot in feet], axis=1)
    assert_allclose(low[mask], t_body().mesh.vertices[:, 1].min(), rtol=0, atol=2e-3)
    again = transfer_motion(clip, t_body(), contacts=mask)
    assert_array_equal(again.clip.vertices, result.clip.vertices)


def test_contacts_out_of_reach_are_limited_and_told() -> None:
    """One foot shall stand all the while the body walks away from it."""
    clip = walking(4.0)
    stated = {"left_foot": [[0, clip.n_frames]], "right_foot": [[0, clip.n_frames]]}
    fixed = replace(clip, root_position=clip.root_position + np.array([0, 0.4, 0]) * _hop(clip.n_frames))
    result = transfer_motion(fixed, t_body(), contacts=stated)
    feet = result.report["contacts"]
    assert np.isfinite(result.clip.vertices).all()
    for foot in feet.values():
        assert foot["stretch"] < 1.2
    assert max(foot["unmet_cm"] for foot in feet.values()) > 1
    assert any("cannot reach where it should stand" in warning for warning in result.report["warnings"])


def _hop(T: int) -> np.ndarray:
    return (np.abs(np.arange(T) - T // 2) < 3).astype(float)[:, None]


def test_a_body_without_feet_says_so() -> None:
    body = human_body()
    pairs = pairs_from_skin(body.skeleton, body)
    keep = np.array([not str(name).endswith(("shin", "foot", "toes")) for name in pairs.source])
    footless = Pairs(
        "joints",
        tuple(np.asarray(pairs.source)[keep]),
        pairs.target[keep],
        joints={k: v for k, v in pairs.joints.items() if not k.endswith(("shin", "foot", "toes"))},
    )
    result = transfer_motion(walking(1.0), body, footless)
    assert result.report["contacts"] == {} and result.report["foot_acceleration"] is None
    assert result.report["skate"] is None
    assert any("no feet" in warning for warning in result.report["warnings"])
    assert transfer_motion(walking(1.0), body, footless, contacts=False).report["warnings"] == []


# ---- ground


@lru_cache
def reaching_down() -> SkeletonClip:
    """The trunk folds forward over standing legs, arms hanging: hands go through the floor and come back."""
    bend = np.clip(1.5 - np.abs(np.arange(30) - 15) / 10, 0, 1)
    turns = {"hips": np.array([about("x", 145 * b) for b in bend])}
    for side in ("left_", "right_"):
        turns[side + "thigh"] = np.array([about("x", -145 * b) for b in bend])
        turns[side + "upper_arm"] = np.array([about("x", -145 * b) for b in bend])
    return clip_of(human_skeleton(), turns, 30)


@pytest.mark.parametrize(("contacts", "height"), [(True, 0.0), (False, -1.3)])
def test_nothing_sinks_into_the_ground(contacts: bool, height: float) -> None:
    clip = reaching_down()
    plain = transfer_motion(clip, human_body(), contacts=contacts)
    solid = transfer_motion(clip, human_body(), contacts=contacts, ground=height)
    assert plain.report["ground"] is None
    assert doubles(solid)[..., 1].min() > height - 1e-6
    assert solid.report["ground"]["height"] == height
    assert solid.report["penetration_cm"] < 1e-4
    # frames in which all is above the ground anyway are moved up or down and nothing else
    first = doubles(solid)[0] - doubles(plain)[0]
    assert_allclose(first - first.mean(axis=0), 0, rtol=0, atol=1e-4)
    steps = np.abs(np.diff(doubles(solid), axis=0)).max()
    assert steps < 1.5 * np.abs(np.diff(doubles(plain), axis=0)).max()


def test_hands_are_lifted_by_their_arms() -> None:
    report = transfer_motion(reaching_down(), human_body(), ground=0.0).report
    assert report["ground"]["hands_lifted_cm"] > 1
    assert report["ground"]["pressed_cm"] < 20


def test_a_ground_that_is_no_height_is_refused() -> None:
    with pytest.raises(ValueError, match="ground must be a height in metres, got nan"):
        transfer_motion(reaching_down(), human_body(), ground=float("nan"))


def test_contacts_of_another_kind_are_refused_not_ignored() -> None:
    with pytest.raises(ValueError, match="contacts must be bool of shape"):
        transfer_motion(walking(), t_body(), contacts=[[0, 12]])  # type: ignore[arg-type]
