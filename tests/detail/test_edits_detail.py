"""More of the detail, less, calmer, here and there, on other bones."""

from __future__ import annotations

import numpy as np
import pytest
from clothed_tube import clothed, swing, tube_rig
from numpy.testing import assert_allclose

from tempose.detail import DetailModel
from tempose.detail.edits import damped, region_strengths, size_ratio, vertex_mask


@pytest.fixture(scope="module")
def model():
    rig = tube_rig()
    motion = swing(rig, 30)
    return DetailModel("regional-gp", folds=0).fit(clothed(rig, motion), rig, [motion])


@pytest.fixture(scope="module")
def parts(model):
    """Posed with all of the detail, and with none."""
    return model.pose().vertices.astype(np.float64), model.pose(strength=0).vertices.astype(np.float64)


@pytest.mark.parametrize("strength", [0.5, 2.0, -1.0])
def test_detail_is_scaled(model, parts, strength: float) -> None:
    whole, skin = parts
    assert_allclose(model.pose(strength=strength).vertices, skin + strength * (whole - skin), atol=3e-6)


def test_strengths_of_regions_add_up(model, parts) -> None:
    whole, skin = parts
    some = model.pose(strength={"joint_1": 0.0}).vertices
    others = model.pose(strength={"joint_0": 0.0, "joint_2": 0.0}).vertices
    assert_allclose(some + others, whole + skin, atol=3e-6)
    alone = model.shares_[:, 0] == 1
    assert alone.any()
    assert_allclose(some[:, alone], whole[:, alone], atol=1e-6)


def test_masks_show_detail_here_and_there(model, parts) -> None:
    whole, skin = parts
    mask = np.linspace(0, 1, whole.shape[1])
    assert_allclose(model.pose(mask=mask).vertices, skin + mask[:, None] * (whole - skin), atol=3e-6)
    shares = model.shares_[:, :1]
    assert_allclose(model.pose(mask=["joint_0"]).vertices, skin + shares * (whole - skin), atol=3e-6)
    assert_allclose(model.pose(mask=model.regions).vertices, whole, atol=1e-6)


def test_damping_keeps_what_lasts_and_lags_nowhere() -> None:
    t = np.arange(200) / 50.0
    assert_allclose(damped(np.full((9, 2), 3.0), 0.2, 30.0), 3.0)
    fast = damped(np.sin(2 * np.pi * 2.0 * t), 0.1, 50.0)
    gain = np.exp(-0.5 * (2 * np.pi * 2.0 * 0.1) ** 2)
    assert_allclose(fast[40:160], gain * np.sin(2 * np.pi * 2.0 * t)[40:160], atol=1e-3)
    line = damped(t, 0.1, 50.0)
    assert_allclose(line[40:160], t[40:160], atol=1e-12)
    again = damped(np.repeat(t, 2), 0.05, 100.0)  # twice the rate, half the time: as many frames
    assert_allclose(again, damped(np.repeat(t, 2), 0.1, 50.0))
    assert_allclose(damped(t, 0.0, 50.0), t)
    with pytest.raises(ValueError, match="damp must be 0 seconds or more"):
        damped(t, -1.0, 50.0)


def test_damped_detail_moves_less(model) -> None:
    def unrest(V: np.ndarray) -> float:
        return float(np.square(np.diff(V - model.pose(strength=0).vertices, n=2, axis=0)).sum())

    assert unrest(model.pose(damp=0.2).vertices) < 0.25 * unrest(model.pose().vertices)
    assert_allclose(model.pose(damp=0.0).vertices, model.pose().vertices)


def test_detail_grows_with_the_bones(model, parts) -> None:
    whole, skin = parts
    same = model.pose(proportions={name: 1.0 for name in model.regions})
    assert_allclose(same.vertices, whole, atol=5e-6)
    factors = {name: {"length": 2.0, "thickness": 2.0} for name in model.regions}
    twice = model.pose(proportions=factors).vertices
    alone = model.pose(proportions=factors, strength=0).vertices
    assert_allclose(twice - alone, 2 * (whole - skin), atol=2e-5)


def test_ratios_of_sizes_are_those_of_lengths(rng) -> None:
    rig = tube_rig()
    V, F = rig.skin.mesh.vertices, rig.skin.mesh.faces
    assert_allclose(size_ratio(V, 3 * V, F, rig.skin.weights), 3.0)
    assert_allclose(size_ratio(V, V + 5, F, rig.skin.weights), 1.0)
    grown = np.where(V[:, 1:2] > 2.2, [3.0, 1, 3], 1.0) * V
    ratio = size_ratio(V, grown, F, rig.skin.weights)
    assert ratio[0] == pytest.approx(1.0) and ratio[-1] > 1.3
    none = np.zeros((len(V), 2))
    assert_allclose(size_ratio(V, 3 * V, F, none), 1.0)


def test_edits_that_name_nothing_are_refused(model) -> None:
    with pytest.raises(ValueError, match="strength: no region named 'tail'; there are joint_0"):
        model.pose(strength={"tail": 1.0})
    with pytest.raises(ValueError, match="strength must be finite"):
        region_strengths(np.inf, ["a"])
    with pytest.raises(ValueError, match="mask: no region named 'tail'"):
        model.pose(mask="tail")
    with pytest.raises(ValueError, match=r"mask must have shape \(240,\)"):
        model.pose(mask=np.ones(7))
    with pytest.raises(ValueError, match="mask must hold numbers from 0 to 1"):
        model.pose(mask=np.full(240, 1.5))
    assert vertex_mask(None, ["a"], np.ones((3, 1))) is None
