"""Curves of adjustments: through every key, smooth, and nothing at all outside their windows."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import quad

from tempose.transfer.adjustments.curves import Key, make_layers, natural_cubic, run_curve, window

T = 200


def key(first: int, last: int | None = None, ease: float = 12, n: int = 0, pinned: bool = False) -> Key:
    return Key(first, first if last is None else last, ease, ease, pinned, [n])


def curve(keys: list[Key], values: dict[int, np.ndarray]) -> np.ndarray:
    total = np.zeros((T, 3))
    for layer in make_layers(keys):
        for run in layer:
            total += run_curve(run, lambda k, at: np.tile(sum(values[n] for n in k.members), (len(at), 1)), T)
    return total


# ---- the window


@pytest.mark.parametrize(
    ("first", "last", "before", "after"), [(50, 50, 12, 12), (50, 70, 7.5, 30), (3, 190, 20, 20)]
)
def test_the_window_is_one_inside_and_nothing_outside(
    first: int, last: int, before: float, after: float
) -> None:
    w = window(T, first, last, before, after)
    t = np.arange(T)
    assert_array_equal(w[first : last + 1], 1)
    assert_array_equal(w[np.logical_or(t <= first - before, t >= last + after)], 0)
    assert (np.diff(w[: first + 1]) >= 0).all() and (np.diff(w[last:]) <= 0).all()


def test_the_window_has_two_continuous_derivatives() -> None:
    """Its second differences have no jump; those of a cubic step would."""
    n = 4000
    second = np.diff(window(n, 2000, 2000, 1000, 500), 2)
    # the third derivative of the step of length 500 is at most 60
    assert np.abs(np.diff(second)).max() < 61 / 500**3


def test_no_ease_is_a_jump() -> None:
    assert_array_equal(window(10, 3, 5, 0, 0), np.isin(np.arange(10), [3, 4, 5]))


# ---- the spline


def test_keys_are_met_and_lines_are_lines(rng: np.random.Generator) -> None:
    at = np.array([3, 10, 11, 40])
    values = rng.normal(size=(4, 3))
    assert_allclose(natural_cubic(at, values, at), values, rtol=0, atol=1e-13)
    line = np.outer(at, [1.0, -2, 0.5]) + 1
    t = np.arange(-20, 80)
    assert_allclose(natural_cubic(at, line, t), np.outer(t, [1.0, -2, 0.5]) + 1, rtol=0, atol=1e-10)
    assert_array_equal(natural_cubic(at[:1], values[:1], t), np.repeat(values[:1], 100, axis=0))


def test_no_other_curve_through_the_keys_accelerates_less(rng: np.random.Generator) -> None:
    """The natural spline is orthogonal to every function that vanishes at the keys."""
    from scipy.interpolate import CubicSpline

    at, values = np.array([0.0, 3, 5, 9, 12]), rng.normal(size=5)
    ours = CubicSpline(
        at, natural_cubic(at.astype(int), values[:, None], at.astype(int))[:, 0], bc_type="natural"
    )
    t = np.arange(13)
    assert_allclose(natural_cubic(at.astype(int), values[:, None], t)[:, 0], ours(t), rtol=0, atol=1e-12)

    def bump(x: float) -> float:
        return float(np.prod(x - at))

    def bump2(x: float) -> float:
        h = 1e-3
        return (bump(x + h) - 2 * bump(x) + bump(x - h)) / h**2

    inner = sum(quad(lambda x: float(ours(x, 2)) * bump2(x), a, b)[0] for a, b in pairwise(at))
    size = sum(quad(lambda x: bump2(x) ** 2, a, b)[0] for a, b in pairwise(at))
    assert abs(inner) < 1e-4 * np.sqrt(size)


def test_the_spline_goes_on_straight() -> None:
    at, values = np.array([0, 10, 15]), np.array([[0.0], [1], [4]])
    t = np.arange(-10, 30)
    assert_allclose(np.diff(natural_cubic(at, values, t)[:, 0], 2)[[0, 5, -1]], 0, rtol=0, atol=1e-12)


# ---- keys together


def test_separate_windows_are_separate_bumps() -> None:
    a, b = np.array([1.0, 0, 0]), np.array([0, 2.0, 0])
    both = curve([key(40, n=0), key(80, n=1)], {0: a, 1: b})
    assert_allclose(both, np.outer(window(T, 40, 40, 12, 12), a) + np.outer(window(T, 80, 80, 12, 12), b))
    assert len(make_layers([key(40), key(64)])[0]) == 2
    assert len(make_layers([key(40), key(63)])[0]) == 1


def test_overlapping_windows_are_one_curve_through_all_keys() -> None:
    values = {0: np.array([1.0, 0, 0]), 1: np.array([-1.0, 2, 0]), 2: np.array([0, 0, 3.0])}
    keys = [key(40, n=0), key(60, n=1), key(50, n=2)]
    total = curve(keys, values)
    for k in keys:
        assert_allclose(total[k.first], values[k.members[0]], rtol=0, atol=1e-12)
    assert_array_equal(np.flatnonzero(total.any(axis=1))[[0, -1]], [29, 71])
    # smooth: the largest second difference is that of a motion over a dozen frames
    assert np.abs(np.diff(total, 2, axis=0)).max() < 0.25


def test_a_hold_holds() -> None:
    a, b = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    total = curve([key(40, 60, n=0), key(75, n=1)], {0: a, 1: b})
    assert_allclose(total[40:61], np.tile(a, (21, 1)), rtol=0, atol=1e-12)
    assert_allclose(total[75], b, rtol=0, atol=1e-12)


def test_keys_of_one_frame_are_one_key_in_order() -> None:
    layers = make_layers([key(40, n=0), key(50, n=1), key(40, ease=20, n=2)])
    assert [[[k.members for k in run] for run in layer] for layer in layers] == [[[[0, 2], [1]]]]
    assert layers[0][0][0].before == 20


def test_holds_that_overlap_are_layers_that_add_up() -> None:
    a, b = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    keys = [key(40, 80, n=0), key(60, n=1)]
    assert len(make_layers(keys)) == 2
    total = curve([key(40, 80, n=0), key(60, n=1)], {0: a, 1: b})
    assert_allclose(total[60], a + b)
    assert_allclose(total[45], a)


def test_a_pinned_key_follows_its_offset_while_it_comes_and_goes() -> None:
    path = np.cumsum(np.random.default_rng(0).normal(size=(T, 3)), axis=0)
    pinned = [key(50, 70, pinned=True)]
    got = run_curve(pinned, lambda k, at: -path[at], T)
    assert_allclose(got, -window(T, 50, 70, 12, 12)[:, None] * path, rtol=0, atol=1e-12)
