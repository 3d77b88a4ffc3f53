"""Windows cover every frame, and their weights are a smooth partition of unity."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from tempose.signals.windows import Cover, cover


@given(st.integers(1, 3000), st.integers(6, 400), st.floats(0, 1))
def test_every_frame_lies_in_one_window_or_in_two_neighbours(T: int, window: int, part: float) -> None:
    overlap = 2 + int(part * (window // 3 - 2))
    windows = cover(T, window, overlap)
    slices = [windows.frames(i) for i in range(len(windows))]
    count = np.zeros(T, dtype=int)
    for frames in slices:
        assert 0 <= frames.start < frames.stop and frames.stop - frames.start <= max(window, 2)
        count[frames] += 1
    assert slices[0].start == 0 and (count >= 1).all() and (count <= 2).all()
    assert (len(windows) == 1) == (T <= window)
    for a, b in pairwise(slices):
        assert a.stop - b.start >= overlap
    lengths = [s.stop - s.start for s in slices]
    assert max(lengths) - min(lengths) <= 1


@given(st.integers(301, 2000))
def test_weights_count_only_windows_that_hold_the_frame(T: int) -> None:
    windows, t = cover(T, 100, 30), np.arange(float(T))
    first, weight = windows(t)
    assert ((weight >= 0) & (weight <= 1)).all()
    early, late = weight < 1, weight > 0
    assert (windows.starts[first[early]] <= t[early]).all() and (
        t[early] <= windows.stops[first[early]]
    ).all()
    assert (windows.starts[first[late] + 1] <= t[late]).all() and (
        t[late] <= windows.stops[first[late] + 1]
    ).all()


def dense_weights(windows: Cover, t: np.ndarray) -> np.ndarray:
    """One column a window, as the docstring says it."""
    W = np.ones((len(t), len(windows)))
    for i in range(len(windows) - 1):
        s = np.clip((t - windows.starts[i + 1]) / (windows.stops[i] - windows.starts[i + 1]), 0, 1)
        fade = 6 * s**5 - 15 * s**4 + 10 * s**3
        W[:, i] *= 1 - fade
        W[:, i + 1] *= fade
    return W


def test_weights_equal_the_product_of_fades_and_sum_to_one() -> None:
    windows, t = cover(700, 150, 40), np.linspace(-5, 710, 4001)
    first, weight = windows(t)
    found = np.zeros((len(t), len(windows)))
    found[np.arange(len(t)), first] += 1 - weight
    found[np.arange(len(t)), np.minimum(first + 1, len(windows) - 1)] += weight
    assert_allclose(found, dense_weights(windows, t), atol=1e-14)
    assert_allclose(found.sum(axis=1), 1, atol=1e-14)


@pytest.mark.parametrize("end", [0, 1])
def test_weights_are_twice_differentiable_where_fading_begins_and_ends(end: int) -> None:
    windows = cover(700, 150, 40)
    i = 2
    at = (windows.starts[1:], windows.stops[:-1])[end][i]
    width = windows.stops[i] - windows.starts[i + 1]
    h = 1e-3 * width
    w = dense_weights(windows, at + h * np.arange(-2, 3))[:, i + 1]
    found = np.array([windows(np.array(at + h * k)) for k in range(-2, 3)])
    assert_allclose(np.where(found[:, 0] == i, found[:, 1], 1 - found[:, 1]), w, atol=1e-12)
    # a jump of the second derivative would make the second difference about 1 / width^2 there
    second = np.diff(w, 2) / h**2 * width**2
    assert np.abs(second).max() < 0.2


def test_any_batch_of_ticks_is_taken() -> None:
    windows = cover(500, 100, 30)
    t = np.random.default_rng(0).uniform(0, 499, (3, 1, 2))
    first, weight = windows(t)
    assert first.shape == weight.shape == (3, 1, 2)
    for i in np.ndindex(t.shape):
        a, b = windows(t[i])
        assert a == first[i] and b == weight[i]


def test_bad_windows_are_refused() -> None:
    for window, overlap in ((100, 1), (100, 34), (5, 2)):
        with pytest.raises(ValueError, match="overlap must be 2 to a third of the window"):
            cover(1000, window, overlap)
    with pytest.raises(ValueError, match="share ticks with their neighbours"):
        Cover(np.array([0.0, 50.0]), np.array([40.0, 90.0]))
    with pytest.raises(ValueError, match="with no other window"):
        Cover(np.array([0.0, 10.0, 20.0]), np.array([30.0, 40.0, 90.0]))
