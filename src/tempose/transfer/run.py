"""From source, target and pairs to a moving target with a report."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.transfer.from_mesh import prepare_mesh
from tempose.transfer.from_skeleton import Prepared, prepare_skeleton
from tempose.transfer.measures import (
    SHORT_QUATERNION,
    direction_measures,
    distortion_measures,
    foot_measures,
    soft_faces,
)
from tempose.transfer.pairs import Pairs
from tempose.transfer.placement import Placement, place_clip
from tempose.transfer.result import TransferResult
from tempose.transfer.skin_pairs import pairs_from_skin
from tempose.transfer.template import template_clip
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
    source_rest: SkeletonClip | Mesh | None = None,
    rest_frame: int | None = None,
    volume: float = 0.0,
    contacts: bool = True,
    measure: bool = True,
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
        Correspondences; from the target's skin weights if not given.
    mapping : dict of str to str, optional
        Source joint to body role, where the names do not tell.
    source_rest : SkeletonClip or Mesh, optional
        Where the source's reference pose stands, if not in the source.
    rest_frame : int, optional
        Frame of the reference pose, in `source_rest` or else in the source.
    volume : float, default 0
        Strength of the inner edges that hold the volume at bends.
    contacts : bool, default True
        Whether the root is moved so that feet in contact stand still.
    measure : bool, default True
        Whether the report holds measures; they cost about as much as the frames.
    progress : Progress
        Called with frames done.

    Returns
    -------
    TransferResult
        The moving target, in metres; its vertices, faces and rest are those of the target.

    Raises
    ------
    ValueError
        If the source is empty, pairs do not fit, or the target cannot be moved; the message says which.
    """
    clock = _Clock()
    mesh = target.mesh if isinstance(target, SkinnedMesh) else target
    _check_source(source, mesh)
    pairs = _checked_pairs(source, target, pairs, mapping)
    clock.lap("pairs")
    job = _prepare(source, mesh, pairs, mapping, source_rest, rest_frame, volume)
    clock.lap("set-up")
    V = _solve(job, progress)
    clock.lap("frames")
    placement = _place(job, V, source.fps, contacts)
    clip = MeshClip(V, mesh, source.fps, replace(mesh.source, fps=source.fps))
    clock.lap("placement")
    report: dict[str, Any] = {"warnings": list(job.warnings)}
    if measure:
        progress(len(V), len(V), "measures")
        report |= _measures(job, V, placement, source.fps)
        clock.lap("measures")
    report |= _facts(job, pairs, placement)
    report["seconds"] = clock.seconds | {"total": sum(clock.seconds.values())}
    return TransferResult(clip, pairs, report, _picture(source, job))


def _check_source(source: SkeletonClip | MeshClip, mesh: Mesh) -> None:
    if source.n_frames == 0:
        raise ValueError("source must have at least one frame, got none")
    if len(mesh.faces) < 2:
        raise ValueError(f"target must be a surface of at least 2 triangles, got {len(mesh.faces)}")
    if np.linalg.matrix_rank(mesh.vertices - mesh.vertices.mean(axis=0), tol=1e-6 * mesh.diagonal) < 3:
        raise ValueError("target must have volume, got a mesh whose vertices lie in one plane")


def _checked_pairs(
    source: SkeletonClip | MeshClip,
    target: Mesh | SkinnedMesh,
    pairs: Pairs | None,
    mapping: dict[str, str] | None,
) -> Pairs:
    mesh = target.mesh if isinstance(target, SkinnedMesh) else target
    if isinstance(source, MeshClip):
        if pairs is None:
            raise ValueError("a mesh that moves another needs pairs of faces or vertices; give a pairs file")
        if pairs.kind == "joints":
            raise ValueError("pairs of kind 'joints' need a skeleton as source, got a mesh clip")
        sizes = (len(source.faces), len(mesh.faces))
        if pairs.kind == "vertices":
            sizes = (source.vertices.shape[1], len(mesh.vertices))
        pairs.check(*sizes)
        return pairs
    if pairs is None:
        if not isinstance(target, SkinnedMesh):
            raise ValueError(
                "the target has no skin weights to take pairs from; give a pairs file "
                "(JSON) or the target's weights (.mhw)"
            )
        pairs = pairs_from_skin(source.skeleton, target, mapping)
    if pairs.kind != "joints":
        raise ValueError(f"pairs of kind {pairs.kind!r} need a mesh clip as source, got a skeleton")
    pairs.check(0, len(mesh.faces), source.skeleton.names)
    return pairs


