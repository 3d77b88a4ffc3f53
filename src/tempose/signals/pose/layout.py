"""Places of the frames in the pose plane: multidimensional scaling with pinned frames."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh
from scipy.spatial.distance import pdist, squareform

from tempose._validate import as_floats, read_only
from tempose.signals.pose._descent import descend
from tempose.signals.pose.pins import Pins, check_pins
from tempose.typing import FloatArray, IntArray

_ROUNDING = 1e-7
"""Steps this short change the stress by less than its rounding."""


@dataclass(frozen=True, eq=False)
class LayoutResult:
    """Where multidimensional scaling put the frames."""

    positions: FloatArray
    """(n, 2) places p_i; those of pinned frames are bit for bit the places asked for."""
    stress: float
    """``sqrt(sum (delta - d)^2 / sum delta^2)``: 0 is perfect, .2 poor."""
    n_iter: int
    """Passes over all pairs."""
    converged: bool
    """Whether the last step was below the tolerance."""
    step: float
    """Root mean square of the last step, as part of the root mean square distance."""
    history: FloatArray
    """(s,) stress of every accepted step, from the start; it never rises."""
    warnings: tuple[str, ...] = ()
    """What the pins ask for that cannot be, with its measure."""

    def __post_init__(self) -> None:
        for name in ("positions", "history"):
            object.__setattr__(self, name, read_only(getattr(self, name)))


class PoseLayout:
    """Lays frames out in the plane so that distances there are those between poses.

    Parameters
    ----------
    distances : (n, n) float
        Target distances delta between the frames, symmetric, zero on the diagonal; any unit.

    Raises
    ------
    ValueError
        If the matrix is not square, not symmetric, negative, or not zero on its diagonal.

    Notes
    -----
    Minimises eq. (6) of [1]_ under fixed places by SMACOF [2]_: with unit weights and c fixed frames the
    inverse of ``V_ff = n I - 1 1^T`` is ``(I + 1 1^T / c) / n``, so that no matrix is ever solved. Steps
    are lengthened by the memory of L-BFGS; one that raises the stress is replaced by the plain one, which
    cannot.

    References
    ----------
    .. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with
       separate signals for time, pose and shape", Computer Graphics Forum 31, 2012.
    .. [2] Borg and Groenen, "Modern Multidimensional Scaling", second edition, Springer, 2005.
    """

    def __init__(self, distances: FloatArray) -> None:
        D = as_floats(distances, "distances", ("n", "n"))
        if D.shape[0] != D.shape[1] or len(D) == 0:
            raise ValueError(f"distances must have shape (n, n) with n >= 1, got {D.shape}")
        biggest = float(D.max())
        if D.min() < 0 or np.abs(np.diagonal(D)).max() > 1e-9 * biggest:
            raise ValueError("distances must be 0 on the diagonal and nowhere negative")
        if np.abs(D - D.T).max() > 1e-9 * biggest:
            raise ValueError(f"distances must be symmetric, they differ by {np.abs(D - D.T).max():.3g}")
        self.distances = read_only(D)
        self.scale = float(np.sqrt(np.square(D / (biggest or 1.0)).mean())) * biggest or 1.0
        # at unit scale no distance of two frames overflows when divided by that of two places
        self._unit = np.ascontiguousarray(D / self.scale)
        self._total = 0.5 * float(np.square(self._unit).sum()) or 1.0

    def start(self) -> FloatArray:
        """Return the layout of classical scaling, where iterations start.

        Returns
        -------
        (n, 2) ndarray
            For distances of points these are their first two principal coordinates; each axis has its
            largest entry positive.
        """
        n = len(self._unit)
        squared = np.square(self._unit)
        means = squared.mean(axis=0)
        gram = 0.5 * (means + means[:, None] - squared - squared.mean())
        if n <= 64:
            values, vectors = eigh(gram, subset_by_index=[max(n - 2, 0), n - 1])
        else:
            values, vectors = eigsh(gram, k=2, which="LA", v0=np.linspace(1.0, 2.0, n))
        P = np.zeros((n, 2))
        for axis, k in enumerate(np.argsort(-values)):
            column = vectors[:, k] * np.sqrt(max(values[k], 0.0))
            P[:, axis] = column * (1.0 if column[np.abs(column).argmax()] >= 0 else -1.0)
        return P * self.scale

    def solve(
        self,
        pins: Pins | None = None,
        start: FloatArray | None = None,
        *,
        tolerance: float = 1e-6,
        iterations: int = 1000,
    ) -> LayoutResult:
        """Find places of least stress.

        Parameters
        ----------
        pins : mapping of int to (2,) float, optional
            Frames kept at places.
        start : (n, 2) float, optional
            Where to start; classical scaling if left out, turned, mirrored and moved to fit the pins.
        tolerance : float, default 1e-6
            Stop once the root mean square step is below this part of the root mean square distance; below
            1e-7 rounding ends the search.
        iterations : int, default 1000
            Passes at most.

        Returns
        -------
        LayoutResult
            The places and how well they were found.

        Raises
        ------
        ValueError
            If the pins contradict the poses (see `check_pins`) or `start` has another shape.
        """
        frames, places, warnings = check_pins(pins or {}, self.distances)
        if start is None:
            P = self.start()
            P = congruence(P[frames], places)(P) if len(frames) else P
        else:
            P = np.array(as_floats(start, "start", (len(self._unit), 2)))
        return self._iterate(P, frames, places, tolerance, iterations, warnings)

    def drag(self, positions: FloatArray, pins: Pins, iterations: int = 5) -> FloatArray:
        """Follow pins that are being moved: a few steps from the places last shown.

        Parameters
        ----------
        positions : (n, 2) float
            The last places.
        pins : mapping of int to (2,) float
            Frames kept at places, the dragged one among them.
        iterations : int, default 5
            Passes over all pairs.

        Returns
        -------
        (n, 2) ndarray
            The next places; called again with the same pins they go on to the optimum.
        """
        return self.solve(pins, positions, iterations=iterations).positions

    def _iterate(
        self,
        P: FloatArray,
        frames: IntArray,
        places: FloatArray,
        tolerance: float,
        iterations: int,
        warnings: tuple[str, ...],
    ) -> LayoutResult:
        P[frames] = places
        z = np.ascontiguousarray(P.T / self.scale)
        free = np.delete(np.arange(len(P)), frames)
        stresses = np.zeros(max(iterations, 1))
        passes, accepted, step = descend(self._unit, z, free, tolerance, len(stresses), stresses)
        positions = z.T * self.scale
        positions[frames] = places
        history = np.sqrt(stresses[:accepted] / self._total)
        return LayoutResult(
            positions, float(history[-1]), passes, step <= max(tolerance, _ROUNDING), step, history, warnings
        )


def stress_of(P: FloatArray, distances: FloatArray) -> float:
    """Return how far distances in the plane are from given ones.

    Parameters
    ----------
    P : (n, 2) float
        Places.
    distances : (n, n) float
        Target distances.

    Returns
    -------
    float
        ``sqrt(sum (delta - d)^2 / sum delta^2)``, as in `LayoutResult`; 0 where all targets are 0.
    """
    lengths = squareform(distances, checks=False)
    total = float(np.square(lengths).sum())
    return float(np.sqrt(np.square(lengths - pdist(P)).sum() / total)) if total > 0 else 0.0


def congruence(P: FloatArray, Q: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return the turn, reflection and shift that brings places nearest to others.

    Parameters
    ----------
    P : (c, 2) float
        Places...
    Q : (c, 2) float
        ...and where they are to come, one or more.

    Returns
    -------
    callable
        Moves any (N, 2) places.
    """
    here, there = P.mean(axis=0), Q.mean(axis=0)
    U, _, Vt = np.linalg.svd((P - here).T @ (Q - there))
    turn = U @ Vt
    return lambda places: (places - here) @ turn + there
