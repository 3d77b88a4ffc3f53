"""The map behind the latent space is sure where frames are; charts and sheets show the numbers given."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.detail.learners import PlainGaussianProcess
from tempose.detail.learners.latent import LatentLearner
from tempose.detail.pictures import LatentPlane, draw_heldout, draw_latent, latent_plane
from tempose.detail.pictures.plane import _columns, _inputs
from tempose.detail.training import Inputs, Training
from tempose.render.drawing import Inset, Stroke, Words

T, K = 40, 3


def inputs(chains: int = 1) -> Inputs:
    t = 2 * np.pi * np.arange(T) / T
    rng = np.random.default_rng(5)
    ring = np.column_stack([np.cos(t), np.sin(t)])
    angles = (ring @ rng.normal(size=(2, 3 * K))).reshape(T, K, 3)
    velocity = np.gradient(angles, axis=0)
    return Inputs(angles, velocity, np.zeros((T, 0)), np.arange(T) * chains // T, tuple("abc"))


def training() -> Training:
    seen = inputs()
    Y = np.tanh(seen.angles.reshape(T, -1) @ np.random.default_rng(6).normal(size=(3 * K, 12)))
    return Training(seen, (Y @ Y.T)[None], np.array([12.0]))


def test_the_map_is_sure_near_frames_and_not_far_from_them() -> None:
    made = training()
    plane = latent_plane(PlainGaussianProcess().fit(made), made.inputs, made.sizes, resolution=24)
    X, Y = np.meshgrid(plane.x, plane.y)
    away = np.sqrt(((np.stack([X, Y], -1)[:, :, None] - plane.points) ** 2).sum(-1).min(-1))
    near, far = plane.spread[away < 0.05 * np.ptp(plane.x)], plane.spread[away > 0.25 * np.ptp(plane.x)]
    assert near.mean() < 0.5 * far.mean()
    assert not plane.latent and 0.5 < plane.share <= 1.0


def test_places_of_frames_mean_their_inputs() -> None:
    seen = inputs()
    back = _inputs(_columns(seen), seen)
    assert_allclose(back.angles, seen.angles, atol=1e-12)
    assert_allclose(back.velocity, seen.velocity, atol=1e-12)
    assert len(np.unique(back.chains)) == T, "places do not follow one another in time"


def test_a_latent_space_is_shown_as_it_is() -> None:
    made = training()
    predictor = LatentLearner().fit(made)
    plane = latent_plane(predictor, made.inputs, made.sizes, resolution=16)
    assert plane.latent and len(plane.points) == len(predictor.latent) == len(plane.chains)
    apart = np.linalg.norm(plane.points[:, None] - plane.points, axis=-1)
    true = np.linalg.norm(predictor.latent[:, None] - predictor.latent, axis=-1)
    assert (apart <= true + 1e-9).all(), "a projection never lengthens"
    assert_allclose((apart**2).sum(), plane.share * (true**2).sum(), rtol=1e-9)
    least = np.sqrt(predictor.mix(made.inputs).variance.min())
    assert 0 < plane.spread.min() < 1.01 * least < plane.spread.max(), "frames are surest, the plane is wider"


def test_the_drawing_holds_all_frames_and_the_range() -> None:
    t = np.linspace(0, 5, T)
    points = np.column_stack([np.sin(t), np.cos(t)])
    x, y = np.linspace(-2, 2, 12), np.linspace(-1, 1, 7)
    spread = np.hypot(*np.meshgrid(x, y)) + 0.5
    plane = LatentPlane(points, np.arange(T) * 2 // T, x, y, spread, 0.9, True)
    drawing = draw_latent(plane, unit="m")
    dots = [s for s in drawing.shapes if isinstance(s, Stroke) and len(s.points) == 1]
    paths = [s for s in drawing.shapes if isinstance(s, Stroke) and len(s.points) == T // 2]
    assert len(dots) == T and len(paths) == 4, "each clip is a path of its own, with a rim"
    (inset,) = [s for s in drawing.shapes if isinstance(s, Inset)]
    assert inset.picture.shape[2] == 4 and (inset.picture[..., 3] == 255).all()
    words = " ".join(s.text for s in drawing.shapes if isinstance(s, Words))
    assert f"{plane.spread.min():.3g} m" in words and f"{plane.spread.max():.3g} m" in words
    assert "2 clips" in words


def test_held_out_errors_are_in_percent_and_in_order() -> None:
    rows = {
        "skin": {"frames": [0.02] * T},
        "nearest": {"frames": [0.9] * T},
        "gp": {"frames": [0.01] * T},
        "ridge": {"frames": [0.005] * T},
    }
    drawing = draw_heldout(rows, "ridge", 2.0, np.zeros(T, dtype=int))
    words = [s.text for s in drawing.shapes if isinstance(s, Words)]
    assert {"skin alone", "plain GP", "ridge"} <= set(words) and "nearest" not in words
    lines = [s for s in drawing.shapes if isinstance(s, Stroke) and len(s.points) == T]
    heights = [float(s.points[0, 1]) for s in lines]
    assert heights == sorted(heights), "from the largest error down"
    assert heights[0] - heights[1] == pytest.approx(2 * (heights[1] - heights[2]))
