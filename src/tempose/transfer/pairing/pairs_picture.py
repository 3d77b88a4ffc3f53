"""Marked faces as something that can be looked at."""

from __future__ import annotations

import colorsys

import numpy as np

from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray

PLAIN = (0.72, 0.72, 0.74)
"""Colour of faces that nothing marks."""
_GOLDEN = 0.618033988749895


def mark_colors(pairs: Pairs, n_faces: int) -> FloatArray:
    """Colour the marked faces of a target, one colour a joint.

    Parameters
    ----------
    pairs : Pairs
        Of kind ``"joints"``.
    n_faces : int
        Faces of the target m.

    Returns
    -------
    (m, 3) ndarray
        sRGB from 0 to 1; joints that follow each other in the list differ much in hue.
    """
    colors = np.tile(PLAIN, (n_faces, 1))
    names = np.array(pairs.source)
    for i, name in enumerate(dict.fromkeys(pairs.source)):
        colors[pairs.target[names == name]] = colorsys.hsv_to_rgb((i * _GOLDEN) % 1, 0.75, 0.9)
    return colors


def bone_segments(pairs: Pairs) -> FloatArray:
    """Return the bones that pairs place inside the target.

    Parameters
    ----------
    pairs : Pairs
        Of kind ``"joints"``.

    Returns
    -------
    (b, 2, 3) ndarray
        Start and end of each, metres; none where the pairs name no places.
    """
    both = [(p, pairs.ends[name]) for name, p in pairs.joints.items() if name in pairs.ends]
    return np.array(both).reshape(-1, 2, 3)
