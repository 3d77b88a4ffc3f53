"""Short vectors do what numpy does to each number."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.linalg.lanes import alike, item, lane, load4, load8, plus_times, scaled, store, turned


@numba.njit
def arithmetic_4(x: Any, y: Any, a: Any, out: Any) -> None:
    p, q = load4(x, 1), load4(y, 2)
    store(out, 0, p + q)
    store(out, 4, p - q)
    store(out, 8, p * q)
    store(out, 12, p / q)
    store(out, 16, plus_times(p, a, q))
    store(out, 20, scaled(a, q))
    store(out, 24, alike(p, a))
    store(out, 28, turned(p))
    out[32] = lane(p, 3)
    out[33] = item(x, 5)


@numba.njit
def arithmetic_8(x: Any, y: Any, a: Any, out: Any) -> None:
    store(out, 0, plus_times(load8(x, 0), a, load8(y, 1)) * load8(x, 2) - alike(load8(x, 0), a))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_lanes_agree_with_numpy(dtype: type, rng) -> None:
    x, y, a = rng.random(12).astype(dtype), (1 + rng.random(12)).astype(dtype), dtype(0.7)
    out = np.zeros(34, dtype=dtype)
    arithmetic_4(x, y, a, out)
    p, q = x[1:5], y[2:6]
    expected = [p + q, p - q, p * q, p / q, p + a * q, a * q, np.full(4, a), p[[1, 2, 0, 3]]]
    assert_allclose(out[:32].reshape(8, 4), expected, rtol=4 * np.finfo(dtype).eps)
    assert_array_equal(out[32:], [p[3], x[5]])
    arithmetic_8(x, y, a, out)
    assert_allclose(out[:8], (x[:8] + a * y[1:9]) * x[2:10] - a, rtol=0, atol=8 * np.finfo(dtype).eps)
