"""The pose signal is the thin-plate spline of the paper, and its derivatives are its derivatives."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.signals.pose import PoseSignal, fit_pose_signal, gaussian_curvature


def literal(g, p):
    """Section 2.2 of the paper, one place and one site after another, in units of the plane."""
    q, s = (p - g.centre) / g.radius, (g.sites - g.centre) / g.radius
    value = g.affine[0] + q @ g.affine[1:]
    for site, weight in zip(s, g.weights):
        r = np.linalg.norm(q - site)
        value = value + (r**2 * np.log(r) if r > 0 else 0.0) * weight
    return value


@pytest.fixture
def g(rng):
    P = rng.normal(size=(20, 2)) * 5.0 + 3.0
    return fit_pose_signal(P, rng.normal(size=(20, 4)), P)


@pytest.fixture
def free(rng):
    """A spline without side conditions: sums over its sites do not cancel."""
    arrays = (rng.normal(size=(20, 2)) * 5.0, rng.normal(size=(20, 4)), rng.normal(size=(3, 4)))
    return PoseSignal(*arrays, np.array([1.0, 2.0]), 5.0)


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2), (0,)])
def test_values_are_those_of_the_formula_for_any_batch(g, rng, shape):
    p = rng.normal(size=(*shape, 2)) * 5.0
    assert g(p).shape == (*shape, 4)
    for index in np.ndindex(shape):
        assert_allclose(g(p)[index], literal(g, p[index]), atol=1e-12)


def test_value_at_a_site_is_that_of_the_formula(g):
    assert_allclose(g(g.sites[3]), literal(g, g.sites[3]), atol=1e-12)


def test_a_place_has_the_same_bits_alone_and_among_others(g, rng):
    p = rng.normal(size=(50, 2))
    assert_array_equal(g(p)[17], g(p[17]))
    assert_array_equal(g(p)[10:30], g(p[10:30]))


def test_side_conditions_hold(g):
    assert_allclose(g.weights.sum(axis=0), 0.0, atol=1e-10)
    assert_allclose(g.sites.T @ g.weights, 0.0, atol=1e-9)


def test_function_does_not_depend_on_the_scale_it_is_written_in(rng):
    P, X, p = rng.normal(size=(15, 2)), rng.normal(size=(15, 3)), rng.normal(size=(7, 2))
    values = [fit_pose_signal(u * P + 2 * u, X, u * P + 2 * u)(u * p + 2 * u) for u in (1e-3, 1.0, 1e3)]
    assert_allclose(values[0], values[1], atol=1e-8)
    assert_allclose(values[2], values[1], atol=1e-8)


@pytest.mark.parametrize("shape", [(), (5,), (2, 3)])
def test_jacobian_is_the_central_difference(free, rng, shape):
    g = free
    p, h = rng.normal(size=(*shape, 2)) * 5.0, 1e-5
    J = g.jacobian(p)
    assert J.shape == (*shape, 4, 2)
    for c in range(2):
        step = h * np.eye(2)[c]
        assert_allclose(J[..., c], (g(p + step) - g(p - step)) / (2 * h), atol=1e-8)


def test_second_derivatives_are_central_differences_of_the_jacobian(free, rng):
    g = free
    p, h = rng.normal(size=(6, 2)) * 5.0, 1e-5
    H = g.second_derivatives(p)
    assert_allclose(H, np.swapaxes(H, -1, -2))
    for c in range(2):
        step = h * np.eye(2)[c]
        assert_allclose(H[..., c], (g.jacobian(p + step) - g.jacobian(p - step)) / (2 * h), atol=1e-6)


def test_derivatives_are_finite_at_sites(g):
    h = 1e-6 * np.eye(2)
    slope = [(g(g.sites + step) - g(g.sites - step)) / 2e-6 for step in h]
    assert_allclose(g.jacobian(g.sites), np.stack(slope, axis=-1), atol=1e-4)
    assert np.isfinite(g.second_derivatives(g.sites)).all()


def test_curvature_is_that_of_the_classic_formula(rng):
    P = rng.normal(size=(12, 2))
    g, p = fit_pose_signal(P, rng.normal(size=(12, 3)), P), rng.normal(size=(6, 2))
    for q, K in zip(p, gaussian_curvature(g, p)):
        (xu, xv), H = g.jacobian(q).T, g.second_derivatives(q)
        n = np.cross(xu, xv) / np.linalg.norm(np.cross(xu, xv))
        L, M, N = n @ H[:, 0, 0], n @ H[:, 0, 1], n @ H[:, 1, 1]
        E, F, G = xu @ xu, xu @ xv, xv @ xv
        assert_allclose(K, (L * N - M * M) / (E * G - F * F), rtol=1e-8)


def test_flat_and_degenerate_surfaces_have_no_curvature(rng):
    P = rng.normal(size=(12, 2))
    flat = fit_pose_signal(P, P @ rng.normal(size=(2, 5)), P)
    line = fit_pose_signal(P, P @ np.outer([1.0, 2.0], rng.normal(size=5)), P)
    for g in (flat, line):
        assert_allclose(gaussian_curvature(g, rng.normal(size=(4, 2))), 0.0, atol=1e-10)


def test_places_that_are_none_are_refused(g):
    with pytest.raises(ValueError, match=r"shape \(..., 2\)"):
        g(np.zeros((4, 3)))
    with pytest.raises(ValueError, match=r"shape \(..., 2\)"):
        g(np.float64(1.0))


def test_a_radius_that_is_none_is_refused(g):
    with pytest.raises(ValueError, match="radius"):
        PoseSignal(g.sites, g.weights, g.affine, g.centre, 0.0)
