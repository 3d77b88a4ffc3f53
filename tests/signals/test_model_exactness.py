"""k - 2 = l = m + 1 = T gives every frame back, and fewer leave out what the budget says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from model_clips import clip_of, repeating, sliding, still, swinging, wandering
from numpy.testing import assert_allclose

from tempose.clips import MeshClip
from tempose.metrics import compare
from tempose.signals import SignalModel
from tempose.signals.sampling import sample


def literal(model: SignalModel) -> np.ndarray:
    """Frames of the paper's psi, without the time spline."""
    signals = replace(model.signals_, path=None)
    return sample(signals, signals.times, dtype=np.float64)


def exact(T: int, **options: object) -> SignalModel:
    return SignalModel(k=T + 2, l=T, m=T - 1, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("layout", ["auto", "mds"])
def test_every_frame_comes_back_in_the_literal_representation(unit: float, layout: str) -> None:
    clip = wandering()
    clip = replace(clip, vertices=unit * clip.vertices, mesh=clip.mesh.with_vertices(unit * clip.rest))
    model = exact(12, layout=layout).fit(clip)
    D = clip.mesh.diagonal
    assert_allclose(literal(model), clip.vertices, atol=1e-9 * D)
    assert_allclose(model.sample(dtype=np.float64), clip.vertices, atol=1e-12 * D)


@pytest.mark.parametrize("space", ["gradient", "patch"])
def test_every_frame_comes_back_in_curved_spaces(space: str) -> None:
    clip = wandering()
    model = exact(12, space=space).fit(clip)
    assert_allclose(literal(model), clip.vertices, atol=1e-6 * clip.mesh.diagonal)


def test_every_frame_comes_back_with_the_placement_split_off() -> None:
    clip = wandering()
    model = exact(12, placement=True).fit(clip)
    assert_allclose(literal(model), clip.vertices, atol=1e-9 * clip.mesh.diagonal)


@pytest.mark.parametrize(
    "clip", [repeating(), sliding(), sliding((0, 1, 5, 5, 5, 9)), still(), wandering(2), wandering(3)]
)
def test_clips_of_low_dimension_come_back_too(clip: MeshClip) -> None:
    T = clip.n_frames
    model = exact(T).fit(clip) if T > 2 else SignalModel(k=4, m=1).fit(clip)
    assert_allclose(literal(model), clip.vertices, atol=1e-9 * clip.mesh.diagonal)


def test_two_frames_are_a_straight_line_between_them() -> None:
    clip = wandering(2)
    model = SignalModel().fit(clip)
    a, b = clip.vertices.astype(np.float64)
    for t in (0.0, 0.3, 1.0):
        assert_allclose(model(t / clip.fps, dtype=np.float64), (1 - t) * a + t * b, atol=1e-12)


def test_a_still_clip_is_a_constant() -> None:
    model = SignalModel().fit(still())
    assert model.report_["m"] == 0 and model.report_["warnings"] == []
    assert_allclose(model(0.077, dtype=np.float64), still().rest, atol=1e-15)
    assert model.clip().n_frames == 5


def test_a_rigid_body_whose_placement_is_split_off_needs_no_shape() -> None:
    model = SignalModel(placement=True).fit(sliding())
    assert model.report_["m"] == 0
    assert_allclose(model.sample(dtype=np.float64), sliding().vertices, atol=1e-12)


@pytest.mark.parametrize(("k", "l", "m"), [(20, 15, 3), (42, 12, 5), (12, 40, 11), (9, 5, 2)])
def test_the_budget_adds_up_to_the_measured_error(k: int, l: int, m: int) -> None:
    clip = swinging()
    model = SignalModel(k=k, l=l, m=m).fit(clip)
    report, budget = model.report_, model.report_["budget"]
    measured = compare(clip.vertices, literal(model), clip.mesh.diagonal)
    assert_allclose(budget["whole"], measured.rms_percent, rtol=1e-9, atol=1e-11)
    assert_allclose(report["paper"]["rms_percent"], measured.rms_percent, rtol=1e-9, atol=1e-11)
    signed = np.sign(budget["f_signed"]) * budget["f_signed"] ** 2
    assert_allclose(budget["h"] ** 2 + budget["g"] ** 2 + signed, budget["whole"] ** 2, rtol=1e-9, atol=1e-20)
    assert_allclose(
        report["errors"]["rms_percent"], budget["h"], rtol=1e-9, atol=1e-11
    )  # the path adds nothing
    for name, whole in (("h", "h"), ("hgf", "whole")):
        frames = np.array(report["frame_errors"][name])
        assert_allclose(np.sqrt(np.mean(frames**2)), budget[whole], rtol=1e-9, atol=1e-11)


def test_the_shape_signal_leaves_out_the_rest_of_the_spectrum() -> None:
    clip = swinging()
    model = SignalModel(k=42, l=40, m=3).fit(clip)
    V = clip.vertices.astype(np.float64).reshape(40, -1)
    s = np.linalg.svd(V - V.mean(axis=0), compute_uv=False)
    expected = 100 / clip.mesh.diagonal * np.sqrt(np.square(s[3:]).sum() / (40 * 4))
    assert_allclose(model.report_["budget"]["h"], expected, rtol=1e-10)
    assert_allclose(model.report_["scree"][3], expected, rtol=1e-10)


def test_a_moved_and_turned_clip_gives_the_moved_and_turned_frames() -> None:
    clip = swinging()
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    shift = np.array([3.0, -2, 1])
    other = clip_of(clip.vertices.astype(np.float64) @ turn.T + shift)
    a = SignalModel(k=20, l=12, m=4).fit(clip).sample(fps=60, dtype=np.float64)
    b = SignalModel(k=20, l=12, m=4).fit(other).sample(fps=60, dtype=np.float64)
    assert_allclose(a @ turn.T + shift, b, atol=1e-5)
