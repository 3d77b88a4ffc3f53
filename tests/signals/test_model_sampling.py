"""Times and frames out of a model: one, many, more than memory."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from model_clips import clip_of, swinging
from numpy.testing import assert_allclose

from tempose.signals import SignalModel
from tempose.signals.blocks import BLOCK_VALUES


@pytest.fixture(scope="module")
def model() -> SignalModel:
    return SignalModel(k=30, l=25, m=8).fit(swinging())


@pytest.mark.parametrize("shape", [(), (1,), (5,), (3, 1, 2), (0,)])
def test_any_shape_of_times_gives_that_shape_of_meshes(model: SignalModel, shape: tuple[int, ...]) -> None:
    t = np.random.default_rng(0).uniform(0, 1.6, shape)
    found = model(t, dtype=np.float64)
    assert found.shape == (*shape, 4, 3)
    flat = [model(float(s), dtype=np.float64) for s in t.reshape(-1)]
    assert_allclose(found.reshape(-1, 4, 3), np.array(flat).reshape(-1, 4, 3), atol=1e-14)


def test_single_precision_is_double_rounded(model: SignalModel) -> None:
    t = np.linspace(0, 1.6, 101)
    single, double = model.sample(t), model.sample(t, dtype=np.float64)
    assert single.dtype == np.float32
    assert_allclose(single, double, atol=4e-7 * np.abs(double).max())
    assert_allclose(model(t[7]), single[7], atol=4e-7)


def test_blocks_joined_are_the_whole(model: SignalModel) -> None:
    t = np.linspace(0, 1.6, BLOCK_VALUES // 12 + 1000)
    parts = list(model.sample_blocks(t))
    assert len(parts) == 2
    assert [p[0].start for p in parts] == [0, BLOCK_VALUES // 12] and parts[1][0].stop == len(t)
    assert np.array_equal(np.concatenate([p[1] for p in parts]), model.sample(t))


def test_a_million_times_are_written_where_they_are_wanted(model: SignalModel, tmp_path: Path) -> None:
    t = np.linspace(0, 1.6, 1_000_000)
    out = np.lib.format.open_memmap(tmp_path / "v.npy", mode="w+", dtype=np.float32, shape=(len(t), 4, 3))
    assert model.sample(t, out=out) is out
    assert np.array_equal(out[::99_999], model.sample(t)[::99_999])


def test_more_than_memory_is_refused_before_it_is_taken(model: SignalModel) -> None:
    with pytest.raises(ValueError, match="more than this machine has; take them in blocks"):
        model.sample(np.broadcast_to(0.5, (2**40,)))


def test_out_of_another_shape_is_refused(model: SignalModel) -> None:
    with pytest.raises(ValueError, match=r"out must have shape \(K, 4, 3\)"):
        model.sample(np.zeros(5), out=np.zeros((4, 4, 3)))


def test_times_that_are_no_number_are_refused(model: SignalModel) -> None:
    for bad in (np.nan, np.inf):
        with pytest.raises(ValueError, match="times must be finite"):
            model(bad)


def test_before_the_start_and_after_the_end_the_end_poses_hold(model: SignalModel) -> None:
    assert np.array_equal(model(-3.0), model(0.0))
    assert np.array_equal(model(99.0), model(model.signals_.duration))


@pytest.mark.parametrize(("fps", "count"), [(24.0, 40), (48.0, 79), (12.0, 20), (60.0, 98), (1.0, 2)])
def test_frame_rates_start_at_frame_0(model: SignalModel, fps: float, count: int) -> None:
    clip = model.clip(fps=fps)
    assert clip.fps == fps and clip.n_frames == count
    assert np.array_equal(clip.vertices[0], model.clip().vertices[0])
    if fps == 48:
        assert_allclose(clip.vertices[::2], model.clip().vertices, atol=4e-7)


@pytest.mark.parametrize("fps", [0.0, -1.0, np.nan, np.inf])
def test_a_frame_rate_that_is_none_is_refused(model: SignalModel, fps: float) -> None:
    with pytest.raises(ValueError, match="fps must be positive"):
        model.clip(fps=fps)


def test_unedited_playback_is_the_cubic_of_every_vertex() -> None:
    from scipy.interpolate import CubicSpline

    clip = swinging()
    model = SignalModel(k=10, l=5, tolerance=1e-9, period=None).fit(clip)
    V = clip.vertices.astype(np.float64)
    cubic = CubicSpline(np.arange(40), V.reshape(40, -1), bc_type="natural")
    ticks = np.linspace(0, 39, 333)
    expected = cubic(ticks).reshape(-1, 4, 3)
    assert_allclose(model.sample(ticks / clip.fps, dtype=np.float64), expected, atol=1e-10)


def test_poses_of_the_plane_are_h_of_g(model: SignalModel) -> None:
    s = model.signals_
    p = s.pose.sites[:3]
    assert_allclose(model.pose_at(p, dtype=np.float64), s.shape.vertices(s.pose(p)), atol=1e-14)


def test_a_long_clip_is_fitted_block_by_block(monkeypatch: pytest.MonkeyPatch) -> None:
    clip = swinging()
    whole = SignalModel(k=30, l=9, m=3).fit(clip)
    monkeypatch.setattr("tempose.signals.fit.frames.IN_MEMORY", 100)
    blocks = SignalModel(k=30, l=9, m=3).fit(clip)
    assert_allclose(blocks.sample(dtype=np.float64), whole.sample(dtype=np.float64), atol=1e-6)
    for name in ("h", "g", "whole"):
        assert_allclose(blocks.report_["budget"][name], whole.report_["budget"][name], rtol=1e-3)
    chosen = SignalModel(tolerance=0.5).fit(clip).report_
    assert chosen["paper"]["rms_percent"] <= 0.5


def test_a_still_long_clip_is_a_constant(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempose.signals.fit.frames.IN_MEMORY", 100)
    clip = clip_of(np.repeat(swinging().vertices[:1], 30, axis=0))
    model = SignalModel().fit(clip)
    assert_allclose(model(0.3), clip.vertices[0], atol=1e-6)


def test_windows_reproduce_what_one_pose_signal_does() -> None:
    clip = swinging(60)
    model = SignalModel(k=62, l=60, m=11, window=20).fit(clip)
    signals = replace(model.signals_, path=None)
    V = signals.shape.vertices(signals.coordinates(signals.times))
    assert model.report_["windows"] > 2
    assert_allclose(V, clip.vertices, atol=1e-6)
