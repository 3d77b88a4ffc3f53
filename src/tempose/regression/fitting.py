"""The kernel under which observations are most likely, from several starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from tempose.regression.group_distances import GroupDistances
from tempose.regression.kernel import Kernel
from tempose.regression.likelihood import GramLikelihood
from tempose.regression.threads import one_blas_thread
from tempose.typing import FloatArray, IntArray

NOISE_FLOOR = 1e-3
"""Smallest noise, as part of the variance of the outputs: below it a process passes through its observations
and believes too much in between."""


@dataclass(frozen=True, eq=False)
class KernelFit:
    """The most likely kernel found."""

    kernel: Kernel
    """That kernel."""
    value: float
    """Minus the log likelihood of one output, with the prior, without its constant."""
    iterations: int
    """Steps from the best start."""
    converged: bool
    """Whether they ended by themselves."""


def fit_kernel(
    X: FloatArray | GroupDistances,
    groups: IntArray,
    S: FloatArray,
    *,
    starts: Sequence[Kernel] | None = None,
    prior: float = 0.0,
    iterations: int = 60,
    noise_floor: float = NOISE_FLOOR,
) -> KernelFit:
    """Find the kernel under which observations are most likely.

    Parameters
    ----------
    X : (T, P) float, or GroupDistances
        Inputs; their distances where many kernels are fitted to the same inputs.
    groups : (P,) int
        Group of every column; the columns of a group share a length scale.
    S : (T, T) float
        Mean over the outputs of their outer products ``Y Y^T``, the outputs centred and scaled so that
        ``trace(S) = T``.
    starts : sequence of Kernel, optional
        Where to begin; by default those of `default_starts`.
    prior : float, default 0.0
        Weight of the squared distance of each logarithm of a precision from that of the start.
    iterations : int, default 60
        Largest number of L-BFGS steps from each start.
    noise_floor : float, default 1e-3
        Least noise.

    Returns
    -------
    KernelFit
        The most likely of the kernels found.
    """
    inputs = X if isinstance(X, GroupDistances) else GroupDistances(X, groups)
    likelihood = GramLikelihood(inputs, S)
    chosen = default_starts(inputs.X, groups) if starts is None else list(starts)
    with one_blas_thread():
        fits = [_descend(likelihood, start, prior, iterations, noise_floor) for start in chosen]
    return min(fits, key=lambda fit: fit.value)


def default_starts(X: FloatArray, groups: IntArray) -> list[Kernel]:
    """Return kernels to begin with: long and short scales, the same in every group or by its spread.

    Parameters
    ----------
    X : (T, P) float
        Inputs.
    groups : (P,) int
        Group of every column.

    Returns
    -------
    list of Kernel
        For outputs of variance 1.
    """
    G = int(np.max(groups, initial=-1)) + 1
    spread = np.bincount(groups, np.var(X, axis=0), minlength=G)
    total = max(float(spread.sum()), 1e-12)
    alike = np.full(G, 1.0 / total)
    each = 1.0 / (G * np.maximum(spread, 1e-4 * total))
    return [
        Kernel(0.7, 0.3, 0.03, factor * precision, np.asarray(groups))
        for precision in ([alike] if G == 1 else [alike, each])
        for factor in (0.25, 2.0)
    ]


def _descend(
    likelihood: GramLikelihood, start: Kernel, prior: float, iterations: int, noise_floor: float
) -> KernelFit:
    first = start.logarithms

    def objective(logarithms: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = likelihood(logarithms)
        away = logarithms[3:] - first[3:]
        gradient[3:] += 2 * prior * away
        return value + prior * float(away @ away), gradient

    bounds = [(-9.0, 6.0), (-14.0, 6.0), (np.log(noise_floor), 1.0)]
    bounds += [(low - 12.0, low + 8.0) for low in first[3:]]
    first[2] = max(first[2], bounds[2][0])
    found = minimize(
        objective, first, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": iterations}
    )
    kernel = Kernel.from_logarithms(found.x, likelihood.inputs.groups)
    return KernelFit(kernel, float(found.fun), int(found.nit), bool(found.success))
