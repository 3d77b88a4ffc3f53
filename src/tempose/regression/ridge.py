"""Ridge regression, as mixtures of what was observed."""

from __future__ import annotations

import numpy as np

from tempose.typing import FloatArray


class RidgeRegression:
    """Linear regression with a penalty on the squared slopes, for any number of outputs.

    Parameters
    ----------
    X : (T, P) float
        Inputs of the observations.

    Notes
    -----
    One factorisation serves all penalties and outputs: with centred inputs ``X = U s V^T`` the weights of a
    query x are ``x V s / (s^2 + penalty) U^T``.
    """

    def __init__(self, X: FloatArray) -> None:
        self.mean: FloatArray = np.mean(X, axis=0)
        U, s, Vt = np.linalg.svd(X - self.mean, full_matrices=False)
        self._U, self._s, self._Vt = U, s, Vt

    def weights(self, X: FloatArray, penalty: float) -> FloatArray:
        """Say how a prediction is mixed from the observations.

        Parameters
        ----------
        X : (Q, P) float
            Inputs.
        penalty : float
            On the squared slopes, in squared units of the input; above 0.

        Returns
        -------
        (Q, T) ndarray
            The predicted output is ``weights @ Y`` for centred outputs Y (T, d).
        """
        shrunk = self._s / (self._s**2 + penalty)
        return ((X - self.mean) @ self._Vt.T * shrunk) @ self._U.T

    @property
    def spread(self) -> float:
        """Sum of the variances of the inputs over the T observations: what penalties are measured by."""
        return float(np.square(self._s).sum() / max(len(self._U), 1))
