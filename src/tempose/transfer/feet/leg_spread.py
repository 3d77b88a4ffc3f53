"""The displacement of a foot, spread over its leg: a fixed weight a vertex."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from tempose.geometry import weld
from tempose.linalg import harmonic_extension
from tempose.transfer.feet.legs import Leg
from tempose.transfer.solver.fabric import field_laplacian
from tempose.transfer.solver.links import ExtraEdges
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class LegSpread:
    """Which vertices follow each foot, and how much."""

    vertices: tuple[IntArray, ...]
    """One list a foot."""
    weights: tuple[FloatArray, ...]
    """1 on the foot, 0 where the leg begins, harmonic between."""

    def add(self, V: FloatArray, paths: FloatArray) -> None:
        """Displace the feet of some frames, in place.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames.
        paths : (T, f, 3) float
            Displacement of each foot, metres.
        """
        for f, (mine, weights) in enumerate(zip(self.vertices, self.weights)):
            V[:, mine] += (weights[:, None] * paths[:, f, None]).astype(V.dtype)


def spread_legs(V: FloatArray, F: IntArray, legs: Sequence[Leg], links: ExtraEdges) -> LegSpread:
    """Weigh the vertices of every leg.

    Parameters
    ----------
    V : (n, 3) float
        Target at rest, metres.
    F : (m, 3) int
        Faces.
    legs : sequence of Leg
        One a foot.
    links : ExtraEdges
        Links between the pieces of the welded mesh: a shoe that is a piece of its own follows its foot.

    Returns
    -------
    LegSpread
        Harmonic weights.
    """
    first, inverse = weld(V)
    V, F = V[first], inverse[F]
    n = len(V)
    copies = sp.csr_array(
        (np.ones(len(inverse)), (inverse, np.arange(len(inverse)))), shape=(n, len(inverse))
    )
    vertices: list[IntArray] = []
    weights: list[FloatArray] = []
    for leg in legs:
        free = np.zeros(n, dtype=bool)
        free[inverse[leg.limb]] = True
        free[inverse[leg.foot]] = False
        near = F[free[F].any(axis=1)]
        tied = free[links.pairs].any(axis=1)
        L = field_laplacian(V, near, ExtraEdges(links.pairs[tied], links.weights[tied]))
        follows = np.zeros(n)
        follows[inverse[leg.foot]] = 1.0
        known = np.flatnonzero(~free)
        follows = harmonic_extension(L, known, follows[known, None])[:, 0]
        on_all = copies.T @ follows
        mine = np.flatnonzero(on_all > 1e-6)
        vertices.append(mine)
        weights.append(np.clip(on_all[mine], 0.0, 1.0))
    return LegSpread(tuple(vertices), tuple(weights))
