"""The whole way from a clip or a mesh to a rig."""

from __future__ import annotations

import os
import time
from dataclasses import asdict
from typing import Any

from tempose.clips import Mesh, MeshClip, Skeleton, SkinnedMesh
from tempose.clips.blocks import cut_blocks, read_block
from tempose.clips.still import stands_still
from tempose.kinematics import rest_motion
from tempose.metrics.errors import ErrorMeter
from tempose.rigging.doubts import doubts_of_skin
from tempose.rigging.joints import auto_skin
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.refine import refine_joints
from tempose.rigging.rig import Blending, Rig
from tempose.rigging.skeletons import Bound, given_skin, read_skeleton
from tempose.rigging.skeletons.frames import frame_mesh, surest_human
from tempose.rigging.skeletons.inside import share_inside
from tempose.typing import Progress, silent

SkeletonLike = str | os.PathLike[str] | Skeleton | SkinnedMesh | Rig
_INSIDE = 0.9
_BLOCK = 1_000_000


def fit_rig(
    clip: MeshClip | Mesh,
    skeleton: SkeletonLike = "human",
    *,
    bones: int | None = None,
    frame: int | None = None,
    blending: Blending = "linear",
    refine: bool | None = None,
    progress: Progress = silent,
) -> Rig:
    """Find a skeleton for a clip, bind the mesh to it and fit its motion to the clip.

    Parameters
    ----------
    clip : MeshClip or Mesh
        T frames of n vertices. A still mesh gets a rig with one frame, at rest.
    skeleton : str, path-like, Skeleton, SkinnedMesh or Rig, default "human"
        ``"human"`` puts 18 joints inside one frame; ``"auto"`` finds bones from the motion itself. A file
        (see `tempose.rigging.skeletons.read_skeleton`), a skeleton, a skin or another rig is brought to the
        mesh: a skin of the same vertices is taken as it is, a skeleton is placed inside and gets heat
        weights.
    bones : int, optional
        Number of bones for ``"auto"``.
    frame : int, optional
        Frame that becomes the bind pose; by default the one whose skeleton fits the clip best.
    blending : str, default "linear"
        ``"linear"`` or ``"dual-quaternion"``.
    refine : bool, optional
        Whether joints are moved to where the clip turns about them (see `tempose.rigging.refine`). By
        default those are that were found inside the mesh, not those of a skeleton that fits as it is.
    progress : Progress
        Told about every stage.

    Returns
    -------
    Rig
        Skin, motion and report. The report's ``warnings`` say what to doubt.

    Raises
    ------
    ValueError
        If an argument is wrong, the mesh is no human where one was asked for, or the skeleton lies outside
        the mesh; the message names the measure and what to do.
    """
    _check(clip, skeleton, bones, frame, blending)
    moving = clip if isinstance(clip, MeshClip) else MeshClip(clip.vertices[None], clip, source=clip.source)
    clock = _Clock()
    bound = _bound(moving, skeleton, bones, frame, progress)
    clock.stage("skeleton")
    report: dict[str, Any] = {
        "skeleton": skeleton if skeleton in ("human", "auto") else "given",
        "joints": bound.skin.skeleton.n_joints,
        "seconds": clock.seconds,
        **bound.facts,
        "warnings": list(bound.warnings),
    }
    if isinstance(clip, Mesh):
        return Rig(bound.skin, rest_motion(bound.skin.skeleton), blending, report)
    skin = bound.skin
    if refine or (refine is None and report.get("placed", skeleton) in ("human", "posed")):
        skin = _refined(bound, clip, report, clock, progress)
    return _fitted(clip, skin, blending, report, clock, progress)


