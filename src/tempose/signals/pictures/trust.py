"""How far a pose is from those of the clip: what is far was made up by extrapolation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.geometry import edge_list
from tempose.signals.pictures.region import curve_points
from tempose.signals.signals import Signals
from tempose.typing import FloatArray, IntArray

STRAIN, FAINTEST = 0.08, 0.16
"""Strain at which a picture has lost most of its strength, and what is left of one far away."""


@dataclass(frozen=True, eq=False)
class Trust:
    """The edge lengths that occur in a clip, and where its curve runs."""

    edges: IntArray
    """(E, 2) vertices of the edges."""
    shortest: FloatArray
    """(E,) logarithm of the least length in the clip, metres."""
    longest: FloatArray
    """(E,) logarithm of the greatest."""
    curve: FloatArray
    """(s, 2) samples of the curve in the pose plane."""
    radius: float
    """How far the curve is from its own middle, root mean square."""

    def strain(self, V: FloatArray) -> float:
        """Return by how much edges are longer or shorter than they ever are in the clip.

        Parameters
        ----------
        V : (n, 3) float
            A mesh, metres.

        Returns
        -------
        float
            Root mean square over the edges of the logarithm of the ratio, weighted by length; 0 where
            every edge has a length that occurs.
        """
        length = np.log(_lengths(V[None], self.edges)[0])
        beyond = np.maximum(np.maximum(length - self.longest, self.shortest - length), 0.0)
        weight = np.exp(0.5 * (self.shortest + self.longest))
        return float(np.sqrt((weight * beyond**2).sum() / weight.sum()))

    def strength(self, p: FloatArray, V: FloatArray) -> float:
        """Return how strongly a pose may be shown.

        Parameters
        ----------
        p : (2,) float
            Its place in the pose plane.
        V : (n, 3) float
            Its mesh, metres.

        Returns
        -------
        float
            1 on the curve, less with strain and with distance.
        """
        far = float(np.linalg.norm(self.curve - p, axis=1).min()) / self.radius
        return float(FAINTEST + (1 - FAINTEST) * np.exp(-self.strain(V) / STRAIN - 0.5 * far))


def make_trust(signals: Signals, most: int = 60) -> Trust:
    """Measure the edges of a clip.

    Parameters
    ----------
    signals : Signals
        A clip.
    most : int, default 60
        Frames looked at, evenly spread.

    Returns
    -------
    Trust
        For poses of this clip.
    """
    curve = curve_points(signals)[1]
    edges = edge_list(signals.mesh.faces)
    times = signals.times[np.unique(np.linspace(0, signals.n_frames - 1, most).round().astype(int))]
    V = signals.shape.vertices(signals.coordinates(times))
    lengths = np.log(_lengths(V, edges))
    radius = float(np.sqrt(np.square(curve - curve.mean(axis=0)).sum(axis=1).mean()))
    return Trust(edges, lengths.min(axis=0), lengths.max(axis=0), curve, max(radius, 1e-12))


def _lengths(V: FloatArray, edges: IntArray) -> FloatArray:
    length = np.linalg.norm(V[:, edges[:, 0]] - V[:, edges[:, 1]], axis=2)
    return np.maximum(length, 1e-9 * max(float(length.mean()), 1e-300))
