"""Sites are chosen as the paper chooses them, and every number of them fits as well as a fit of its own."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.distance import pdist, squareform

import tempose
from tempose.signals.pose import PoseLayout, fit_pose_signal, order_sites


def refit(P, X, sites, weights=None):
    """Least squares under the paper's side conditions: the null space of one QR, then an n x l system."""
    c, r = P.mean(axis=0), np.sqrt(np.square(P - P.mean(axis=0)).sum(axis=1).mean())
    Q, S = (P - c) / r, (sites - c) / r
    root = np.ones((len(P), 1)) if weights is None else np.sqrt(weights)[:, None]
    r2 = np.square(Q[:, None] - S[None]).sum(axis=2)
    phi = 0.5 * r2 * np.log(np.where(r2 > 0, r2, 1.0))
    null = np.linalg.qr(np.column_stack([np.ones(len(S)), S]), mode="complete")[0][:, 3:]
    columns = np.column_stack([phi @ null, np.ones(len(Q)), Q])
    fitted = columns @ np.linalg.lstsq(root * columns, root * X, rcond=1e-14)[0]
    return fitted, float(np.square(root * (fitted - X)).sum())


def literal_order(P, X):
    """The algorithm of section 3.2.2 with a fit of its own for every l."""
    Y = X - X.mean(axis=0)
    plane = np.linalg.svd(Y, full_matrices=False)[2][:2]
    order = list(np.argsort(-np.linalg.norm(Y - Y @ plane.T @ plane, axis=1))[:4])
    while len(order) < len(P):
        off = np.linalg.norm(refit(P, X, P[order])[0] - X, axis=1)
        off[order] = -1.0
        order.append(int(off.argmax()))
    return order


@pytest.fixture
def clip(rng):
    X = np.cumsum(rng.normal(size=(30, 6)) * [3, 2, 1, 1, 0.5, 0.5], axis=0)
    return PoseLayout(squareform(pdist(X))).solve().positions, X


def test_order_and_errors_are_those_of_a_fit_for_every_number_of_sites(clip):
    P, X = clip
    found = order_sites(P, X)
    order = literal_order(P, X)
    assert set(found.order[:4]) == set(order[:4])
    assert_array_equal(found.order[4:], order[4:])
    scale = np.square(X).sum()
    for l in range(4, 31):
        fitted, error = refit(P, X, P[found.order[:l]])
        assert_allclose(found.errors[l], error, atol=1e-10 * scale)
        assert_allclose(found.signal(l)(P), fitted, atol=1e-10 * np.abs(X).max())


def test_errors_never_rise_and_are_those_of_the_signals(clip):
    P, X = clip
    found = order_sites(P, X)
    assert found.errors.shape == (31,)
    assert (np.diff(found.errors) <= 0).all()
    for l in range(3, 31):
        assert_allclose(np.square(found.signal(l)(P) - X).sum(), found.errors[l], atol=1e-9)
    assert_allclose(found.errors[0], np.square(X).sum())
    assert_allclose(found.errors[[1, 2]], np.square(X - X.mean(axis=0)).sum())


def test_fewer_sites_are_the_first_of_more(clip):
    P, X = clip
    found, short = order_sites(P, X), order_sites(P, X, most=12)
    assert_array_equal(short.order, found.order[:12])
    assert_allclose(short.errors[:13], found.errors[:13], rtol=1e-12)
    for l in (3, 7, 20):
        assert_allclose(found.signal(l).sites, P[found.order[:l]], atol=1e-12)


def test_as_many_sites_as_frames_give_every_frame_back(clip):
    P, X = clip
    assert_allclose(order_sites(P, X).signal(30)(P), X, atol=1e-11)
    assert_allclose(fit_pose_signal(P, X, P)(P), X, atol=1e-11)


def test_fit_on_the_chosen_sites_is_the_signal(clip, rng):
    P, X = clip
    found, p = order_sites(P, X), rng.normal(size=(9, 2)) * 5
    assert_allclose(fit_pose_signal(P, X, P[found.order[:11]])(p), found.signal(11)(p), atol=1e-9)


def test_three_sites_fit_an_affine_map_exactly(rng):
    P = rng.normal(size=(10, 2))
    X = P @ rng.normal(size=(2, 4)) + 1.0
    found = order_sites(P, X)
    assert found.errors[3] < 1e-24
    p = rng.normal(size=(5, 2)) * 100
    assert_allclose(found.signal(3)(p), fit_pose_signal(P, X, P)(p), rtol=1e-9)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_order_does_not_depend_on_units_or_turns(clip, rng, unit):
    P, X = clip
    turn = np.linalg.qr(rng.normal(size=(2, 2)))[0]
    basis = np.linalg.qr(rng.normal(size=(6, 6)))[0]
    one, other = order_sites(P, X), order_sites(unit * P @ turn + 3 * unit, unit * X @ basis)
    assert_array_equal(other.order, one.order)
    assert_allclose(other.errors, unit**2 * one.errors, rtol=1e-6, atol=1e-12 * other.errors[0])


def test_weights_count_as_repetition(clip):
    P, X = clip
    w = np.where(np.arange(30) % 3 == 0, 4.0, 1.0)
    found = order_sites(P, X, w)
    fitted, error = refit(P, X, P[found.order[:9]], w)
    assert_allclose(found.errors[9], error, rtol=1e-9)
    assert_allclose(found.signal(9)(P), fitted, atol=1e-9)
    again = fit_pose_signal(P, X, P[found.order[:9]], w)
    assert_allclose(again(P), fitted, atol=1e-9)


