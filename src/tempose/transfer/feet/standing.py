"""Feet held in contact: displacements within reach of the legs, ready to be added frame by frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.transfer.feet.contacts import intervals
from tempose.transfer.feet.leg_spread import LegSpread, spread_legs
from tempose.transfer.feet.legs import Leg
from tempose.transfer.feet.reach import within_reach
from tempose.transfer.frames import gather
from tempose.transfer.solver.motion_transfer import MotionTransfer
from tempose.typing import BoolArray, FloatArray, IntArray

UNMET = 0.001
"""Metres: a foot that stays short of its place by less is where it shall be."""


@dataclass(frozen=True)
class Standing:
    """What is added to the frames so that feet stand still: small paths times a fixed basis."""

    paths: FloatArray
    """(T, f, 3) metres, displacement of each foot."""
    missing: FloatArray
    """(T, f) metres by which a foot stays short of its place because its leg does not reach."""
    stretch: FloatArray
    """(T, f) length of each leg over that when straight; NaN for one without joints."""
    ankles: FloatArray
    """(T, f, 3) metres: ankles in frames with the displacements, the anchor at its rest place."""
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

    def facts(self, contact: BoolArray, f: int, first_frame: int = 0) -> dict[str, Any]:
        """Say when a foot was held and what it cost.

        Parameters
        ----------
        contact : (T, f) bool
            Frames in which each foot was to be held.
        f : int
            Which foot.
        first_frame : int, default 0
            Number of the first of the T frames.

        Returns
        -------
        dict
            ``intervals`` ([first frame, first frame after it]), ``frames``, ``largest_cm`` (displacement),
            ``stretch`` (longest the leg becomes, over its length when straight; None without joints),
            ``unmet_frames`` and ``unmet_cm``: where the leg does not reach.
        """
        mine = contact[:, f]
        short = mine & (self.missing[:, f] > UNMET)
        stretch = self.stretch[:, f]
        return {
            "intervals": [[a + first_frame, b + first_frame] for a, b in intervals(mine)],
            "frames": int(mine.sum()),
            "largest_cm": float(100 * np.linalg.norm(self.paths[:, f], axis=1).max(initial=0.0)),
            "stretch": None if np.isnan(stretch).any() or len(stretch) == 0 else float(stretch.max()),
            "unmet_frames": [[a + first_frame, b + first_frame] for a, b in intervals(short)],
            "unmet_cm": float(100 * np.where(mine, self.missing[:, f], 0.0).max(initial=0.0)),
        }


def hold_standing(
    legs: tuple[Leg, ...], solver: MotionTransfer, V: FloatArray, paths: FloatArray
) -> Standing:
    """Limit the displacements of feet to what their legs reach and spread them.

    Parameters
    ----------
    legs : tuple of Leg
        One for each of the first of the f paths, or none.
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
    stretch, ankles = np.full(paths.shape[:2], np.nan), np.zeros(paths.shape)
    for f, leg in enumerate(legs):
        ankle = _point(V, leg.ankle)
        if leg.hip is not None and np.isfinite(leg.length):
            hip = _point(V, leg.hip)
            limited[:, f] = within_reach(hip, ankle, leg.length, paths[:, f])
            stretch[:, f] = np.linalg.norm(ankle + limited[:, f] - hip, axis=1) / leg.length
        ankles[:, f] = ankle + limited[:, f]
    missing = np.linalg.norm(limited - paths, axis=-1)
    legs = legs if np.abs(limited).max(initial=0.0) > 0 else ()
    mesh = solver.mesh
    spread = spread_legs(mesh.vertices, mesh.faces, legs, solver.links)
    return Standing(limited, missing, stretch, ankles, spread)


def _point(V: FloatArray, rows: tuple[IntArray, FloatArray]) -> FloatArray:
    return np.einsum("s,tsi->ti", rows[1][0], gather(V, rows[0][0]))
