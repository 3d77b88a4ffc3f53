"""Adjustments layered on a result: sorted by part, carried out from the body outwards, checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tempose.rotations import conjugate, from_rotation_vector, multiply, rotate, to_rotation_vector
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.curves import Key, make_layers, run_curve
from tempose.transfer.adjustments.layer import Layer
from tempose.transfer.adjustments.parts import HIPS, Part, find_part, follows
from tempose.transfer.facing import heading, yaw
from tempose.transfer.from_skeleton import Prepared
from tempose.typing import FloatArray, IntArray, Progress, silent

MISSED = 1e-5
"""A point further from its place than this share of the height did not get there."""


@dataclass
class _Group:
    """All adjustments of one part."""

    part: Part
    index: list[int] = field(default_factory=list[int])
    entries: list[Adjustment] = field(default_factory=list[Adjustment])
    keys: list[Key] = field(default_factory=list[Key])


@dataclass(frozen=True)
class _Check:
    """A place that was asked for."""

    name: str
    part: Part
    key: Key
    place: FloatArray | None
    """(3,) metres; None for a displacement, whose miss is known at once."""
    missed: float


def adjust_frames(
    job: Prepared,
    frames: FloatArray,
    adjustments: Sequence[Adjustment],
    fps: float,
    progress: Progress = silent,
) -> tuple[Prepared, dict[str, Any]]:
    """Lay adjustments over the frames of a job, in place.

    Parameters
    ----------
    job : Prepared
        The transfer.
    frames : (T, n, 3) float32
        Its placed frames, metres.
    adjustments : sequence of Adjustment
        What shall be different.
    fps : float
        Frames per second.
    progress : Progress
        Called with frames done.

    Returns
    -------
    job : Prepared
        With the adjusted rotations.
    report : dict
        ``keys``: part, frame and the distance by which each was missed; ``unmet``: those that were;
        ``frames_changed``.

    Raises
    ------
    ValueError
        If a part or frame does not exist, or two places are asked of one part in one frame.
    """
    layer = Layer.over(job, frames, progress)
    groups = _grouped(job, adjustments, len(frames), fps)
    checks: list[_Check] = []
    for group in sorted(groups, key=lambda g: _depth(job, g.part)):
        checks += _carry_out(layer, group)
    keys = [_found(layer, check) for check in checks]
    limit = MISSED * job.solver.mesh.height
    report = {
        "count": len(adjustments),
        "keys": keys,
        "unmet": [key for key in keys if key["distance_m"] > limit],
        "frames_changed": len(layer.changed),
    }
    return layer.adjusted_job(), report


def _found(layer: Layer, check: _Check) -> dict[str, Any]:
    distance = check.missed
    if check.place is not None:
        points = check.part.points(layer.frames[check.key.first : check.key.last + 1])
        distance = float(np.linalg.norm(points - check.place, axis=1).max())
    return {"part": check.name, "frame": check.key.first, "distance_m": round(distance, 9)}


def _grouped(job: Prepared, adjustments: Sequence[Adjustment], n_frames: int, fps: float) -> list[_Group]:
    groups: dict[Any, _Group] = {}
    for i, a in enumerate(adjustments):
        try:
            part = find_part(job, a.part)
            first = a.key(n_frames, fps)
            _check_possible(part, a)
        except ValueError as error:
            raise ValueError(f"adjustment {i}: {error}") from None
        last = min(n_frames - 1, first + round(a.hold * fps))
        group = groups.setdefault(part.name if isinstance(a.part, str) else a.part, _Group(part))
        group.index.append(i)
        group.entries.append(a)
        pinned = a.to is not None and last > first
        group.keys.append(Key(first, last, a.ease_in * fps, a.ease_out * fps, pinned, [len(group.keys)]))
    for group in groups.values():
        _check_agreement(group)
    return list(groups.values())


def _check_possible(part: Part, a: Adjustment) -> None:
    if a.turn is not None and part.bone is None and not part.whole:
        raise ValueError(f"{part.name} cannot be turned: no bone carries it")
    named = isinstance(a.part, str) and not part.whole
    if (a.move or a.to) and named and part.chain is None:
        raise ValueError(
            f"{part.name!r} hangs on the hips and cannot move by itself; turn it, or move 'hips'"
        )


def _check_agreement(group: _Group) -> None:
    placed = [(i, a, k) for i, a, k in zip(group.index, group.entries, group.keys) if a.to is not None]
    for n, (i, a, k) in enumerate(placed):
        for j, b, other in placed[n + 1 :]:
            meet = max(k.first, other.first)
            if meet <= min(k.last, other.last) and a.to != b.to:
                raise ValueError(
                    f"adjustments {i} and {j} contradict each other: {group.part.name!r} cannot be at "
                    f"{a.to} and at {b.to} in frame {meet}; leave one out or move it to another frame"
                )


def _depth(job: Prepared, part: Part) -> int:
    """Order in which parts are done: the body, then outwards, so that a hand finds its place last."""
    if part.whole:
        return -1
    if part.bone is None or job.bones is None:
        return 10**6
    depth, bone = 0, part.bone
    while (bone := int(job.bones.parents[bone])) >= 0:
        depth += 1
    return depth


def _carry_out(layer: Layer, group: _Group) -> list[_Check]:
    part = group.part
    feet = _feet(layer) if part.name == HIPS else []
    turns = _turns(layer, group)
    if turns.any():
        if part.whole:
            layer.turn_body(turns, part.points(layer.frames))
        else:
            layer.turn_part(part, turns)
    checks: list[_Check] = []
    if any(a.move or a.to for a in group.entries):
        base = part.points(layer.frames)
        offsets, active = _offsets(layer, group, base)
        wanted = base + offsets
        if part.whole:
            layer.shift_body(offsets)
            missed = np.zeros(len(wanted))
        else:
            follow = follows(part, group.entries[-1])
            missed = layer.shift_part(part, wanted, active, follow)
        checks = _checks(group, missed)
    return checks + _keep_feet(layer, group, feet, turns)


def _checks(group: _Group, missed: FloatArray) -> list[_Check]:
    checks: list[_Check] = []
    for n, (a, key) in enumerate(zip(group.entries, group.keys)):
        if a.move is None and a.to is None:
            continue
        later = any(
            key.last >= other.first and key.first <= other.last and b.move
            for b, other in list(zip(group.entries, group.keys))[n + 1 :]
        )
        place = np.array(a.to) if a.to is not None and not later else None
        worst = float(missed[key.first : key.last + 1].max())
        checks.append(_Check(group.part.name, group.part, key, place, worst))
    return checks


def _feet(layer: Layer) -> list[tuple[Part, FloatArray]]:
    """Feet and where they are before the pelvis moves."""
    bones = layer.job.bones
    names = [
        name for name in ("left_foot", "right_foot") if bones is not None and bones.find(name) is not None
    ]
    parts = [find_part(layer.job, name) for name in names]
    return [(part, part.points(layer.frames)) for part in parts if part.chain is not None]


def _keep_feet(
    layer: Layer, group: _Group, feet: list[tuple[Part, FloatArray]], turns: FloatArray
) -> list[_Check]:
    checks: list[_Check] = []
    for part, place in feet:
        if turns.any():
            layer.turn_part(part, -turns)
        active = np.flatnonzero(np.abs(part.points(layer.frames) - place).max(axis=1) > 0)
        missed = layer.shift_part(part, place, active, False)
        for key in group.keys:
            worst = float(missed[key.first : key.last + 1].max())
            checks.append(_Check(f"{part.name} (kept)", part, key, None, worst))
    return checks


def _turns(layer: Layer, group: _Group) -> FloatArray:
    """Rotation vector a frame, in the axes of the world, of all turns of a part."""
    total = np.zeros((len(layer.frames), 3))
    for own in (False, True):
        chosen = [n for n, a in enumerate(group.entries) if a.turn is not None and (a.axes == "part") == own]
        for run in (run for runs in make_layers([_copy(group.keys[n], n) for n in chosen]) for run in runs):
            curve = run_curve(run, lambda key, at: _turn_at(layer, group, key, at), len(total))
            if own and group.part.bone is not None:
                curve = rotate(layer.rotations[:, group.part.bone], curve)
            total = to_rotation_vector(multiply(from_rotation_vector(curve), from_rotation_vector(total)))
    return total


def _copy(key: Key, n: int) -> Key:
    return Key(key.first, key.last, key.before, key.after, False, [n])


def _turn_at(layer: Layer, group: _Group, key: Key, at: IntArray) -> FloatArray:
    total = np.array([1.0, 0, 0, 0])
    for n in key.members:
        turn = group.entries[n].rotation
        assert turn is not None
        if group.entries[n].axes == "body":
            frame = _heading(layer, key.first)
            turn = multiply(multiply(frame, turn), conjugate(frame))
        total = multiply(turn, total)
    return np.tile(to_rotation_vector(total), (len(at), 1))


def _offsets(layer: Layer, group: _Group, base: FloatArray) -> tuple[FloatArray, IntArray]:
    """Displacement of a part's point a frame, and the frames in which there is any."""
    path = np.array(base)
    chosen = [n for n, a in enumerate(group.entries) if a.move is not None or a.to is not None]
    keys = [Key(k.first, k.last, k.before, k.after, k.pinned, [n]) for n in chosen for k in [group.keys[n]]]
    for runs in make_layers(keys):
        before = np.array(path)

        def offsets(key: Key, at: IntArray, before: FloatArray = before) -> FloatArray:
            total = np.zeros((len(at), 3))
            for n in key.members:
                a = group.entries[n]
                if a.to is not None:
                    total = np.array(a.to) - before[at]
                elif a.move is not None:
                    total = total + rotate(_axes(layer, group.part, a, key.first), np.array(a.move))
            return total

        for run in runs:
            path = path + run_curve(run, offsets, len(path))
    return path - base, np.flatnonzero((path != base).any(axis=1))


def _axes(layer: Layer, part: Part, a: Adjustment, frame: int) -> FloatArray:
    if a.axes == "body":
        return _heading(layer, frame)
    if a.axes == "part" and part.bone is not None:
        return layer.rotations[frame, part.bone]
    return np.array([1.0, 0, 0, 0])


def _heading(layer: Layer, frame: int) -> FloatArray:
    """Turn about the vertical from the world's front to the body's."""
    if layer.job.bones is None:
        return np.array([1.0, 0, 0, 0])
    return yaw(heading(rotate(layer.rotations[frame, 0], np.array([0.0, 0, 1]))))
