"""A rig as a file that any animation package opens."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tempose.clips import SkeletonClip
from tempose.formats import FormatError, save, save_skin
from tempose.kinematics import linear_blend_skinning
from tempose.rigging.rig import Rig
from tempose.typing import FloatArray, Progress, silent

_SKINS = (".glb", ".usda", ".usdc", ".usd")
_MOST_GLTF_WEIGHTS = 4
_CHECKED = 32


@dataclass(frozen=True)
class Exported:
    """What a file holds, compared with the rig."""

    frames: int
    """Frames written."""
    largest_percent: float
    """Farthest that a vertex stands from where the rig has it, percent of the diagonal of the bind pose;
    0 for a skeleton alone."""
    warnings: tuple[str, ...]
    """What the format cannot hold, one sentence each."""


def export_rig(
    rig: Rig,
    path: str | os.PathLike[str],
    *,
    motion: SkeletonClip | None = None,
    up: str | None = None,
    unit: str | float | None = None,
    progress: Progress = silent,
) -> Exported:
    """Write a rig for an animation package: BVH, GLB or USD.

    Parameters
    ----------
    rig : Rig
        Skin and motion.
    path : path-like
        ``.bvh`` for the skeleton alone; ``.glb``, ``.usda``, ``.usdc`` or ``.usd`` with the mesh.
    motion : SkeletonClip, optional
        Frames on the joints of the rig in place of its own.
    up, unit
        Axes and unit of the file, where the format leaves a choice.
    progress : Progress
        Told about every array.

    Returns
    -------
    Exported
        Frames, and what is lost.

    Raises
    ------
    FormatError
        If the ending is unknown.
    ValueError
        If the motion is not on the joints of the rig.

    Notes
    -----
    GLB holds at most four weights a vertex and blends linearly; the difference this makes is measured over
    the frames, at most 32 of them. USD holds all weights and says how they blend.
    """
    motion = motion or rig.motion
    if motion.skeleton.names != rig.skin.skeleton.names:
        raise ValueError("motion must move the joints of the rig; match_motion puts another one on them")
    place = os.fspath(path)
    suffix = Path(place).suffix.lower()
    if suffix == ".bvh":
        save(place, motion, up=up, unit=unit)
        return Exported(motion.n_frames, 0.0, ())
    if suffix not in _SKINS:
        raise FormatError(f"{place}: a rig goes into .bvh, {', '.join(_SKINS)}, got {suffix or 'no ending'}")
    save_skin(place, rig.skin, motion, blending=rig.blending, up=up, unit=unit, progress=progress)
    if suffix != ".glb":
        return Exported(motion.n_frames, 0.0, ())
    return _compare(rig, motion)


def _compare(rig: Rig, motion: SkeletonClip) -> Exported:
    """Pose the linear skin of four weights and measure how far it is off."""
    weights, warnings = _fewer(rig.skin.weights), list[str]()
    many = int((np.count_nonzero(rig.skin.weights, axis=1) > _MOST_GLTF_WEIGHTS).sum())
    if not many and rig.blending == "linear":
        return Exported(motion.n_frames, 0.0, ())
    chosen = np.unique(np.linspace(0, motion.n_frames - 1, _CHECKED).round().astype(int))
    some = motion.frames(chosen)
    skin = replace(rig.skin, weights=weights)
    V = linear_blend_skinning(skin, some.rotations, some.root_position, some.skeleton)
    off = np.linalg.norm(V - rig.vertices(some), axis=2).max()
    percent = float(100 * off / (rig.skin.mesh.diagonal or 1.0))
    if many:
        warnings.append(f"{many} vertices have more than four weights; a GLB keeps the four largest.")
    if rig.blending != "linear":
        warnings.append("A GLB blends linearly, the rig by dual quaternions: joints that twist look thinner.")
    warnings.append(f"Vertices are off by up to {percent:.2g} % of the size of the mesh.")
    return Exported(motion.n_frames, percent, tuple(warnings))


def _fewer(weights: FloatArray) -> FloatArray:
    kept = np.array(weights)
    if weights.shape[1] > _MOST_GLTF_WEIGHTS:
        weakest = np.argsort(-weights, axis=1, kind="stable")[:, _MOST_GLTF_WEIGHTS:]
        np.put_along_axis(kept, weakest, 0.0, axis=1)
    sums = kept.sum(axis=1, keepdims=True)
    return kept * np.divide(weights.sum(axis=1, keepdims=True), sums, out=np.ones_like(sums), where=sums > 0)
