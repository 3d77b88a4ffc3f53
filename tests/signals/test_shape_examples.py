"""A basis of example poses: the normal equation of section 4.3, and what it must not depend on."""

from __future__ import annotations

import numpy as np
import pytest
from model_clips import CORNERS, swinging, wandering
from numpy.testing import assert_allclose

from tempose.clips import Mesh
from tempose.shape_spaces import VertexSpace
from tempose.signals import SignalModel
from tempose.signals.shape.examples import orthonormal_basis, shape_coordinates, shape_from_examples


def encoded(clip: object) -> np.ndarray:
    V = clip.vertices.astype(np.float64)  # type: ignore[attr-defined]
    return V.reshape(len(V), -1)


def test_coordinates_solve_the_least_squares_problem() -> None:
    Z = encoded(wandering())
    shape = shape_from_examples(VertexSpace(4), Z[[2, 5, 7]])
    H = shape.components.T
    expected = np.linalg.lstsq(H, (Z - shape.mean).T, rcond=None)[0].T
    assert_allclose(shape_coordinates(shape, Z), expected, atol=1e-12)
    assert_allclose(shape_coordinates(shape, Z[3]), expected[3], atol=1e-12)
    assert_allclose(shape_coordinates(shape, Z.reshape(3, 4, -1)), expected.reshape(3, 4, -1), atol=1e-12)


def test_examples_have_unit_coordinates() -> None:
    Q = encoded(wandering())[[1, 4, 6, 9]]
    shape = shape_from_examples(VertexSpace(4), Q)
    assert_allclose(shape_coordinates(shape, Q), np.eye(4)[:, 1:], atol=1e-12)


def test_the_turn_makes_distances_those_of_the_shape_space() -> None:
    Q = encoded(wandering())[[1, 4, 6, 9]]
    shape = shape_from_examples(VertexSpace(4), Q)
    x = np.random.default_rng(0).normal(size=(7, 3))
    lengths = np.linalg.norm(x @ orthonormal_basis(shape), axis=1)
    assert_allclose(lengths, np.linalg.norm(x @ shape.components, axis=1), rtol=1e-12)


def test_which_example_is_the_reference_changes_nothing_that_is_played() -> None:
    clip = swinging()
    frames = clip.vertices[[0, 9, 17, 30]]
    a = SignalModel(k=30, l=20).fit(clip, examples=frames)
    b = SignalModel(k=30, l=20).fit(clip, examples=frames[[2, 0, 3, 1]])
    assert_allclose(a.sample(fps=50, dtype=np.float64), b.sample(fps=50, dtype=np.float64), atol=1e-9)
    p = np.array([[0.1, -0.2], [1.0, 0.5]])
    same = np.abs(a.positions_ @ np.linalg.lstsq(a.positions_, b.positions_, rcond=None)[0] - b.positions_)
    assert same.max() < 1e-6
    assert a.pose_at(p).shape == (2, 4, 3)


def test_examples_that_span_the_clip_give_it_back() -> None:
    clip = wandering()
    model = SignalModel(k=14, l=12).fit(clip, examples=clip.vertices)
    assert model.report_["m"] == 11
    assert model.report_["paper"]["rms_percent"] < 1e-8 and model.report_["errors"]["rms_percent"] < 1e-8


def test_what_examples_leave_out_is_reported_and_not_held_against_the_rest() -> None:
    clip = wandering()
    report = SignalModel(tolerance=0.1).fit(clip, examples=clip.vertices[[0, 6, 11]]).report_
    assert report["budget"]["h"] > 1 and report["budget"]["g"] <= 0.1


@pytest.mark.parametrize("space", ["vertex", "gradient"])
def test_a_tolerance_is_met_with_examples_that_span_the_clip(space: str) -> None:
    clip = wandering()
    report = SignalModel(space, tolerance=0.5).fit(clip, examples=clip.vertices).report_
    assert report["paper"]["rms_percent"] <= 0.6 and report["l"] > 3


def test_meshes_do_as_examples() -> None:
    clip = wandering()
    poses = [Mesh(V, clip.faces) for V in clip.vertices[[0, 4, 8]]]
    a = SignalModel(k=14, l=12).fit(clip, examples=poses).sample()
    assert np.array_equal(a, SignalModel(k=14, l=12).fit(clip, examples=clip.vertices[[0, 4, 8]]).sample())


@pytest.mark.parametrize(
    ("which", "message"),
    [([3], "two poses or more, got 1"), ([0, 3, 3], "number 2 .* is a mixture"), ([0, 0], "number 1")],
)
def test_examples_that_span_nothing_are_refused(which: list[int], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        SignalModel().fit(wandering(), examples=wandering().vertices[which])


def test_examples_of_another_mesh_are_refused() -> None:
    with pytest.raises(ValueError, match=r"examples\[0\] must have shape \(4, 3\), got \(3, 3\)"):
        SignalModel().fit(wandering(), examples=[CORNERS[:3], CORNERS[:3]])


def test_m_beside_examples_must_agree() -> None:
    with pytest.raises(ValueError, match="m must be"):
        SignalModel(m=5).fit(wandering(), examples=wandering().vertices[[0, 3]])
