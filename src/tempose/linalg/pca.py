"""Principal components of few long vectors, by the small Gram matrix."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tempose._validate import as_floats
from tempose.typing import FloatArray

_SECOND_LOOK = 1e-3
"""Singular values below this part of the largest are found from a Gram matrix of their own: squares lose half
the digits, so the first one knows them, and the angles of their components, to 1e-10 only."""

_CERTAIN = 1e-5
"""Singular values above this part of the largest are no rounding, whatever is still to be found."""

_ROUNDING = 1e-14
"""Singular values below this part of the largest, or of the vectors themselves, are rounding."""


class PrincipalComponents(NamedTuple):
    """An orthonormal basis of vectors about their mean."""

    mean: FloatArray
    """(d,) mean of the vectors."""
    components: FloatArray
    """(r, d) orthonormal rows, the widest spread first."""
    coordinates: FloatArray
    """(n, r) of the vectors in that basis."""
    singular_values: FloatArray
    """(n,) all of them, descending; from r on what is left out. Of few components that suffice: values below
    1e-7 of the largest are uncertain."""


class GramPCA:
    """Principal components of n vectors in d >> n dimensions, as many of them as are asked for.

    The spread is known before any component is made, so that their number can be chosen by it.

    Parameters
    ----------
    Z : (n, d) float
        Vectors, n >= 1.

    Raises
    ------
    ValueError
        If the shape is another or a value is not finite.

    Notes
    -----
    With rows ``Y = Z - mean`` and ``Y Y^T = U s^2 U^T`` the components are ``U^T Y / s`` (section 3.1 of [1]_
    has the same from the singular value decomposition of Y). Small singular values come from Gram matrices
    of their own, of what Y has in their directions, so that all together span the vectors to rounding.

    References
    ----------
    .. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with
       separate signals for time, pose and shape", Computer Graphics Forum 31, 2012.
    """

    def __init__(self, Z: FloatArray) -> None:
        Z = as_floats(Z, "Z", ("n", "d"))
        if len(Z) == 0:
            raise ValueError(f"Z must hold one vector or more, got shape {Z.shape}")
        self.mean: FloatArray = Z.mean(axis=0)
        self._Y: FloatArray = Z - self.mean
        G = _gram(self._Y)
        self._squares: FloatArray = np.diagonal(G).copy()
        self._s, self._U = _descending(G)
        self._rounding = _ROUNDING * max(np.sqrt(len(Z)) * self._s[0], float(np.linalg.norm(Z)))
        self._s[self._s < self._rounding] = 0.0
        self._sharp = False

    @property
    def spread(self) -> FloatArray:
        """(n,) root of the squared sum along each component, descending; what is below 1e-7 is uncertain."""
        return self._s

    @property
    def singular_values(self) -> FloatArray:
        """(n,) the same to rounding, 0 from `rank` on."""
        self._sharpen()
        return self._s

    @property
    def rank(self) -> int:
        """Number of dimensions that the vectors span about their mean."""
        return int((self.singular_values > 0).sum())

    def at_most(self, m: int) -> int:
        """Return how many of the first components there are.

        Parameters
        ----------
        m : int
            Number asked for.

        Returns
        -------
        int
            `m`, or `rank` where that is less.
        """
        known = m == 0 or (m < len(self._s) and self._s[m - 1] > _CERTAIN * self._s[0])
        return m if known else min(m, self.rank)

    def left_out(self, m: int) -> FloatArray:
        """Return how far the vectors are from the span of the first components.

        Parameters
        ----------
        m : int
            Number of components, at most `rank`.

        Returns
        -------
        (n,) ndarray
            Squared distances.
        """
        rest = self._squares - np.square(self.coordinates(m)).sum(axis=1)
        if rest.min(initial=0.0) > _SECOND_LOOK**2 * self._squares.max(initial=0.0):
            return rest
        return np.square(self._U[:, m:] * self.singular_values[m:]).sum(axis=1)

    def coordinates(self, m: int) -> FloatArray:
        """Return the vectors in the first components.

        Parameters
        ----------
        m : int
            Number of components, at most `rank`.

        Returns
        -------
        (n, m) ndarray
            Coordinates; their columns are orthogonal and as long as the singular values.
        """
        self._sharpen_for(m)
        return self._U[:, :m] * self._s[:m]

    def components(self, m: int) -> FloatArray:
        """Return the first components.

        Parameters
        ----------
        m : int
            Number of components, at most `rank`.

        Returns
        -------
        (m, d) ndarray
            Orthonormal rows.
        """
        self._sharpen_for(m)
        s = self._s[:m]
        H = (self._U[:, :m] / s).T @ self._Y
        large = int((s >= _SECOND_LOOK * s[:1]).sum())
        if large < m:
            H[large:] = _orthonormal(H[large:], H[:large])
        return H

    def _sharpen_for(self, m: int) -> None:
        if m and self._s[m - 1] < _SECOND_LOOK * self._s[0]:
            self._sharpen()

    def _sharpen(self) -> None:
        """Find small singular values from Gram matrices of their own, of the rows in their directions."""
        if self._sharp:
            return
        s, U, first = self._s, self._U, 0
        while (small := _below(s, first)) < len(s):
            first, rows = small, U[:, small:].T @ self._Y
            s[first:], turn = _descending(_gram(rows))
            U[:, first:] = U[:, first:] @ turn
        s[s < self._rounding] = 0.0
        s[-1] = 0.0  # rows that sum to zero have one dimension less
        self._sharp = True


def gram_pca(Z: FloatArray, m: int | None = None) -> PrincipalComponents:
    """Find principal components of few long vectors.

    Parameters
    ----------
    Z : (n, d) float
        Vectors.
    m : int, optional
        At most so many components; all that the vectors span where left out.

    Returns
    -------
    PrincipalComponents
        Mean, components, coordinates and all singular values.

    Raises
    ------
    ValueError
        If `Z` has another shape or holds NaN, or `m` is negative.
    """
    if m is not None and m < 0:
        raise ValueError(f"m must be 0 or more, got {m}")
    pca = GramPCA(Z)
    r = pca.rank if m is None else pca.at_most(m)
    return PrincipalComponents(pca.mean, pca.components(r), pca.coordinates(r), pca.spread)


def _below(s: FloatArray, first: int) -> int:
    """Where ``s[first:]`` begins to be small beside its first value, unless that is rounding itself."""
    small = first + int((s[first:] >= _SECOND_LOOK * s[first]).sum())
    return small if small > first and s[first] > _ROUNDING * s[0] else len(s)


def _gram(A: FloatArray) -> FloatArray:
    return A @ A.T


def _descending(G: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Roots of the eigenvalues and eigenvectors, the largest first."""
    w, U = np.linalg.eigh(G)
    return np.sqrt(np.maximum(w[::-1], 0.0)), np.ascontiguousarray(U[:, ::-1])


def _orthonormal(A: FloatArray, B: FloatArray) -> FloatArray:
    """Rows of A, nearly orthonormal, made so, also against the orthonormal rows of B."""
    for _ in range(2):
        A = A - (A @ B.T) @ B
        L = np.linalg.cholesky(_gram(A))
        A = np.linalg.solve(L, A)
    return A
