"""Places of frames are those of least stress, with pins where they were put."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.distance import pdist, squareform

from tempose.signals.pose._descent import _guttman_step
from tempose.signals.pose._smacof import pair_sums
from tempose.signals.pose.layout import PoseLayout, congruence, stress_of


def distances(X):
    return squareform(pdist(X))


def raw_stress(P, D):
    return 0.5 * np.square(D - distances(P)).sum()


def guttman(P, D, free):
    """The paper's iteration by dense matrices: V_ff^-1 (B P - V_fc P_c)."""
    n, d = len(P), distances(P)
    B = np.where(d > 0, -D / np.where(d > 0, d, 1), 0.0)
    np.fill_diagonal(B, 0.0)
    np.fill_diagonal(B, -B.sum(axis=1))
    V = n * np.eye(n) - 1.0
    right = (B @ P)[free] - V[np.ix_(free, ~free)] @ P[~free]
    moved = P.copy()
    moved[free] = np.linalg.lstsq(V[np.ix_(free, free)], right, rcond=None)[0]
    if free.all():
        moved += P.mean(axis=0)
    return moved


@pytest.mark.parametrize("pinned", [[], [3], [0, 4, 11]])
def test_one_step_is_the_guttman_transform(rng, pinned):
    D, P = distances(rng.normal(size=(12, 5))), rng.normal(size=(12, 2))
    P[7] = P[2]
    free = np.ones(12, dtype=bool)
    free[pinned] = False
    z, sums, step = P.T.copy(), np.zeros((2, 12)), np.zeros((2, free.sum()))
    stress = pair_sums(D, z[0], z[1], sums[0], sums[1])
    _guttman_step(z, sums, np.flatnonzero(free), len(pinned), step)
    assert_allclose(stress, raw_stress(P, D), rtol=1e-12)
    assert_allclose(P[free] + step.T, guttman(P, D, free)[free], atol=1e-12)


@pytest.mark.parametrize("pins", [{}, {2: (0.3, -1.0)}, {0: (0.0, 0.0), 9: (2.0, 1.0), 10: (-1.0, 1.0)}])
def test_stress_never_rises_and_its_gradient_ends_at_zero(rng, pins):
    D = distances(rng.normal(size=(30, 6)))
    found = PoseLayout(D).solve(pins, tolerance=1e-9)
    assert found.converged
    assert (np.diff(found.history) <= 0).all()
    assert_allclose(found.history[-1], stress_of(found.positions, D), rtol=1e-9)
    h = 1e-5
    for i in np.setdiff1d(np.arange(30), list(pins))[::5]:
        for c in range(2):
            step = np.zeros((30, 2))
            step[i, c] = h
            slope = (raw_stress(found.positions + step, D) - raw_stress(found.positions - step, D)) / (2 * h)
            assert abs(slope) < 1e-5 * np.square(D).sum() / 30


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_points_of_a_plane_are_recovered(rng, unit):
    Q = unit * rng.normal(size=(40, 2))
    found = PoseLayout(distances(Q)).solve()
    assert found.converged and found.stress < 1e-6
    assert_allclose(congruence(found.positions, Q)(found.positions), Q, atol=1e-5 * unit)


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_alignment_undoes_a_turn_a_mirror_and_a_move(rng, mirror):
    Q, c, s = rng.normal(size=(9, 2)), np.cos(0.7), np.sin(0.7)
    P = Q @ np.array([[c, s], [-s, c]]) * [1.0, mirror] + [3.0, -2.0]
    assert_allclose(congruence(P[[1, 4, 8]], Q[[1, 4, 8]])(P), Q, atol=1e-12)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_layout_scales_with_the_distances(rng, unit):
    D = distances(rng.normal(size=(25, 4)))
    one, other = PoseLayout(D).solve(), PoseLayout(unit * D).solve()
    assert_allclose(other.positions, unit * one.positions, atol=1e-5 * unit)
    assert_allclose(other.stress, one.stress, rtol=1e-6)


def test_layout_does_not_depend_on_a_rotation_of_the_poses(rng):
    X = rng.normal(size=(25, 4))
    turn = np.linalg.qr(rng.normal(size=(4, 4)))[0]
    one, other = (PoseLayout(distances(Y)).solve(tolerance=1e-9) for Y in (X, X @ turn + 5.0))
    assert_allclose(other.positions, one.positions, atol=1e-6)


def test_three_poses_equally_far_make_an_equilateral_triangle():
    found = PoseLayout(1.0 - np.eye(3)).solve(tolerance=1e-10)
    assert_allclose(pdist(found.positions), 1.0, atol=1e-8)


