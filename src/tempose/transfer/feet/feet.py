"""Feet: where the source's stand, and which vertices of the target are theirs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.metrics import detect_contacts
from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.feet.contacts import steady_contacts
from tempose.transfer.feet.legs import Leg, bone_leg
from tempose.typing import BoolArray, FloatArray, IntArray

NEAR_GROUND = 0.06
"""Share of the height below which something may be a foot."""
_STEP = 0.05


@dataclass(frozen=True)
class Feet:
    """The feet that source and target share."""

    names: tuple[str, ...]
    """f names."""
    trajectories: FloatArray
    """(T, f, 3) metres: the ball of each source foot."""
    vertices: tuple[IntArray, ...]
    """Vertices of each target foot."""
    contact: BoolArray
    """(T, f) whether the source foot is on the ground."""
    legs: tuple[Leg, ...] = ()
    """Leg of the target above each foot; none where the target at rest was not given."""
    ankles: FloatArray | None = None
    """(T, f, 3) metres: the ankle of each source foot, or its ball where no ankle is known."""
    held: BoolArray | None = None
    """(T, f) frames in which each foot is held; those of `contact` if not given."""
    levels: FloatArray | None = None
    """(f,) metres by which the ground under each source foot is higher than under the lowest."""
    ground: float | None = None
    """Height of a plane under the target that nothing sinks into, metres; None for no such plane."""

    @property
    def standing(self) -> BoolArray:
        """(T, f) frames in which each foot is held."""
        return self.contact if self.held is None else self.held


def bone_feet(
    bones: Bones,
    motion: BonePose,
    target: BonePose,
    owner: IntArray,
    height: float,
    fps: float,
    V: FloatArray | None = None,
) -> Feet:
    """Feet of bodies made of bones.

    Parameters
    ----------
    bones : Bones
        B bones.
    motion : BonePose
        (T, B) source.
    target : BonePose
        (B,) target at rest.
    owner : (n,) int
        Bone of largest influence on each target vertex.
    height : float
        Height of the source, metres.
    fps : float
        Frames per second.
    V : (n, 3) float, optional
        Target at rest, metres, from which its legs are found.

    Returns
    -------
    Feet
        By role; for other bodies the leaves of the tree that reach the ground. None if there are none.
    """
    found = [
        (group, ball, mine)
        for group, ball in _foot_groups(bones, target)
        if len(mine := np.flatnonzero(np.isin(owner, group)))
    ]
    if not found:
        return no_feet(len(motion.starts))
    balls = [motion.ends[:, ball] if ball == group[0] else motion.starts[:, ball] for group, ball, _ in found]
    trajectories = np.stack(balls, axis=1)
    ankles = np.stack([motion.starts[:, group[0]] for group, _, _ in found], axis=1)
    return Feet(
        tuple(bones.roles[group[0]] or bones.names[group[0]] for group, _, _ in found),
        trajectories,
        tuple(mine for _, _, mine in found),
        detect_contacts(trajectories, height, fps),
        () if V is None else tuple(bone_leg(bones, group, target, owner, V) for group, _, _ in found),
        ankles,
        steady_contacts([trajectories, ankles], height, fps),
        ground_levels(trajectories, height),
    )


def ground_levels(balls: FloatArray, height: float) -> FloatArray:
    """Find feet that stand on something: a box, a step, a table.

    Parameters
    ----------
    balls : (T, f, 3) float
        Trajectories of the source's feet, metres.
    height : float
        Height of the source, metres.

    Returns
    -------
    (f,) ndarray
        Metres above the lowest foot's ground; 0 within 5 % of the height, which is noise and thick soles.
    """
    low = np.percentile(balls[..., 1], 5, axis=0)
    above = low - low.min(initial=np.inf)
    return np.where(above > _STEP * height, above, 0.0)


def no_feet(n_frames: int) -> Feet:
    """Return the feet of a body that has none.

    Parameters
    ----------
    n_frames : int
        Number of frames T.

    Returns
    -------
    Feet
        Empty lists.
    """
    return Feet((), np.zeros((n_frames, 0, 3)), (), np.zeros((n_frames, 0), dtype=bool))


def _foot_groups(bones: Bones, target: BonePose) -> list[tuple[list[int], int]]:
    """Bones of each foot, and the one whose start (toes) or end (foot alone) touches the ground."""
    groups: list[tuple[list[int], int]] = []
    for side in ("left_", "right_"):
        foot, toes = bones.find(side + "foot"), bones.find(side + "toes")
        if foot is not None:
            groups.append(([foot] if toes is None else [foot, toes], foot if toes is None else toes))
        elif (shin := bones.find(side + "shin")) is not None:
            groups.append(([shin], shin))  # a skeleton that ends at the ankles
    if groups or any(bones.roles):
        return groups
    leaves = sorted(set(range(len(bones.names))) - {int(p) for p in bones.parents})
    low = target.starts[:, 1].min()
    reach = NEAR_GROUND * 2 * float(np.ptp(target.starts[:, 1]))
    return [([b], b) for b in leaves if target.starts[b, 1] < low + reach]


def flat_stance(bones: Bones, motion: BonePose, height: float, fps: float) -> BoolArray:
    """Tell when foot and toe bones lie flat: ankle and ball both on the ground.

    Parameters
    ----------
    bones : Bones
        B bones.
    motion : BonePose
        (T, B) source.
    height : float
        Height of the source, metres.
    fps : float
        Frames per second.

    Returns
    -------
    (T, B) ndarray of bool
        False for other bones.
    """
    flat = np.zeros(motion.starts.shape[:2], dtype=bool)
    for b, role in enumerate(bones.roles):
        if split_role(role)[1] != "foot":
            continue
        ends = np.stack([motion.starts[:, b], motion.ends[:, b]], axis=1)
        touching = detect_contacts(ends, height, fps)
        both = touching.all(axis=1)
        flat[:, b] = both if both.any() else touching[:, 1]
        toes = bones.find(role.replace("foot", "toes"))
        if toes is not None:
            flat[:, toes] = flat[:, b]
    return flat
