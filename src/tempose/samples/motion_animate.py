"""A body and its legs joined into a motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.clips import Skeleton
from tempose.rotations import conjugate, multiply, rotate
from tempose.samples.motion_clip import Body, BodyPose, SampleMotion, SolePoint
from tempose.samples.motion_curves import about
from tempose.samples.motion_legs import Leg, limb_roots
from tempose.samples.motion_limbs import aim_limb, hinge_rotations, limb_vector
from tempose.samples.motion_swings import leg_states
from tempose.typing import BoolArray, FloatArray


def pose_leg(skeleton: Skeleton, leg: Leg, states: FloatArray, pose: BodyPose) -> None:
    """Write the local rotations of a leg into a pose.

    Parameters
    ----------
    skeleton : Skeleton
        The joints.
    leg : Leg
        The leg.
    states : (T, 8) float
        Columns as in `STATE`.
    pose : BodyPose
        T poses of the body; its rotations of this leg are changed.
    """
    forward, outward, flexion, yaw, pitch, toe_bend, fold, knee = states.T
    limb, joints = leg.limb, leg.limb.joints
    direction = np.stack(
        [np.sin(outward), -np.cos(outward) * np.cos(forward), np.cos(outward) * np.sin(forward)], axis=1
    )
    vectors = limb_vector(limb, flexion, fold, forward)
    upright = about("y", pose.heading)
    lateral = rotate(about("y", pose.heading + knee), np.eye(3)[0])
    carrier = limb_roots(skeleton, limb, pose)[0]
    first = aim_limb(vectors, rotate(upright, direction), lateral)
    hinges = hinge_rotations(limb, flexion, fold, forward)
    pose.rotations[:, joints[0]] = multiply(conjugate(carrier), first)
    pose.rotations[:, joints[1:-1]] = hinges
    last = first
    for k in range(hinges.shape[1]):
        last = multiply(last, hinges[:, k])
    foot = multiply(about("y", pose.heading + yaw), about("x", pitch))
    pose.rotations[:, joints[-1]] = multiply(conjugate(last), foot)
    if leg.foot.toes is not None:
        pose.rotations[:, leg.foot.toes] = about("x", toe_bend)


def animate(
    skeleton: Skeleton, body: Body, legs: Sequence[Leg], times: FloatArray, fps: float, name: str
) -> SampleMotion:
    """Join a body and its legs into a motion.

    Parameters
    ----------
    skeleton : Skeleton
        The joints.
    body : Body
        Pose of everything else.
    legs : sequence of Leg
        The legs.
    times : (T,) float
        Seconds of each frame.
    fps : float
        Frames per second.
    name : str
        Name of the motion.

    Returns
    -------
    SampleMotion
        T frames.
    """
    pose = body(times)
    contacts: list[BoolArray] = []
    soles: list[SolePoint] = []
    for leg in legs:
        states, touching = leg_states(skeleton, leg, body, times)
        pose_leg(skeleton, leg, states, pose)
        contacts.append(touching)
        soles += [
            SolePoint(n, joint, (float(x), float(y), float(z))) for n, joint, (x, y, z) in leg.foot.soles
        ]
    return SampleMotion(
        skeleton,
        pose.rotations,
        pose.root_position,
        fps,
        name,
        soles=tuple(soles),
        contacts=np.concatenate(contacts, axis=1),
    )
