"""What is said of skin weights that do not sum to one."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray

_ROUNDED = 0.02
"""Four weights of eight bits miss one by so much at most, and a little more."""


def weight_notes(sums: FloatArray) -> tuple[str, ...]:
    """Describe weights that had to be normalised.

    Parameters
    ----------
    sums : (n,) float
        What the weights of each vertex sum to in the file; 0 for a vertex bound to nothing.

    Returns
    -------
    tuple of str
        One sentence, or none where no sum misses one by more than rounding.
    """
    off = np.where(sums > 0, np.abs(sums - 1), 0.0)
    if off.max(initial=0.0) <= _ROUNDED:
        return ()
    v = int(off.argmax())
    return (
        f"The skin weights of {int((off > _ROUNDED).sum())} of {len(sums)} vertices did not sum to one and "
        f"were normalised; the furthest off summed to {sums[v]:.4g}, at vertex {v}.",
    )


def held_notes(sums: FloatArray) -> tuple[str, ...]:
    """Describe vertices of a skin without weights, which its first joint holds.

    Parameters
    ----------
    sums : (n,) float
        What the weights of each vertex sum to in the file.

    Returns
    -------
    tuple of str
        One sentence, or none where every vertex has weights.
    """
    bare = int((sums == 0).sum())
    if bare == 0:
        return ()
    return (
        f"{bare} of {len(sums)} vertices have no skin weights, which should sum to one; the first joint of "
        "their skin holds them.",
    )
