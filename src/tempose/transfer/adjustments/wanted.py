"""What is wanted of a part in every frame: how it turns, where its point goes."""

from __future__ import annotations

import numpy as np

from tempose.rotations import (
    IDENTITY,
    conjugate,
    from_rotation_vector,
    multiply,
    rotate,
    to_rotation_vector,
)
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.curves import Key, make_layers, run_curve
from tempose.transfer.adjustments.groups import Group
from tempose.transfer.bodies.facing import heading, yaw
from tempose.typing import FloatArray, IntArray


def wanted_turns(group: Group, Q: FloatArray) -> FloatArray:
    """Sum the turns of a part through time.

    Parameters
    ----------
    group : Group
        Adjustments of one part.
    Q : (T, B, 4) float
        Rotations of the bones, the root's first.

    Returns
    -------
    (T, 3) ndarray
        Rotation vectors, axes of the world; exactly 0 outside all windows.
    """
    total = np.zeros((len(Q), 3))
    for own in (False, True):
        chosen = [n for n, a in enumerate(group.entries) if a.turn is not None and (a.axes == "part") == own]
        for run in (run for runs in make_layers([_copy(group.keys[n], n) for n in chosen]) for run in runs):
            curve = run_curve(run, lambda key, at: _turn_at(group, Q, key, at), len(total))
            if own and group.part.bone is not None:
                curve = rotate(Q[:, group.part.bone], curve)
            total = to_rotation_vector(multiply(from_rotation_vector(curve), from_rotation_vector(total)))
    return total


def wanted_swivel(group: Group, n_frames: int) -> FloatArray:
    """Sum the swivels of an elbow or knee through time.

    Parameters
    ----------
    group : Group
        Adjustments of one hand or foot.
    n_frames : int
        Number of frames T.

    Returns
    -------
    (T,) ndarray
        Radians about the line from the body outwards; exactly 0 outside all windows.
    """
    chosen = [n for n, a in enumerate(group.entries) if a.swivel is not None]
    name = group.part.name
    # outwards: an elbow points back and a knee ahead, and sides mirror each other
    sign = -1.0 if name.startswith("right_") != name.endswith(("foot", "toes")) else 1.0

    def angles(key: Key, at: IntArray) -> FloatArray:
        total = sum(float(group.entries[n].swivel or 0.0) for n in key.members)
        return np.full((len(at), 3), sign * np.radians(total))

    out = np.zeros(n_frames)
    for runs in make_layers([_copy(group.keys[n], n) for n in chosen]):
        for run in runs:
            out += run_curve(run, angles, n_frames)[:, 0]
    return out


def _copy(key: Key, n: int) -> Key:
    return Key(key.first, key.last, key.before, key.after, key.pinned, [n])


def _turn_at(group: Group, Q: FloatArray, key: Key, at: IntArray) -> FloatArray:
    total = IDENTITY
    for n in key.members:
        turn = group.entries[n].rotation
        assert turn is not None
        if group.entries[n].axes == "body":
            facing = _heading(Q, key.first)
            turn = multiply(multiply(facing, turn), conjugate(facing))
        total = multiply(turn, total)
    return np.tile(to_rotation_vector(total), (len(at), 1))


def wanted_offsets(group: Group, Q: FloatArray, base: FloatArray) -> tuple[FloatArray, IntArray]:
    """Sum the displacements of a part's point through time.

    Parameters
    ----------
    group : Group
        Adjustments of one part.
    Q : (T, B, 4) float
        Rotations of the bones, the root's first.
    base : (T, 3) float
        Where the point is, metres.

    Returns
    -------
    offsets : (T, 3) ndarray
        Metres; exactly 0 outside all windows.
    active : (k,) ndarray of int
        Frames in which there is any.
    """
    path = np.array(base)
    chosen = [n for n, a in enumerate(group.entries) if a.moves]
    keys = [_copy(group.keys[n], n) for n in chosen]
    for runs in make_layers(keys):
        before = np.array(path)

        def offsets(key: Key, at: IntArray, before: FloatArray = before) -> FloatArray:
            total = np.zeros((len(at), 3))
            for n in key.members:
                a = group.entries[n]
                if a.to is not None:
                    total = np.array(a.to) - before[at]
                elif a.move is not None:
                    total = total + rotate(_axes(group, Q, a, key.first), np.array(a.move))
            return total

        for run in runs:
            path = path + run_curve(run, offsets, len(path))
    return path - base, np.flatnonzero((path != base).any(axis=1))


def _axes(group: Group, Q: FloatArray, a: Adjustment, frame: int) -> FloatArray:
    if a.axes == "body":
        return _heading(Q, frame)
    if a.axes == "part" and group.part.bone is not None:
        return Q[frame, group.part.bone]
    return IDENTITY


def _heading(Q: FloatArray, frame: int) -> FloatArray:
    """Turn about the vertical from the world's front to the body's."""
    return yaw(heading(rotate(Q[frame, 0], np.array([0.0, 0, 1]))))
