"""A long clip is fitted, played, edited and saved as a short one is, without ever being in memory."""

from __future__ import annotations

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, MeshClip
from tempose.rotations import from_rotation_vector
from tempose.signals import SignalModel
from tempose.signals.placement import place
from tempose.signals.windows import WindowedPose
from tempose.typing import FloatArray

pytestmark = pytest.mark.slow

T, N = 900, 1500
UP = np.array([0.0, 1.0, 0.0])


def walker() -> FloatArray:
    """A blob that walks round a circle with a stride that changes; all comes back after 237 frames."""
    random = np.random.default_rng(0)
    rest = random.standard_normal((N, 3)) * [0.3, 0.9, 0.3] + [0, 1, 0]
    modes = 0.1 * random.standard_normal((4, 3, 3))
    modes += modes.transpose(0, 2, 1)  # no turn in them: that would be placement
    t = np.arange(T)
    stride, slow = 2 * np.pi * t / 23.7, np.sin(2 * np.pi * t / 237)
    amounts = np.stack([np.sin(stride), np.cos(stride), 0.5 * np.sin(2 * stride + slow), 0.7 * slow], axis=1)
    amounts[:, 0] *= 1 + 0.3 * slow
    body = rest + np.einsum("tk,kij,nj->tni", amounts, modes, rest - rest.mean(axis=0))
    angle = 0.01 * t
    way = np.stack([5 * np.cos(angle), 0 * angle, -5 * np.sin(angle)], axis=1)
    return place(body, np.concatenate([from_rotation_vector(angle[:, None] * UP), way], axis=1))


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> MeshClip:
    path = tmp_path_factory.mktemp("long") / "walker.npy"
    V = walker().astype(np.float32)
    np.save(path, V)
    faces = np.stack([np.arange(N - 2), np.arange(1, N - 1), np.arange(2, N)], axis=1)
    return MeshClip(np.load(path, mmap_mode="r"), Mesh(V[0].astype(float), faces), 30.0)


@pytest.fixture(scope="module")
def model(clip: MeshClip) -> SignalModel:
    return SignalModel(tolerance=0.5, k=T + 2, placement=True, window=200).fit(clip)


def test_frames_come_back_to_the_tolerance(clip: MeshClip, model: SignalModel) -> None:
    assert isinstance(model.signals_.pose, WindowedPose) and len(model.signals_.pose.windows) > 4
    off = np.linalg.norm(model.sample() - clip.vertices, axis=2)
    percent = 100 * np.sqrt(np.square(off).mean()) / clip.mesh.diagonal
    assert percent <= 0.5 and model.report_["paper"]["rms_percent"] <= 0.5
    assert_allclose(model.report_["errors"]["rms_percent"], percent, rtol=1e-3)


def test_placement_split_off_leaves_few_modes(model: SignalModel) -> None:
    assert model.report_["m"] <= 4


def test_fitting_and_playing_take_a_part_of_the_clip_in_memory(
    clip: MeshClip, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempose.signals.blocks.BLOCK_VALUES", 20_000)
    out = np.lib.format.open_memmap(tmp_path / "back.npy", "w+", np.float32, clip.vertices.shape)
    model = SignalModel(m=4, l=30, k=300, placement=True, window=100)
    model.fit(clip)  # so that nothing is loaded or compiled below
    tracemalloc.start()
    try:
        model.fit(clip).sample(out=out)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 0.4 * clip.vertices.size * 8
    off = np.linalg.norm(out - clip.vertices, axis=2)
    assert off.mean() < 0.01 * clip.mesh.diagonal


def test_saved_and_loaded_it_plays_the_same_bits(model: SignalModel, tmp_path: Path) -> None:
    again = SignalModel.load(model.save(tmp_path / "long.tempose"))
    t = np.linspace(-1, 31, 97)
    assert_array_equal(again(t), model(t))
    assert_array_equal(
        again.pose_at(model.positions_[::90], 455.5), model.pose_at(model.positions_[::90], 455.5)
    )


def test_moving_a_control_changes_its_support_alone(model: SignalModel) -> None:
    j = 400
    edited = model.edited([{"op": "move", "control": j, "by": [0.05, 0.02]}])
    low, high = model.signals_.time.curve.support(j)
    u = model.signals_.time.pace(np.arange(float(T)))
    inside = (u > low) & (u < high)
    before, after = model.sample(), edited.sample()
    assert_array_equal(before[~inside], after[~inside])
    assert (before[inside] != after[inside]).any(axis=(1, 2)).all() and 0 < inside.sum() <= 4


def test_a_loop_of_a_long_walk_walks_on(model: SignalModel) -> None:
    looped = model.edited([{"op": "loop", "from": 237, "to": 474, "times": 3}])
    assert looped.signals_.n_frames == T + 2 * 237
    V, W = model.sample(dtype=np.float64), looped.sample(dtype=np.float64)
    reach = 30
    assert_array_equal(V[: 474 - reach], W[: 474 - reach])
    centres = W.mean(axis=1)
    steps = np.linalg.norm(np.diff(centres, axis=0), axis=1)
    assert steps.max() < 1.5 * np.linalg.norm(np.diff(V.mean(axis=1), axis=0), axis=1).max()
    # on the circle it goes round three times as far
    angle = np.unwrap(np.arctan2(-centres[:, 2], centres[:, 0]))
    assert_allclose(angle[-1] - angle[0], 0.01 * (T - 1 + 2 * 237), rtol=0.02)
    assert_allclose(np.linalg.norm(centres[:, [0, 2]], axis=1), 5, atol=0.25)


def options(**changes: Any) -> dict[str, Any]:
    return {"m": 4, "k": 62, "placement": True} | changes


def test_a_clip_of_one_window_is_fitted_as_without_windows(clip: MeshClip) -> None:
    part = MeshClip(clip.vertices[:60], clip.mesh, clip.fps)
    one, other = (SignalModel(l=20, window=w, **options()).fit(part) for w in (60, 500))
    assert_array_equal(one.sample(), other.sample())
