"""k, l and m chosen from one tolerance: met, and not by more than is needed."""

from __future__ import annotations

import numpy as np
import pytest
from model_clips import swinging, wandering

from tempose.signals import SignalModel
from tempose.signals.fit.fidelity import POSE_SHARE, SHAPE_SHARE, choose_controls, choose_sites


@pytest.mark.parametrize("tolerance", [5.0, 1.0, 0.2, 0.02])
@pytest.mark.parametrize("space", ["vertex", "gradient"])
def test_the_tolerance_is_met_by_the_literal_representation(tolerance: float, space: str) -> None:
    report = SignalModel(space, tolerance=tolerance).fit(swinging()).report_
    assert report["paper"]["rms_percent"] <= tolerance * (1 if space == "vertex" else 1.05)
    assert report["errors"]["rms_percent"] <= tolerance
    if space == "vertex":
        assert report["budget"]["h"] <= SHAPE_SHARE * tolerance
        assert np.hypot(report["budget"]["h"], report["budget"]["g"]) <= POSE_SHARE * tolerance


@pytest.mark.parametrize("space", ["patch", "edge-dihedral", "rotation-invariant"])
def test_so_it_is_in_the_other_spaces(space: str) -> None:
    report = SignalModel(space, tolerance=1.0).fit(swinging(16)).report_
    assert 0.2 < report["paper"]["rms_percent"] <= 1.05
    assert report["errors"]["rms_percent"] <= 1.0


@pytest.mark.parametrize("tolerance", [3.0, 0.5])
def test_one_mode_or_site_less_would_not_do(tolerance: float) -> None:
    clip = swinging()
    report = SignalModel(tolerance=tolerance, layout="mds").fit(clip).report_
    m, l = report["m"], report["l"]
    fewer = SignalModel(k=42, l=40, m=m - 1, layout="mds").fit(clip).report_
    assert fewer["budget"]["h"] > SHAPE_SHARE * tolerance
    if l > 3:
        fewer = SignalModel(k=42, l=l - 1, m=m, layout="mds").fit(clip).report_
        assert np.hypot(fewer["budget"]["h"], fewer["budget"]["g"]) > POSE_SHARE * tolerance


def test_numbers_given_stay_and_the_others_follow_the_tolerance() -> None:
    report = SignalModel(m=6, tolerance=1.0).fit(swinging()).report_
    assert report["m"] == 6 and report["paper"]["rms_percent"] <= 1.0


def test_the_scale_of_the_clip_does_not_matter() -> None:
    small, large = wandering(size=0.3), wandering(size=0.3)
    a = SignalModel(tolerance=2.0).fit(small).report_
    b = SignalModel(tolerance=2.0).fit(large).report_
    assert [a[n] for n in "klm"] == [b[n] for n in "klm"]


def test_without_a_tolerance_a_slight_motion_is_not_frozen() -> None:
    clip = wandering(size=1e-4)
    report = SignalModel().fit(clip).report_
    spread = np.linalg.norm(clip.vertices - clip.vertices.mean(axis=0)) / np.sqrt(48) / clip.mesh.diagonal
    assert 100 * spread < 0.5
    assert report["paper"]["rms_percent"] <= 0.05 * 100 * spread * (1 + 1e-6)


def test_a_tolerance_above_the_motion_gives_one_pose_and_says_so() -> None:
    report = SignalModel(tolerance=1e3).fit(wandering()).report_
    assert report["m"] == 0 and "one pose stands for all frames" in report["warnings"][0]


def test_sites_are_the_fewest_that_meet_the_limit() -> None:
    errors = np.array([99.0, 98, 97, 9, 4, 4, 1, 0])
    assert choose_sites(errors, 1.0, 5.0) == 4
    assert choose_sites(errors, 0.0, 1e9) == 3
    assert choose_sites(errors, 2.0, 1.0) == 7  # out of reach: the best there is


def test_controls_are_the_fewest_from_which_on_every_number_meets_the_limit() -> None:
    errors = {4: 9.0, 5: 1.0, 6: 3.0, 7: 1.5, 8: 1.0, 9: 0.5, 10: 0.0}
    tried: list[int] = []

    def error(k: int) -> float:
        tried.append(k)
        return errors[k]

    assert choose_controls(error, 8, 2.0) == (7, True)
    assert 5 not in tried and 4 not in tried
    assert choose_controls(lambda k: 0.0, 8, 2.0) == (4, True)
    assert choose_controls(lambda k: 5.0, 8, 2.0) == (10, False)
