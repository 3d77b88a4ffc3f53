"""What must hold on a real capture, as ratios in one run."""

from __future__ import annotations

import numpy as np
import pytest

from tempose.detail.evaluation import evaluate
from tempose.detail.inputs import motion_inputs
from tempose.detail.learners import PlainGaussianProcess, RegionalGaussianProcess
from tempose.detail.regions import region_grams, region_shares
from tempose.detail.residuals import residuals
from tempose.detail.training import Training
from tempose.formats import load
from tempose.rigging import fit_rig


@pytest.mark.real
@pytest.mark.slow
def test_default_halves_what_the_skin_leaves_and_knows_where_it_is_wrong(data_folder):
    clip = load(data_folder("vlasic-crane"))
    rig = fit_rig(clip, frame=10)
    shares = region_shares(rig.skin.weights)
    train, test = np.arange(122), np.arange(122, 175)
    found = {}
    for basis in ("blended", "world"):
        D = np.asarray(residuals(rig, rig.motion, clip.vertices, basis))
        training = Training(motion_inputs(rig.motion), *region_grams(D, shares))
        for learner in (RegionalGaussianProcess(), PlainGaussianProcess()):
            found[basis, learner.name] = evaluate(learner, training, train, test, D=D, shares=shares)
        alone = np.sqrt(np.square(D[test]).sum(axis=2).mean())
    default, plain = found["blended", "regional-gp"], found["blended", "gp"]
    assert default.rms <= 0.56 * alone
    assert default.rms <= 1.00 * plain.rms
    assert default.rms <= 0.60 * found["world", "regional-gp"].rms
    assert default.spearman >= 0.4 and default.regional_spearman >= 0.4
    assert 0.6 <= default.calibration <= 1.4
