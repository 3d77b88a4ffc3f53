"""A jointed skin settled on its clip: joints, poses and weights in turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import bone_transforms
from tempose.kinematics.skinning import bake
from tempose.rigging.decomposition import weights_for
from tempose.rigging.refine import refine_joints
from tempose.typing import BoolArray, FloatArray, Progress, silent


@dataclass(frozen=True, eq=False)
class Settled:
    """A skin that suits a clip."""

    skin: SkinnedMesh
    """Joints and weights; the mesh has no faces."""
    motion: SkeletonClip
    """Fitted to the frames."""
    rms: FloatArray
    """(rounds + 1,) root mean square distance after the joints and after every round, metres."""

    @property
    def vertices(self) -> FloatArray:
        """(T, n, 3) frames that the skin makes, metres."""
        return bake(self.skin, self.motion)


def settle(
    rest: FloatArray,
    skeleton: Skeleton,
    weights: FloatArray,
    motion: SkeletonClip,
    frames: FloatArray,
    influences: int = 4,
    *,
    pull: float = 0.02,
    rounds: int = 10,
    allowed: BoolArray | None = None,
    progress: Progress = silent,
) -> Settled:
    """Move joints, fit poses and solve weights in turn.

    Parameters
    ----------
    rest : (n, 3) float
        Rest positions, metres.
    skeleton : Skeleton
        B joints to start from.
    weights : (n, B) float
        Weights to start from.
    motion : SkeletonClip
        T frames to start from.
    frames : (T, n, 3) float
        Positions to reach, metres.
    influences : int, default 4
        Most bones that a vertex may follow.
    pull : float, default 0.02
        Holds a joint where it is, as a mean squared turn (radians) about it would. Hinges leave the place
        along their axis open: with a small pull the skin follows the clip more closely, and joints may wander
        out of the mesh.
    rounds : int, default 10
        How often weights are solved again; a round that lowers the error by less than 1 % is the
        last.
    allowed : (n, B) bool, optional
        Which bones each vertex may follow; by default all. Bones that move alike need it: the frames do
        not tell them apart.
    progress : Progress
        Told about every round.

    Returns
    -------
    Settled
        Skin, motion and errors.
    """
    mesh = Mesh(rest, np.zeros((0, 3), dtype=np.int32))
    best = _joined(SkinnedMesh(mesh, skeleton, weights), motion, frames, pull)
    history = [_rms(best, frames)]
    for k in range(rounds):
        turns, shifts = bone_transforms(best[0].skeleton, best[1].rotations, best[1].root_position)
        again = weights_for(
            frames,
            rest,
            turns,
            shifts,
            weights=best[0].weights,
            influences=influences,
            allowed=allowed,
        )
        trial = _joined(SkinnedMesh(mesh, best[0].skeleton, again), best[1], frames, pull)
        progress(k + 1, rounds, "joints and weights")
        rms = _rms(trial, frames)
        if rms >= history[-1]:
            break
        best = trial
        history.append(rms)
        if rms > 0.99 * history[-2]:
            break
    return Settled(*best, np.array(history))


def _joined(
    skin: SkinnedMesh, motion: SkeletonClip, frames: FloatArray, pull: float
) -> tuple[SkinnedMesh, SkeletonClip]:
    refined = refine_joints(skin, motion, frames, pull=pull)
    return refined.skin, refined.fit.motion


def _rms(fitted: tuple[SkinnedMesh, SkeletonClip], frames: FloatArray) -> float:
    away = bake(*fitted) - frames
    return float(np.sqrt((away**2).sum(axis=2).mean()))
