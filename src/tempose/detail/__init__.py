"""Learned detail: the cloth and flesh that a skeleton alone does not carry."""

from tempose.detail.inputs import motion_inputs
from tempose.detail.learners import LEARNERS
from tempose.detail.model import DetailModel
from tempose.detail.regions import region_grams, region_shares
from tempose.detail.residuals import residuals, vertex_bases
from tempose.detail.training import Inputs, Learner, Mixture, Predictor, Training

__all__ = [
    "LEARNERS",
    "DetailModel",
    "Inputs",
    "Learner",
    "Mixture",
    "Predictor",
    "Training",
    "motion_inputs",
    "region_grams",
    "region_shares",
    "residuals",
    "vertex_bases",
]
