"""A long clip is laid out as scaling of all its frames would, and poses that come back find their places."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import minimize
from scipy.spatial.distance import cdist

from tempose.signals.pose.layout import PoseLayout
from tempose.signals.windows import long_layout, place_frames
from tempose.signals.windows.key_frames import farthest_frames, key_frames
from tempose.typing import FloatArray


def pacing(T: int, unit: float = 1.0) -> FloatArray:
    """Shape coordinates of a gait whose stride changes slowly."""
    t = np.arange(T)
    stride, slow = 2 * np.pi * t / 23.7, np.sin(2 * np.pi * t / 400)
    columns = [(1 + 0.3 * slow) * np.sin(stride), np.cos(stride), 0.4 * np.sin(2 * stride + slow), 0.6 * slow]
    columns += [0.1 * np.sin(3 * stride + k * slow) for k in range(3)]
    return unit * np.stack(columns, axis=1)


def stress(X: FloatArray, P: FloatArray) -> float:
    D = cdist(X, X)
    return float(np.sqrt(np.square(D - cdist(P, P)).sum() / np.square(D).sum()))


@pytest.mark.parametrize("keys", [60, 150])
def test_stress_is_that_of_scaling_all_frames(keys: int) -> None:
    X = pacing(500)
    plain, found = PoseLayout(cdist(X, X)).solve(), long_layout(X, keys)
    assert plain.stress <= stress(X, found.positions) * 1.001
    assert stress(X, found.positions) < plain.stress + 0.005
    assert_allclose(found.stress, stress(X, found.positions), atol=0.01)
    assert len(found.keys) == keys


def test_as_many_keys_as_frames_is_plain_scaling() -> None:
    X, pins = pacing(60), {3: (0.5, 0.2), 41: (-1.0, 0.0)}
    for keys in (60, 1000):
        assert_array_equal(
            long_layout(X, keys, pins).positions, PoseLayout(cdist(X, X)).solve(pins).positions
        )


def test_a_flat_clip_is_laid_out_exactly() -> None:
    t = np.arange(300) / 40
    X = np.stack([np.sin(t) + 0.2 * t, np.cos(1.7 * t)], axis=1)
    found = long_layout(X, 40)
    assert found.stress < 1e-4
    assert_allclose(cdist(found.positions, found.positions), cdist(X, X), atol=1e-3)


def test_poses_that_come_back_find_the_same_places() -> None:
    X = np.concatenate([pacing(100), pacing(300)[:, [2, 3, 0, 1, 6, 5, 4]] + 0.5, pacing(100)])
    P = long_layout(X, 80).positions
    extent = np.linalg.norm(P - P.mean(axis=0), axis=1).mean()
    twice = np.linalg.norm(P[:100] - P[400:], axis=1)
    assert twice.max() < 0.15 * extent and np.median(twice) < 1e-4 * extent


def test_each_place_is_where_its_own_stress_is_least() -> None:
    X = pacing(200)
    keys = key_frames(X, 30)
    P_keys = PoseLayout(cdist(X[keys], X[keys])).solve().positions
    P, _ = place_frames(X, X[keys], P_keys)
    D = cdist(X, X[keys])

    def own(p: FloatArray, d: FloatArray) -> float:
        return float(np.square(d - np.linalg.norm(p - P_keys, axis=1)).sum())

    for i in range(0, 200, 17):
        best = minimize(
            own, P[i], args=(D[i],), method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-12}
        )
        assert np.linalg.norm(best.x - P[i]) < 1e-4


def test_place_depends_on_the_pose_alone() -> None:
    X, order = pacing(120), np.random.default_rng(0).permutation(120)
    keys = key_frames(X, 25)
    P_keys = PoseLayout(cdist(X[keys], X[keys])).solve().positions
    P, share = place_frames(X, X[keys], P_keys)
    Q, again = place_frames(X[order], X[keys], P_keys)
    assert_allclose(Q, P[order], atol=1e-6)
    assert_allclose(share, again, rtol=1e-6)
    alone, _ = place_frames(X[40:41], X[keys], P_keys)
    assert_allclose(alone[0], P[40], atol=1e-6)


def test_pinned_frames_stay_where_they_are_pinned() -> None:
    X, pins = pacing(300), {5: (1.0, 0.3), 150: (-0.8, 0.1), 299: (0.0, -1.0)}
    found = long_layout(X, 50, pins)
    for frame, place in pins.items():
        assert_array_equal(found.positions[frame], place)
        assert frame in found.keys


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_unit_does_not_matter(unit: float) -> None:
    one, other = (long_layout(pacing(200, u), 60) for u in (1.0, unit))
    assert_array_equal(one.keys, other.keys)
    assert_allclose(other.positions, unit * one.positions, atol=1e-4 * unit)


def test_keys_are_those_of_the_slow_farthest_point_search() -> None:
    X = pacing(120)
    chosen = [3, 77]
    while len(chosen) < 15:
        chosen.append(int(cdist(X, X[chosen]).min(axis=1).argmax()))
    assert_array_equal(farthest_frames(X, 15, np.array([3, 77])), np.sort(chosen))


def test_keys_are_spread_over_time_and_hold_what_must_be_held() -> None:
    X = pacing(500)
    keys = key_frames(X, 50, np.array([7, 333]))
    assert {0, 7, 333, 499} <= set(keys.tolist()) and len(keys) == 50
    assert np.diff(keys).max() <= 499 / 24 + 1
    assert_array_equal(key_frames(X, 600), np.arange(500))
    assert len(key_frames(np.tile(X[:9], (5, 1)), 20)) < 20


def test_a_clip_that_never_changes_lies_at_one_place() -> None:
    found = long_layout(np.ones((50, 3)), 10)
    assert_allclose(found.positions - found.positions[0], 0, atol=1e-12)
    assert found.stress == 0


def test_bad_input_is_refused() -> None:
    X = pacing(50)
    with pytest.raises(ValueError, match="keys must be at least 3, got 2"):
        long_layout(X, 2)
    with pytest.raises(ValueError, match="pins must name frames 0 to 49, got 50"):
        long_layout(X, 20, {50: (0.0, 0.0)})
    with pytest.raises(ValueError, match="X must be finite"):
        long_layout(np.where(X > 1, np.nan, X), 20)
