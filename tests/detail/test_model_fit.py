"""A model gives its clips back, follows other motions, and says where it has to guess."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from clothed_tube import clothed, faced, hanging, swing, tube_rig
from numpy.testing import assert_allclose

from tempose.clips import MeshClip, SkeletonClip
from tempose.clips.resample import resample
from tempose.detail import DetailModel, motion_inputs, residuals
from tempose.detail.evaluation import mixed_residuals
from tempose.detail.learners import PlainGaussianProcess
from tempose.detail.learners.memory import frames_remembered
from tempose.rotations import from_rotation_vector


@pytest.fixture(scope="module")
def rig():
    return tube_rig()


@pytest.fixture(scope="module")
def motion(rig):
    return swing(rig, 60)


@pytest.fixture(scope="module")
def clip(rig, motion):
    return clothed(rig, motion)


@pytest.fixture(scope="module")
def model(rig, motion, clip):
    return DetailModel("gp", folds=0, tolerance=0.02).fit(clip, rig, [motion])


def rms(V, W) -> float:
    return float(np.sqrt(np.square(np.asarray(V, dtype=np.float64) - W).sum(axis=-1).mean()))


def test_frames_that_were_learned_come_back(model, clip) -> None:
    D = clip.mesh.diagonal
    assert rms(model.pose().vertices, clip.vertices) < 0.03 / 100 * D
    assert_allclose(model.report_["errors"]["rms"], rms(model.pose().vertices, clip.vertices), rtol=1e-6)
    assert model.report_["kept"]["rms_percent"] < 0.022
    assert model.report_["baselines"]["skin"]["rms_percent"] > 1
    json.dumps(model.report_, allow_nan=False)


def test_strength_zero_is_the_skin(model, motion) -> None:
    posed = model.pose(motion, strength=0.0)
    assert_allclose(posed.vertices, model.rig_.vertices(motion), atol=2e-6)
    assert_allclose(model.rig_.skin.weights.sum(axis=1), 1.0, atol=1e-15)


def test_the_lean_rig_is_the_rig(model, rig, motion) -> None:
    assert_allclose(model.rig_.vertices(motion), rig.vertices(motion), atol=5e-4)


def test_posing_is_the_mixture_of_residuals_vertex_by_vertex(model, rig, motion, clip) -> None:
    other = resample(motion, 60.0).frames(slice(1, 40, 2))
    D = residuals(model.rig_, model.motions_[0], clip.vertices)
    mixture = model.predictor_.mix(motion_inputs(other, 30.0, model.mean_angles))
    slow = mixed_residuals(D, model.shares_, mixture)
    assert rms(model.residual(other), slow) < 0.05 / 100 * clip.mesh.diagonal
    back = residuals(model.rig_, other, model.pose(other).vertices)
    assert_allclose(model.residual(other), back, atol=3e-6)


def test_a_motion_that_was_not_learned_is_followed(model, rig) -> None:
    other = swing(rig, 40, seed=0).frames(slice(5, 40))
    truth = clothed(rig, swing(rig, 40, seed=0)).vertices[5:]
    none, found = rms(model.pose(other, strength=0).vertices, truth), rms(model.pose(other).vertices, truth)
    assert found < 0.25 * none


def test_a_body_turned_as_a_whole_keeps_its_detail(model, motion) -> None:
    turn = from_rotation_vector(np.array([0.0, 2.0, 0.0]))
    assert_allclose(model.residual(faced(motion, turn)), model.residual(motion), atol=1e-6)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_models_scale_with_the_body(unit: float, model, motion) -> None:
    rig = tube_rig(unit=unit)
    scaled = swing(rig, 60)
    large = DetailModel("gp", folds=0, tolerance=0.02).fit(clothed(rig, scaled), rig, [scaled])
    assert large.detail_.n_modes == model.detail_.n_modes
    assert_allclose(large.pose().vertices / unit, model.pose().vertices, atol=2e-4)


def test_frames_come_one_by_one_as_well(model, rig) -> None:
    other = swing(rig, 8, seed=5, turning=2.0)
    batch, live = model.pose(other).vertices, model.live()
    live.pose(other.rotations[3], other.root_position[3])
    live.reset()
    for t in range(8):
        frame = live.pose(other.rotations[t], other.root_position[t])
        if t:  # nothing is known of how the first frame moves
            assert_allclose(frame, batch[t], atol=2e-6)
    with pytest.raises(ValueError, match="rotations must have shape"):
        live.pose(np.zeros((2, 4)), np.zeros(3))


def test_live_velocities_count_in_frames_of_the_training(model, rig) -> None:
    vectors = np.linspace(0, 0.5, 12)[:, None, None] * np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 0]])
    steady = SkeletonClip(rig.skin.skeleton, from_rotation_vector(vectors), np.zeros((12, 3)), 75.0)
    batch, live = model.pose(steady).vertices, model.live(75.0)
    frames = [np.array(live.pose(q, p)) for q, p in zip(steady.rotations, steady.root_position)]
    kept = [6, 8, 10]  # rates of 75 and 30: every fifth moment of 150 is every other frame; others are mixed
    assert_allclose(np.array(frames)[kept], batch[kept], atol=1e-5)
    early = np.array([model.residual(steady)[t] for t in (2, 6)])
    assert np.abs(early[0] - early[1]).max() > 1e-3
    assert_allclose(frames[2], batch[2], atol=1e-5)


@pytest.mark.parametrize("blending", ["linear", "dual-quaternion"])
@pytest.mark.parametrize("basis", ["blended", "root", "world"])
def test_every_basis_and_blending_gives_frames_back(basis, blending) -> None:
    rig = tube_rig(blending=blending)
    motion = swing(rig, 20)
    clip = clothed(rig, motion)
    model = DetailModel("gp", basis, folds=0).fit(clip, rig, [motion])
    assert model.report_["errors"]["rms_percent"] < 0.12
    live = model.live()
    live.pose(motion.rotations[0], motion.root_position[0])
    frame = live.pose(motion.rotations[1], motion.root_position[1])
    assert rms(frame, clip.vertices[1]) < 0.2 / 100 * clip.mesh.diagonal


@pytest.mark.parametrize("factor", [2, 4])
def test_more_frames_a_second_show_the_same(factor: int, model, motion) -> None:
    dense = model.pose(resample(motion, 30.0 * factor)).vertices
    assert_allclose(dense[factor::factor], model.pose(motion).vertices[1:], atol=2e-6)


def test_fewer_frames_a_second_lag_by_the_right_time(model, motion) -> None:
    sparse = SkeletonClip(motion.skeleton, motion.rotations[::2], motion.root_position[::2], 15.0)
    full, half = model.pose(motion).vertices[::2], model.pose(sparse).vertices
    none = model.pose(motion, strength=0).vertices[::2]
    # slerp knows less of the motion than its frames do
    assert rms(half[1:], full[1:]) < 0.1 * rms(none, full)


def test_poses_that_were_not_learned_are_far(model, rig, motion) -> None:
    assert model.far().max() < 0.05
    bent = np.array(motion.rotations)
    bent[:, 1] = from_rotation_vector(np.array([0.0, 0.0, 2.0]))
    far = replace(motion, rotations=bent)
    assert model.far(far).min() > 2
    assert (model.region_variance(far).mean(axis=0) > model.region_variance().mean(axis=0)).all()
    V = model.variance(far)
    assert V.shape == (60, 240) and (V > 0).all()
    r = int(model.shares_[0].argmax())
    assert_allclose(V[:, 0], model.region_variance(far)[:, r], rtol=1e-9)


def test_several_clips_are_learned_together(rig) -> None:
    motions = [swing(rig, 30, seed=s) for s in range(3)]
    clips = [clothed(rig, m) for m in motions]
    model = DetailModel("gp", folds=0).fit(clips, rig, motions)
    for motion, clip in zip(motions, clips):
        assert rms(model.pose(motion).vertices, clip.vertices) < 0.12 / 100 * clip.mesh.diagonal
    assert model.report_["clips"] == 3 and model.report_["frames"] == 90
    assert len(model.report_["frame_errors"]["ours"]) == 90


def test_motions_are_found_where_none_are_given(rig, motion, clip) -> None:
    short = MeshClip(clip.vertices[:15], clip.mesh, clip.fps)
    model = DetailModel("mean", folds=0).fit(short, rig)
    given = DetailModel("mean", folds=0).fit(short, rig, [motion.frames(slice(0, 15))])
    assert model.report_["baselines"]["skin"]["rms"] < given.report_["baselines"]["skin"]["rms"]


def test_noise_is_left_to_the_mean(rig, motion, rng) -> None:
    V = rig.vertices(motion)[:40] + 0.01 * rng.normal(size=(40, 240, 3))
    model = DetailModel(folds=3).fit(MeshClip(V, rig.skin.mesh), rig, [motion.frames(slice(0, 40))])
    assert model.report_["learner"] == "mean"
    assert "mean" in model.report_["why"]
    assert any("strength 0" in w for w in model.report_["warnings"])
    assert {"skin", "mean", "nearest", "ridge", "gp", "regional-gp"} <= set(model.report_["heldout"])


def test_what_motion_explains_is_not_left_to_the_mean(rig, motion, clip) -> None:
    model = DetailModel(PlainGaussianProcess(), folds=3).fit(clip, rig, [motion])
    rows = model.report_["heldout"]
    assert rows["gp"]["rms"] < 0.8 * rows["mean"]["rms"] and rows["skin"]["part"] == 1.0


def test_warnings_say_what_to_beware_of(rig, motion, clip) -> None:
    turned = swing(rig, 20, turning=2.0)
    world = DetailModel("mean", "world", folds=0).fit(clothed(rig, turned), rig, [turned])
    assert any("world axes" in w and "115" in w for w in world.report_["warnings"])
    still = MeshClip(np.repeat(clip.vertices[:1], 20, axis=0), clip.mesh)
    constant = motion.frames(np.zeros(20, dtype=int))
    found = DetailModel().fit(still, rig, [constant]).report_
    assert any("all frames are the same" in w for w in found["warnings"])
    assert found["errors"]["rms_percent"] < 0.1
    few = DetailModel().fit(MeshClip(clip.vertices[:5], clip.mesh), rig, [motion.frames(slice(0, 5))])
    assert few.report_["learner"] == "mean" and any("only 5 frames" in w for w in few.report_["warnings"])
    one = DetailModel().fit(MeshClip(clip.vertices[:1], clip.mesh), rig, [motion.frames(slice(0, 1))])
    assert one.report_["errors"]["rms_percent"] < 0.1


def test_what_does_not_belong_together_is_refused(rig, motion, clip, model) -> None:
    other = tube_rig(rings=10)
    with pytest.raises(ValueError, match=r"clips\[0\] must have the 120 vertices of the rig, got 240"):
        DetailModel().fit(clip, other)
    with pytest.raises(ValueError, match="one for each of 1 clips, got 2"):
        DetailModel().fit(clip, rig, [motion, motion])
    with pytest.raises(ValueError, match="60 frames of its clip, got 59"):
        DetailModel().fit(clip, rig, [motion.frames(slice(0, 59))])
    with pytest.raises(ValueError, match="clips must hold one clip or more"):
        DetailModel().fit([], rig)
    with pytest.raises(ValueError, match=r"match_motion"):
        model.pose(swing(tube_rig(joints=4), 3))
    with pytest.raises(ValueError, match="has learned nothing yet"):
        DetailModel().pose()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"learner": "magic"}, "learner must be auto, mean"),
        ({"basis": "local"}, "basis must be one of"),
        ({"tolerance": 0.0}, "tolerance must be a positive"),
        ({"resolution": 120.0}, "resolution must be above 0"),
        ({"folds": 1}, "folds must be 0 or 2"),
    ],
)
def test_options_out_of_range_are_refused(options, message, rig, clip, motion) -> None:
    with pytest.raises(ValueError, match=message):
        DetailModel(**options).fit(clip, rig, [motion])


def test_truth_of_these_tests_is_what_the_model_is_told(rig, motion, clip) -> None:
    D = residuals(rig, motion, clip.vertices)
    assert_allclose(D, hanging(rig, motion), atol=1e-6)


@pytest.fixture(scope="module")
def remembering(rig, motion, clip):
    """A learner that looks back twelve frames."""
    return DetailModel("regional-gp", folds=0).fit(clip, rig, [motion])


@pytest.mark.parametrize("factor", [2, 3])
def test_memories_are_of_the_frames_of_the_training(factor: int, remembering, motion) -> None:
    dense = remembering.pose(resample(motion, 30.0 * factor)).vertices
    assert_allclose(dense[factor::factor], remembering.pose(motion).vertices[1:], atol=2e-6)


@pytest.mark.parametrize(("fps", "step", "others"), [(15.0, 1, 2), (24.0, 4, 5), (45.0, 3, 2), (50.0, 5, 3)])
def test_any_rate_shows_the_same_detail(fps: float, step: int, others: int, remembering, motion) -> None:
    found = remembering.residual(resample(motion, fps))[::step]
    truth = remembering.residual(motion)[::others][: len(found)]
    late = math.ceil(13 / others)
    # frames at another rate know less of the motion between them
    assert rms(found[late:], truth[late:]) < 0.12 * rms(truth, truth.mean(axis=0))


@pytest.mark.parametrize("factor", [1, 2])
def test_live_frames_remember_as_batches_do(factor: int, remembering, rig) -> None:
    other = resample(swing(rig, 30, seed=2), 30.0 * factor)
    batch, live = remembering.pose(other).vertices, remembering.live(30.0 * factor)
    frames = [np.array(live.pose(q, p)) for q, p in zip(other.rotations, other.root_position)]
    # the first knows nothing of how it moves, and is looked back at for twelve frames of the training
    late = 14 * factor
    assert_allclose(frames[late:], batch[late:], atol=2e-6)


def test_a_model_learned_at_60_hz_remembers_as_many_seconds(rig, tmp_path) -> None:
    motion, other = (resample(swing(rig, 40, seed=s), 60.0) for s in (0, 3))
    model = DetailModel("regional-gp", folds=0).fit(clothed(rig, motion), rig, [motion])
    model = DetailModel.load(model.save(tmp_path / "dense.tempose"))
    assert frames_remembered(model.predictor_) == 24
    batch, live = model.pose(other).vertices, model.live()
    frames = [np.array(live.pose(q, p)) for q, p in zip(other.rotations, other.root_position)]
    assert_allclose(frames[26:], batch[26:], atol=2e-6)


def test_clips_of_other_rates_are_brought_to_that_of_the_first(rig) -> None:
    motions = [swing(rig, 30), resample(swing(rig, 30, seed=1), 60.0)]
    clips = [clothed(rig, motions[0]), clothed(rig, motions[1])]
    model = DetailModel("gp", folds=0).fit(clips, rig, motions)
    assert model.report_["frames"] == 60
    assert [m.fps for m in model.motions_] == [30.0, 30.0]
    assert_allclose(model.motions_[1].rotations, motions[1].rotations[::2], atol=1e-6)


def test_blocks_of_frames_remember_those_before(remembering, motion, monkeypatch) -> None:
    whole = remembering.coefficients(motion)
    variance = remembering.region_variance(motion)
    monkeypatch.setattr("tempose.detail.prediction._FRAMES", 7)
    assert_allclose(remembering.coefficients(motion), whole, rtol=1e-5, atol=1e-9)
    assert_allclose(remembering.region_variance(motion), variance, rtol=1e-6)
