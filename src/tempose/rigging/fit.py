"""The whole way from a clip to a rig."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip, Skeleton, SkinnedMesh
from tempose.embedding import embed_skeleton, heat_weights
from tempose.metrics import compare
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.rig import Blending, Rig
from tempose.typing import Progress, silent


def fit_rig(
    clip: MeshClip,
    skeleton: str | SkinnedMesh = "human",
    *,
    bones: int | None = None,
    frame: int | None = None,
    blending: Blending = "linear",
    progress: Progress = silent,
) -> Rig:
    """Find a skeleton for a clip, bind the mesh to it and fit its motion to the clip.

    Parameters
    ----------
    clip : MeshClip
        T frames of n vertices.
    skeleton : str or SkinnedMesh, default "human"
        ``"human"`` puts 18 joints inside one frame; ``"auto"`` finds bones from the motion itself; a skin is
        taken as it is.
    bones : int, optional
        Number of bones for ``"auto"``.
    frame : int, optional
        Frame that becomes the bind pose; by default the one in which the body is read most surely.
    blending : str, default "linear"
        ``"linear"`` or ``"dual-quaternion"``.
    progress : Progress
        Told about every stage.

    Returns
    -------
    Rig
        Skin, motion and report.
    """
    if isinstance(skeleton, str):
        mesh = clip.mesh.with_vertices(clip.vertices[0 if frame is None else frame].astype(np.float64))
        skin = _human(mesh)
    else:
        skin = skeleton
    fitted = fit_poses(skin, clip.vertices, fps=clip.fps, blending=blending, progress=progress)
    report: dict[str, Any] = {"warnings": []}
    rig = Rig(skin, fitted.motion, blending, report)
    errors = compare(clip.vertices, rig.vertices(), skin.mesh.diagonal)
    return Rig(skin, fitted.motion, blending, {**report, "errors": asdict(errors)})


def _human(mesh: Mesh) -> SkinnedMesh:
    embedding = embed_skeleton(mesh)
    parents = embedding.parents
    offsets = np.array(
        [
            p - (embedding.joints[parents[j]] if parents[j] >= 0 else 0.0)
            for j, p in enumerate(embedding.joints)
        ]
    )
    tips = np.array(
        [
            embedding.ends[name] - embedding.joints[j] if name in embedding.ends else np.full(3, np.nan)
            for j, name in enumerate(embedding.names)
        ]
    )
    skeleton = Skeleton(embedding.names, parents, offsets, tips=tips)
    return SkinnedMesh(mesh, skeleton, heat_weights(mesh, skeleton))
