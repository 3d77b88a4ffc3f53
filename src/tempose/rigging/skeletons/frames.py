"""Which frame of a clip becomes the bind pose of a human rig."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.embedding import Embedding, embed_whole_or_piece
from tempose.embedding.cells import Cells
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.skeletons.bound import Bound
from tempose.rigging.skeletons.human import check_human, human_bound
from tempose.typing import FloatArray, Progress

_TRIED, _FITTED, _SAMPLE = 6, 3, 12
"""Frames in which a skeleton is sought; of these, how many rigs are fitted; to how many frames."""
_UNLIKE = 3.0
_SURE = 0.7
"""Score from which no other frame is looked at: all crane frames below it fit the clip well."""


@dataclass(frozen=True)
class _Candidate:
    frame: int
    mesh: Mesh
    embedding: Embedding
    cells: Cells | None

    @property
    def side_ratio(self) -> float:
        """Longer to shorter of paired bones, the worst."""
        return max(self.embedding.report.get("side_ratios", {"": 1.0}).values())

    @property
    def score(self) -> float:
        """Least for a body that is read most surely: human, and alike on both sides."""
        return self.embedding.penalty + _UNLIKE * float(np.log(self.side_ratio))


def frame_mesh(clip: MeshClip, frame: int) -> Mesh:
    """Return one frame of a clip as a mesh.

    Parameters
    ----------
    clip : MeshClip
        T frames.
    frame : int
        0-based.

    Returns
    -------
    Mesh
        The frame.

    Raises
    ------
    ValueError
        If there is no such frame.
    """
    if not 0 <= frame < clip.n_frames:
        raise ValueError(f"frame must be from 0 to {clip.n_frames - 1}, got {frame}")
    return clip.mesh.with_vertices(np.asarray(clip.vertices[frame], dtype=np.float64))


def surest_human(clip: MeshClip, frame: int | None, progress: Progress) -> Bound:
    """Put a human skeleton inside the frame of a clip in which it fits the whole clip best.

    Parameters
    ----------
    clip : MeshClip
        T frames of a person.
    frame : int or None
        The frame; None tries some.
    progress : Progress
        Told about every frame tried.

    Returns
    -------
    Bound
        Skin in the pose of that frame; ``frame`` and, where some were tried, ``candidates`` among the facts.

    Raises
    ------
    ValueError
        If there is no such frame, or no frame shows a human.

    Notes
    -----
    A skeleton is sought in six frames spread over the clip, the ends first. One in which the body is human
    and alike on both sides beyond doubt is taken at once. Else the three that come nearest to it are bound
    and fitted to twelve frames, and the least rms wins: on a captured man, frames differ by a factor of two
    in that rms, and penalties alone do not tell which is good.
    """
    if frame is not None:
        mesh = frame_mesh(clip, frame)
        embedding, cells = embed_whole_or_piece(mesh)
        check_human(embedding, moving=clip.n_frames > 1)
        return _with_facts(_bound(_Candidate(frame, mesh, embedding, cells), clip), frame, [])
    tried = _tried(clip, progress)
    check_human(tried[0].embedding, moving=clip.n_frames > 1)
    T = clip.n_frames
    sample = np.asarray(clip.vertices[np.unique(np.linspace(0, T - 1, _SAMPLE).round().astype(int))])
    bounds = [_bound(candidate, clip) for candidate in tried[:_FITTED]]
    rms = [_sample_rms(bound, sample) for bound in bounds] if len(bounds) > 1 else [0.0]
    best = int(np.argmin(rms))
    table: list[dict[str, Any]] = [
        {
            "frame": c.frame,
            "penalty": round(float(c.embedding.penalty), 4),
            "side_ratio": round(c.side_ratio, 4),
            **({"rms_percent": round(rms[k], 4)} if k < len(bounds) and len(bounds) > 1 else {}),
        }
        for k, c in enumerate(tried)
    ]
    return _with_facts(bounds[best], tried[best].frame, table)


def _tried(clip: MeshClip, progress: Progress) -> list[_Candidate]:
    """Read bodies in some frames, the surest first; those that cannot be read at all are left out."""
    frames = np.unique(np.linspace(0, clip.n_frames - 1, _TRIED).round().astype(int))
    frames = frames[np.argsort(-np.abs(frames - (clip.n_frames - 1) / 2), kind="stable")]
    found: list[_Candidate] = []
    failure: ValueError | None = None
    for k, t in enumerate(frames):
        mesh = frame_mesh(clip, int(t))
        try:
            found.append(_Candidate(int(t), mesh, *embed_whole_or_piece(mesh)))
        except ValueError as error:
            failure = error
        progress(k + 1, len(frames), "bind pose")
        if found and found[-1].score < _SURE:
            return found[-1:]
    if not found:
        assert failure is not None
        raise failure
    return sorted(found, key=lambda c: c.score)


def _bound(candidate: _Candidate, clip: MeshClip) -> Bound:
    return human_bound(candidate.mesh, candidate.embedding, candidate.cells, moving=clip.n_frames > 1)


def _sample_rms(bound: Bound, sample: FloatArray) -> float:
    errors = fit_poses(bound.skin, sample).errors
    return 100 * float(np.sqrt(np.mean(np.square(errors)))) / bound.skin.mesh.diagonal


def _with_facts(bound: Bound, frame: int, table: list[dict[str, Any]]) -> Bound:
    facts = bound.facts | {"frame": frame} | ({"candidates": table} if len(table) > 1 else {})
    return replace(bound, facts=facts)
