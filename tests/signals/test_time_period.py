"""Periods of closed forms are found, also fractions of a frame; what does not repeat has none."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline

from tempose.signals.time._period_scan import natural_weights, phase_errors
from tempose.signals.time.path import time_path
from tempose.signals.time.period import find_period


def cyclic(t: np.ndarray, period: float) -> np.ndarray:
    w = 2 * np.pi * np.asarray(t)[..., None] / period
    return np.sin(w * [1, 1, 2, 3] + [0.0, 1.5, 1.0, 2.0]) * [1.0, 0.7, 0.4, 0.2]


@pytest.mark.parametrize(
    ("n", "period"), [(10, 4.8), (16, 8.0), (24, 3.7), (30, 7.3), (48, 24.0), (60, 12.4), (90, 40.2)]
)
@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_periods_of_sines_are_found(n, period, unit):
    found = find_period(unit * cyclic(np.arange(n), period))
    assert found is not None
    assert_allclose(found.ticks, period, atol=0.5 * period / n**1.5)
    assert found.error < 0.5 * found.cubic


def test_whole_periods_are_whole_and_no_fraction_of_them():
    stride = np.random.default_rng(0).normal(size=(24, 6))
    found = find_period(np.concatenate([stride, stride]))
    assert found is not None and found.ticks == 24.0


def test_no_period_where_nothing_repeats():
    rng = np.random.default_rng(1)
    for n in (5, 8, 13, 34):
        walk = np.cumsum(rng.normal(size=(n, 5)), axis=0)
        for X in (rng.normal(size=(n, 5)), walk, np.cumsum(walk, axis=0)):
            assert find_period(X) is None
    t = np.arange(80.0)
    assert find_period(np.stack([t, t**2 / 80], axis=1)) is None
    assert find_period(cyclic(t**1.3, 20.0)) is None
    assert find_period(np.zeros((30, 3))) is None


def test_a_period_does_not_depend_on_the_axes():
    X = cyclic(np.arange(30), 7.3)
    Q = np.linalg.qr(np.random.default_rng(0).normal(size=(40, 4)))[0]
    plain, turned = find_period(X), find_period(X @ Q.T + 3.0)
    assert plain is not None and turned is not None
    assert_allclose(turned.ticks, plain.ticks, rtol=1e-6)


def test_a_period_that_is_found_never_makes_the_path_worse():
    rng = np.random.default_rng(4)
    for trial in range(0, 12, 2):
        n, period = int(rng.integers(8, 40)), float(rng.uniform(3.2, 9.0))
        warp = 0.02 * trial * rng.normal(size=(1, 4))  # cycles that drift apart
        true = lambda t: cyclic(t, period) + np.asarray(t)[..., None] / n * warp  # noqa: E731, B023
        X = true(np.arange(n))
        found = find_period(X)
        between = np.arange(n - 1) + 0.5
        errors = [
            np.linalg.norm(time_path(X, p)(between) - true(between))
            for p in (None, found.ticks if found is not None and found.interleaves else None)
        ]
        assert errors[1] <= errors[0] * (1 + 1e-9)


def test_weights_of_the_natural_spline_agree_with_scipy():
    t = np.cumsum(np.random.default_rng(0).random(9) + 0.1)
    for x in np.linspace(t[0], t[-1], 30):
        expected = CubicSpline(t, np.eye(9), bc_type="natural")(x)
        assert_allclose(natural_weights(t, x), expected, atol=1e-13)


def test_errors_by_phase_agree_with_the_plain_way():
    X = np.ascontiguousarray(cyclic(np.arange(14), 4.3))
    X = X + 0.1 * np.random.default_rng(0).normal(size=X.shape)
    period, n = 4.37, len(X)
    phases = np.arange(n) % period
    total = 0.0
    for i in range(n):
        others = np.flatnonzero(np.arange(n) != i)
        at = (phases[others, None] + period * np.arange(-2, 3)).ravel()
        values = np.repeat(X[others], 5, axis=0)
        order = np.argsort(at)
        at, values = at[order], values[order]
        left = np.searchsorted(at, phases[i])
        near = slice(left - 5, left + 5)
        total += np.square(CubicSpline(at[near], values[near], bc_type="natural")(phases[i]) - X[i]).sum()
    assert_allclose(phase_errors(X, np.array([period]), 0.0, False), np.sqrt(total / n), rtol=1e-10)
