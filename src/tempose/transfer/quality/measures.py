"""How good a transfer is: pose, distortion, volume, feet."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.geometry import weld
from tempose.metrics import direction_angles, edge_ratios, folded_percent, penetration, skate
from tempose.metrics import volume_change as change_of_volume
from tempose.transfer.bodies.bones import Bones, split_role
from tempose.transfer.bodies.joint_regressor import apply_regressor, regress_points
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.feet.feet import Feet
from tempose.transfer.frames import gather
from tempose.transfer.pairing.marks import RIGID_PARTS
from tempose.transfer.quality.flip_kernel import FlipCounter
from tempose.transfer.solver.motion_transfer import MotionTransfer
from tempose.transfer.turns.references import References
from tempose.typing import BoolArray, FloatArray, IntArray

LIMB_BONES = ("upper_arm", "forearm", "thigh", "shin")
SHORT_QUATERNION = 0.5
"""Below this length of the interpolated quaternion neighbouring marks contradict each other."""
_BLOCK = 16


def distortion_measures(
    solver: MotionTransfer,
    V: FloatArray,
    Q: FloatArray,
    faces: BoolArray | None,
    references: References | None = None,
) -> dict[str, Any]:
    """Measure the surface of a transferred clip.

    Parameters
    ----------
    solver : MotionTransfer
        What made it.
    V : (T, n, 3) float
        Its frames.
    Q : (T, B, 4) float
        The rotations it was given.
    faces : (m,) bool or None
        Faces that count for the edge ratios; parts that move rigidly would hide everything.
    references : References, optional
        Reference poses it was given beside the rest.

    Returns
    -------
    dict
        ``edge_ratio`` [p1, p99], ``edge_ratio_max``, ``flipped_percent`` and ``folded_percent`` (means over
        frames), ``volume`` (percent change a frame; None for a surface that encloses nothing),
        ``quaternion_norm_min``, and for every frame ``quaternion_norm`` with the ``quaternion_vertex`` that
        has it.
    """
    F, V_rest = solver.mesh.faces, solver.mesh.vertices
    ratios = edge_ratios(V, F, V_rest, faces=faces)
    flips = FlipCounter(F, V_rest)
    flipped, norms, where = np.zeros(len(V)), np.ones(len(V)), np.zeros(len(V), dtype=np.int64)
    for t in range(0, len(V), _BLOCK):
        q = solver.field(Q[t : t + _BLOCK], references, t)
        length = np.linalg.norm(q, axis=1)
        norms[t : t + _BLOCK], where[t : t + _BLOCK] = length.min(axis=0), length.argmin(axis=0)
        flipped[t : t + _BLOCK] = flips.percent(V[t : t + _BLOCK], q)
    return {
        "edge_ratio": [ratios.p1, ratios.p99],
        "edge_ratio_max": ratios.max,
        "flipped_percent": float(flipped.mean()),
        "folded_percent": float(folded_percent(V, F, V_rest).mean()),
        **_volume_measures(V, F, V_rest),
        "quaternion_norm_min": float(norms.min()),
        "quaternion_norm": norms,
        "quaternion_vertex": where,
    }


def _volume_measures(V: FloatArray, F: IntArray, V_rest: FloatArray) -> dict[str, Any]:
    # texture seams split a closed surface into open pieces: welded, it encloses its volume again
    first, inverse = weld(V_rest)
    try:
        volume = change_of_volume(V, first[inverse[F]], V_rest)
    except ValueError:  # a sheet encloses nothing
        return {"volume": None, "volume_worst": None, "volume_mean": None}
    return {
        "volume": [round(float(v), 4) for v in volume],
        "volume_worst": float(volume[np.abs(volume).argmax()]),
        "volume_mean": float(volume.mean()),
    }


def soft_faces(F: IntArray, owner: IntArray, roles: tuple[str, ...]) -> BoolArray | None:
    """Faces outside head, hands and feet.

    Parameters
    ----------
    F : (m, 3) int
        Faces.
    owner : (n,) int
        Bone of largest influence on each vertex.
    roles : tuple of str
        Role of each bone.

    Returns
    -------
    (m,) ndarray of bool or None
        None where nothing is left or no roles are known.
    """
    rigid = np.array([split_role(role)[1] in RIGID_PARTS for role in roles])
    soft: BoolArray = np.logical_not(rigid[owner[F]].any(axis=1))
    return soft if rigid.any() and soft.any() else None


def direction_measures(
    bones: Bones, source: BonePose, target: BonePose, solver: MotionTransfer, owner: IntArray, V: FloatArray
) -> dict[str, Any]:
    """Angle between source and target bones, the one measure that sees a wrong pose.

    Parameters
    ----------
    bones : Bones
        B bones.
    source : BonePose
        (T, B) source.
    target : BonePose
        (B,) target at rest.
    solver : MotionTransfer
        Whose mesh it is.
    owner : (n,) int
        Bone of largest influence on each vertex.
    V : (T, n, 3) float
        Transferred frames.

    Returns
    -------
    dict
        ``bone_direction_deg`` with ``mean`` and ``max`` over the limbs, and the mean a bone.
    """
    known: BoolArray = np.logical_and(target.lengths > 0, (source.lengths > 0).all(axis=0))
    limbs = [b for b, role in enumerate(bones.roles) if split_role(role)[1] in LIMB_BONES and known[b]]
    if not limbs:
        limbs = [b for b in range(len(bones.names)) if known[b] and bones.parents[b] >= 0]
    if not limbs:
        return {}
    rest = solver.mesh.vertices
    own = [_own_vertices(b, owner) for b in limbs]
    starts = apply_regressor(V, *regress_points(rest, target.starts[limbs], own))
    ends = apply_regressor(V, *regress_points(rest, target.ends[limbs], own))
    angles = direction_angles(source.directions[:, limbs], ends - starts)
    per_bone = {
        bones.roles[b] or bones.names[b]: round(float(angles[:, i].mean()), 3) for i, b in enumerate(limbs)
    }
    return {
        "bone_direction_deg": {"mean": float(angles.mean()), "max": float(angles.max()), "bones": per_bone}
    }


def _own_vertices(b: int, owner: IntArray) -> IntArray:
    mine = np.flatnonzero(owner == b)
    return mine if len(mine) else np.arange(len(owner))


def foot_measures(
    feet: Feet, V: FloatArray, height: float, source_height: float, ground: float, fps: float
) -> dict[str, Any]:
    """Measure sliding and sinking.

    Parameters
    ----------
    feet : Feet
        Feet of both.
    V : (T, n, 3) float
        Transferred, placed frames, metres.
    height, source_height : float
        Heights of target and source, metres.
    ground : float
        Height of the ground under the target.
    fps : float
        Frames per second.

    Returns
    -------
    dict
        ``skate`` and ``source_skate`` in percent of the height per second, ``penetration_cm`` at worst.
    """
    if not feet.names:
        return {"skate": None, "source_skate": None}
    points = [np.array([f]) for f in range(len(feet.names))]
    deep = penetration(V, height, ground)
    return {
        "skate": _foot_skate(feet, V, height, fps),
        "source_skate": skate(feet.trajectories, points, feet.contact, source_height, fps),
        "penetration_cm": deep.max_cm,
        "contact_frames": {name: int(feet.contact[:, f].sum()) for f, name in enumerate(feet.names)},
    }


def _foot_skate(feet: Feet, V: FloatArray, height: float, fps: float) -> float | None:
    # the feet of all frames are read once, some frames at a time: V may be a file
    used, place = np.unique(np.concatenate(feet.vertices), return_inverse=True)
    parts = np.split(place, np.cumsum([len(foot) for foot in feet.vertices])[:-1])
    return skate(gather(V, used), parts, feet.contact, height, fps)
