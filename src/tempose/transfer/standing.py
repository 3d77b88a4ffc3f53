"""Feet held in contact: displacements within reach of the legs, ready to be added frame by frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.transfer.feet import Feet
from tempose.transfer.frames import gather
from tempose.transfer.leg_spread import LegSpread, spread_legs
from tempose.transfer.motion_transfer import MotionTransfer
from tempose.transfer.reach import within_reach
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Standing:
    """What is added to the frames so that feet stand still: small paths times a fixed basis."""

    paths: FloatArray
    """(T, f, 3) metres, displacement of each foot."""
    missing: FloatArray
    """(T, f) metres by which a foot stays short of its place because its leg does not reach."""
    stretch: FloatArray
    """(T, f) length of each leg over that when straight; NaN for one without joints."""
    spread: LegSpread
    """How each displacement is spread over its leg."""

    def add(self, V: FloatArray, frames: slice) -> None:
        """Displace the feet of some frames, in place.

        Parameters
        ----------
        V : (K, n, 3) float
            Those frames.
        frames : slice
            Which ones they are.
        """
        self.spread.add(V, self.paths[frames])


def hold_standing(feet: Feet, solver: MotionTransfer, V: FloatArray, paths: FloatArray) -> Standing:
    """Limit the displacements of the feet to what legs reach and spread them.

    Parameters
    ----------
    feet : Feet
        Feet of source and target.
    solver : MotionTransfer
        The target.
    V : (T, n, 3) float
        Frames without the displacements.
    paths : (T, f, 3) float
        Displacements wanted, metres.

    Returns
    -------
    Standing
        Displacements and what they cost; nothing to add for feet without legs.
    """
    limited = np.array(paths, dtype=np.float64)
    stretch = np.full(paths.shape[:2], np.nan)
    for f, leg in enumerate(feet.legs):
        if leg.hip is None or not np.isfinite(leg.length):
            continue
        hip, ankle = _point(V, leg.hip), _point(V, leg.ankle)
        limited[:, f] = within_reach(hip, ankle, leg.length, paths[:, f])
        stretch[:, f] = np.linalg.norm(ankle + limited[:, f] - hip, axis=1) / leg.length
    missing = np.linalg.norm(limited - paths, axis=-1)
    legs = feet.legs if np.abs(limited).max(initial=0.0) > 0 else ()
    mesh = solver.mesh
    return Standing(limited, missing, stretch, spread_legs(mesh.vertices, mesh.faces, legs, solver.links))


def _point(V: FloatArray, rows: tuple[IntArray, FloatArray]) -> FloatArray:
    return np.einsum("s,tsi->ti", rows[1][0], gather(V, rows[0][0]))
