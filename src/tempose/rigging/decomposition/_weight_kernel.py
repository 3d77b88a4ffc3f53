"""The weights of one vertex at a time: a small convex problem on few bones, and which bones those are."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.typing import FloatArray, IntArray


@njit(cache=True)
def mixing_energy(E: FloatArray, S: IntArray, k: int, w: FloatArray) -> float:
    """Return ``w^T E w`` on the first k bones of S."""
    total = 0.0
    for a in range(k):
        for b in range(k):
            total += w[a] * w[b] * E[S[a], S[b]]
    return total


@njit(cache=True)
def _unconstrained(E: FloatArray, S: IntArray, k: int, L: FloatArray, z: FloatArray) -> None:
    """Write the minimiser of ``w^T E w`` with sum 1 (signs free) into z."""
    trace = 0.0
    for a in range(k):
        trace += abs(E[S[a], S[a]])
    ridge = 1e-12 * trace + 1e-300
    for a in range(k):
        for b in range(a + 1):
            value = E[S[a], S[b]]
            for c in range(b):
                value -= L[a, c] * L[b, c]
            if a == b:
                L[a, a] = np.sqrt(max(value + ridge, ridge))
            else:
                L[a, b] = value / L[b, b]
    for a in range(k):
        value = 1.0
        for c in range(a):
            value -= L[a, c] * z[c]
        z[a] = value / L[a, a]
    total = 0.0
    for a in range(k - 1, -1, -1):
        value = z[a]
        for c in range(a + 1, k):
            value -= L[c, a] * z[c]
        z[a] = value / L[a, a]
        total += z[a]
    for a in range(k):
        z[a] /= total


@njit(cache=True)
def convex_weights(E: FloatArray, S: IntArray, k: int, w: FloatArray, L: FloatArray, z: FloatArray) -> int:
    """Lower ``w^T E w`` over weights >= 0 of sum 1, by an active set that starts at w.

    A bone that leaves does not come back here: `choose_bones` sees which ones should.

    Parameters
    ----------
    E : (B, B) float
        Products of the residuals that each bone alone would leave.
    S : (K,) int
        Bones; the first k are in use. Edited: bones whose weight vanishes leave.
    k : int
        How many are in use.
    w : (K,) float
        Weights >= 0 of sum 1 to start from, edited.
    L, z : (K, K) and (K,) float
        Scratch.

    Returns
    -------
    int
        How many bones are left.
    """
    while k > 1:
        _unconstrained(E, S, k, L, z)
        step, leaves = 1.0, -1
        for a in range(k):
            if z[a] <= 0.0:
                reach = w[a] / (w[a] - z[a]) if w[a] > z[a] else 0.0
                if reach < step or leaves < 0:
                    step, leaves = reach, a
        for a in range(k):
            w[a] += step * (z[a] - w[a])
        if leaves < 0:
            return k
        total = 0.0
        for a in range(k - 1):
            if a >= leaves:
                S[a], w[a] = S[a + 1], w[a + 1]
            total += w[a]
        k -= 1
        for a in range(k):
            w[a] = w[a] / total if total > 0 else 1.0 / k
    w[0] = 1.0 if k == 1 else w[0]
    return k


@njit(cache=True)
def _inverse(E: FloatArray, S: IntArray, P: FloatArray) -> None:
    """Write the inverse of E on the bones of S (plus a hair on the diagonal) into P, by Gauss and Jordan."""
    K = len(S)
    ridge = 1e-300
    for a in range(K):
        ridge += 1e-12 * abs(E[S[a], S[a]])
    for a in range(K):
        for b in range(K):
            P[a, b] = E[S[a], S[b]]
        P[a, a] += ridge
    for a in range(K):
        pivot = max(P[a, a], ridge)
        P[a, a] = 1.0
        for c in range(K):
            P[a, c] /= pivot
        for b in range(K):
            if b != a:
                factor = P[b, a]
                P[b, a] = 0.0
                for c in range(K):
                    P[b, c] -= factor * P[a, c]


@njit(cache=True)
def _swap_bounds(E: FloatArray, S: IntArray, P: FloatArray, j: int, z: FloatArray, bound: FloatArray) -> None:
    """Write, for each place of S, the least energy that j in that place could reach with free signs.

    The inverse of E on S and j follows from P by bordering; leaving a bone out of it is a rank-one change.
    """
    K = len(S)
    schur, rest, total = E[j, j] * (1 + 1e-12), 1.0, 0.0
    for a in range(K):
        z[a] = 0.0
        for b in range(K):
            z[a] += P[a, b] * E[S[b], j]
            total += P[a, b]
        schur -= z[a] * E[S[a], j]
        rest -= z[a]
    schur = max(schur, 1e-12 * abs(E[j, j]) + 1e-300)
    total += rest * rest / schur
    for a in range(K):
        row = -z[a] * rest / schur
        for b in range(K):
            row += P[a, b]
        without = total - row * row / (P[a, a] + z[a] * z[a] / schur)
        bound[a] = 1.0 / without if without > 0 else 0.0


@njit(cache=True)
def _swap(
    E: FloatArray, S: IntArray, k: int, w: FloatArray, j: int, energy: float, spare: IntArray, F: FloatArray
) -> tuple[int, float]:
    """Put bone j in the place of the bone where that helps most; edits S and w if it helps at all."""
    K = len(S)
    best, place = energy * (1 - 1e-9), -1
    _swap_bounds(E, S, F[K + 2 :], j, F[K + 1], F[2 * K + 2])
    for out in range(k):
        if F[2 * K + 2, out] >= best:
            continue
        for a in range(k):
            spare[a], F[K, a] = S[a], w[a]
        spare[out] = j
        k2 = convex_weights(E, spare, k, F[K], F[:K], F[K + 1])
        e = mixing_energy(E, spare, k2, F[K])
        if e < best:
            best, place = e, out
    if place < 0:
        return k, energy
    S[place] = j
    k = convex_weights(E, S, k, w, F[:K], F[K + 1])
    return k, mixing_energy(E, S, k, w)


@njit(cache=True)
def choose_bones(
    E: FloatArray, S: IntArray, k: int, w: FloatArray, g: FloatArray, spare: IntArray, F: FloatArray
) -> tuple[int, float]:
    """Improve which bones hold a vertex, by adding and by exchanging, until no change of one bone helps.

    Parameters
    ----------
    E : (B, B) float
        Products of residuals.
    S, w : (K,) int and (K,) float
        Bones and weights, edited.
    k : int
        How many of them are in use, at least one.
    g, spare, F : (B,), (K,), (2 K + 3, K)
        Scratch.

    Returns
    -------
    k : int
        Bones in use.
    energy : float
        ``w^T E w``.

    Notes
    -----
    Bones are tried in order of descent, all of them: to try the few steepest only costs half of the accuracy.
    """
    K, B = len(S), len(E)
    k = convex_weights(E, S, k, w, F[:K], F[K + 1])
    energy = mixing_energy(E, S, k, w)
    for _ in range(4 * K):
        before, inverted = energy, False
        for j in range(B):
            g[j] = 0.0
            for a in range(k):
                g[j] += E[j, S[a]] * w[a]
        for _ in range(B):
            j = int(np.argmin(g))
            if g[j] >= energy * (1 - 1e-9):
                break
            g[j] = np.inf
            if k < K:
                S[k], w[k] = j, 0.0
                k = convex_weights(E, S, k + 1, w, F[:K], F[K + 1])
                energy = mixing_energy(E, S, k, w)
            else:
                if not inverted:
                    _inverse(E, S, F[K + 2 : 2 * K + 2])
                    inverted = True
                k, energy = _swap(E, S, k, w, j, energy, spare, F)
            if energy < before:
                break
        if energy >= before * (1 - 1e-9):
            break
    return k, energy


@njit(cache=True)
def weights_of_block(
    pairs: FloatArray, own: FloatArray, yy: FloatArray, bones: IntArray, weights: FloatArray
) -> FloatArray:
    """Improve the weights of many vertices.

    Parameters
    ----------
    pairs : (m, B (B + 1) / 2) float
        ``g_j . g_k`` for k <= j, where ``g_j`` is where bone j alone carries the vertex in all frames.
    own : (m, B) float
        ``g_j . y``, y where the vertex truly is.
    yy : (m,) float
        ``y . y``.
    bones, weights : (m, K) int and float
        What to start from, edited; a row of zero weights starts at the bone that fits best alone.

    Returns
    -------
    (m,) ndarray
        Squared distance left, over all frames.
    """
    m, B = own.shape
    K = bones.shape[1]
    E, g, F = np.zeros((B, B)), np.zeros(B), np.zeros((2 * K + 3, K))
    S, spare, w = np.zeros(K, np.int64), np.zeros(K, np.int64), np.zeros(K)
    left = np.zeros(m)
    for i in range(m):
        p, best = 0, 0
        for a in range(B):
            for b in range(a + 1):
                E[a, b] = E[b, a] = pairs[i, p] - own[i, a] - own[i, b] + yy[i]
                p += 1
            if E[a, a] < E[best, best]:
                best = a
        k = 0
        for a in range(K):
            if weights[i, a] > 0:
                S[k], w[k] = bones[i, a], weights[i, a]
                k += 1
        if k == 0:
            S[0], w[0], k = best, 1.0, 1
        k, energy = choose_bones(E, S, k, w, g, spare, F)
        for a in range(K):
            bones[i, a] = S[a] if a < k else 0
            weights[i, a] = w[a] if a < k else 0.0
        left[i] = max(energy, 0.0)
    return left
