"""Residuals kept on a control mesh, and their modes at all vertices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from tempose.clips import SkinnedMesh
from tempose.detail.basis import DetailBasis
from tempose.detail.multiresolution.control import way_up
from tempose.typing import FloatArray, IntArray

_LARGEST = 32767


@dataclass(frozen=True, eq=False)
class CoarseBasis:
    """Modes at K control vertices, the mean at all n: it costs one mode and holds every fold that stays."""

    basis: DetailBasis
    """Modes at the control vertices."""
    mean: IntArray
    """(n, 3) int16, in the steps of the basis."""
    owner: IntArray
    """(n,) control vertex that each vertex went into; -1 for one without a face."""
    share: FloatArray
    """(n,) float32, its part of that control vertex."""

    def raised(self, skin: SkinnedMesh) -> DetailBasis:
        """Carry the modes up to all vertices.

        Parameters
        ----------
        skin : SkinnedMesh
            n vertices.

        Returns
        -------
        DetailBasis
            Modes at n vertices, in the same steps.
        """
        up = way_up(skin, self.down(len(self.basis.modes[0])))
        modes = np.stack(
            [self.mean, *(_whole(up @ mode) for mode in self.basis.modes[1:].astype(np.float64))]
        )
        return DetailBasis(modes, self.basis.step, self.basis.coordinates)

    def down(self, count: int) -> csr_matrix:
        """Return the way down.

        Parameters
        ----------
        count : int
            Number of control vertices K.

        Returns
        -------
        (K, n) csr_matrix
            Replayed collapses.
        """
        used = np.flatnonzero(self.owner >= 0)
        share = self.share[used].astype(np.float64)
        return csr_matrix((share, (self.owner[used].astype(np.int64), used)), (count, len(self.owner)))


def coarse_basis(basis: DetailBasis, mean: FloatArray, down: csr_matrix) -> CoarseBasis:
    """Note what a file needs of residuals on a control mesh.

    Parameters
    ----------
    basis : DetailBasis
        Modes at K control vertices.
    mean : (n, 3) float
        Mean residual at all vertices, metres.
    down : (K, n) csr_matrix
        Replayed collapses: no column holds more than one entry.

    Returns
    -------
    CoarseBasis
        In the digits of a file.
    """
    columns: Any = down.tocsc()
    starts: Any = columns.indptr
    n = len(starts) - 1
    owner, share = np.full(n, -1, dtype=np.int32), np.zeros(n, dtype=np.float32)
    used = np.diff(starts) > 0
    owner[used], share[used] = columns.indices, columns.data
    return CoarseBasis(basis, _whole(mean / basis.step), owner, share)


def _whole(values: FloatArray) -> IntArray:
    return np.clip(np.rint(values), -_LARGEST, _LARGEST).astype(np.int16)
