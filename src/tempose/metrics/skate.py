"""Feet that slide while they should stand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.metrics._frames import check_clip
from tempose.metrics.contacts import velocities
from tempose.typing import BoolArray, FloatArray, IntArray

SOLE = 0.005
"""Share of the height: vertices no higher above the lowest one belong to what touches the ground."""


def sole_velocities(foot: FloatArray, height: float, fps: float, sole: float = SOLE) -> FloatArray:
    """Velocity of the lowest vertices of a foot: the part that touches the ground, heel or toe.

    Parameters
    ----------
    foot : (T, k, 3) float
        Vertices of one foot, at least one, metres.
    height : float
        Height of the character, metres.
    fps : float
        Frames per second.
    sole : float, default 0.005
        Vertices less than this share of `height` above the lowest one are counted, in each frame anew.

    Returns
    -------
    (T, 3) ndarray
        Mean velocity of those vertices, metres per second.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or `height` or `fps` is not positive.
    """
    foot = as_floats(foot, "foot", ("T", "k", 3))
    if foot.shape[1] == 0:
        raise ValueError("foot must hold at least one vertex, got none")
    if not 0 < height < float("inf"):
        raise ValueError(f"height must be positive, got {height}")
    y = foot[..., 1]
    lowest = (y <= y.min(axis=1, keepdims=True) + sole * height).astype(np.float64)
    share = lowest / lowest.sum(axis=1, keepdims=True)
    return np.einsum("tk,tki->ti", share, velocities(foot, fps))


def skate(
    V: FloatArray, feet: Sequence[IntArray], contact: BoolArray, height: float, fps: float
) -> float | None:
    """Mean horizontal speed of the feet while they are in contact.

    Parameters
    ----------
    V : (T, n, 3) float
        Vertices of the target (or joints of the source, one a foot), metres.
    feet : sequence of (k,) int
        Vertices of each foot, 0-based.
    contact : (T, len(feet)) bool
        Contacts of the *source*, from `detect_contacts`.
    height : float
        Height of the target, metres.
    fps : float
        Frames per second.

    Returns
    -------
    float or None
        Percent of the height per second, each frame of each foot in contact counted once; None where no
        foot is ever in contact.

    Raises
    ------
    ValueError
        If a shape is wrong, an index is out of range, a value is not finite, or `height` or `fps` is not
        positive.
    """
    V = check_clip(V, "V")
    mask = _check_contact(contact, len(V), len(feet))
    speeds = np.zeros(mask.shape)
    for f, vertices in enumerate(feet):
        index = as_indices(vertices, f"feet[{f}]", ("k",), limit=V.shape[1])
        velocity = sole_velocities(V[:, index], height, fps)
        speeds[:, f] = np.hypot(velocity[:, 0], velocity[:, 2])
    return float(100 * speeds[mask].mean() / height) if mask.any() else None


def _check_contact(contact: Any, T: int, n_feet: int) -> BoolArray:
    mask = np.asarray(contact)
    if mask.dtype != np.bool_ or mask.shape != (T, n_feet):
        raise ValueError(
            f"contact must be bool of shape ({T}, {n_feet}), got {mask.dtype} of shape {mask.shape}"
        )
    return mask
