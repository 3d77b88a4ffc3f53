"""How far one clip is from another."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tempose.clips.blocks import read_block
from tempose.metrics._frames import block_slices, check_clip
from tempose.metrics._tails import UpperTail
from tempose.typing import FloatArray


@dataclass(frozen=True)
class ClipErrors:
    """Distance between two clips of one topology, in the measures the field uses."""

    rms: float
    """Root mean square of the vertex distances, in the unit of the clips (metres inside Tempose)."""
    rms_percent: float
    """`rms` in percent of the diagonal D."""
    p99_percent: float
    """99th percentile of the vertex distances of all frames, percent of D."""
    max_percent: float
    """Distance of the worst vertex of the worst frame, percent of D."""
    e_rms: float
    """E_RMS of Kavan et al. as coded by CraGL: ``1000 ||V - V'|| / sqrt(3 n T) * 2 / D``."""
    kg: float
    """Karni-Gotsman error in percent: distance against spread of `V` about each frame's centroid."""

    def as_dict(self) -> dict[str, float]:
        """Return the six numbers under the keys that reports use.

        Returns
        -------
        dict
            ``rms``, ``rms_percent``, ``p99_percent``, ``max_percent``, ``e_rms`` and ``kg``.
        """
        return asdict(self)


def compare(V: FloatArray, V2: FloatArray, D: float) -> ClipErrors:
    """Measure how far a clip is from the true one.

    Parameters
    ----------
    V : (T, n, 3) float
        The true clip; an array or a memory map, read in blocks of frames.
    V2 : (T, n, 3) float
        The clip to judge, in the same unit.
    D : float
        Diagonal of the bounding box of the rest mesh, same unit.

    Returns
    -------
    ClipErrors
        All zero if and only if the clips are equal.

    Raises
    ------
    ValueError
        If shapes differ, a clip is empty or holds NaN, or `D` is not positive.

    Notes
    -----
    ``kg`` divides by ``||V - mean_per_frame(V)||``; where that is zero (a single vertex) it is 0 for
    equal clips and infinite otherwise. All others are symmetric in `V` and `V2`.

    References
    ----------
    .. [1] Karni and Gotsman, "Compression of Soft-Body Animation Sequences", Computers & Graphics 28, 2004.
    .. [2] Kavan, Sloan and O'Sullivan, "Fast and Efficient Skinning of Animated Meshes", CGF 29, 2010.

    Examples
    --------
    >>> V = np.zeros((2, 4, 3))
    >>> compare(V, V + [0.0, 0.01, 0.0], D=2.0).rms_percent
    0.5
    """
    V, V2 = check_clip(V, "V"), check_clip(V2, "V2")
    if V.shape != V2.shape:
        raise ValueError(f"V2 must have the shape {V.shape} of V, got {V2.shape}: frames or vertices differ")
    T, n, _ = V.shape
    meter = ErrorMeter(T * n, D)
    for frames in block_slices(T, 3 * n):
        meter.add(read_block(V, frames, "V"), read_block(V2, frames, "V2"))
    return meter.errors


class ErrorMeter:
    """Measures a clip that comes in blocks of frames; `compare` is this over two clips.

    Parameters
    ----------
    count : int
        How many vertices will come in all, over all frames.
    D : float
        Diagonal of the bounding box of the rest mesh.

    Raises
    ------
    ValueError
        If `D` is not positive.
    """

    def __init__(self, count: int, D: float) -> None:
        self._count, self._D = count, _check_diagonal(D)
        self._squared, self._spread = 0.0, 0.0
        self._distances = UpperTail(count, 99)

    def add(self, V: FloatArray, V2: FloatArray) -> FloatArray:
        """Take in more frames.

        Parameters
        ----------
        V : (k, n, 3) float
            The next frames of the true clip.
        V2 : (k, n, 3) float
            Those of the clip to judge.

        Returns
        -------
        (k,) ndarray
            Mean squared distance of each frame.
        """
        squares = np.square(V - V2).sum(axis=2)
        self._squared += float(squares.sum())
        self._spread += float(np.square(V - V.mean(axis=1, keepdims=True)).sum())
        self._distances.add(np.sqrt(squares))
        return squares.mean(axis=1)

    @property
    def errors(self) -> ClipErrors:
        """The measures of what has come in, once all of it has."""
        return _assemble(self._squared, self._spread, self._distances, self._count, self._D)


def _assemble(squared: float, spread: float, distances: UpperTail, count: int, D: float) -> ClipErrors:
    rms = math.sqrt(squared / count)
    flat = math.inf if squared > 0 else 0.0
    return ClipErrors(
        rms=rms,
        rms_percent=100 * rms / D,
        p99_percent=100 * distances.percentile / D,
        max_percent=100 * distances.maximum / D,
        e_rms=1000 * rms / math.sqrt(3) * 2 / D,
        kg=100 * math.sqrt(squared / spread) if spread > 0 else flat,
    )


def _check_diagonal(D: Any) -> float:
    if not 0 < D < math.inf:
        raise ValueError(f"D must be the positive diagonal of the rest mesh's bounding box, got {D}")
    return float(D)
