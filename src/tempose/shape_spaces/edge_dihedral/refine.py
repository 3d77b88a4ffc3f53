"""Gauss-Newton steps to the mesh whose lengths and dihedral angles are nearest to those wanted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from tempose.linalg import SparseCholesky
from tempose.linalg.ordering import nested_dissection
from tempose.shape_spaces.edge_dihedral.derivatives import NormalEquations
from tempose.shape_spaces.edge_dihedral.hinges import Hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals, normals
from tempose.typing import FloatArray, IntArray

_DAMPING = 1e-6
_HALVINGS = 5
_GAIN = 0.01


@dataclass(frozen=True, eq=False)
class Refined:
    """A mesh and how far its lengths and angles are from those wanted."""

    vertices: FloatArray
    """(n, 3) metres."""
    energy: float
    """Squared distance to the wanted coordinates, places left out."""
    n_iter: int
    """Steps taken."""
    converged: bool
    """Whether the last step gained less than 1 %."""


class Refinement:
    """Gauss-Newton on weighted lengths and angles; the pattern of its systems is ordered once.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    n : int
        Number of vertices.
    hinges : Hinges
        Of the faces.
    length_weights, angle_weights : (E,), (n_slots,) float
        Weights of the coordinates.

    References
    ----------
    .. [1] Fröhlich and Botsch, "Example-Driven Deformations Based on Discrete Shells", 2011.
    """

    def __init__(
        self, F: IntArray, n: int, hinges: Hinges, length_weights: FloatArray, angle_weights: FloatArray
    ) -> None:
        self.F, self.hinges = F, hinges
        self.length_weights, self.angle_weights = length_weights, angle_weights
        self.equations = NormalEquations(F, n, hinges)
        self._order: IntArray | None = None

    def residuals(
        self, V: FloatArray, lengths: FloatArray, dihedrals: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Compare a mesh with what is wanted.

        Parameters
        ----------
        V : (n, 3) float
            Vertices.
        lengths, dihedrals : (E,), (n_slots,) float
            Wanted.

        Returns
        -------
        of_lengths : (E,) ndarray
            Weighted differences.
        of_angles : (n_slots,) ndarray
            Weighted differences; whole turns do not count.
        """
        found, angles = lengths_and_dihedrals(V, self.F, self.hinges)
        away = angles - dihedrals
        away -= np.round(away / (2 * np.pi)) * (2 * np.pi)
        return (found - lengths) * self.length_weights, away * self.angle_weights

    def refine(
        self, V: FloatArray, lengths: FloatArray, dihedrals: FloatArray, steps: int, near: float = 0.0
    ) -> Refined:
        """Take steps as long as they help.

        Parameters
        ----------
        V : (n, 3) float
            Start.
        lengths, dihedrals : (E,), (n_slots,) float
            Wanted.
        steps : int
            Steps at most.
        near : float, default 0
            Distance to the wanted coordinates that is good enough.

        Returns
        -------
        Refined
            Never worse than the start.
        """
        r = self.residuals(V, lengths, dihedrals)
        energy = _energy(r)
        for k in range(steps):
            if energy <= near * near:
                return Refined(V, energy, k, True)
            move = self._step(V, r)
            X, found, trial = self._search(V, move, lengths, dihedrals, energy)
            if not trial < energy:
                return Refined(V, energy, k, True)
            V, r, before, energy = X, found, energy, trial
            if energy > (1 - _GAIN) * before:
                return Refined(V, energy, k + 1, True)
        return Refined(V, energy, steps, False)

    def _search(
        self, V: FloatArray, move: FloatArray, lengths: FloatArray, dihedrals: FloatArray, energy: float
    ) -> tuple[FloatArray, tuple[FloatArray, FloatArray], float]:
        X, r, trial = V, (V, V), np.inf
        for halving in range(_HALVINGS):
            X = V + 0.5**halving * move
            r = self.residuals(X, lengths, dihedrals)
            trial = _energy(r)
            if trial < energy:
                break
        return X, r, trial

    def _step(self, V: FloatArray, r: tuple[FloatArray, FloatArray]) -> FloatArray:
        hinges, equations = self.hinges, self.equations
        lengths, _ = lengths_and_dihedrals(V, self.F, hinges)
        slot = hinges.slot
        angles = equations.angle_gradients(V, normals(V, self.F, hinges), lengths)
        blocks, rhs = equations.system(
            (
                (equations.length_gradients(V, lengths), self.length_weights, r[0]),
                (angles, self.angle_weights[slot], r[1][slot]),
            )
        )
        # no length tells where the whole stands: a little is added everywhere, which also tames slivers
        scale = _DAMPING * np.trace(blocks[equations.diagonal], axis1=1, axis2=2).mean()
        blocks[equations.diagonal] += scale * np.eye(3)
        A = sp.bsr_array((blocks, equations.indices, equations.indptr)).tocsc()
        return SparseCholesky(A, order=self.order).solve(rhs.reshape(-1)).reshape(-1, 3)

    @property
    def order(self) -> IntArray:
        """Order of elimination, found when first needed."""
        if self._order is None:
            vertices = nested_dissection(self.equations.graph())
            self._order = (3 * vertices[:, None] + np.arange(3)).ravel()
        return self._order


def _energy(r: tuple[FloatArray, FloatArray]) -> float:
    return float(r[0] @ r[0] + r[1] @ r[1])