def _prepare(
    source: SkeletonClip | MeshClip,
    mesh: Mesh,
    pairs: Pairs,
    mapping: dict[str, str] | None,
    rest: SkeletonClip | Mesh | None,
    rest_frame: int | None,
    volume: float,
) -> Prepared:
    if isinstance(source, SkeletonClip):
        if isinstance(rest, Mesh):
            raise ValueError("source_rest must be a motion clip of the same skeleton, got a mesh")
        return prepare_skeleton(
            source, mesh, pairs, mapping=mapping, rest_clip=rest, rest_frame=rest_frame, volume=volume
        )
    V_rest: FloatArray | None = None
    if isinstance(rest, SkeletonClip):
        raise ValueError("source_rest must be a mesh like the source, got a skeleton clip")
    if rest is not None:
        if rest.vertices.shape[0] != source.vertices.shape[1]:
            raise ValueError(
                f"source_rest must have the {source.vertices.shape[1]} vertices of the source, "
                f"got {rest.vertices.shape[0]}"
            )
        V_rest = rest.vertices
    elif rest_frame is not None:
        if not 0 <= rest_frame < source.n_frames:
            raise ValueError(f"source_rest must be a frame from 0 to {source.n_frames - 1}, got {rest_frame}")
        V_rest = np.asarray(source.vertices[rest_frame], dtype=np.float64)
    return prepare_mesh(source, mesh, pairs, rest=V_rest, volume=volume)


def _solve(job: Prepared, progress: Progress) -> FloatArray:
    T = len(job.rotations)
    V = np.zeros((T, len(job.solver.mesh.vertices), 3), dtype=np.float32)

    def receive(block: slice, frames: FloatArray) -> None:
        V[block] = frames
        progress(min(block.stop, T), T, "frames")

    job.solver.pose_blocks(job.rotations, receive)
    return V


def _place(job: Prepared, V: FloatArray, fps: float, contacts: bool) -> Placement:
    mesh = job.solver.mesh
    soles = [np.asarray(V[:, mine], dtype=np.float64) for mine in job.feet.vertices]
    ground = float(mesh.vertices[:, 1].min())
    placement = place_clip(
        job.anchor_path, soles, job.feet.contact, ground, mesh.height, job.leg_ratio, fps, contacts
    )
    V += placement.shift[:, None].astype(np.float32)
    return placement


def _measures(job: Prepared, V: FloatArray, placement: Placement, fps: float) -> dict[str, Any]:
    mesh = job.solver.mesh
    roles = job.bones.roles if job.bones else ()
    soft = soft_faces(mesh.faces, job.owner, roles) if any(roles) else None
    measures = distortion_measures(job.solver, V, job.rotations, soft)
    if job.bones and job.motion and job.target:
        measures |= direction_measures(job.bones, job.motion, job.target, job.solver, job.owner, V)
    ground = float(mesh.vertices[:, 1].min())
    measures |= foot_measures(job.feet, V, mesh.height, job.source_height, ground, fps)
    if measures["quaternion_norm_min"] < SHORT_QUATERNION:
        measures["warnings"] = [
            *job.warnings,
            "neighbouring marks turn against each other (shortest quaternion "
            f"{measures['quaternion_norm_min']:.2f}): look for a torn or collapsed place",
        ]
    return measures


def _facts(job: Prepared, pairs: Pairs, placement: Placement) -> dict[str, Any]:
    return {
        "pairs": {"count": len(pairs), "kind": pairs.kind, "origin": pairs.origin},
        "reference": job.chosen,
        "first_frame": job.first_frame,
        "links": len(job.solver.links.pairs),
        "scale": placement.scale,
        "scale_vertical": placement.scale_vertical,
        "scale_fitted": placement.fitted,
        "root_correction_m": placement.correction,
    }


def _picture(source: SkeletonClip | MeshClip, job: Prepared) -> MeshClip:
    if isinstance(source, MeshClip):
        return source
    assert job.bones and job.motion
    return template_clip(job.bones.names, job.motion, source.fps, source.name or "source")
