"""Adjustments laid over frames: carried out from the body outwards, then checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.curves import Key
from tempose.transfer.adjustments.groups import Group, group_by_part
from tempose.transfer.adjustments.layer import Layer
from tempose.transfer.adjustments.parts import HIPS, Part, find_part, follows
from tempose.transfer.adjustments.wanted import wanted_offsets, wanted_swivel, wanted_turns
from tempose.transfer.from_skeleton import Prepared
from tempose.typing import FloatArray, Progress, silent

MISSED = 1e-5
"""A point further from its place than this share of the height did not get there."""


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
    checks: list[_Check] = []
    for group in group_by_part(job, adjustments, len(frames), fps):
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


def _carry_out(layer: Layer, group: Group) -> list[_Check]:
    part = group.part
    feet = _feet(layer) if part.name == HIPS else []
    turns = wanted_turns(group, layer.rotations)
    if turns.any():
        if part.whole:
            layer.turn_body(turns, part.points(layer.frames))
        else:
            layer.turn_part(part, turns)
    checks: list[_Check] = []
    if any(a.moves or a.swivel is not None for a in group.entries):
        base = part.points(layer.frames)
        offsets, active = wanted_offsets(group, layer.rotations, base)
        wanted = base + offsets
        if part.whole:
            layer.shift_body(offsets)
            missed = np.zeros(len(wanted))
        else:
            swivel = wanted_swivel(group, len(wanted))
            active = np.union1d(active, np.flatnonzero(swivel))
            missed = layer.shift_part(part, wanted, active, follows(part, group.entries[-1]), swivel)
        checks = _checks(group, missed)
    return checks + _keep_feet(layer, group, feet, turns)


def _checks(group: Group, missed: FloatArray) -> list[_Check]:
    checks: list[_Check] = []
    for n, (a, key) in enumerate(zip(group.entries, group.keys)):
        if not a.moves:
            continue
        later = any(
            key.last >= other.first and key.first <= other.last and b.move is not None
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
    layer: Layer, group: Group, feet: list[tuple[Part, FloatArray]], turns: FloatArray
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
