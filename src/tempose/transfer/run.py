"""From source, target and pairs to a moving target with a report."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.groups import group_by_part
from tempose.transfer.adjustments.on_result import adjust
from tempose.transfer.bodies.template import template_clip
from tempose.transfer.contact_report import contact_facts, contact_warnings
from tempose.transfer.frames import BLOCK, make_frames, release
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.lead import LEAD
from tempose.transfer.pairing.matching import Matched, match
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.placing import (
    Contacts,
    Placed,
    place_frames,
    with_contacts,
)
from tempose.transfer.preparing import prepare
from tempose.transfer.quality.measuring import add_measures
from tempose.transfer.result import TransferResult
from tempose.transfer.turns.references import Singular, choose_references
from tempose.typing import FloatArray, Progress, silent


@dataclass
class _Clock:
    seconds: dict[str, float] = field(default_factory=dict[str, float])
    _last: float = field(default_factory=time.perf_counter)

    def lap(self, stage: str) -> None:
        now = time.perf_counter()
        self.seconds[stage], self._last = now - self._last, now


def transfer_motion(
    source: SkeletonClip | MeshClip,
    target: Mesh | SkinnedMesh,
    pairs: Pairs | None = None,
    *,
    mapping: dict[str, str] | None = None,
    embed: bool = False,
    source_rest: SkeletonClip | Mesh | None = None,
    rest_frame: int | None = None,
    volume: float = 0.0,
    twist: bool = True,
    lead: float = LEAD,
    singular: Singular = "reference",
    contacts: Contacts = True,
    ground: float | None = None,
    measure: bool = True,
    adjustments: Sequence[Adjustment] = (),
    scratch: str | os.PathLike[str] | None = None,
    progress: Progress = silent,
) -> TransferResult:
    """Move a still mesh as a skeleton clip or another mesh moves.

    Parameters
    ----------
    source : SkeletonClip or MeshClip
        The motion.
    target : Mesh or SkinnedMesh
        What shall move, at rest.
    pairs : Pairs, optional
        Correspondences; from the target's skin weights if not given, or without weights from a human
        skeleton placed inside it.
    mapping : dict of str to str, optional
        Source joint to body role, where the names do not tell.
    embed : bool, default False
        Whether the target's own skin weights are left alone and a skeleton is placed inside it.
    source_rest : SkeletonClip or Mesh, optional
        Where the source's reference pose stands, if not in the source.
    rest_frame : int, optional
        Frame of the reference pose, in `source_rest` or else in the source.
    volume : float, default 0
        How much of the volume that bends cost is kept: 1 for all of it, by inner edges and by skin pushed out
        round shoulders, elbows, hips and knees.
    twist : bool, default True
        Whether forearms, upper arms and thighs take up the twist at their ends little by little.
    lead : float, default 0.6
        Share of the lag of limbs behind their bones that is made up for; 1 points them exactly where the
        source's point and stretches skin more.
    singular : {"reference", "path", "none"}, default "reference"
        What is done where a limb turns further than rotations can be interpolated: a previous frame becomes
        the reference pose, or shortest paths over the surface carry the rotation along.
    contacts : bool, mapping or (T, f) bool, default True
        Whether feet stand still, and on the ground, while they are in contact; or the contacts themselves, if
        not those found in the source: ``{"left_foot": [[0, 10], ...]}``, intervals of the source's frames
        [first, first after it], or one column a foot in the order of the report's ``contacts``.
    ground : float, optional
        Height of a plane on which feet stand and into which nothing sinks, metres; without it feet stand at
        the height of the target's lowest vertex, and only feet are kept from sinking.
    measure : bool, default True
        Whether the report holds measures; they cost several times as much as the frames.
    adjustments : sequence of Adjustment, optional
        Key-framed changes layered on the result (`adjust`), which then keeps the frames without them too.
    scratch : path-like, optional
        Folder for the frames, when they are too many for memory: the clip's vertices are then a memory map
        of a new file in it, which is yours to delete.
    progress : Progress
        Called with frames done.

    Returns
    -------
    TransferResult
        The moving target, in metres; its vertices, faces and rest are those of the target, stood up if it
        lies or its up axis was guessed wrong, which the report says.

    Raises
    ------
    ValueError
        If the source is empty, pairs do not fit, or the target cannot be moved; the message says which.
    """
    clock = _Clock()
    matched = match(source, target, pairs, mapping, embed)
    mesh = matched.mesh
    clock.lap("pairs")
    job = prepare(
        source,
        mesh,
        matched.pairs,
        mapping=mapping,
        rest=source_rest,
        rest_frame=rest_frame,
        volume=volume,
        twist=twist,
        lead=lead,
        singular=singular,
    )
    if singular == "reference":
        job = replace(job, references=choose_references(job.solver.spread, job.rotations))
    job = with_contacts(job, contacts, source.n_frames, ground)
    group_by_part(job, adjustments, len(job.rotations), source.fps)
    clock.lap("set-up")
    V = _solve(job, progress, scratch)
    clock.lap("frames")
    placed = _place(job, V, source.fps, contacts is not False)
    clip = MeshClip(V, mesh, source.fps, replace(mesh.source, fps=source.fps))
    release(V)
    clock.lap("placement")
    report: dict[str, Any] = {"warnings": [*matched.warnings, *job.warnings]}
    if measure and not adjustments:
        progress(len(V), len(V), "measures")
        add_measures(report, job, V, source.fps)
        clock.lap("measures")
    report |= _facts(job, matched, placed, source.fps)
    report["warnings"] += contact_warnings(job, placed)
    report["seconds"] = clock.seconds | {"total": sum(clock.seconds.values())}
    result = TransferResult(clip, matched.listed, report, _picture(source, job), job)
    return adjust(result, adjustments, measure=measure, scratch=scratch, progress=progress)


def _solve(job: Prepared, progress: Progress, scratch: str | os.PathLike[str] | None) -> FloatArray:
    T = len(job.rotations)
    V = make_frames(T, len(job.solver.mesh.vertices), scratch)

    def receive(block: slice, frames: FloatArray) -> None:
        V[block] = frames
        release(V)
        progress(min(block.stop, T), T, "frames")

    job.solver.pose_blocks(job.rotations, receive, job.references)
    return V


def _place(job: Prepared, V: FloatArray, fps: float, hold: bool) -> Placed:
    placed, pressed = place_frames(job, V, fps, hold), 0.0
    for block in _blocks(len(V)):
        pressed = max(pressed, placed.add(V[block], block))
        release(V)
    return replace(placed, pressed=pressed)


def _blocks(n_frames: int) -> list[slice]:
    return [slice(t, t + BLOCK) for t in range(0, n_frames, BLOCK)]


def _facts(job: Prepared, matched: Matched, placed: Placed, fps: float) -> dict[str, Any]:
    pairs, placement = matched.pairs, placed.placement
    return matched.facts | {
        "pairs": {"count": len(pairs), "kind": pairs.kind, "origin": pairs.origin},
        "reference": job.chosen,
        "first_frame": job.first_frame,
        "links": len(job.solver.links.pairs),
        "scale": placement.scale,
        "scale_vertical": placement.scale_vertical,
        "scale_fitted": placement.fitted,
        "root_correction_m": placement.correction,
        **contact_facts(job, placed, fps),
    }


def _picture(source: SkeletonClip | MeshClip, job: Prepared) -> MeshClip:
    if isinstance(source, MeshClip):
        return source
    assert job.bones and job.motion
    return template_clip(job.bones.names, job.motion, source.fps, source.name or "source")
