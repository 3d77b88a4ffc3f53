"""How many bones a clip needs."""

from __future__ import annotations

import numpy as np

from tempose.rigging.decomposition.decompose import arranged, search_part
from tempose.rigging.decomposition.growth import grow
from tempose.typing import FloatArray

_ABOVE = 1.2  # the error while bones are being added stands about this far above that of settled ones


def count_bones(
    frames: FloatArray,
    rest: FloatArray,
    tolerance: float = 1.5e-3,
    influences: int = 4,
    *,
    most: int = 40,
    seed: int = 0,
) -> int:
    """Count the bones that bring free bones and their weights within a tolerance.

    Parameters
    ----------
    frames : (T, n, 3) float
        Vertices in every frame.
    rest : (n, 3) float
        Vertices at rest.
    tolerance : float, default 1.5e-3
        Root mean square distance in diagonals of the rest mesh.
    influences : int, default 4
        Most bones that a vertex may follow.
    most : int, default 40
        Largest answer; a clip that would need more gets it.
    seed : int, default 0
        Where bones are tried is drawn.

    Returns
    -------
    int
        Number of bones, at least one.

    Raises
    ------
    ValueError
        If the tolerance is not positive.
    """
    if not tolerance > 0:
        raise ValueError(f"tolerance must be positive, got {tolerance}")
    problem, _ = arranged(frames, rest)
    rng = np.random.default_rng(seed)
    most = max(1, min(most, len(rest) // 3))
    part = problem.part(search_part(len(rest), rng))
    state, _ = grow(part, most, min(influences, most), rng, _ABOVE * tolerance)
    return state.n_bones
