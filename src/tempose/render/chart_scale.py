"""Numbers to places on a chart: ticks, ranges, thinned curves."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray


def nice_ticks(low: float, high: float, count: int = 5) -> list[float]:
    """Return round numbers that divide a range.

    Parameters
    ----------
    low, high : float
        The range.
    count : int, default 5
        About how many.

    Returns
    -------
    list of float
        Multiples of 1, 2 or 5 times a power of ten, within the range.

    Examples
    --------
    >>> nice_ticks(0.0, 1.0)
    [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    """
    rough = (high - low) / max(count, 1)
    power = 10.0 ** np.floor(np.log10(rough))
    step = min((m * power for m in (1, 2, 5, 10)), key=lambda s: abs(np.log(s / rough)))
    first, last = int(np.ceil(low / step - 1e-9)), int(np.floor(high / step + 1e-9))
    return [float(round(k * step, 12)) for k in range(first, last + 1)]


def value_range(values: list[FloatArray], given: tuple[float, float] | None) -> tuple[float, float]:
    """Return the values that a vertical axis shows.

    Parameters
    ----------
    values : list of ndarray
        What is drawn; not finite values do not count.
    given : (float, float), optional
        What the caller wants to see.

    Returns
    -------
    (float, float)
        Least and greatest, different.

    Raises
    ------
    ValueError
        If `given` is empty.
    """
    if given is not None:
        if not given[0] < given[1]:
            raise ValueError(f"y_range must go from low to high, got {given}")
        return float(given[0]), float(given[1])
    flat = np.concatenate([v.ravel() for v in values])
    flat = flat[np.isfinite(flat)]
    if flat.size == 0:
        return 0.0, 1.0
    low, high = float(flat.min()), float(flat.max())
    margin = 0.06 * (high - low) if high > low else max(abs(high) * 0.1, 0.5)
    # Values that start at nothing keep their zero.
    return (0.0 if 0 <= low <= 0.35 * high else low - margin), high + margin


def pen_path(x: FloatArray, y: FloatArray, width: int) -> str:
    """Return the path of a curve for SVG; it breaks where values are missing.

    Parameters
    ----------
    x, y : (T,) float
        Pixels; y may be NaN.
    width : int
        Pixels of the drawing: longer curves are thinned to their extremes in each.

    Returns
    -------
    str
        Moves and lines.
    """
    x, y = _thinned(x, y, width)
    words, pen = [], "M"
    for a, b in zip(x, y):
        if not np.isfinite(b):
            pen = "M"
            continue
        words.append(f"{pen}{a:.1f} {b:.1f}")
        pen = "L"
    return "".join(words)


def _thinned(x: FloatArray, y: FloatArray, width: int) -> tuple[FloatArray, FloatArray]:
    # More points than pixels: keep the least and the greatest of each column, so that peaks stay.
    if len(x) <= 3 * width:
        return x, y
    keep: list[int] = []
    for part in np.array_split(np.arange(len(x)), width):
        finite = part[np.isfinite(y[part])]
        ends = (
            {int(finite[y[finite].argmin()]), int(finite[y[finite].argmax()])} if len(finite) else set[int]()
        )
        keep += sorted(ends | ({int(part[~np.isfinite(y[part])][0])} if len(finite) < len(part) else set()))
    return x[keep], y[keep]
