"""Every check at the border rejects what it should, by name, and accepts what it should."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tempose._validate import as_floats, as_indices, read_only


@pytest.mark.parametrize(
    ("value", "shape"),
    [
        ([[0, 1, 2]], ("n", 3)),
        (np.zeros((0, 3)), ("n", 3)),
        (np.zeros((4, 3), dtype=np.float32), (4, 3)),
        (np.zeros((2, 5, 3)), ("T", "n", 3)),
        (7, ()),
        ([], ("n",)),
    ],
)
def test_floats_of_the_right_shape_pass_as_double(value, shape) -> None:
    array = as_floats(value, "V", shape)
    assert array.dtype == np.float64
    assert_array_equal(array, value)


def test_nothing_is_copied_that_already_fits() -> None:
    V, F = np.zeros((2, 3)), np.zeros((1, 3), dtype=np.int32)
    assert as_floats(V, "V", ("n", 3)) is V
    assert as_indices(F, "F", ("m", 3)) is F
    assert as_floats(V, "V", ("n", 3), np.float32).dtype == np.float32


@pytest.mark.parametrize(
    ("value", "shape", "message"),
    [
        (np.zeros((4, 2)), ("n", 3), r"^V must have shape \(n, 3\), got \(4, 2\)$"),
        (np.zeros(3), ("n", 3), r"^V must have shape \(n, 3\), got \(3,\)$"),
        (np.zeros((4, 3)), (5, 3), r"^V must have shape \(5, 3\), got \(4, 3\)$"),
        (np.zeros((1, 4, 3)), ("n", 3), r"got \(1, 4, 3\)$"),
        (None, ("n",), r"^V must have shape \(n,\), got \(\)$"),
        ([[1, 2, 3], [4, 5]], ("n", 3), r"^V must be an array of numbers of shape \(n, 3\): .*inhomogeneous"),
        ("abc", ("n",), r"^V must be an array of numbers of shape \(n,\): "),
        ([1j], ("n",), r"^V must be an array of numbers of shape \(n,\): "),
        ([[0, 1, np.nan]], ("n", 3), r"^V must be finite, got nan at index \(0, 2\)$"),
        ([0, -np.inf], ("n",), r"^V must be finite, got -inf at index \(1,\)$"),
    ],
)
def test_other_floats_are_refused_by_name(value, shape, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        as_floats(value, "V", shape)


def test_numbers_too_large_for_the_type_are_refused() -> None:
    assert as_floats([3e38], "V", ("n",), np.float32)[0] == np.float32(3e38)
    with pytest.raises(ValueError, match=r"^V must be finite, got inf at index \(0,\)$"):
        as_floats([1e39], "V", ("n",), np.float32)


@pytest.mark.parametrize("dtype", [np.int8, np.uint16, np.int32, np.int64, np.uint64])
def test_indices_of_any_integer_type_pass_as_int32(dtype) -> None:
    F = as_indices(np.array([[0, 5, 3]], dtype=dtype), "F", ("m", 3), limit=6)
    assert F.dtype == np.int32
    assert_array_equal(F, [[0, 5, 3]])


def test_no_indices_pass_whatever_numpy_makes_of_an_empty_list() -> None:
    assert as_indices([], "k", ("k",)).dtype == np.int32
    assert as_indices(np.zeros((0, 3)), "F", ("m", 3), limit=0).shape == (0, 3)


@pytest.mark.parametrize(
    ("value", "shape", "limit", "message"),
    [
        ([[0, 1, 3]], ("m", 3), 3, r"^F must hold indices from 0 and below 3, got 3 at index \(0, 2\)$"),
        ([[0, -1, 2]], ("m", 3), 3, r"^F must hold indices from 0 and below 3, got -1 at index \(0, 1\)$"),
        ([0], ("m",), 0, r"below 0, got 0"),
        ([2**31], ("m",), None, r"^F must hold indices from 0 and below 2147483648, got 2147483648"),
        ([[0, 1]], ("m", 3), 3, r"^F must have shape \(m, 3\), got \(1, 2\)$"),
        ([0.0, 1.0], ("m",), 3, r"^F must hold integers, got dtype float64$"),
        ([True], ("m",), 3, r"^F must hold integers, got dtype bool$"),
        (["a"], ("m",), 3, r"^F must hold integers, got dtype <U1$"),
        (None, ("m",), 3, r"^F must hold integers, got dtype object$"),
        ([[0, 1, 2], [3]], ("m", 3), 9, r"^F must hold integers in shape \(m, 3\): .*inhomogeneous"),
    ],
)
def test_other_indices_are_refused_by_name(value, shape, limit, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        as_indices(value, "F", shape, limit)


def test_a_read_only_view_shares_memory_and_refuses_writes() -> None:
    V = np.zeros((2, 3))
    view = read_only(V)
    assert np.shares_memory(V, view) and V.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        view[0, 0] = 1
