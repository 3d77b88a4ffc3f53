"""Skin weights as colours: a hue for every joint, mixed as the weights mix."""

from __future__ import annotations

import colorsys

import numpy as np

from tempose.clips import Skeleton
from tempose.render.colors import to_linear, to_srgb
from tempose.typing import FloatArray

_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0


def weight_colors(weights: FloatArray, skeleton: Skeleton) -> FloatArray:
    """Mix a colour for every vertex.

    Parameters
    ----------
    weights : (n, J) float
        Skin weights.
    skeleton : Skeleton
        J joints.

    Returns
    -------
    (n, 3) ndarray
        sRGB, 0 to 1. Joints next to each other differ in hue; vertices bound to nothing are grey.
    """
    colors = joint_colors(skeleton)
    mixed = weights @ to_linear(colors)
    mixed += (1.0 - weights.sum(axis=1, keepdims=True)) * to_linear(np.full((1, 3), 0.5))
    return to_srgb(mixed)


def joint_colors(skeleton: Skeleton) -> FloatArray:
    """Choose a colour for every joint, far from those of its neighbours.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.

    Returns
    -------
    (J, 3) ndarray
        sRGB, 0 to 1; hues by the golden ratio, which never come close for joints numbered one after another.
    """
    found: list[tuple[float, float, float]] = []
    for j in range(skeleton.n_joints):
        hue, light = (0.08 + _GOLDEN * j) % 1.0, (0.62, 0.5)[j % 2]
        found.append(colorsys.hls_to_rgb(hue, light, 0.55))
    return np.array(found)
