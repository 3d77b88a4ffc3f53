"""Decimal text to floats, compiled: several times the speed of the C library on long numbers.

Importing this module switches `tempose.formats._numbers.parse_floats` to it; results are the same to the
last bit. It is imported where the text is long enough to pay for loading the compiler.
"""

from __future__ import annotations

import math
import re

import numpy as np
from numba import njit

from tempose.typing import FloatArray

_POWERS = np.array([10.0**k for k in range(23)])
_SPLIT = 134217729.0  # 2^27 + 1: splits a double into two halves whose products are exact
_MOST = np.uint64(10**18)


_WORD = re.compile(rb"\S+")


def read_floats(block: bytes) -> FloatArray | None:
    """Read every word of a text as a number.

    Parameters
    ----------
    block : bytes
        Words separated by white space.

    Returns
    -------
    (k,) ndarray of float64 or None
        The numbers, correctly rounded; None if a word is no plain decimal number.
    """
    text = np.frombuffer(block, np.uint8)
    values = np.zeros(_count(text))
    hard = np.zeros((len(values), 2), np.int64)
    n_hard = _read(text, values, hard, _POWERS)
    for word, begin in hard[: max(n_hard, 0)].tolist():
        found = _WORD.match(block, begin)
        assert found is not None
        values[word] = float(found.group())
    return None if n_hard < 0 else values


@njit(cache=True)
def _count(text: np.ndarray) -> int:
    """Count the words."""
    words, inside = 0, False
    for byte in text:
        words += byte > 32 and not inside
        inside = byte > 32
    return words


@njit(cache=True)
def _read(text: np.ndarray, values: np.ndarray, hard: np.ndarray, powers: np.ndarray) -> int:
    """Fill `values` and list in `hard` which words, beginning where, are left to Python.

    Gives their number, or -1 if a word is bad.
    """
    n_hard = word = i = 0
    n = len(text)
    while True:
        while i < n and text[i] <= 32:
            i += 1
        if i >= n:
            return n_hard
        begin = i
        mantissa, exponent, negative, sure, i = _scan(text, i)
        if i < 0:
            return -1
        value, sure = _nearest(mantissa, exponent, powers, sure)
        values[word] = -value if negative else value
        if not sure:
            hard[n_hard, 0], hard[n_hard, 1] = word, begin
            n_hard += 1
        word += 1


@njit(cache=True)
def _scan(text: np.ndarray, i: int) -> tuple[np.uint64, int, bool, bool, int]:
    """Find digits, exponent, sign, whether no digit was dropped, and the end of a word (-1 if bad)."""
    n = len(text)
    negative = text[i] == 45
    if text[i] == 45 or text[i] == 43:
        i += 1
    mantissa, exponent, digits, dropped, point = np.uint64(0), 0, 0, False, False
    while i < n and (48 <= text[i] <= 57 or (text[i] == 46 and not point)):
        if text[i] == 46:
            point = True
        else:
            digits += 1
            if mantissa < _MOST:
                mantissa = mantissa * np.uint64(10) + np.uint64(text[i] - 48)
                exponent -= point
            else:
                dropped = True
        i += 1
    if i < n and digits and (text[i] == 101 or text[i] == 69):
        i += 1
        sign = -1 if i < n and text[i] == 45 else 1
        if i < n and (text[i] == 45 or text[i] == 43):
            i += 1
        first, power = i, 0
        while i < n and 48 <= text[i] <= 57:
            power = min(power * 10 + text[i] - 48, 100000)
            i += 1
        exponent += sign * power
        digits = 0 if i == first else digits
    bad = digits == 0 or (i < n and text[i] > 32)
    return mantissa, exponent, negative, not dropped, -1 if bad else i


@njit(cache=True)
def _nearest(mantissa: np.uint64, exponent: int, powers: np.ndarray, sure: bool) -> tuple[float, bool]:
    """Round ``mantissa * 10**exponent`` to a double and say whether it is surely the nearest.

    Quotient and remainder in double-double arithmetic (T. J. Dekker, "A floating-point technique for
    extending the available precision", 1971); what falls near the middle of two doubles is not decided.
    """
    high = float(mantissa)
    if mantissa < np.uint64(1 << 53):
        if 0 <= exponent <= 22:
            return high * powers[exponent], sure
        if -22 <= exponent < 0:
            return high / powers[-exponent], sure
        return high, sure and mantissa == np.uint64(0)
    if exponent > 0 or exponent < -22:
        return high, False
    low = float(np.int64(mantissa - np.uint64(high)))
    power = powers[-exponent]
    quotient = high / power
    product, error = _exact_product(quotient, power)
    correction = (((high - product) - error) + low) / power
    value = quotient + correction
    left_over = abs(correction - (value - quotient))
    _, binary_exponent = math.frexp(value)
    half_step = math.ldexp(0.5, binary_exponent - 53)
    return value, sure and abs(left_over - half_step) > 1e-6 * half_step


@njit(cache=True)
def _exact_product(a: float, b: float) -> tuple[float, float]:
    """Multiply two doubles: the rounded product and its exact error."""
    product = a * b
    t = _SPLIT * a
    a_high = t - (t - a)
    t = _SPLIT * b
    b_high = t - (t - b)
    a_low, b_low = a - a_high, b - b_high
    error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
    return product, error
