"""A skin for anything that moves: bones from the clip, joined, settled on the clip."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import MeshClip, SkinnedMesh
from tempose.clips.blocks import read_block
from tempose.metrics import compare
from tempose.rigging.decomposition import Decomposition, count_bones, decompose
from tempose.rigging.joints.regions import part_limbs
from tempose.rigging.joints.seams import distinct_vertices
from tempose.rigging.joints.settling import settle
from tempose.rigging.joints.skeleton import hang_bones
from tempose.rigging.joints.surface import surface_links
from tempose.typing import FloatArray, Progress, silent

_MOST_FRAMES = 240
_FEW_FRAMES = 4
_ALONE = 3e-3  # without it a bone may lie far from what it moves, and tear every joint by a tenth of a horse


def auto_skin(
    clip: MeshClip,
    bones: int | None = None,
    *,
    influences: int = 4,
    tolerance: float = 1.5e-3,
    pull: float = 0.02,
    seed: int = 0,
    progress: Progress = silent,
) -> tuple[SkinnedMesh, dict[str, Any]]:
    """Find a skeleton and weights in the motion of a clip.

    Parameters
    ----------
    clip : MeshClip
        At least two frames in which the mesh moves in itself.
    bones : int, optional
        Number of bones; by default as few as bring free bones to `tolerance`, and one more for each limb
        that moves like another and is far from it along the surface.
    influences : int, default 4
        Most bones that a vertex may follow.
    tolerance : float, default 1.5e-3
        Root mean square distance, in diagonals of the rest mesh, that sets the number of bones.
    pull : float, default 0.02
        How firmly joints stay where both bones hold the mesh, see `settle`.
    seed : int, default 0
        The same seed gives the same answer.
    progress : Progress
        Told about every stage.

    Returns
    -------
    skin : SkinnedMesh
        The rest mesh of the clip, joints ``bone_00`` ..., weights.
    report : dict
        ``bones``, ``e_rms_free`` of free bones, ``e_rms`` and ``rms_percent`` of the skeleton,
        ``frames`` looked at, ``warnings``.

    Raises
    ------
    ValueError
        If the clip is still or moves rigidly, or like fewer bones than asked for.
    """
    used = np.unique(np.linspace(0, clip.n_frames - 1, min(clip.n_frames, _MOST_FRAMES)).round().astype(int))
    frames = _frames(clip, used)
    first, back = distinct_vertices(clip.rest, frames)
    rest, frames = clip.rest[first], frames[:, first]
    count = bones if bones is not None else count_bones(frames, rest, tolerance, influences, seed=seed)
    if count == 1 and bones is None:
        raise ValueError(
            f"clip moves as one rigid body, to {100 * tolerance:.2g} % of D: there are no bones to find; "
            "use skeleton 'human' or a skeleton file, or a smaller tolerance"
        )
    found = decompose(
        frames, rest, bones=count, influences=influences, alone=_ALONE, seed=seed, progress=progress
    )
    faces = back[clip.faces].astype(np.int64)
    allowed = np.ones(found.weights.shape, dtype=bool)
    if bones is None:
        found, allowed = part_limbs(found, surface_links(rest, faces))
    skeleton, motion, order = hang_bones(found, faces, clip.fps)
    settled = settle(
        rest,
        skeleton,
        found.weights[:, order],
        motion,
        frames,
        influences,
        pull=pull,
        allowed=None if allowed.all() else allowed[:, order],
        progress=progress,
    )
    report = _report(found, settled.vertices, frames)
    report["frames"] = len(used)
    if len(used) < _FEW_FRAMES:
        report["warnings"].append(
            f"only {len(used)} frames: parts that turn alike in them share a bone, and joints are doubtful"
        )
    skin = SkinnedMesh(clip.mesh, settled.skin.skeleton, settled.skin.weights[back])
    return skin, report


def _frames(clip: MeshClip, used: Any) -> FloatArray:
    if len(used) < 2:
        raise ValueError(f"clip must have at least two frames to find bones in, got {clip.n_frames}")
    blocks = [read_block(clip.vertices, slice(int(t), int(t) + 1), "clip") for t in used]
    return np.concatenate(blocks).astype(np.float64)


def _report(found: Decomposition, vertices: FloatArray, frames: FloatArray) -> dict[str, Any]:
    D = float(np.linalg.norm(np.ptp(found.rest, axis=0)))
    free = compare(frames, found.vertices(), D)
    joined = compare(frames, vertices, D)
    report: dict[str, Any] = {
        "bones": found.n_bones,
        "e_rms_free": free.e_rms,
        "e_rms": joined.e_rms,
        "rms_percent": joined.rms_percent,
        "warnings": [],
    }
    if joined.rms > 2 * free.rms + 1e-3 * D:
        report["warnings"].append(
            f"joints of constant length cost much: {joined.rms_percent:.2f} % of D where free bones reach "
            f"{free.rms_percent:.2f} %; the clip slides or stretches, ask for fewer bones"
        )
    return report
