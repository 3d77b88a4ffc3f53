"""Colours: between light and screen, and from numbers."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from tempose._validate import as_floats
from tempose.render.themes import rgb
from tempose.typing import FloatArray

Picture: TypeAlias = npt.NDArray[np.uint8]
"""(height, width, 3) bytes, sRGB, row 0 at the top."""

RAMPS = {
    "heat": ("#7a8aa8", "#8c74b4", "#c066a6", "#ee7480", "#ffd6c9"),
    "time": ("#3f46b8", "#1f77a8", "#12806a", "#4f8a12", "#a17a00"),
    "time-dark": ("#7d8bf2", "#4aa8da", "#3fc4a8", "#a4dc5e", "#f2e650"),
    "signed": ("#2f6fc4", "#8fb3dc", "#c9ccd1", "#e2a489", "#c04a30"),
}
"""Ramps of colour: errors and uncertainty, time, and values on both sides of zero."""


def to_linear(color: FloatArray) -> FloatArray:
    """Turn sRGB into linear light.

    Parameters
    ----------
    color : (...) float
        0 to 1.

    Returns
    -------
    (...) ndarray of float64
        Linear, 0 to 1 (IEC 61966-2-1).
    """
    c = np.asarray(color, dtype=np.float64)
    return np.where(c <= 0.04045, c / 12.92, ((np.maximum(c, 0.0) + 0.055) / 1.055) ** 2.4)


def to_srgb(light: FloatArray) -> FloatArray:
    """Turn linear light into sRGB.

    Parameters
    ----------
    light : (...) float
        Linear; clipped to 0 to 1.

    Returns
    -------
    (...) ndarray of float64
        0 to 1 (IEC 61966-2-1).
    """
    x = np.clip(light, 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def as_colors(value: Any, name: str, count: int) -> FloatArray:
    """Check colours, one for all or one for each.

    Parameters
    ----------
    value : str or array_like
        ``"#rrggbb"``, (3,) or (count, 3) numbers from 0 to 1; bytes from 0 to 255 are accepted too.
    name : str
        Name of the argument, for the message.
    count : int
        How many are needed.

    Returns
    -------
    (count, 3) ndarray of float64
        sRGB, 0 to 1.

    Raises
    ------
    ValueError
        If the shape is another or a number lies outside 0 to 1.
    """
    raw = np.asarray(rgb(value) if isinstance(value, str) else value)
    scale = 255.0 if raw.dtype == np.uint8 else 1.0
    if raw.ndim == 1:
        raw = np.broadcast_to(raw, (count, *raw.shape))
    color = as_floats(raw, name, (count, 3)) / scale
    if color.size and (color.min() < 0 or color.max() > 1):
        raise ValueError(f"{name} must lie from 0 to 1, got {color.min():.3g} to {color.max():.3g}")
    return color


def ramp_colors(values: Any, low: float, high: float, ramp: str = "heat") -> FloatArray:
    """Colour numbers by a ramp.

    Parameters
    ----------
    values : (...) array_like
        Numbers; those outside the range take the colour of its end, NaN becomes middle grey.
    low, high : float
        Values of the first and the last colour.
    ramp : str, default "heat"
        A name out of `RAMPS`.

    Returns
    -------
    (..., 3) ndarray of float64
        sRGB, 0 to 1.

    Raises
    ------
    ValueError
        If there is no such ramp, or the range is empty or not finite.
    """
    if ramp not in RAMPS:
        raise ValueError(f"ramp must be one of {', '.join(RAMPS)}, got {ramp!r}")
    if not low < high or not np.isfinite([low, high]).all():
        raise ValueError(f"the range of colours must go from low to high, got {low} to {high}")
    x = (np.asarray(values, dtype=np.float64) - low) / (high - low)
    stops = np.array([rgb(code) for code in RAMPS[ramp]])
    at = np.linspace(0.0, 1.0, len(stops))
    color = np.stack([np.interp(x, at, stops[:, c]) for c in range(3)], axis=-1)
    return np.where(np.isnan(x)[..., None], 0.5, color)
