"""A few frames, quickly, so that the effect of a changed pair is seen at once."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip, SkeletonClip
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.from_mesh import prepare_mesh
from tempose.transfer.from_skeleton import Prepared, prepare_skeleton
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.quality.measures import direction_measures, distortion_measures, soft_faces
from tempose.transfer.solver.fabric import Fabric, weave
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Preview:
    """The target in some frames of the source."""

    vertices: FloatArray
    """(k, n, 3) metres, pelvis (or marks) at its rest place."""
    frames: tuple[int, ...]
    """Which frames of the source."""
    report: dict[str, Any]
    """Distortion, volume and bone directions of these frames, as in the report of a transfer."""
    seconds: dict[str, float]
    """Of set-up, frames and measures."""
    fabric: Fabric
    """What does not depend on the pairs, for the next preview of the same target."""


def preview_pairs(
    source: SkeletonClip | MeshClip,
    target: Mesh,
    pairs: Pairs,
    frames: int | Sequence[int],
    *,
    rest: FloatArray | None = None,
    volume: float = 0.0,
    mapping: dict[str, str] | None = None,
    measure: bool = True,
    fabric: Fabric | None = None,
) -> Preview:
    """Pose the target by the given pairs in chosen frames of the source.

    Parameters
    ----------
    source : SkeletonClip or MeshClip
        The motion.
    target : Mesh
        At rest.
    pairs : Pairs
        As far as they are; must fit both.
    frames : int or sequence of int
        Frames of the source.
    rest : (n, 3) float, optional
        Reference pose of a mesh source.
    volume : float, default 0
        See `tempose.transfer.MotionTransfer`.
    mapping : dict of str to str, optional
        Source joint to body role.
    measure : bool, default True
        Whether to report measures.
    fabric : Fabric, optional
        That of the last preview of this very target: most of the set-up is then done.

    Returns
    -------
    Preview
        Poses and how good they are; nothing is placed on the ground.

    Raises
    ------
    ValueError
        If pairs do not fit or a frame does not exist.

    Notes
    -----
    Only the chosen frames of a mesh are read; of a skeleton every so many others are looked at too, which
    tell its reference pose.
    """
    began = time.perf_counter()
    chosen = [int(frames)] if isinstance(frames, (int, np.integer)) else [int(t) for t in frames]
    wrong = [t for t in chosen if not 0 <= t < source.n_frames]
    if wrong or not chosen:
        raise ValueError(f"frames must be from 0 to {source.n_frames - 1}, got {wrong or chosen}")
    if fabric is None or fabric.mesh is not target:
        fabric = weave(target)
    if isinstance(source, SkeletonClip):
        pairs.check(0, len(target.faces), source.skeleton.names)
        job, rows = _of_skeleton(source, fabric, pairs, chosen, volume, mapping)
    else:
        n = (source.vertices.shape[1], len(target.vertices))
        pairs.check(*(n if pairs.kind == "vertices" else (len(source.faces), len(target.faces))))
        part = replace(source, vertices=source.vertices[chosen])
        job = prepare_mesh(part, target, pairs, rest=rest, volume=volume, fabric=fabric)
        rows = np.arange(len(chosen))
    ready = time.perf_counter()
    Q = job.rotations[rows]
    V = job.solver.pose(Q)
    posed = time.perf_counter()
    report = _measures(job, V, Q, rows) if measure else {}
    seconds = {"set-up": ready - began, "frames": posed - ready, "measures": time.perf_counter() - posed}
    return Preview(V, tuple(chosen), report, seconds, fabric)


_CONTEXT = 60


def _of_skeleton(
    source: SkeletonClip,
    fabric: Fabric,
    pairs: Pairs,
    chosen: list[int],
    volume: float,
    mapping: dict[str, str] | None,
) -> tuple[Prepared, np.ndarray]:
    """Prepare a thinned clip; frame 0 stays, because it often is the rest pose."""
    step = max(1, source.n_frames // _CONTEXT)
    kept = np.union1d(np.arange(0, source.n_frames, step), chosen)
    thin = replace(source.frames(kept), fps=source.fps / step)
    job = prepare_skeleton(thin, fabric.mesh, pairs, mapping=mapping, volume=volume, fabric=fabric)
    rows = np.searchsorted(kept, chosen) - job.first_frame
    # a chosen frame that was taken for the rest pose is no motion: the first of the motion then
    return job, np.maximum(rows, 0)


def _measures(job: Prepared, V: FloatArray, Q: FloatArray, rows: np.ndarray) -> dict[str, Any]:
    roles = job.bones.roles if job.bones else ()
    soft = soft_faces(job.solver.mesh.faces, job.owner, roles) if any(roles) else None
    report = distortion_measures(job.solver, V, Q, soft)
    if job.bones and job.motion and job.target:
        m = job.motion
        some = BonePose(m.turns[rows], m.starts[rows], m.ends[rows])
        report |= direction_measures(job.bones, some, job.target, job.solver, job.owner, V)
    return report
