"""The bones of one frame at a time, from sums over the vertices that hold for every frame."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


@njit(cache=True)
def shared_moments(u1: FloatArray, bones: IntArray, weights: FloatArray, B: int) -> FloatArray:
    """Return ``sum_i w_ij w_ik u_i u_i^T`` for all pairs of bones.

    Parameters
    ----------
    u1 : (n, 4) float
        Rest vertices and a one.
    bones, weights : (n, K) int and float
        Bones of each vertex and their weights.
    B : int
        Number of bones.

    Returns
    -------
    (B, B, 4, 4) ndarray
        Zero for bones that share no vertex.
    """
    A = np.zeros((B, B, 4, 4))
    n, K = bones.shape
    for i in range(n):
        for a in range(K):
            if weights[i, a] == 0.0:
                continue
            for b in range(K):
                s = weights[i, a] * weights[i, b]
                if s != 0.0:
                    block = A[bones[i, a], bones[i, b]]
                    for p in range(4):
                        for q in range(4):
                            block[p, q] += s * u1[i, p] * u1[i, q]
    return A


@njit(cache=True)
def _nearest_rotation(X: FloatArray) -> FloatArray:
    U, _, Vt = np.linalg.svd(X)
    if np.linalg.det(U) * np.linalg.det(Vt) < 0:
        U[:, 2] = -U[:, 2]
    return U @ Vt


@njit(cache=True)
def sweep_bones(A: FloatArray, H: FloatArray, M: FloatArray, keep: float, sweeps: int) -> None:
    """Give each bone in turn its best rigid motion, the others held; all frames, edits M.

    Parameters
    ----------
    A : (B, B, 4, 4) float
        See `shared_moments`.
    H : (T, B, 4, 3) float
        ``sum_i w_ij u_i y_i^T`` a frame.
    M : (T, B, 3, 4) float
        Rotation and translation of every bone, edited.
    keep : float
        Pull towards the present rotation, as a part of the bone's moment: it settles turns that the vertices
        leave open (a bone that holds a line of them).
    sweeps : int
        How often round.

    Notes
    -----
    With the rest of the sum taken from the target this is weighted Procrustes: eqs. (8) to (11) of [1]_, in
    moments, so that its cost does not depend on the vertices.

    References
    ----------
    .. [1] Le and Deng, "Smooth Skinning Decomposition with Rigid Bones", SIGGRAPH Asia 2012.
    """
    T, B = M.shape[:2]
    h, X = np.zeros((4, 3)), np.zeros((3, 3))
    for t in range(T):
        for _ in range(sweeps):
            for j in range(B):
                own = A[j, j]
                mass = own[3, 3]
                if mass <= 1e-12:
                    continue
                h[:] = H[t, j]
                for k in range(B):
                    if k == j or A[j, k, 3, 3] == 0.0:
                        continue
                    for p in range(4):
                        for q in range(4):
                            for r in range(3):
                                h[p, r] -= A[j, k, p, q] * M[t, k, r, q]
                size = own[0, 0] + own[1, 1] + own[2, 2]
                size -= (own[0, 3] ** 2 + own[1, 3] ** 2 + own[2, 3] ** 2) / mass
                for p in range(3):
                    for r in range(3):
                        X[r, p] = h[p, r] - own[p, 3] * h[3, r] / mass + keep * size * M[t, j, r, p]
                R = _nearest_rotation(X)
                for r in range(3):
                    shift = h[3, r]
                    for p in range(3):
                        M[t, j, r, p] = R[r, p]
                        shift -= R[r, p] * own[p, 3]
                    M[t, j, r, 3] = shift / mass
