"""Ridge regression by its normal equations; folds that leave out whole blocks and what touches them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.regression import RidgeRegression, blocked_folds, one_blas_thread


def test_ridge_solves_its_normal_equations(rng):
    X, Y, queries = rng.standard_normal((20, 4)), rng.standard_normal((20, 3)), rng.standard_normal((6, 4))
    Z, centred = X - X.mean(axis=0), Y - Y.mean(axis=0)
    slopes = np.linalg.solve(Z.T @ Z + 0.7 * np.eye(4), Z.T @ centred)
    expected = (queries - X.mean(axis=0)) @ slopes
    assert_allclose(RidgeRegression(X).weights(queries, 0.7) @ centred, expected, atol=1e-12)


def test_ridge_without_spread_predicts_the_mean():
    regression = RidgeRegression(np.ones((5, 3)))
    assert_allclose(regression.weights(np.full((2, 3), 9.0), 1.0), 0, atol=1e-12)
    assert regression.spread == 0


@pytest.mark.parametrize("gap", [0, 1, 3])
def test_folds_test_every_frame_once_and_keep_their_distance(gap):
    chains = np.repeat([0, 1], [17, 9])
    folds = blocked_folds(chains, 4, gap)
    assert_allclose(np.sort(np.concatenate([test for _, test in folds])), np.arange(26))
    for train, test in folds:
        assert (np.diff(test) == 1).all()
        for t in train:
            own = test[chains[test] == chains[t]]
            assert len(own) == 0 or np.abs(own - t).min() > gap


def test_other_clips_next_to_a_block_stay_in_the_training():
    folds = blocked_folds(np.repeat([0, 1], 5), 2, 1)
    assert_allclose(folds[0][0], [5, 6, 7, 8, 9])


def test_number_of_threads_is_restored():
    from threadpoolctl import threadpool_info

    def threads():
        return [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]

    before = threads()
    with one_blas_thread():
        assert set(threads()) == {1}
    assert threads() == before
