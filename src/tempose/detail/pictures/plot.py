"""All pictures of a model of detail, in a folder."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tempose.clips import MeshClip
from tempose.detail.fitting import training_inputs
from tempose.detail.pictures.latent import draw_latent
from tempose.detail.pictures.plane import latent_plane
from tempose.detail.pictures.sheets import detail_sheet, skin_clip, variance_sheet
from tempose.regression import blocked_folds
from tempose.render import save_png
from tempose.render.drawing import Drawing, save_drawing
from tempose.rigging.pictures import draw_frame_errors
from tempose.typing import FloatArray, IntArray, Progress, silent

if TYPE_CHECKING:
    from tempose.detail.model import DetailModel

_WORDS = {
    "skin": "skin alone",
    "mean": "mean residual",
    "ours": "with detail",
    "gp": "plain GP",
    "regional-gp": "GP a region",
    "gplvm": "GP-LVM",
    "gplvm-paper": "GP-LVM as in the paper",
}
_FOLDS = 5


def plot_detail(
    model: DetailModel,
    folder: str | os.PathLike[str],
    clips: Sequence[MeshClip] = (),
    *,
    progress: Progress = silent,
) -> list[Path]:
    """Draw a model: where its training lies and how sure it is, errors of every frame, frames, variance.

    Parameters
    ----------
    model : DetailModel
        Fitted or loaded.
    folder : path-like
        Where the pictures go; made if its parent exists. Files of the same names are replaced.
    clips : sequence of MeshClip, optional
        What it was learned from; the first is shown beside its skin and its detail.
    progress : Progress, default silent
        Called after each picture.

    Returns
    -------
    list of Path
        ``latent-space``, ``heldout-errors``, ``frame-errors``, ``frames.png`` and ``variance.png``, as far as
        the model knows what they show.

    Raises
    ------
    OSError
        If the folder cannot be made or written.
    """
    place = Path(folder)
    place.mkdir(exist_ok=True)
    written: list[Path] = []
    charts = _charts(model)
    for i, (name, drawing) in enumerate(charts.items()):
        written += [place / f"{name}.{suffix}" for suffix in ("png", "svg")]
        for path in written[-2:]:
            save_drawing(drawing, path)
        progress(i + 1, len(charts) + 2, "drawing pictures")
    motion = model.rig_.motion
    detailed = model.pose(motion)
    if clips and clips[0].n_frames == motion.n_frames:
        written.append(place / "frames.png")
        skin = skin_clip(model.rig_, motion)
        save_png(detail_sheet(clips[0], skin, detailed, motion), written[-1])
    progress(len(charts) + 1, len(charts) + 2, "drawing pictures")
    written.append(place / "variance.png")
    save_png(variance_sheet(detailed, model.variance(motion), motion), written[-1])
    progress(len(charts) + 2, len(charts) + 2, "drawing pictures")
    return written


def _charts(model: DetailModel) -> dict[str, Drawing]:
    report: Any = model.report_
    D = model.rig_.skin.mesh.diagonal
    inputs = training_inputs(model.motions_)
    sizes = 3 * model.shares_.sum(axis=0)
    found = {"latent-space": draw_latent(latent_plane(model.predictor_, inputs, sizes))}
    if report.get("heldout"):
        found["heldout-errors"] = draw_heldout(report["heldout"], report["learner"], D, inputs.chains)
    if report.get("frame_errors"):
        errors: dict[str, FloatArray] = {
            _WORDS.get(name, str(name)): 100 / D * np.asarray(row, dtype=np.float64)
            for name, row in report["frame_errors"].items()
        }
        title = "rms error of frames learned from, % of the diagonal"
        found["frame-errors"] = draw_frame_errors(errors, title)
    return found


def draw_heldout(
    rows: Mapping[str, Mapping[str, Any]], learner: str, diagonal: float, chains: IntArray
) -> Drawing:
    """Draw the error of every frame, predicted without its part of the clip (after Fig. 5c of the paper).

    Parameters
    ----------
    rows : mapping
        ``heldout`` of a report: name to ``frames``, rms of every frame in metres.
    learner : str
        The one that was taken.
    diagonal : float
        Of the mesh, metres.
    chains : (T,) int
        Which clip every frame is from.

    Returns
    -------
    Drawing
        Skin alone, the mean, the plain Gaussian process and what was taken, as far as they are known.
    """
    errors: dict[str, FloatArray] = {}
    for name in dict.fromkeys(("skin", "mean", "gp", learner)):
        if "frames" in rows.get(name, {}):
            errors[_WORDS.get(name, name)] = (
                100 / diagonal * np.asarray(rows[name]["frames"], dtype=np.float64)
            )
    parts = [int(test[0]) for _, test in blocked_folds(chains, _FOLDS)][1:]
    title = "rms error of frames predicted without their part, % of the diagonal"
    return draw_frame_errors(errors, title, parts=parts)
