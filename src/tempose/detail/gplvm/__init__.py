"""The shared Gaussian process latent variable model with dynamics: pose and detail from one path.

One latent point a frame explains both the pose of the skeleton and the detail of the surface, and the points
follow one another smoothly. Nothing here knows vertices: residuals enter by their T x T inner products.
"""

from tempose.detail.gplvm.back_map import BackMap, fit_back_map
from tempose.detail.gplvm.calibration import Widening, widen_variances
from tempose.detail.gplvm.grams import centred_gram, gram_factor, unit_gram
from tempose.detail.gplvm.objective import SharedObjective
from tempose.detail.gplvm.plane import LatentPlane, latent_plane
from tempose.detail.gplvm.prediction import LatentProcess
from tempose.detail.gplvm.training import LatentFit, latent_start, train_latent

__all__ = [
    "BackMap",
    "LatentFit",
    "LatentPlane",
    "LatentProcess",
    "SharedObjective",
    "Widening",
    "centred_gram",
    "fit_back_map",
    "gram_factor",
    "latent_plane",
    "latent_start",
    "train_latent",
    "unit_gram",
    "widen_variances",
]
