"""Coordinates found block by block are those of the whole clip, in every space that can go on."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip
from tempose.rotations import from_rotation_vector
from tempose.shape_spaces import SPACES
from tempose.signals import SignalModel
from tempose.signals.fit.frames import FOLLOWING, ClipFrames
from tempose.signals.placement import place
from tempose.signals.shape.streamed import (
    encoded_blocks,
    first_coordinates,
    fit_streamed_shape,
    streamed_space,
)
from tempose.typing import FloatArray

SIDE = 8


def flag(T: int) -> MeshClip:
    """A sheet that bends, and turns by more than once round about an axis that sways."""
    x, z = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, SIDE), np.linspace(-1, 1, SIDE), indexing="ij"))
    s = np.linspace(0, 1, T)[:, None]
    y = 0.4 * np.sin(2 * x + 9 * s) + 0.3 * s * z**2 + 0.2 * np.cos(3 * z - 4 * s)
    body = np.stack([np.broadcast_to(x, y.shape), y, np.broadcast_to(z, y.shape)], axis=2)
    axis = np.stack([0.3 * np.sin(5 * s[:, 0]), np.ones(T), 0.2 * s[:, 0]], axis=1)
    q = from_rotation_vector(7.5 * s * axis)
    V = place(body, np.concatenate([q, np.zeros((T, 3))], axis=1))
    i = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[1:, 1:].ravel(), i[:-1, 1:].ravel()
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([a, d, c], axis=1)])
    return MeshClip(V.astype(np.float32), Mesh(V[0], faces), 30.0)


def off(model: SignalModel, clip: MeshClip) -> FloatArray:
    return np.linalg.norm(model.sample(dtype=np.float64) - clip.vertices, axis=2)


@pytest.mark.parametrize("space", FOLLOWING[1:])
@pytest.mark.parametrize("split", [False, True])
def test_blocks_are_encoded_as_the_whole_is(space: str, split: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    clip = flag(90)
    frames = ClipFrames.of(clip, split)
    made = streamed_space(space, frames)
    monkeypatch.setattr("tempose.signals.blocks.BLOCK_VALUES", 7 * made.dimension // 3)
    blocks = list(encoded_blocks(made, frames, first_coordinates(made, frames)))
    assert len(blocks) > 5
    Z = np.concatenate(blocks)
    whole = made.encode_path(frames.block(slice(None)))
    assert_allclose(Z, whole, atol=1e-9)
    assert np.linalg.norm(np.diff(Z, axis=0), axis=1).max() < 1


@pytest.mark.parametrize("space", FOLLOWING)
def test_a_streamed_fit_meets_the_tolerance_with_hardly_more_modes(
    space: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    clip = flag(70)
    plain = SignalModel(space=space, tolerance=0.5, placement=True).fit(clip)
    monkeypatch.setattr("tempose.signals.fit.frames.IN_MEMORY", 100)
    found = SignalModel(space=space, tolerance=0.5, placement=True).fit(clip)
    for model in (plain, found):
        percent = 100 * np.sqrt(np.square(off(model, clip)).mean()) / clip.mesh.diagonal
        assert percent <= 0.5
    assert plain.report_["m"] - 1 <= found.report_["m"] <= plain.report_["m"] + 2
    assert_allclose(found.report_["budget"]["h"], plain.report_["budget"]["h"], rtol=0.3)


def test_the_number_of_modes_asked_for_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempose.signals.fit.frames.IN_MEMORY", 100)
    model = SignalModel(space="gradient", m=5, l=30, k=40).fit(flag(40))
    assert model.report_["m"] == 5


def test_a_space_that_cannot_go_on_refuses_a_clip_that_is_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempose.signals.fit.frames.IN_MEMORY", 100)
    for space in set(SPACES) - set(FOLLOWING):
        with pytest.raises(ValueError, match=r"too large for the space.*choose vertex, gradient or patch"):
            SignalModel(space=space).fit(flag(20))


@pytest.mark.parametrize("space", FOLLOWING)
def test_what_is_left_out_of_each_frame_is_told(space: str) -> None:
    frames = ClipFrames.of(flag(50), True)
    made = streamed_space(space, frames)
    found = fit_streamed_shape(made, frames, None, 1.0)
    Z = made.encode_path(frames.block(slice(None)))
    off = Z - found.shape.mean - found.X @ found.shape.components
    assert 0 < found.X.shape[1] < 20
    assert_allclose(found.left_out, np.square(off).sum(axis=1), rtol=1e-6, atol=1e-10)
