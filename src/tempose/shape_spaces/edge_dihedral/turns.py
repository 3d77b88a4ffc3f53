"""Rotations of the faces from the rotations between neighbours."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.geometry import edge_laplacian
from tempose.linalg import SparseCholesky
from tempose.shape_spaces.edge_dihedral.hinges import Hinges, walk
from tempose.typing import FloatArray

_SMALL = 1e-11
_GAIN = 1e-3
_CONSISTENT = 2e-3


@numba.njit(cache=True, nogil=True)
def _between(directions: Any, along: Any, faces: Any, sides: Any, angles: Any, M: Any) -> None:
    """``M = Rz(a) Rx(angle) Rz(-b)``: the second face's frame, seen from the first's."""
    for h in range(len(faces)):
        f, g, s, t = faces[h, 0], faces[h, 1], sides[h, 0], sides[h, 1]
        a = directions[f, s] if along[f, s] > 0 else directions[f, s] + math.pi
        b = directions[g, t] if along[g, t] > 0 else directions[g, t] + math.pi
        ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
        c, s_ = math.cos(angles[h]), math.sin(angles[h])
        M[h, 0, 0], M[h, 0, 1], M[h, 0, 2] = ca * cb + sa * c * sb, ca * sb - sa * c * cb, sa * s_
        M[h, 1, 0], M[h, 1, 1], M[h, 1, 2] = sa * cb - ca * c * sb, sa * sb + ca * c * cb, -ca * s_
        M[h, 2, 0], M[h, 2, 1], M[h, 2, 2] = -s_ * sb, s_ * cb, c


@numba.njit(cache=True, nogil=True)
def _carry(order: Any, over: Any, faces: Any, M: Any, R: Any) -> None:
    for k in range(len(order)):
        h, f = over[k], order[k]
        if h < 0:
            for i in range(3):
                for j in range(3):
                    R[f, i, j] = 1.0 if i == j else 0.0
        elif faces[h, 1] == f:
            p = faces[h, 0]
            for i in range(3):
                for j in range(3):
                    R[f, i, j] = R[p, i, 0] * M[h, 0, j] + R[p, i, 1] * M[h, 1, j] + R[p, i, 2] * M[h, 2, j]
        else:
            p = faces[h, 1]
            for i in range(3):
                for j in range(3):
                    R[f, i, j] = R[p, i, 0] * M[h, j, 0] + R[p, i, 1] * M[h, j, 1] + R[p, i, 2] * M[h, j, 2]


@numba.njit(cache=True, nogil=True)
def _mismatch(faces: Any, weights: Any, M: Any, R: Any, rhs: Any) -> float:
    """Right side of the step, and ``sum w (2 - 2 cos)`` of the angles by which neighbours disagree."""
    rhs[:] = 0.0
    total = 0.0
    P = np.zeros((3, 3))
    H = np.zeros((3, 3))
    for h in range(len(faces)):
        f, g = faces[h, 0], faces[h, 1]
        for i in range(3):
            for j in range(3):
                P[i, j] = R[f, i, 0] * M[h, 0, j] + R[f, i, 1] * M[h, 1, j] + R[f, i, 2] * M[h, 2, j]
        for i in range(3):
            for j in range(3):
                H[i, j] = P[i, 0] * R[g, j, 0] + P[i, 1] * R[g, j, 1] + P[i, 2] * R[g, j, 2]
        x, y, z = H[2, 1] - H[1, 2], H[0, 2] - H[2, 0], H[1, 0] - H[0, 1]
        sine = 0.5 * math.sqrt(x * x + y * y + z * z)
        cosine = 0.5 * (H[0, 0] + H[1, 1] + H[2, 2] - 1.0)
        scale = 0.5 * weights[h]
        # 1 - cosine without losing its digits
        total += weights[h] * (2 * sine * sine / (1 + cosine) if cosine > 0 else 2 * (1 - cosine))
        rhs[f, 0] -= scale * x
        rhs[f, 1] -= scale * y
        rhs[f, 2] -= scale * z
        rhs[g, 0] += scale * x
        rhs[g, 1] += scale * y
        rhs[g, 2] += scale * z
    return total


@numba.njit(cache=True, nogil=True)
def _turn(steps: Any, R: Any) -> None:
    """``R <- exp(step) R``, rows kept orthonormal."""
    for f in range(len(R)):
        x, y, z = steps[f, 0], steps[f, 1], steps[f, 2]
        angle = math.sqrt(x * x + y * y + z * z)
        w = math.cos(0.5 * angle)
        s = math.sin(0.5 * angle) / angle if angle > 1e-12 else 0.5
        x, y, z = s * x, s * y, s * z
        for j in range(3):
            a, b, c = R[f, 0, j], R[f, 1, j], R[f, 2, j]
            p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
            R[f, 0, j] = a + w * p + y * r - z * q
            R[f, 1, j] = b + w * q + z * p - x * r
            R[f, 2, j] = c + w * r + x * q - y * p


class FaceTurns:
    """Find rotations of all faces from those between neighbours; factorised once for a mesh.

    Parameters
    ----------
    hinges : Hinges
        Of m faces.
    weights : (H,) float
        Weight of each hinge, positive.

    Notes
    -----
    Minimises ``sum w |R_g - R_f M_fg|^2`` over rotations. A walk over the best hinges gives the start, exact
    where the angles belong to a mesh. Each step solves a Laplacian of the faces that never changes and
    bounds the second derivatives from above, so that no step goes up. Of numbers far from any mesh the
    descent from rest may end lower. Solved over all matrices with
    one face held, as is usual, the rotations shrink away from that face where the angles belong to no mesh.
    """

    def __init__(self, hinges: Hinges, weights: FloatArray) -> None:
        m = len(hinges.patch)
        self.hinges = hinges
        self.weights = np.ascontiguousarray(weights, dtype=np.float64)
        self.order, self.over = walk(hinges, self.weights)
        is_seed = np.zeros(m, dtype=bool)
        is_seed[self.order[self.over < 0]] = True
        self.free = np.flatnonzero(~is_seed)
        L = edge_laplacian(hinges.faces, self.weights, m)
        self.solver = SparseCholesky(L[self.free][:, self.free]) if len(self.free) else None
        self.at_rest: FloatArray | None = None

    def start_from(self, directions: FloatArray, dihedrals: FloatArray) -> None:
        """Remember a mesh as another start for numbers that belong to none.

        Parameters
        ----------
        directions : (m, 3) float
            Angle of each side to the first axis of its face, radians.
        dihedrals : (n_slots,) float
            Radians.
        """
        self.at_rest = self._walked(self._between_faces(directions, dihedrals))

    def rotations(
        self, directions: FloatArray, dihedrals: FloatArray, max_iter: int = 12
    ) -> tuple[FloatArray, float, int]:
        """Find the rotations.

        Parameters
        ----------
        directions : (m, 3) float
            Angle of each side to the first axis of its face, radians.
        dihedrals : (n_slots,) float
            Radians.
        max_iter : int, default 12
            Steps at most from each start.

        Returns
        -------
        rotations : (m, 3, 3) ndarray
            Columns: first axis, second axis, normal of each face; the identity at the seed of each patch.
        mismatch : float
            Root mean square of the angles by which neighbours disagree, radians.
        n_iter : int
            Steps taken.
        """
        M = self._between_faces(directions, dihedrals)
        R, energy, n_iter = self._descend(M, self._walked(M), max_iter)
        total = max(float(self.weights.sum()), 1e-300)
        if self.at_rest is not None and energy > _CONSISTENT**2 * total:
            # the walk heaps up the errors of numbers that belong to no mesh; rest may be the better start
            other, lower, more = self._descend(M, self.at_rest, max_iter)
            n_iter += more
            if lower < energy:
                R, energy = other, lower
        return R, math.sqrt(energy / total), n_iter

    def _between_faces(self, directions: FloatArray, dihedrals: FloatArray) -> FloatArray:
        hinges = self.hinges
        M = np.zeros((len(hinges.faces), 3, 3))
        angles = np.ascontiguousarray(dihedrals[hinges.slot], dtype=np.float64)
        _between(directions, hinges.along, hinges.faces, hinges.sides, angles, M)
        return M

    def _walked(self, M: FloatArray) -> FloatArray:
        R = np.zeros((len(self.hinges.patch), 3, 3))
        _carry(self.order, self.over, self.hinges.faces, M, R)
        return R

    def _descend(self, M: FloatArray, R: FloatArray, max_iter: int) -> tuple[FloatArray, float, int]:
        faces, rhs = self.hinges.faces, np.zeros((len(R), 3))
        energy = _mismatch(faces, self.weights, M, R, rhs)
        n_iter = 0
        while self.solver is not None and n_iter < max_iter:
            steps = np.zeros(rhs.shape)
            steps[self.free] = self.solver.solve(rhs[self.free])
            if np.abs(steps).max() < _SMALL:
                break
            moved = R.copy()
            _turn(steps, moved)
            before, trial = energy, _mismatch(faces, self.weights, M, moved, rhs)
            n_iter += 1
            if not trial < before:
                break
            R, energy = moved, trial
            if trial > (1 - _GAIN) * before:
                break
        return R, energy, n_iter
