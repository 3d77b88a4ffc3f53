"""What kernels on faces need of short vectors beside `tempose.linalg.lanes`."""

# pyright: reportCallIssue=false
from __future__ import annotations

from typing import Any

import numba
from llvmlite import ir
from numba.core import types

from tempose.linalg.lanes import alike, intrinsic

_INT32 = ir.IntType(32)


def _vector_function(name: str) -> Any:
    @intrinsic
    def apply(typing: Any, x: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            vector = arguments[0].type
            letters = "f64" if isinstance(vector.element, ir.DoubleType) else "f32"
            kind = ir.FunctionType(vector, [vector])
            symbol = f"llvm.{name}.v{x.width}{letters}"
            function = builder.module.globals.get(symbol) or ir.Function(builder.module, kind, symbol)
            return builder.call(function, arguments)

        return x(x), generate

    return apply


root = _vector_function("sqrt")
"""``root(x)``: square root of every lane; NaN of negative numbers."""
floor = _vector_function("floor")
"""``floor(x)``: largest whole number not above each lane."""


@intrinsic
def at_least(typing: Any, x: Any, y: Any) -> Any:
    """``at_least(x, y)``: the larger of two numbers in every lane, y where x is NaN."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.select(builder.fcmp_ordered(">", *arguments), *arguments)

    return x(x, y), generate


@intrinsic
def transposed(typing: Any, x: Any, y: Any, z: Any) -> Any:
    """``transposed(x, y, z)``: three components of four points as four points (x, y, z, 0)."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        a, b, c = arguments
        nothing = ir.Constant(a.type, [0.0] * 4)

        def shuffle(p: Any, q: Any, mask: list[int]) -> Any:
            return builder.shuffle_vector(p, q, ir.Constant(ir.VectorType(_INT32, 4), mask))

        low, high = shuffle(a, b, [0, 4, 1, 5]), shuffle(a, b, [2, 6, 3, 7])
        low_z, high_z = shuffle(c, nothing, [0, 4, 1, 5]), shuffle(c, nothing, [2, 6, 3, 7])
        points = [
            shuffle(low, low_z, [0, 1, 4, 5]),
            shuffle(low, low_z, [2, 3, 6, 7]),
            shuffle(high, high_z, [0, 1, 4, 5]),
            shuffle(high, high_z, [2, 3, 6, 7]),
        ]
        return context.make_tuple(builder, signature.return_type, points)

    return types.UniTuple(x, 4)(x, y, z), generate


@numba.njit(cache=True, nogil=True, inline="always")
def polynomial(coefficients: Any, x: Any) -> Any:
    """Evaluate a polynomial in every lane.

    Parameters
    ----------
    coefficients : tuple of float
        The constant first.
    x : lanes
        Where.

    Returns
    -------
    lanes
        Values.
    """
    last = len(coefficients) - 1
    y = alike(x, coefficients[last])
    for k in range(last):
        y = y * x + alike(x, coefficients[last - 1 - k])
    return y
