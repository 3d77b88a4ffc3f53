"""Models of detail as files: small, the same when read again, refused when damaged."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from clothed_tube import clothed, swing, tube_rig
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays_of
from numpy.testing import assert_allclose, assert_array_equal
from safetensors.numpy import load_file, save_file

from tempose.clips import Source
from tempose.detail import LEARNERS, DetailModel
from tempose.detail.basis import compress
from tempose.detail.saving.lean import lean_weights
from tempose.detail.saving.packing import pack, unpack
from tempose.detail.saving.tree import from_arrays, to_arrays

KINDS = [np.float64, np.float32, np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint16]


@pytest.fixture(scope="module")
def case():
    rig = tube_rig()
    motions = [swing(rig, 25, seed=s) for s in range(2)]
    return rig, motions, [clothed(rig, m) for m in motions]


@pytest.fixture(scope="module")
def saved(case, tmp_path_factory):
    rig, motions, clips = case
    model = DetailModel("gp", folds=0).fit(clips, rig, motions)
    return model, model.save(tmp_path_factory.mktemp("models") / "tube.tempose")


@given(
    st.sampled_from(KINDS).flatmap(
        lambda kind: arrays_of.arrays(kind, arrays_of.array_shapes(min_dims=0, max_dims=3, min_side=0))
    )
)
def test_packed_arrays_come_back_bit_by_bit(array) -> None:
    packed, how = pack(array)
    back = unpack(packed, json.loads(json.dumps(how)))
    assert back.dtype == array.dtype and back.shape == array.shape
    assert back.tobytes() == array.tobytes() or np.array_equal(back, array, equal_nan=True)


def test_extreme_integers_survive() -> None:
    for kind in (np.int64, np.int32, np.uint16):
        info = np.iinfo(kind)
        array = np.array([[info.min, info.max], [info.max, info.min]], dtype=kind)
        assert_array_equal(unpack(*pack(array)), array)


def test_damaged_bytes_are_refused() -> None:
    packed, how = pack(np.arange(300.0))
    with pytest.raises(ValueError, match=r"end after|damaged"):
        unpack(packed[:-20], how)
    with pytest.raises(ValueError, match="packed into"):
        unpack(packed, {**how, "shape": [10**12]})
    with pytest.raises(ValueError, match="end after"):
        unpack(packed, {**how, "shape": [301]})
    with pytest.raises(ValueError, match="end after"):
        unpack(packed, {**how, "shape": [299]})
    with pytest.raises(ValueError, match="shape"):
        unpack(packed, {**how, "shape": [-3]})
    with pytest.raises(ValueError, match="type"):
        unpack(packed, {**how, "type": "|O"})


def test_lean_weights_sum_to_one_exactly(rng) -> None:
    weights = rng.dirichlet(np.full(20, 0.3), size=200)
    weights[3] = 0.0
    lean = lean_weights(weights)
    assert_array_equal(lean.sum(axis=1), np.where(np.arange(200) == 3, 0.0, 1.0))
    assert ((lean > 0).sum(axis=1) <= 8).all() and (lean >= 0).all()
    few = rng.dirichlet(np.ones(4), size=50)
    assert np.abs(lean_weights(few) - few).max() <= 1 / 4096
    assert_array_equal(lean_weights(lean), lean)


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3])
@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_modes_keep_what_the_tolerance_asks_for(tolerance: float, unit: float, rng) -> None:
    D = unit * np.einsum(
        "tk,kvc->tvc", rng.normal(size=(20, 20)) * 0.5 ** np.arange(20), rng.normal(size=(20, 50, 3))
    )
    Y = (D - D.mean(axis=0)).reshape(20, -1)
    basis = compress(D, Y @ Y.T, unit * tolerance)
    kept = np.stack([basis.residual(t) for t in range(20)])
    rms = np.sqrt(np.square(kept - D).sum(axis=-1).mean())
    assert 0.3 * tolerance * unit < rms < 1.05 * tolerance * unit
    assert_allclose(np.square(basis.coordinates).mean(axis=0), 1.0, atol=0.1)


def test_constant_residuals_need_no_modes(rng) -> None:
    D = np.repeat(rng.normal(size=(1, 30, 3)), 5, axis=0)
    basis = compress(D, np.zeros((5, 5)), 1e-3)
    assert basis.n_modes == 0
    assert_allclose(basis.residual(3), D[0], atol=2e-3)
    nothing = compress(0 * D, np.zeros((5, 5)), 1e-3)
    assert (nothing.residual(0) == 0).all()


def test_a_model_plays_the_same_when_it_is_read_again(saved, case) -> None:
    model, path = saved
    again = DetailModel.load(path)
    other = swing(case[0], 15, seed=9, turning=1.0)
    for motion in (None, other, case[1][1]):
        assert_array_equal(again.pose(motion).vertices, model.pose(motion).vertices)
        assert_array_equal(again.variance(motion), model.variance(motion))
        assert_array_equal(again.far(motion), model.far(motion))
    assert again.report_ == model.report_
    assert again.pose(proportions={"joint_1": 1.5}).vertices.shape == (25, 240, 3)
    assert len(again.motions_) == 2 and again.basis == "blended"
    copy = again.save(path.with_name("copy.tempose"))
    assert copy.read_bytes() == path.read_bytes()


@pytest.mark.parametrize("name", sorted(LEARNERS))
def test_every_learner_can_be_saved(name: str, case, tmp_path) -> None:
    rig, motions, clips = case
    model = DetailModel(name, folds=0).fit(clips[0], rig, motions[:1])
    again = DetailModel.load(model.save(tmp_path / "model.tempose"))
    other = swing(rig, 5, seed=4)
    assert_allclose(again.pose(other).vertices, model.pose(other).vertices, atol=1e-6)
    assert_allclose(again.region_variance(other), model.region_variance(other), rtol=1e-5)


def test_a_file_is_a_tenth_of_the_clip_at_most(case, tmp_path) -> None:
    rig = tube_rig(rings=120, around=40)
    motion = swing(rig, 60)
    clip = clothed(rig, motion)
    model = DetailModel("gp", folds=0).fit(clip, rig, [motion])
    size = model.save(tmp_path / "model.tempose").stat().st_size
    assert size < 0.1 * clip.vertices.nbytes
    assert model.report_["errors"]["rms_percent"] < 0.11


def test_files_that_are_no_models_are_refused(saved, case, tmp_path) -> None:
    path = saved[1]
    data = path.read_bytes()
    cut = tmp_path / "cut.tempose"
    cut.write_bytes(data[: len(data) // 2])
    with pytest.raises(ValueError, match=r"cut\.tempose: no Tempose model, or one cut short"):
        DetailModel.load(cut)
    with pytest.raises(FileNotFoundError, match="no such file"):
        DetailModel.load(tmp_path / "missing.tempose")
    rig = case[0].save(tmp_path / "rig.tempose")
    with pytest.raises(ValueError, match="a model of kind 'rig', expected 'detail'"):
        DetailModel.load(rig)
    with pytest.raises(ValueError, match="has learned nothing yet"):
        DetailModel().save(tmp_path / "none.tempose")


def rewritten(path: Path, to: Path, change) -> Path:
    """The same file with another header."""
    text = path.read_bytes()
    length = int.from_bytes(text[:8], "little")
    header = json.loads(json.loads(text[8 : 8 + length])["__metadata__"]["tempose"])
    change(header)
    save_file(load_file(path), to, metadata={"tempose": json.dumps(header)})
    return to


@pytest.mark.parametrize(
    "change",
    [
        lambda h: h.pop("predictor"),
        lambda h: h.update(step=-1.0),
        lambda h: h.update(step="far"),
        lambda h: h["packed"].pop("detail/modes"),
        lambda h: h["packed"]["detail/modes"].update(shape=[3, 720]),
        lambda h: h["packed"]["detail/coordinates"].update(shape=[10**9, 10**9]),
        lambda h: h["predictor"].update(module="os", **{"class": "system"}),
        lambda h: h["predictor"].update(module="tempose.clips.mesh", **{"class": "Mesh"}),
        lambda h: h["predictor"]["fields"].update(more=1),
        lambda h: h["options"].update(basis="sideways"),
        lambda h: h["motions"].append({"fps": 30.0, "name": ""}),
    ],
)
def test_headers_that_lie_are_refused(change, saved, tmp_path) -> None:
    lying = rewritten(saved[1], tmp_path / "lying.tempose", change)
    with pytest.raises(
        ValueError, match=r"lying\.tempose: a model of detail whose parts do not fit together"
    ):
        DetailModel.load(lying)


def test_only_learners_are_taken_apart() -> None:
    arrays: dict = {}
    with pytest.raises(TypeError, match=r"x\.1: a set cannot be saved"):
        to_arrays([1, {2}], "x", arrays)
    with pytest.raises(ValueError, match="unknown part"):
        from_arrays({"module": "tempose.detail.model", "class": "DetailModel", "fields": {}}, arrays)
    tree = to_arrays((1, "b", None, np.float64(2.5), np.eye(2)), "x", arrays)
    back = from_arrays(json.loads(json.dumps(tree)), arrays)
    assert back[:4] == (1, "b", None, 2.5)
    assert_array_equal(back[4], np.eye(2))


def test_bone_lengths_and_origin_of_every_motion_are_kept(case, tmp_path) -> None:
    rig, motions, clips = case
    longer = replace(motions[1].skeleton, offsets=1.25 * motions[1].skeleton.offsets)
    other = replace(motions[1], skeleton=longer, name="walk", source=Source("walk.bvh", "bvh"))
    model = DetailModel("mean", folds=0).fit(clips, rig, [motions[0], other])
    back = DetailModel.load(model.save(tmp_path / "tube.tempose"))
    for one, two in zip(model.motions_, back.motions_):
        assert_array_equal(one.skeleton.offsets, two.skeleton.offsets)
        assert (one.name, one.source, one.fps) == (two.name, two.source, two.fps)
    assert_array_equal(model.pose(model.motions_[1]).vertices, back.pose(back.motions_[1]).vertices)


def test_a_file_that_lost_a_motion_is_refused(saved, tmp_path) -> None:
    path = rewritten(saved[1], tmp_path / "lost.tempose", lambda header: header["motions"].clear())
    with pytest.raises(ValueError, match="coordinates of 50 frames, not of the motions"):
        DetailModel.load(path)