def _check(clip: Any, skeleton: Any, bones: int | None, frame: int | None, blending: str) -> None:
    if not isinstance(clip, MeshClip | Mesh):
        raise ValueError(f"clip must be a MeshClip or a Mesh, got {type(clip).__name__}")
    if isinstance(clip, MeshClip) and clip.n_frames == 0:
        raise ValueError("clip must have at least one frame, got none")
    if blending not in ("linear", "dual-quaternion"):
        raise ValueError(f"blending must be 'linear' or 'dual-quaternion', got {blending!r}")
    if bones is not None and skeleton != "auto":
        raise ValueError("bones is for skeleton 'auto'; every other skeleton has its own number of joints")
    if frame is not None and skeleton == "auto":
        raise ValueError(
            "frame is for other skeletons than 'auto', whose bind pose is the rest mesh of the clip"
        )
    if skeleton == "auto" and (isinstance(clip, Mesh) or clip.n_frames < 2):
        raise ValueError(
            "skeleton 'auto' finds bones from motion and needs a clip of at least 2 frames; "
            "use 'human' or a skeleton file for a still mesh"
        )


def _bound(
    clip: MeshClip, skeleton: SkeletonLike, bones: int | None, frame: int | None, progress: Progress
) -> Bound:
    if isinstance(skeleton, str) and skeleton == "human":
        return surest_human(clip, frame, progress)
    if isinstance(skeleton, str) and skeleton == "auto":
        skin, facts = auto_skin(clip, bones, progress=progress)
        return Bound(skin, facts, tuple(facts.pop("warnings", ())))
    mesh = clip.mesh if frame is None else frame_mesh(clip, frame)
    if isinstance(skeleton, str | os.PathLike):
        skeleton = read_skeleton(skeleton, mesh)
    return given_skin(mesh, skeleton.skin if isinstance(skeleton, Rig) else skeleton)


def _refined(
    bound: Bound, clip: MeshClip, report: dict[str, Any], clock: _Clock, progress: Progress
) -> SkinnedMesh:
    skin = bound.skin
    D = max(skin.mesh.diagonal, 1e-300)
    better = refine_joints(skin, None, clip.vertices, progress=progress)
    far = int(better.moved.argmax())
    report["refined"] = {
        "rms_percent": [round(100 * float(rms) / D, 4) for rms in better.rms],
        "moved_percent": round(100 * float(better.moved[far]) / D, 3),
        "moved_most": skin.skeleton.names[far],
    }
    if bound.cells is not None:
        inside = share_inside(better.skin.skeleton, bound.cells.solid)
        report["refined"]["inside_percent"] = round(100 * inside, 2)
        if inside < _INSIDE:
            report["warnings"].append(
                f"after moving the joints to where the clip turns, only {100 * inside:.0f} % of the length "
                "of the bones lies inside the mesh; look at the skeleton, or fit without refining"
            )
    clock.stage("joints")
    return better.skin


def _fitted(
    clip: MeshClip,
    skin: SkinnedMesh,
    blending: Blending,
    report: dict[str, Any],
    clock: _Clock,
    progress: Progress,
) -> Rig:
    fitted = fit_poses(skin, clip.vertices, fps=clip.fps, blending=blending, progress=progress)
    clock.stage("poses")
    rig = Rig(skin, fitted.motion, blending, report)
    errors = _errors(clip, rig)
    clock.stage("errors")
    report["warnings"] += doubts_of_skin(errors["rms_percent"])
    if clip.n_frames > 1 and stands_still(clip):
        report["warnings"].append(
            f"all {clip.n_frames} frames are the same; the skeleton does not move, and nothing can be "
            "learned from the clip"
        )
    return Rig(skin, fitted.motion, blending, {**report, "errors": errors})


def _errors(clip: MeshClip, rig: Rig) -> dict[str, float]:
    """Compare block by block: the posed frames of a long clip need not all be held at once."""
    n = len(rig.skin.mesh.vertices)
    meter = ErrorMeter(clip.n_frames * n, rig.skin.mesh.diagonal)
    for some in cut_blocks(clip.n_frames, 3 * n, _BLOCK):
        meter.add(read_block(clip.vertices, some, "vertices"), rig.vertices(rig.motion.frames(some)))
    return asdict(meter.errors)


class _Clock:
    """Seconds a stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def stage(self, name: str) -> None:
        """Note the end of a stage."""
        now = time.perf_counter()
        self.seconds[name] = round(now - self._last, 4)
        self._last = now
