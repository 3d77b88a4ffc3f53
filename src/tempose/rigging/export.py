"""A rig as a file that any animation package opens."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.formats import FormatError, save, save_skin
from tempose.kinematics import linear_blend_skinning
from tempose.rigging.few_weights import few_weights
from tempose.rigging.rig import Rig
from tempose.typing import Progress, silent

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
    GLB holds at most four weights a vertex (see `tempose.rigging.few_weights`) and blends linearly; the
    difference this makes is measured over the frames, at most 32 of them. USD holds all weights and says how
    they blend.
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
    skin = few_weights(rig.skin, motion) if suffix == ".glb" else rig.skin
    save_skin(place, skin, motion, blending=rig.blending, up=up, unit=unit, progress=progress)
    if suffix != ".glb":
        return Exported(motion.n_frames, 0.0, ())
    return _compare(rig, skin, motion)


def _compare(rig: Rig, skin: SkinnedMesh, motion: SkeletonClip) -> Exported:
    """Pose the linear skin of few weights and measure how far it is off."""
    many = int((np.count_nonzero(rig.skin.weights, axis=1) > _MOST_GLTF_WEIGHTS).sum())
    if not many and rig.blending == "linear":
        return Exported(motion.n_frames, 0.0, ())
    chosen = np.unique(np.linspace(0, motion.n_frames - 1, _CHECKED).round().astype(int))
    some = motion.frames(chosen)
    V = linear_blend_skinning(skin, some.rotations, some.root_position, some.skeleton)
    off = np.linalg.norm(V - rig.vertices(some), axis=2)
    size = rig.skin.mesh.diagonal or 1.0
    largest, rms = float(100 * off.max() / size), float(100 * np.sqrt((off**2).mean()) / size)
    warnings: list[str] = []
    if many:
        warnings.append(f"{many} vertices follow more than four joints; a GLB binds them to the best four.")
    if rig.blending != "linear":
        warnings.append("A GLB blends linearly, the rig by dual quaternions: joints that twist look thinner.")
    warnings.append(f"Vertices are off by {rms:.2g} % of the size of the mesh, at most {largest:.2g} %.")
    return Exported(motion.n_frames, largest, tuple(warnings))
