"""The report of a fit: errors with and without detail, what was learned, what to beware of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.clips.blocks import read_block
from tempose.detail.fitting import Gathered
from tempose.detail.posing import DetailPoser
from tempose.detail.report.heldout import HeldOut
from tempose.detail.report.warnings import warnings_of
from tempose.detail.residuals import Basis
from tempose.metrics.errors import ErrorMeter
from tempose.rigging.doubts import doubts_of_faces, doubts_of_skin
from tempose.typing import FloatArray, Progress


def fit_report(
    clips: Sequence[MeshClip],
    gathered: Gathered,
    chosen: HeldOut,
    C: FloatArray,
    basis: Basis,
    progress: Progress,
) -> dict[str, Any]:
    """Measure a fit on its own clips and sum it up.

    Parameters
    ----------
    clips : sequence of MeshClip
        The true frames.
    gathered : Gathered
        What was learned from.
    chosen : HeldOut
        The learner and the table.
    C : (T, R, 1 + K) float
        Predicted coefficients of the frames of the training.
    basis : {"blended", "root", "world"}
        Of the residuals.
    progress : Progress
        Told about the frames.

    Returns
    -------
    dict
        What JSON can hold. ``errors`` are those of the frames learned from, with detail; ``baselines`` has
        the same of the skin alone and of the mean; ``kept`` of what the modes can show at best; ``heldout``
        the table of parts left out.
    """
    rig, detail = gathered.rig, gathered.detail
    R = gathered.shares.shape[1]
    mean = np.zeros((1, R, 1 + detail.n_modes), np.float32)
    mean[..., 0] = detail.step
    best = np.concatenate([np.ones((len(detail.coordinates), 1)), detail.coordinates], axis=1) * detail.step
    kept = np.broadcast_to(best[:, None], C.shape)
    poser = DetailPoser(rig, detail, gathered.shares, basis)
    ways = {"ours": C, "skin": 0 * mean, "mean": mean, "kept": kept}
    measured = {
        name: _measure(poser, gathered, clips, np.broadcast_to(way, C.shape), progress)
        for name, way in ways.items()
    }
    return {
        "learner": chosen.learner.name,
        "why": chosen.why,
        "basis": basis,
        "clips": len(clips),
        "frames": len(C),
        "vertices": len(rig.skin.mesh.vertices),
        "regions": list(rig.skin.skeleton.names),
        "modes": detail.n_modes,
        "errors": measured["ours"][0],
        "baselines": {"skin": measured["skin"][0], "mean": measured["mean"][0]},
        "kept": measured["kept"][0],
        "frame_errors": {name: measured[name][1] for name in ("skin", "mean", "ours")},
        "heldout": chosen.rows,
        "warnings": [
            *_strangers(clips, rig.skin.mesh),
            *doubts_of_skin(measured["skin"][0]["rms_percent"]),
            *warnings_of(clips, gathered, chosen, basis),
        ],
    }


def _strangers(clips: Sequence[MeshClip], mesh: Mesh) -> list[str]:
    return [s for i, clip in enumerate(clips) for s in doubts_of_faces(mesh, clip.mesh, f"clip {i}")]


def _measure(
    poser: DetailPoser,
    gathered: Gathered,
    clips: Sequence[MeshClip],
    C: FloatArray,
    progress: Progress,
) -> tuple[dict[str, float], list[float]]:
    mesh = gathered.rig.skin.mesh
    meter = ErrorMeter(len(C) * len(mesh.vertices), mesh.diagonal)
    frames: list[float] = []
    first = 0
    for clip, motion in zip(clips, gathered.motions):
        posed = poser.frames(motion, C[first : first + clip.n_frames], progress)
        first += clip.n_frames
        for t in range(0, clip.n_frames, 16):
            some = slice(t, min(t + 16, clip.n_frames))
            squares = meter.add(read_block(clip.vertices, some), posed[some].astype(np.float64))
            frames += [float(e) for e in np.sqrt(squares)]
    return meter.errors.as_dict(), frames