def test_four_poses_equally_far_make_a_square_of_known_stress():
    # side a, diagonal a sqrt 2: 4 (1 - a)^2 + 2 (1 - a sqrt 2)^2 is least at a = (2 + sqrt 2) / 4
    start = np.array([[0, 0], [1, 0.2], [1.1, 1], [0, 0.9]])
    found = PoseLayout(1.0 - np.eye(4)).solve(start=start, tolerance=1e-10)
    a = (2 + np.sqrt(2)) / 4
    assert_allclose(np.sort(pdist(found.positions)), [a] * 4 + [a * np.sqrt(2)] * 2, atol=1e-7)
    assert_allclose(found.stress, np.sqrt((4 * (1 - a) ** 2 + 2 * (1 - a * np.sqrt(2)) ** 2) / 6), atol=1e-8)


def test_pose_beside_two_pins_lies_where_its_distances_say():
    D = distances(np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]))
    found = PoseLayout(D).solve({0: (1.0, 1.0), 1: (5.0, 1.0)}, tolerance=1e-10)
    assert_allclose(np.abs(found.positions[2] - 1.0), [0.0, 3.0], atol=1e-7)


def test_pinned_frames_keep_their_bits_and_drags_near_the_optimum(rng):
    layout = PoseLayout(distances(rng.normal(size=(50, 6))))
    P = layout.solve().positions
    pins = {4: P[4] + [0.7, 0.1 + 1e-17], 30: P[30] / 3}
    for _ in range(60):
        P = layout.drag(P, pins)
        for frame, place in pins.items():
            assert_array_equal(P[frame], place)
    assert_allclose(stress_of(P, layout.distances), layout.solve(pins, P).stress, rtol=2e-3)


def test_repeated_frames_lie_at_one_place(rng):
    X = rng.normal(size=(15, 4))
    found = PoseLayout(distances(np.concatenate([X, X]))).solve()
    assert_allclose(found.positions[:15], found.positions[15:], atol=1e-12)


@pytest.mark.parametrize("n", [1, 2])
def test_one_and_two_frames(n):
    found = PoseLayout(3.0 * (1 - np.eye(n))).solve()
    assert found.converged
    assert_allclose(pdist(found.positions), [3.0] * (n - 1))


def test_frames_that_are_all_alike_lie_at_one_point():
    found = PoseLayout(np.zeros((5, 5))).solve()
    assert found.converged and found.stress == 0.0
    assert_array_equal(found.positions, np.zeros((5, 2)))


@pytest.mark.parametrize(
    ("D", "why"),
    [
        (np.zeros((2, 3)), "shape"),
        (np.array([[0.0, -1.0], [-1.0, 0.0]]), "negative"),
        (np.array([[0.0, 1.0], [2.0, 0.0]]), "symmetric"),
        (np.array([[0.0, np.nan], [np.nan, 0.0]]), "finite"),
        (np.ones((2, 2)), "diagonal"),
    ],
)
def test_distances_that_are_none_are_refused(D, why):
    with pytest.raises(ValueError, match=why):
        PoseLayout(D)


@pytest.mark.parametrize(
    ("pins", "why"),
    [
        ({8: (0.0, 0.0)}, "frames 0 to 7"),
        ({-1: (0.0, 0.0)}, "frames 0 to 7"),
        ({"a": (0.0, 0.0)}, "frames 0 to 7"),
        ({1: (0.0, np.inf)}, "finite"),
        ({1: (0.0, 0.0, 0.0)}, "shape"),
        ({0: (1.0, 2.0), 7: (1.0, 2.0)}, "frames 0 and 7 are pinned at one place.*times the mean step"),
        ({i: (float(i), 2.0 * i) for i in range(8)}, "all 8 frames on one line"),
    ],
)
def test_pins_that_contradict_the_poses_are_refused(rng, pins, why):
    X = np.cumsum(rng.uniform(0.5, 1.0, size=(8, 3)), axis=0)
    with pytest.raises(ValueError, match=why):
        PoseLayout(distances(X)).solve(pins)


def test_pins_on_a_line_are_taken_when_the_poses_are_on_one():
    t = np.arange(8.0)
    found = PoseLayout(distances(np.outer(t, [1.0, 2.0, 3.0]))).solve({i: (i, 0.5 * i) for i in range(8)})
    assert_array_equal(found.positions, np.stack([t, 0.5 * t], axis=1))


def test_neighbouring_poses_at_one_place_are_a_warning_with_its_measure(rng):
    X = np.cumsum(rng.uniform(0.5, 1.0, size=(8, 3)), axis=0)
    X[4] = X[3] + 0.3 * (X[4] - X[3])
    found = PoseLayout(distances(X)).solve({3: (0.0, 0.0), 4: (0.0, 0.0)})
    assert len(found.warnings) == 1 and "times the mean step" in found.warnings[0]
    assert PoseLayout(distances(X)).solve({3: (0.0, 0.0), 4: (1.0, 0.0)}).warnings == ()
