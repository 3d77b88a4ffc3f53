"""All measures of a transferred clip, ready for its report."""

from __future__ import annotations

from typing import Any

from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.measures import (
    SHORT_QUATERNION,
    direction_measures,
    distortion_measures,
    foot_measures,
    soft_faces,
)
from tempose.typing import FloatArray


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
    measures = distortion_measures(job.solver, V, job.rotations, soft)
    if job.bones and job.motion and job.target:
        measures |= direction_measures(job.bones, job.motion, job.target, job.solver, job.owner, V)
    ground = float(mesh.vertices[:, 1].min()) if job.feet.ground is None else job.feet.ground
    measures |= foot_measures(job.feet, V, mesh.height, job.source_height, ground, fps)
    if measures["quaternion_norm_min"] < SHORT_QUATERNION:
        report["warnings"].append(
            "neighbouring marks turn against each other (shortest quaternion "
            f"{measures['quaternion_norm_min']:.2f}): look for a torn or collapsed place"
        )
    report |= measures
