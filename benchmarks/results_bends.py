"""Hard bends and twists of the MakeHuman body: jumps, collapse and the volume of joints.

python benchmarks/results_bends.py            all, renews the table
python benchmarks/results_bends.py hand-twist one of them, prints its rows
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from real_bodies import person
from results_page import line, table, write_block
from tempose.clips import SkeletonClip
from tempose.kinematics import forward_kinematics
from tempose.kinematics.roles import find_roles
from tempose.rotations import conjugate, from_rotation_vector, multiply
from tempose.transfer import TransferResult, transfer_motion

COLUMNS = (
    "motion",
    "settings",
    "largest step / median",
    "shortest quaternion",
    "at",
    "volume there %",
    "thinnest radius there",
)
UP, SIDE = np.array([0, 0, 1.0]), np.array([1.0, 0, 0])
# joint that turns, axis (a vector or the bone it lies along), last degrees, degrees looked at, joint, limb
BENDS: dict[str, tuple[str, Any, float, tuple[float, ...], str, str]] = {
    "hand-twist": ("left_hand", "left_forearm", 360, (90, 170, 180), "left_forearm_middle", "left_forearm"),
    "arm-twist": ("left_upper_arm", "left_upper_arm", 360, (90, 170), "left_upper_arm", "left_upper_arm"),
    "shin-turned": ("left_shin", "left_shin", 350, (180,), "left_shin", ""),
    "arm-raise": ("left_upper_arm", UP, 130, (90, 130), "left_upper_arm", ""),
    "elbow": ("left_forearm", "hinge", 100, (100,), "left_forearm", ""),
    "knee": ("left_shin", SIDE, 120, (120,), "left_shin", ""),
    "hip": ("left_thigh", -SIDE, 120, (90, 120), "left_thigh", ""),
}
SETTINGS: dict[str, dict[str, Any]] = {
    "plain": {"twist": False, "singular": "none"},
    "path": {"twist": False, "singular": "path"},
    "default": {},
    "volume 1": {"volume": 1.0},
}
STEP = 5.0
_NEXT = {"left_upper_arm": "left_forearm", "left_forearm": "left_hand", "left_shin": "left_foot"}


def turning(joint: str, axis: Any, last: float) -> tuple[SkeletonClip, dict[str, str]]:
    """The body's own skeleton with one joint turned in the world, and what its joints are."""
    skeleton = person("makehuman").skeleton
    roles = find_roles(skeleton)
    rest = np.asarray(skeleton.rest_rotations)
    world, places = (x[0] for x in forward_kinematics(skeleton, rest[None], skeleton.offsets[:1]))

    def along(bone: str) -> np.ndarray:
        return places[roles[_NEXT[bone]]] - places[roles[bone]]

    if isinstance(axis, str):
        bent = axis == "hinge"
        axis = np.cross(along("left_upper_arm"), along("left_forearm")) if bent else along(axis)
        axis = axis / np.linalg.norm(axis)
    angle = np.radians(np.arange(0, last + 1e-9, STEP))
    j = roles[joint]
    above = world[skeleton.parents[j]]
    local = multiply(multiply(conjugate(above), from_rotation_vector(angle[:, None] * axis)), above)
    rotations = np.tile(rest, (len(angle), 1, 1))
    rotations[:, j] = multiply(local, rotations[:, j])
    path = np.tile(skeleton.offsets[0], (len(angle), 1))
    mapping = {skeleton.names[joint]: role for role, joint in roles.items()}
    return SkeletonClip(skeleton, rotations, path, 24.0), mapping


def radius(result: TransferResult, limb: str, t: int) -> float:
    """Mean radius of the cross-sections of a limb over that at rest, where it is thinnest."""
    job, rest = result.job, result.clip.rest
    b = job.bones.find(limb)
    start, axis, length = job.target.starts[b], job.target.directions[b], job.target.lengths[b]
    mine = np.isin(job.owner, [b, job.bones.find(_NEXT[limb])])
    along = (rest - start) @ axis / length
    ratios = []
    for s in np.arange(0.25, 1.0, 0.05):
        ring = mine & (np.abs(along - s) < 0.03)
        if ring.sum() < 6:
            continue
        size = []
        for V in (np.asarray(result.clip.vertices[t], dtype=float), rest):
            away = V[ring] - V[ring].mean(axis=0)
            away = away - (away @ axis)[:, None] * axis
            size.append(np.linalg.norm(away, axis=1).mean())
        ratios.append(size[0] / size[1])
    return min(ratios)


def rows(name: str) -> list[str]:
    joint, axis, last, looked, where, limb = BENDS[name]
    clip, mapping = turning(joint, axis, last)
    found: list[str] = []
    for label, options in SETTINGS.items():
        if label == "path" and last < 180:
            continue
        result = transfer_motion(
            clip,
            person("makehuman"),
            mapping=mapping,
            source_rest=clip,
            rest_frame=0,
            contacts=False,
            **options,
        )
        steps = np.linalg.norm(np.diff(result.clip.vertices, axis=0), axis=2).max(axis=1)
        frames = [round(degrees / STEP) for degrees in looked]
        lost = result.report["joint_volume"][where]["frames"]
        found.append(
            line(
                name,
                label,
                f"{steps.max() / np.median(steps):.2f}",
                f"{result.report['quaternion_norm_min']:.2f}",
                " / ".join(f"{degrees:g}°" for degrees in looked),
                " / ".join(f"{lost[t]:.1f}" for t in frames),
                " / ".join(f"{radius(result, limb, t):.2f}" for t in frames) if limb else "-",
            )
        )
        print(found[-1], flush=True)
    return found


def main(names: list[str]) -> None:
    found = [row for name in names or BENDS for row in rows(name)]
    if not names:
        write_block("bends", table(COLUMNS, found))


if __name__ == "__main__":
    main(sys.argv[1:])
