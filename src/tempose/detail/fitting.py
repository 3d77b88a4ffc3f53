"""From clips and a rig to what is learned: motions, residuals, inner products, modes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tempose.clips import MeshClip, SkeletonClip
from tempose.clips.resample import resample
from tempose.detail.basis import DetailBasis, compress
from tempose.detail.inputs import joined_inputs, motion_inputs
from tempose.detail.multiresolution import CoarseBasis, ControlMesh, coarse_basis, make_control
from tempose.detail.regions import region_grams, region_shares
from tempose.detail.residuals import Basis, residuals
from tempose.detail.saving.lean import lean_motion, lean_rig
from tempose.detail.training import Inputs, Training
from tempose.rigging import Rig
from tempose.rigging.pose_fit import fit_poses
from tempose.typing import FloatArray, Progress


@dataclass(frozen=True, eq=False)
class Gathered:
    """What learners and reports need of the clips."""

    rig: Rig
    """Lean, with the motion of the first clip."""
    motions: tuple[SkeletonClip, ...]
    """One for each clip."""
    shares: FloatArray
    """(n, R) of all vertices."""
    residuals: FloatArray
    """(T, k, 3) float32 of all clips one after another, of the k vertices that are learned from."""
    learned_shares: FloatArray
    """(k, R) of those vertices."""
    training: Training
    """T frames."""
    detail: DetailBasis
    """Modes at all vertices."""
    coarse: CoarseBasis | None = None
    """What a file keeps in their place where fewer vertices are learned from."""
    seconds: dict[str, float] = field(default_factory=dict[str, float])
    """Of every stage."""


def gather(
    clips: Sequence[MeshClip],
    rig: Rig,
    motions: Sequence[SkeletonClip] | None,
    basis: Basis,
    tolerance: float,
    resolution: float | None,
    progress: Progress,
) -> Gathered:
    """Prepare clips for learning.

    Parameters
    ----------
    clips : sequence of MeshClip
        All of the mesh of the rig.
    rig : Rig
        Skin and skeleton.
    motions : sequence of SkeletonClip, optional
        Of every clip; fitted where left out.
    basis : {"blended", "root", "world"}
        In which residuals are kept.
    tolerance : float
        What the modes may lose, rms in percent of the diagonal.
    resolution : float, optional
        Percentage of vertices that are learned from; all where left out.
    progress : Progress
        Told about every stage.

    Returns
    -------
    Gathered
        All that follows from the clips.
    """
    seconds: dict[str, float] = {}
    clock = _Clock(seconds)
    lean = lean_rig(rig)
    fitted = tuple(_motions(lean, clips, motions, progress))
    lean = replace(lean, motion=fitted[0])
    clock("poses")
    shares = region_shares(lean.skin.weights)
    control = _control(lean, clips[0], resolution)
    D = _residuals(lean, clips, fitted, basis, progress)
    mean, learned = D.mean(axis=0, dtype=np.float64), shares
    if control is not None:
        D, learned = _lowered(D, control), region_shares(control.skin.weights)
    clock("residuals")
    grams, sizes = region_grams(D, learned)
    training = Training(training_inputs(fitted), grams, sizes)
    clock("inner products")
    detail = compress(D, training.centred_gram, tolerance / 100 * lean.skin.mesh.diagonal)
    coarse = None
    if control is not None:
        coarse = coarse_basis(detail, mean, control.collapses.matrix)
        detail = coarse.raised(lean.skin)
    clock("modes")
    return Gathered(lean, fitted, shares, D, learned, training, detail, coarse, seconds)


def at_one_rate(
    clips: Sequence[MeshClip], motions: Sequence[SkeletonClip] | None
) -> tuple[list[MeshClip], list[SkeletonClip] | None]:
    """Give all clips the rate of the first, since learners count time in frames.

    Parameters
    ----------
    clips : sequence of MeshClip
        At any rates.
    motions : sequence of SkeletonClip, optional
        Of every clip.

    Returns
    -------
    clips : list of MeshClip
        Those of other rates with frames between their frames.
    motions : list of SkeletonClip or None
        Likewise.
    """
    fps = clips[0].fps
    # the clip states the rate: a motion that was written at another one still has a frame for each of its
    moving = None if motions is None else [replace(m, fps=c.fps) for m, c in zip(motions, clips)]
    return [resample(c, fps) for c in clips], None if moving is None else [resample(m, fps) for m in moving]


def training_inputs(motions: Sequence[SkeletonClip]) -> Inputs:
    """Read the motions that are learned from.

    Parameters
    ----------
    motions : sequence of SkeletonClip
        At least one, of the same rate.

    Returns
    -------
    Inputs
        A chain for each motion.
    """
    first = motion_inputs(motions[0])
    near = first.angles.mean(axis=0)
    others = [motion_inputs(m, motions[0].fps, near, i + 1) for i, m in enumerate(motions[1:])]
    return joined_inputs([first, *others])


def _motions(
    rig: Rig, clips: Sequence[MeshClip], motions: Sequence[SkeletonClip] | None, progress: Progress
) -> list[SkeletonClip]:
    if motions is not None:
        return [lean_motion(motion) for motion in motions]
    found: list[SkeletonClip] = []
    for clip in clips:
        fit = fit_poses(rig.skin, clip.vertices, fps=clip.fps, blending=rig.blending, progress=progress)
        found.append(lean_motion(fit.motion))
    return found


def _control(rig: Rig, clip: MeshClip, resolution: float | None) -> ControlMesh | None:
    if resolution is None or resolution >= 100:
        return None
    return make_control(rig.skin, np.asarray(clip.vertices[0], dtype=np.float64), resolution)


def _residuals(
    rig: Rig, clips: Sequence[MeshClip], motions: Sequence[SkeletonClip], basis: Basis, progress: Progress
) -> FloatArray:
    parts = [
        residuals(rig, motion, clip.vertices, basis, np.float32, progress)
        for clip, motion in zip(clips, motions)
    ]
    return np.concatenate(parts)


def _lowered(D: FloatArray, control: ControlMesh) -> FloatArray:
    """Replay the collapses on residuals: mixed each in the basis of its own vertex, they stay what they are.

    A control mesh with a skin of its own would bend otherwise than the mixture of its vertices does.
    """
    return np.stack([control.collapses.replay(d).astype(np.float32) for d in D])


class _Clock:
    def __init__(self, seconds: dict[str, float]) -> None:
        self._seconds, self._last = seconds, time.perf_counter()

    def __call__(self, stage: str) -> None:
        now = time.perf_counter()
        self._seconds[stage] = now - self._last
        self._last = now
