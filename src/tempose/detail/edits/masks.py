"""Where detail is shown, and how much of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tempose._validate import as_floats
from tempose.typing import FloatArray


def region_strengths(strength: float | Mapping[str, float], names: Sequence[str]) -> FloatArray:
    """Read how strong the detail of every region is to be.

    Parameters
    ----------
    strength : float or mapping of str to float
        One factor for all, or factors of some regions; the others keep theirs.
    names : sequence of str
        R regions.

    Returns
    -------
    (R,) ndarray
        Factors.

    Raises
    ------
    ValueError
        If a region is unknown or a factor is not finite.
    """
    if isinstance(strength, Mapping):
        unknown = [name for name in strength if name not in names]
        if unknown:
            raise ValueError(f"strength: no region named {unknown[0]!r}; there are {', '.join(names)}")
        factors = np.array([float(strength.get(name, 1.0)) for name in names])
    else:
        factors = np.full(len(names), float(strength))
    if not np.isfinite(factors).all():
        raise ValueError(f"strength must be finite, got {strength}")
    return factors


def vertex_mask(mask: Any, names: Sequence[str], shares: FloatArray) -> FloatArray | None:
    """Read where detail is to be shown.

    Parameters
    ----------
    mask : (n,) float, sequence of str, or None
        From 0 (none) to 1 (all) a vertex, or the regions that show it.
    names : sequence of str
        R regions.
    shares : (n, R) float
        Share of every vertex in every region.

    Returns
    -------
    (n,) ndarray or None
        From 0 to 1; it fades over the seams of regions.

    Raises
    ------
    ValueError
        If a region is unknown or a number is out of range.
    """
    if mask is None:
        return None
    words = [mask] if isinstance(mask, str) else list(mask)
    if words and all(isinstance(word, str) for word in words):
        unknown = [word for word in words if word not in names]
        if unknown:
            raise ValueError(f"mask: no region named {unknown[0]!r}; there are {', '.join(names)}")
        return shares[:, [name in words for name in names]].sum(axis=1)
    values = as_floats(mask, "mask", (len(shares),))
    if values.min(initial=0.0) < 0 or values.max(initial=0.0) > 1:
        raise ValueError(f"mask must hold numbers from 0 to 1, got {values.min():.3g} to {values.max():.3g}")
    return values
