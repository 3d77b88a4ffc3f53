"""A shape signal spanned by given poses instead of principal components (section 4.3 of the paper)."""

from __future__ import annotations

import numpy as np

from tempose.shape_spaces import ShapeSpace
from tempose.signals.shape.signal import ShapeSignal
from tempose.typing import FloatArray

_DEPENDENT = 1e-9
"""An example counts as a mixture of the others when this part of its distance to the first is left of it."""


def shape_from_examples(space: ShapeSpace, Q: FloatArray) -> ShapeSignal:
    """Return the affine hull of example poses, ``h_0 = q_0`` and ``h_j = q_j - q_0``.

    Parameters
    ----------
    space : ShapeSpace
        Where the meshes live.
    Q : (m + 1, d) float
        Example poses, encoded; the first is the reference pose.

    Returns
    -------
    ShapeSignal
        Its components are not orthonormal.

    Raises
    ------
    ValueError
        If there are fewer than two examples, or one is a mixture of the others.
    """
    if len(Q) < 2:
        raise ValueError(f"examples must hold two poses or more, got {len(Q)}")
    H = Q[1:] - Q[0]
    R = np.linalg.qr(H.T, mode="r")
    left = np.abs(np.diag(R)) if len(R) == len(H) else np.zeros(len(H))
    bad = np.flatnonzero(left <= _DEPENDENT * np.maximum(np.linalg.norm(H, axis=1), np.finfo(float).tiny))
    if len(bad):
        raise ValueError(
            f"examples must be independent poses: number {bad[0] + 1} (from 0) is a mixture of those "
            "before it; leave it out"
        )
    return ShapeSignal(space, Q[0], H)


def shape_coordinates(shape: ShapeSignal, Z: FloatArray) -> FloatArray:
    """Project encoded meshes on the subspace of a shape signal.

    Parameters
    ----------
    shape : ShapeSignal
        h.
    Z : (..., d) float
        Encoded meshes.

    Returns
    -------
    (..., m) ndarray
        The x with least ``|Z - h(x)|``: the normal equation ``H^T H X = H^T Y^T`` of section 4.3.
    """
    H = shape.components
    sides = (np.asarray(Z) - shape.mean) @ H.T
    return np.linalg.solve(H @ H.T, sides.reshape(-1, len(H)).T).T.reshape(sides.shape)


def orthonormal_basis(shape: ShapeSignal) -> FloatArray:
    """Return what makes distances of shape coordinates those of the shape space.

    Parameters
    ----------
    shape : ShapeSignal
        h.

    Returns
    -------
    (m, m) ndarray
        L with ``|x L| = |x H|`` for every x: poses are laid out and sites chosen by ``x L``, so that neither
        depends on which example is called the first.
    """
    H = shape.components
    return np.linalg.cholesky(H @ H.T)