def test_next_site_is_where_the_error_is_greatest_whatever_its_weight(clip):
    P, X = clip
    w = np.where(np.arange(30) % 3 == 0, 50.0, 1.0)
    found = order_sites(P, X, w)
    for l in range(4, 29):
        off = np.linalg.norm(refit(P, X, P[found.order[:l]], w)[0] - X, axis=1)
        off[found.order[:l]] = -1.0
        assert off.argmax() == found.order[l]


def test_frames_at_one_place_are_averaged_by_their_weights(clip):
    P, X = clip
    P, X = np.concatenate([P, P[[4]]]), np.concatenate([X, X[[4]] + 0.5])
    w = np.ones(31)
    w[30] = 3.0
    assert_allclose(order_sites(P, X, w).signal()(P[4]), 0.25 * X[4] + 0.75 * X[30], atol=1e-9)


def test_columns_are_orthogonal_however_close_the_sites(rng):
    P = np.concatenate([rng.normal(size=(20, 2)), 1e-2 * rng.normal(size=(20, 2))])
    Q = order_sites(P, rng.normal(size=(40, 3))).factors[0]
    assert_allclose(Q @ Q.T, np.eye(len(Q)), atol=1e-14 * 40)


def test_frames_at_one_place_are_one_site_and_leave_half_their_difference(clip):
    P, X = clip
    P, X = np.concatenate([P, P[[4]]]), np.concatenate([X, X[[4]] + 0.5])
    found = order_sites(P, X)
    assert found.most == 30 and len(found.errors) == 32
    floor = 0.5 * np.square(X[4] - X[30]).sum()
    assert_allclose([found.floor, found.errors[30], found.errors[31]], floor, rtol=1e-9)
    assert_allclose(found.signal()(P[4]), 0.5 * (X[4] + X[30]), atol=1e-9)


def test_clip_that_repeats_itself_has_half_as_many_sites(clip):
    P, X = clip
    found = order_sites(np.concatenate([P, P]), np.concatenate([X, X]))
    assert found.most == 30 and found.floor == 0.0
    assert_allclose(found.signal()(P), X, atol=1e-10)


@pytest.mark.parametrize("n", [2, 3, 9])
def test_places_on_a_line_need_two_sites_and_are_fitted(rng, n):
    P = np.outer(np.cumsum(rng.uniform(1, 2, size=n)), [1.0, 2.0])
    X = rng.normal(size=(n, 3))
    found = order_sites(P, X)
    assert found.least == 2 and found.most == n
    assert_allclose(found.signal()(P), X, atol=1e-10)
    assert_allclose(fit_pose_signal(P, X, P)(P), X, atol=1e-10)


def test_one_place_has_one_pose(rng):
    X = rng.normal(size=(5, 3))
    found = order_sites(np.ones((5, 2)), X)
    assert found.least == found.most == 1
    assert_allclose(found.signal()(rng.normal(size=(4, 2))), np.tile(X.mean(axis=0), (4, 1)))
    assert_allclose(found.errors[1:], np.square(X - X.mean(axis=0)).sum())


def test_first_four_on_a_line_of_the_plane_still_give_a_surface(rng):
    P = rng.normal(size=(12, 2))
    P[:5] = np.outer(np.arange(5.0), [1.0, 0.5])
    X = np.column_stack([P * 10, rng.normal(size=12) * 0.01])
    X[:5, 2] = [3.0, -3.0, 3.5, -2.5, 2.8]
    found = order_sites(P, X)
    assert found.least == 3 and found.most == 12
    assert_allclose(found.signal()(P), X, atol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        ((np.zeros((3, 2)), np.zeros((4, 1))), "X must have shape"),
        ((np.full((3, 2), np.nan), np.zeros((3, 1))), "P must be finite"),
        ((np.zeros((0, 2)), np.zeros((0, 1))), "at least one frame"),
        ((np.zeros((3, 2)), np.zeros((3, 1)), np.array([1.0, 0.0, 1.0])), "positive"),
    ],
)
def test_frames_that_cannot_be_ordered_are_refused(arguments, why):
    with pytest.raises(ValueError, match=why):
        order_sites(*arguments)


def test_too_few_sites_are_refused(clip):
    with pytest.raises(ValueError, match="l must be 3 to 30, got 2"):
        order_sites(*clip).signal(2)


@pytest.mark.parametrize("count", [0, 31])
def test_sites_beyond_the_frames_are_refused(clip, count):
    with pytest.raises(ValueError, match="sites must number 1 to 30"):
        fit_pose_signal(*clip, np.zeros((count, 2)))


@pytest.mark.real
@pytest.mark.parametrize(("name", "frames"), [("horse-gallop", 24), ("vlasic-crane", None)])
def test_real_clips_are_given_back_to_a_billionth_of_the_diagonal(data_folder, name, frames):
    clip = tempose.load(data_folder(name))
    V = np.asarray(clip.vertices[:frames], dtype=np.float64)
    Y = (V - V.mean(axis=0)).reshape(len(V), -1)
    values, vectors = np.linalg.eigh(Y @ Y.T)
    X = (vectors * np.sqrt(np.maximum(values, 0.0)))[:, ::-1][:, : len(V) - 1]
    P = PoseLayout(squareform(pdist(X))).solve().positions
    D = np.linalg.norm(np.ptp(clip.rest, axis=0))
    # X are coordinates in an orthonormal basis: no vertex can be off by more than they are
    assert np.linalg.norm(order_sites(P, X).signal()(P) - X, axis=1).max() < 1e-9 * D
