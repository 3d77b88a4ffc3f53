"""BVH (Biovision hierarchy): joints with Euler channels, one row of numbers a frame."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.formats._bvh_text import BvhJoint, BvhText, parse_bvh
from tempose.formats._motion_clip import Found, rate_from_period, to_clip
from tempose.formats._names import distinct
from tempose.formats.conventions import FormatError
from tempose.rotations import from_euler_degrees, multiply, rotate
from tempose.typing import FloatArray


def read_bvh(
    path: str | os.PathLike[str],
    *,
    up: str | None = None,
    unit: float | None = None,
    fps: float | None = None,
) -> SkeletonClip:
    """Read a BVH file.

    Parameters
    ----------
    path : path-like
        The file.
    up : str, optional
        Up axis of the file; guessed from where the feet are if not given.
    unit : float, optional
        Metres per unit of the file; guessed from the height if not given.
    fps : float, optional
        Frames per second; the file states them.

    Returns
    -------
    SkeletonClip
        T frames of J joints; rest (all channels zero) is the identity. What was guessed or unusual stands in
        `source`.

    Raises
    ------
    FormatError
        If the file is no BVH, is cut short or holds something other than numbers; the message names the line.

    Notes
    -----
    Position channels replace the offset of their joint. Bone lengths are constant here: where they move,
    the mean is kept and `source.notes` states the deviation. A root whose only child has position
    channels of its own (a still "reference" joint over hips that travel) is folded into that child.
    """
    path = Path(path)
    text = parse_bvh(path)
    notes = text.notes
    joints = text.joints
    rotations, places = _channels(text)
    _displacements(joints, places, notes)
    joints, rotations, places = _fold_root(joints, rotations, places, notes)
    root = places.pop(0, np.tile(joints[0].offset, (len(rotations), 1)).astype(np.float64))
    skeleton = _skeleton(joints, places, notes)
    rate = _rate(path, text, fps)
    found = Found(str(path), "bvh", rate, tuple(notes))
    return to_clip(skeleton, rotations, root, found, up=up, unit=unit, fps=fps)


def _channels(text: BvhText) -> tuple[FloatArray, dict[int, FloatArray]]:
    """Local rotations (T, J, 4), and positions (T, 3) of the joints that have position channels."""
    T = len(text.motion)
    rotations = np.tile([1.0, 0, 0, 0], (T, len(text.joints), 1))
    places: dict[int, FloatArray] = {}
    columns: dict[str, list[tuple[int, list[int]]]] = {}
    start = 0
    for j, joint in enumerate(text.joints):
        turns = [k for k, c in enumerate(joint.channels) if c.endswith("rotation")]
        order = "".join(joint.channels[k][0] for k in turns)
        columns.setdefault(order, []).append((j, [start + k for k in turns]))
        for k, channel in enumerate(joint.channels):
            if channel.endswith("position"):
                place = places.setdefault(j, np.tile(joint.offset, (T, 1)).astype(np.float64))
                place[:, "xyz".index(channel[0])] = text.motion[:, start + k]
        start += len(joint.channels)
    for order, members in columns.items():
        if order:
            angles = text.motion[:, np.array([c for _, c in members])]
            rotations[:, [j for j, _ in members]] = from_euler_degrees(angles, order)
    return rotations, places


def _displacements(joints: list[BvhJoint], places: dict[int, FloatArray], notes: list[str]) -> None:
    # some writers (MakeHuman's pose files) give every joint position channels that mean a
    # displacement: read as positions they would collapse all bones to a point
    inner = [j for j in places if j > 0]
    size = sum(np.abs(joints[j].offset).max() for j in inner)
    if not size or sum(np.abs(places[j]).max() for j in inner) > 0.01 * size:
        return
    for j in places:
        places[j] += joints[j].offset
    notes.append("Position channels of inner joints are zero: read as displacements from OFFSET.")


def _fold_root(
    joints: list[BvhJoint], rotations: FloatArray, places: dict[int, FloatArray], notes: list[str]
) -> tuple[list[BvhJoint], FloatArray, dict[int, FloatArray]]:
    children = [j for j, joint in enumerate(joints) if joint.parent == 0]
    if len(children) != 1 or 1 not in places or np.allclose(places[1], joints[1].offset, rtol=1e-3):
        return joints, rotations, places
    root, child = joints[0], joints[1]
    offset = (
        root.offset[0] + child.offset[0],
        root.offset[1] + child.offset[1],
        root.offset[2] + child.offset[2],
    )
    folded = [BvhJoint(child.name, -1, offset, child.channels, child.tip)]
    folded += [BvhJoint(j.name, j.parent - 1, j.offset, j.channels, j.tip) for j in joints[2:]]
    moved = {j - 1: place for j, place in places.items() if j > 0}
    moved[0] = places.get(0, np.asarray(root.offset)) + rotate(rotations[:, 0], places[1])
    turned = multiply(rotations[:, :1], rotations[:, 1:2])
    notes.append(f"Root {root.name!r} is folded into its child {child.name!r}, which travels.")
    return folded, np.concatenate([turned, rotations[:, 2:]], axis=1), moved


def _skeleton(joints: list[BvhJoint], places: dict[int, FloatArray], notes: list[str]) -> Skeleton:
    offsets = np.array([joint.offset for joint in joints], dtype=np.float64)
    size = float(np.linalg.norm(offsets, axis=1).sum())
    worst, who = 0.0, ""
    for j, place in places.items():
        offsets[j] = place.mean(axis=0)
        deviation = float(np.linalg.norm(place - offsets[j], axis=1).max())
        if deviation > worst:
            worst, who = deviation, joints[j].name
    if worst > 1e-4 * size:
        notes.append(f"Bone lengths vary, means are kept: largest deviation {worst:.4g} units at {who!r}.")
    # an end site on its own joint says that the length is unknown
    tips = np.array([joint.tip if any(joint.tip or ()) else (np.nan,) * 3 for joint in joints])
    parents = np.array([joint.parent for joint in joints])
    named = [joint.name for joint in joints]
    names = distinct(named)
    notes += [f"A second joint {old!r} is called {new!r}." for old, new in zip(named, names) if old != new]
    return Skeleton(names, parents, offsets, tips=tips)


def _rate(path: Path, text: BvhText, fps: float | None) -> float | None:
    if 1e-6 < float(text.frame_time) < 1e6:
        return rate_from_period(text.frame_time)
    if fps is None and len(text.motion) > 1:
        raise FormatError(f"{path}: expected a 'Frame Time:' above 0, found {text.frame_time}; pass fps")
    return None
