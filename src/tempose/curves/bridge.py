"""The curve from one state of motion to another."""

from __future__ import annotations

import numpy as np

from tempose.curves.offsets import carried
from tempose.curves.spline import Spline
from tempose.typing import FloatArray


def bridge(left: FloatArray, right: FloatArray, length: float) -> Spline:
    """Return the curve from one state to another.

    Parameters
    ----------
    left, right : (3, c) float
        Value, velocity and acceleration at its start and end.
    length : float
        Of its domain, from 0.

    Returns
    -------
    Spline
        The quintic between the states, followed by a cubic with 9 knots inside.
    """
    k = 13
    knots = np.concatenate([[0.0] * 3, np.linspace(0, length, k - 2), [length] * 3])
    flat = Spline(knots, np.zeros((k, left.shape[1])))

    def quintic(q: FloatArray) -> FloatArray:
        scale = length ** np.arange(3)[:, None]
        a, b = left * scale, right * scale
        rise = b[0] - a[0] - a[1] - 0.5 * a[2]
        speed, bend = b[1] - a[1] - a[2], b[2] - a[2]
        c = np.stack(
            [
                a[0],
                a[1],
                0.5 * a[2],
                10 * rise - 4 * speed + 0.5 * bend,
                -15 * rise + 7 * speed - bend,
                6 * rise - 3 * speed + 0.5 * bend,
            ]
        )
        s = np.clip(q / length, 0.0, 1.0)
        rows: list[FloatArray] = []
        for order in range(4):
            rows.append(np.stack([s**i for i in range(len(c))], axis=1) @ c / length**order)
            c = np.arange(1, len(c))[:, None] * c[1:]
        return np.stack(rows)

    curve = carried(flat, quintic, at_end=False)
    last = carried(
        flat, lambda q: quintic(length - q) * np.array([1, -1, 1, -1.0])[:, None, None], at_end=True
    )
    return curve.with_controls(np.concatenate([curve.controls[:-3], last.controls[-3:]]))
