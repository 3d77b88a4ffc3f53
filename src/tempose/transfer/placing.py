"""Where every frame goes: the root's path and the feet's, from a few vertices of the solved frames."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose.metrics import foot_acceleration
from tempose.transfer.contacts import Intervals, given_contacts
from tempose.transfer.feet import Feet
from tempose.transfer.frames import gather
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.placement import Placement, place_clip
from tempose.transfer.standing import Standing, hold_standing
from tempose.typing import BoolArray, FloatArray

Contacts = bool | Intervals | BoolArray
"""Whether feet are held; or when, a foot's name to its intervals or one column a foot."""

_UNEVEN = 6e-4
"""Share of the height, a millimetre: soles that differ by less at rest both stand."""


@dataclass(frozen=True)
class Placed:
    """What is added to the solved frames."""

    placement: Placement
    """Path of the whole body."""
    standing: Standing
    """Displacements of the feet."""
    ground: float
    """Height of the ground, metres."""
    held: bool
    """Whether feet are held at all."""

    def add(self, V: FloatArray, frames: slice) -> None:
        """Put some frames in their places.

        Parameters
        ----------
        V : (K, n, 3) float
            Those frames as the solver left them; changed in place.
        frames : slice
            Which ones they are.
        """
        V += self.placement.shift[frames, None].astype(V.dtype)
        self.standing.add(V, frames)


def place_frames(job: Prepared, V: FloatArray, fps: float, hold: bool) -> Placed:
    """Find what is to be added to solved frames.

    Parameters
    ----------
    job : Prepared
        Source and target.
    V : (T, n, 3) float
        Solved frames, the anchor at its rest place.
    fps : float
        Frames per second.
    hold : bool
        Whether feet are held while they stand.

    Returns
    -------
    Placed
        Paths.
    """
    mesh, feet = job.solver.mesh, job.feet
    ground = float(mesh.vertices[:, 1].min())
    soles = [gather(V, mine) for mine in feet.vertices]
    levels = _uneven(feet, mesh.vertices, ground)
    levels += 0.0 if feet.levels is None else job.leg_ratio * feet.levels
    placement = place_clip(
        job.anchor_path, soles, feet.standing, ground, mesh.height, job.leg_ratio, fps, hold, levels
    )
    return Placed(placement, hold_standing(feet, job.solver, V, placement.feet), ground, hold)


def _uneven(feet: Feet, V_rest: FloatArray, ground: float) -> FloatArray:
    """By how much a sole that stands at rest lies higher than the other: rest shall give rest."""
    lows = np.array([V_rest[foot, 1].min() for foot in feet.vertices]) - ground
    return np.where(lows < _UNEVEN * np.ptp(V_rest[:, 1]), lows, 0.0)


def with_contacts(job: Prepared, contacts: Contacts, n_frames: int) -> Prepared:
    """Take the contacts that the user states instead of those found in the source.

    Parameters
    ----------
    job : Prepared
        Source and target.
    contacts : bool, mapping or (n_frames, f) bool
        What the user gave; a bool leaves those that were found.
    n_frames : int
        Frames of the source.

    Returns
    -------
    Prepared
        With these contacts to hold and to measure by.

    Raises
    ------
    ValueError
        See `given_contacts`.
    """
    if not isinstance(contacts, (Mapping, np.ndarray)):
        return job
    mask = given_contacts(contacts, job.feet.names, n_frames, job.first_frame)
    return replace(job, feet=replace(job.feet, contact=mask, held=mask))


def contact_facts(job: Prepared, placed: Placed, fps: float) -> dict[str, Any]:
    """Say which contacts were held, what it cost, and how hard the feet accelerate.

    Parameters
    ----------
    job : Prepared
        Source and target.
    placed : Placed
        How its frames were placed.
    fps : float
        Frames per second.

    Returns
    -------
    dict
        ``contacts``: a dict a foot, see `Standing.facts`, in frames of the source;
        ``foot_acceleration``: of the target's ankles over that of the source's times the ratio of leg
        lengths, ``rms`` and ``p99``; None where there is nothing to compare.
    """
    feet, standing = job.feet, placed.standing
    held = feet.standing if placed.held else np.zeros_like(feet.standing)
    ratio = None
    if feet.names and feet.legs and feet.ankles is not None:
        ankles = standing.ankles + placed.placement.shift[:, None]
        ratio = foot_acceleration(ankles, feet.ankles, job.leg_ratio, fps)
    return {
        "contacts": {name: standing.facts(held, f, job.first_frame) for f, name in enumerate(feet.names)},
        "foot_acceleration": None if ratio is None else {"rms": ratio.rms, "p99": ratio.p99},
    }


def contact_warnings(job: Prepared, placed: Placed) -> list[str]:
    """Say which contacts could not be held.

    Parameters
    ----------
    job : Prepared
        Source and target.
    placed : Placed
        How its frames were placed.

    Returns
    -------
    list of str
        One line for each kind of trouble.
    """
    if not placed.held:
        return []
    if not job.feet.names:
        return ["source and target share no feet: nothing is held, and the height is that of the hips"]
    told: list[str] = []
    for f, name in enumerate(job.feet.names):
        facts = placed.standing.facts(job.feet.standing, f, job.first_frame)
        if facts["unmet_frames"]:
            first, stop = facts["unmet_frames"][0]
            more = f" and {len(facts['unmet_frames']) - 1} more" if len(facts["unmet_frames"]) > 1 else ""
            told.append(
                f"{name} cannot reach where it should stand, by {facts['unmet_cm']:.1f} cm at most: "
                f"frames {first} to {stop - 1}{more}; state other contacts or hold none"
            )
    return told
