"""Legs over time: planted while they stand, carried on smoothly while they swing.

A leg is described by eight curves (see `STATE`). In stance they follow from the planted foot and the
moving body; in swing splines bridge the gap, with the same velocity at both ends. As they hold the flexion of
the knee itself and not the place of the ankle, no joint snaps when the leg is nearly straight.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from tempose.clips import Skeleton
from tempose.samples.motion_clip import Body
from tempose.samples.motion_curves import bridge, jet
from tempose.samples.motion_feet import lowest_point, sole_contacts
from tempose.samples.motion_legs import Leg, limb_roots
from tempose.samples.motion_limbs import flexion_for_length, limb_vector
from tempose.samples.motion_stances import STATE, Stance, planted, standing_state
from tempose.typing import BoolArray, FloatArray, IntArray

STEP = 0.01
"""Distance of the samples from which the velocities at lift-off and landing are taken, in swings."""

WHIP = 3.0
"""Radians of flexion a swing: a stretched leg bends no faster as its foot leaves or meets the ground."""


def leg_states(skeleton: Skeleton, leg: Leg, body: Body, times: FloatArray) -> tuple[FloatArray, BoolArray]:
    """State of a leg over time.

    Parameters
    ----------
    skeleton : Skeleton
        The joints.
    leg : Leg
        With S sole points.
    body : Body
        What the leg hangs from.
    times : (T,) float
        Seconds.

    Returns
    -------
    states : (T, 8) ndarray
        Columns as in `STATE`.
    contacts : (T, S) ndarray of bool
        Which points of the foot stand on the ground.
    """
    states = np.zeros((len(times), len(STATE)))
    contacts = np.zeros((len(times), len(leg.foot.soles)), dtype=bool)
    swings = [
        (before, after, frames)
        for before, after in pairwise(leg.stances)
        if len(frames := np.flatnonzero((times > before.end) & (times < after.start)))
    ]
    stands = [
        (stance, frames)
        for stance in leg.stances
        if len(frames := np.flatnonzero((times >= stance.start) & (times <= stance.end)))
    ]
    into = STEP * np.arange(5)
    edges = [
        edge
        for a, b, _ in swings
        for edge in ((a, a.end - into * (b.start - a.end)), (b, b.start + into * (b.start - a.end)))
    ]
    known = _standing(skeleton, leg, body, [(stance, times[frames]) for stance, frames in stands] + edges)
    for (stance, frames), rows in zip(stands, known):
        states[frames] = rows
        contacts[frames] = sole_contacts(leg.foot, *stance.roll(times[frames]))
    ends = known[len(stands) :]
    height = limb_roots(skeleton, leg.limb, body(times))[1][:, 1]
    for k, (before, after, frames) in enumerate(swings):
        s = (times[frames] - before.end) / (after.start - before.end)
        edges_of_swing = _edge(ends[2 * k], -STEP), _edge(ends[2 * k + 1], STEP)
        states[frames] = bridge(s, *edges_of_swing, leg.via, leg.at)
        lift_foot(leg, states, frames, s, height[frames])
    return states, contacts


def _standing(
    skeleton: Skeleton, leg: Leg, body: Body, moments: list[tuple[Stance, FloatArray]]
) -> list[FloatArray]:
    """States at some times of some stances, all found in one call."""
    if not moments:
        return []
    feet = planted(leg.foot, moments)
    pose = body(feet.times)
    states = standing_state(leg.limb, feet, limb_roots(skeleton, leg.limb, pose)[1], pose.heading)
    return np.split(states, np.cumsum([len(when) for _, when in moments])[:-1])


def _edge(rows: FloatArray, step: float) -> FloatArray:
    """Value and velocity of the state as the foot leaves or meets the ground."""
    edge = jet(rows, step)
    column = STATE.index("flexion")
    edge[1, column] = np.clip(edge[1, column], -WHIP, WHIP)
    return edge


def lift_foot(leg: Leg, states: FloatArray, frames: IntArray, s: FloatArray, height: FloatArray) -> None:
    """Bend a swinging leg where its foot would come too near to the ground.

    Parameters
    ----------
    leg : Leg
        The leg.
    states : (T, 8) float
        Columns as in `STATE`; the flexion is changed in place.
    frames : (k,) int
        Frames of the swing.
    s : (k,) float
        Part of the swing gone by.
    height : (k,) float
        Height of the first joint of the limb, metres.
    """
    forward, outward, flexion, _, pitch, toe_bend, fold, _ = states[frames].T
    wanted = np.linalg.norm(limb_vector(leg.limb, flexion, fold, forward), axis=1)
    hump = (4.0 * s * (1.0 - s)) ** 2
    drop = lowest_point(leg.foot, pitch, toe_bend) - leg.clearance * hump
    allowed = (height + drop) / (np.cos(forward) * np.cos(outward))
    # a smooth minimum, so that the correction sets in without a jerk
    gap = wanted - allowed
    length = wanted - 0.5 * (gap + np.hypot(gap, leg.clearance * hump))
    states[frames, STATE.index("flexion")] = flexion_for_length(leg.limb, length, fold, forward)
