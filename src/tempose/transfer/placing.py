"""Where every frame goes: the root's path and the feet's, from a few vertices of the solved frames."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.transfer.feet.contacts import Intervals, given_contacts
from tempose.transfer.feet.feet import Feet
from tempose.transfer.feet.foot_hold import FADE
from tempose.transfer.feet.ground_plane import find_arms, lift_above, lowest
from tempose.transfer.feet.legs import Leg
from tempose.transfer.feet.placement import Placement, place_clip
from tempose.transfer.feet.soles import FootFrames
from tempose.transfer.feet.standing import Standing, hold_standing
from tempose.transfer.from_skeleton import Prepared
from tempose.typing import BoolArray, FloatArray, IntArray

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
    solid: bool
    """Whether nothing may sink into the ground."""
    pressed: float = 0.0
    """Metres by which the deepest vertex was pressed flat on the ground."""

    def add(self, V: FloatArray, frames: slice) -> float:
        """Put some frames in their places.

        Parameters
        ----------
        V : (K, n, 3) float
            Those frames as the solver left them; changed in place.
        frames : slice
            Which ones they are.

        Returns
        -------
        float
            Metres by which the deepest vertex had to be pressed flat on the ground.
        """
        V += self.placement.shift[frames, None].astype(V.dtype)
        self.standing.add(V, frames)
        if not self.solid:
            return 0.0
        depth = self.ground - float(V[..., 1].min(initial=np.inf))
        np.maximum(V[..., 1], self.ground, out=V[..., 1])
        return max(depth, 0.0)


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
        Whether feet are held while they stand: on `Feet.ground`, else at the height of the lowest vertex at
        rest.

    Returns
    -------
    Placed
        Paths.
    """
    mesh, feet = job.solver.mesh, job.feet
    rest, solid = float(mesh.vertices[:, 1].min()), feet.ground is not None
    ground = rest if feet.ground is None else feet.ground
    arms = _arms(job) if solid and hold else ()
    soles = [FootFrames(V, mine) for mine in feet.vertices]
    levels = _uneven(feet, mesh.vertices, rest)
    levels += 0.0 if feet.levels is None else job.leg_ratio * feet.levels
    trunk = lowest(V, _trunk(len(mesh.vertices), (*feet.legs, *arms), hold)) if solid else None
    placement = place_clip(
        job.anchor_path, soles, feet.standing, ground, mesh.height, job.leg_ratio, fps, hold, levels, trunk
    )
    paths = placement.feet
    for arm in arms:
        lift = np.zeros((len(V), 1, 3))
        lift[:, 0, 1] = lift_above(lowest(V, arm.foot) + placement.shift[:, 1], ground, FADE * fps)
        paths = np.concatenate([paths, lift], axis=1)
    standing = hold_standing((*feet.legs, *arms), job.solver, V, paths)
    return Placed(placement, standing, ground, hold, solid)


def _arms(job: Prepared) -> tuple[Leg, ...]:
    if job.bones is None or job.target is None:
        return ()
    return find_arms(job.bones, job.target, job.owner, job.solver.mesh.vertices)


def _trunk(n: int, limbs: tuple[Leg, ...], hold: bool) -> IntArray:
    """Vertices that the root alone keeps above the ground; all of them where no foot is displaced."""
    free = np.zeros(n, dtype=bool)
    for limb in limbs if hold else ():
        free[limb.foot] = free[limb.limb] = True
    return np.arange(n) if free.all() else np.flatnonzero(~free)


def _uneven(feet: Feet, V_rest: FloatArray, ground: float) -> FloatArray:
    """By how much a sole that stands at rest lies higher than the other: rest shall give rest."""
    lows = np.array([V_rest[foot, 1].min() for foot in feet.vertices]) - ground
    return np.where(lows < _UNEVEN * np.ptp(V_rest[:, 1]), lows, 0.0)


def with_contacts(job: Prepared, contacts: Contacts, n_frames: int, ground: float | None = None) -> Prepared:
    """Take contacts and ground that the user states instead of those found.

    Parameters
    ----------
    job : Prepared
        Source and target.
    contacts : bool, mapping or (n_frames, f) bool
        What the user gave; a bool leaves those that were found.
    n_frames : int
        Frames of the source.
    ground : float, optional
        Height of a plane under the target, metres.

    Returns
    -------
    Prepared
        With these contacts to hold and to measure by.

    Raises
    ------
    ValueError
        If `ground` is not finite; else see `given_contacts`.
    """
    if ground is not None:
        if not np.isfinite(ground):
            raise ValueError(f"ground must be a height in metres, got {ground}")
        job = replace(job, feet=replace(job.feet, ground=float(ground)))
    if isinstance(contacts, bool):
        return job
    mask = given_contacts(contacts, job.feet.names, n_frames, job.first_frame)
    return replace(job, feet=replace(job.feet, contact=mask, held=mask))
