"""All measures of a transferred clip, ready for its report."""

from __future__ import annotations

from typing import Any

from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.joint_patches import joint_patches
from tempose.transfer.quality.measures import (
    SHORT_QUATERNION,
    direction_measures,
    distortion_measures,
    foot_measures,
    soft_faces,
)
from tempose.transfer.quality.volume_report import joint_volumes
from tempose.transfer.turns.singular import singular_measures
from tempose.typing import FloatArray, IntArray


def add_measures(report: dict[str, Any], job: Prepared, V: FloatArray, fps: float) -> None:
    """Measure frames and write what was found into a report.

    Parameters
    ----------
    report : dict
        With a list ``warnings``, to which may be added.
    job : Prepared
        What made the frames.
    V : (T, n, 3) float
        Placed frames, metres.
    fps : float
        Frames per second.
    """
    mesh = job.solver.mesh
    roles = job.bones.roles if job.bones else ()
    soft = soft_faces(mesh.faces, job.owner, roles) if any(roles) else None
    measures = distortion_measures(job.solver, V, job.rotations, soft, job.references)
    measures |= _singular(job, measures.pop("quaternion_norm"), measures.pop("quaternion_vertex"))
    if job.bones and job.motion and job.target:
        measures |= direction_measures(job.bones, job.motion, job.target, job.solver, job.owner, V)
        patches = joint_patches(job.solver, job.bones, job.target, job.owner)
        measures |= joint_volumes(V, mesh.vertices, patches)
    ground = float(mesh.vertices[:, 1].min()) if job.feet.ground is None else job.feet.ground
    measures |= foot_measures(job.feet, V, mesh.height, job.source_height, ground, fps)
    if measures["quaternion_norm_min"] < SHORT_QUATERNION:
        report["warnings"].append(
            "neighbouring marks turn against each other (shortest quaternion "
            f"{measures['quaternion_norm_min']:.2f}): look for a torn or collapsed place"
        )
    report |= measures


def _singular(job: Prepared, norms: FloatArray, vertices: IntArray) -> dict[str, Any]:
    if job.bones is None:
        return singular_measures(norms, vertices, job.owner, (), job.rotations, None)
    names = tuple(role or name for role, name in zip(job.bones.roles, job.bones.names))
    Q = job.rotations[:, : len(names)]
    found = singular_measures(norms, vertices, job.owner, names, Q, job.bones.parents)
    references = job.references
    found["singular"]["references"] = [] if references is None else [int(t) for t in references.frames]
    return found
