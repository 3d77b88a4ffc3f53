"""Paths of least acceleration: cubic between conditions, exact on them, zero where nothing is asked."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.testing import assert_allclose

from tempose.transfer.feet.steady_path import path_above, second_differences, steady_path


def rows_at(frames: list[int], T: int) -> sp.csr_array:
    return sp.csr_array((np.ones(len(frames)), (np.arange(len(frames)), frames)), shape=(len(frames), T))


def energy(T: int, fade: float) -> np.ndarray:
    bend = second_differences(T).toarray()
    return bend.T @ bend + np.eye(T) * fade**-4.0


def test_nothing_asked_gives_nothing() -> None:
    assert_allclose(steady_path(rows_at([3, 7], 20), np.zeros((2, 3)), 5.0), 0, rtol=0, atol=0)
    assert_allclose(steady_path(sp.csr_array((0, 20)), np.zeros((0, 2)), 5.0), np.zeros((20, 2)))


def test_between_two_stances_the_path_is_the_cubic_of_hermite() -> None:
    """Two frames at either end fix place and velocity; the fourth differences between vanish."""
    T, given = 40, np.array([0.0, 0.02, 0.5, 0.51])
    frames = np.array([5, 6, 30, 31])
    path = steady_path(rows_at(list(frames), T), given[:, None], np.inf)[:, 0]
    cubic = np.polynomial.Polynomial.fit(frames, given, 3)
    assert_allclose(path[5:32], cubic(np.arange(5, 32)), rtol=0, atol=1e-5)
    # beyond them nothing bends it
    assert_allclose(np.diff(path[31:], 2), 0, rtol=0, atol=1e-5)


def test_a_displacement_fades_as_the_damped_wave_of_its_equation() -> None:
    """The solution of d'''' + d / fade^4 = 0 that dies out, level at its top."""
    T, fade = 400, 20.0
    path = steady_path(rows_at([200], T), np.ones((1, 1)), fade)[:, 0]
    a = np.abs(np.arange(T) - 200) / (fade * np.sqrt(2))
    assert_allclose(path, np.exp(-a) * (np.cos(a) + np.sin(a)), rtol=0, atol=2e-3)
    assert np.abs(path[:20]).max() < 5e-3


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_the_dense_solution(seed: int) -> None:
    rng = np.random.default_rng(seed)
    T, c, fade = 50, 12, 6.0
    C, g = rng.normal(size=(c, T)) * (rng.random((c, T)) < 0.2), rng.normal(size=(c, 2))
    C[np.arange(c), rng.permutation(T)[:c]] = 1.0
    full = np.block([[energy(T, fade), C.T], [C, np.zeros((c, c))]])
    expected = np.linalg.solve(full, np.concatenate([np.zeros((T, 2)), g]))[:T]
    path = steady_path(sp.csr_array(C), g, fade)
    assert_allclose(C @ path, g, rtol=0, atol=1e-11)
    assert_allclose(path, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("T", [2000, 20000])
def test_conditions_hold_exactly_in_long_clips_at_any_rate(T: int) -> None:
    rng = np.random.default_rng(T)
    first = np.flatnonzero(np.sin(np.arange(T - 8) / 40) > 0)
    rows = np.arange(len(first))
    C = sp.csr_array(
        (np.r_[np.ones(len(first)), -np.ones(len(first))], (np.r_[rows, rows], np.r_[first + 8, first])),
        shape=(len(first), T),
    )
    g = 0.002 * np.sin(first / 30)[:, None] + 1e-4 * rng.normal(size=(len(first), 1))
    assert np.abs(C @ steady_path(C, g, 96.0) - g).max() < 1e-9


def test_conditions_that_contradict_each_other_are_met_in_the_mean() -> None:
    path = steady_path(rows_at([10, 10, 4], 30), np.array([[1.0], [2.0], [0.0]]), 5.0)
    assert path[10, 0] == pytest.approx(1.5, abs=1e-6) and path[4, 0] == pytest.approx(0, abs=1e-6)


def test_time_may_run_backwards_and_sizes_scale() -> None:
    C, g = rows_at([3, 9, 10, 22], 30), np.array([[0.0], [1.0], [1.5], [-2.0]])
    path = steady_path(C, g, 4.0)
    assert_allclose(steady_path(C[:, ::-1], g, 4.0), path[::-1], rtol=0, atol=1e-12)
    assert_allclose(steady_path(C, -1e-3 * g, 4.0), -1e-3 * path, rtol=0, atol=1e-15)


@pytest.mark.parametrize("T", [1, 2, 3])
def test_paths_of_a_few_frames(T: int) -> None:
    path = steady_path(rows_at([T - 1], T), np.array([[0.3]]), 5.0)
    assert path.shape == (T, 1) and path[-1, 0] == pytest.approx(0.3, abs=1e-12)
    assert_allclose(path_above(np.full(T, 0.2), np.zeros(T, dtype=bool), 5.0), 0.2, rtol=0, atol=1e-9)


# ---- above a floor


def test_above_the_floor_already() -> None:
    floor = -np.abs(np.sin(np.arange(60) / 7)) - 0.1
    assert_allclose(path_above(floor, np.zeros(60, dtype=bool), 5.0), 0, rtol=0, atol=0)


@pytest.mark.parametrize("seed", range(6))
def test_the_least_path_above_a_floor(seed: int) -> None:
    """Optimal by its multipliers: free where it is higher, pushed up alone where it touches."""
    rng = np.random.default_rng(seed)
    T, fade = 80, 6.0
    floor = np.convolve(rng.normal(size=T + 8), np.ones(9) / 9, mode="valid") - 0.1
    fixed = np.sin(np.arange(T) / 6 + seed) > 0.6
    d = path_above(floor, fixed, fade)
    assert (d >= floor - 1e-12).all()
    assert_allclose(d[fixed], floor[fixed], rtol=0, atol=1e-14)
    push = energy(T, fade) @ d
    touching = d <= floor + 1e-7
    assert np.abs(push[~touching]).max() < 1e-6
    assert push[touching & ~fixed].min(initial=0) > -1e-6


def test_a_floor_in_other_units_and_backwards() -> None:
    floor = 0.1 * np.sin(np.arange(90) / 5) ** 3 - 0.02
    fixed = np.arange(90) % 30 < 6
    d = path_above(floor, fixed, 4.0)
    assert_allclose(path_above(1000 * floor, fixed, 4.0), 1000 * d, rtol=0, atol=1e-6)
    assert_allclose(path_above(floor[::-1], fixed[::-1], 4.0), d[::-1], rtol=0, atol=1e-9)
