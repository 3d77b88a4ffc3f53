"""Learning from few frames: folds of a clip, ridge regression, Gaussian processes."""

from tempose.regression.fitting import KernelFit, default_starts, fit_kernel
from tempose.regression.folds import blocked_folds
from tempose.regression.gaussian_process import GaussianProcess
from tempose.regression.group_distances import GroupDistances
from tempose.regression.inducing import InducingProcess, choose_inducing
from tempose.regression.kernel import Kernel
from tempose.regression.likelihood import GramLikelihood
from tempose.regression.process_bank import ProcessBank
from tempose.regression.ridge import RidgeRegression
from tempose.regression.threads import one_blas_thread

__all__ = [
    "GaussianProcess",
    "GramLikelihood",
    "GroupDistances",
    "InducingProcess",
    "Kernel",
    "KernelFit",
    "ProcessBank",
    "RidgeRegression",
    "blocked_folds",
    "choose_inducing",
    "default_starts",
    "fit_kernel",
    "one_blas_thread",
]
