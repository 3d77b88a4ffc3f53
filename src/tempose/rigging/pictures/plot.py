"""All pictures of a rig, in a folder."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import MeshClip
from tempose.kinematics import rest_motion
from tempose.render import Theme, contact_sheet, save_png
from tempose.render.colors import Picture
from tempose.render.drawing import save_drawing
from tempose.rigging.pictures.bones import bone_lines
from tempose.rigging.pictures.charts import draw_frame_errors
from tempose.rigging.pictures.views import abreast, body_views
from tempose.rigging.pictures.weights import weight_colors
from tempose.rigging.rig import Rig
from tempose.typing import FloatArray, Progress, silent

_MOMENTS = 7


def plot_rig(
    rig: Rig,
    folder: str | os.PathLike[str],
    clip: MeshClip | None = None,
    *,
    theme: str | Theme = "light",
    progress: Progress = silent,
) -> list[Path]:
    """Draw a rig: the skeleton in its mesh, the weights and, beside a clip, how the skin follows it.

    Parameters
    ----------
    rig : Rig
        Any.
    folder : path-like
        Where the pictures go; made if its parent exists. Files of the same names are replaced.
    clip : MeshClip, optional
        The clip that the rig follows.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.
    progress : Progress, default silent
        Called after each picture.

    Returns
    -------
    list of Path
        ``skeleton.png``, ``weights.png`` and, with a clip, ``frames.png`` and ``frame-errors``.

    Raises
    ------
    ValueError
        If the clip has other frames than the motion of the rig.
    OSError
        If the folder cannot be made or written.
    """
    place = Path(folder)
    place.mkdir(exist_ok=True)
    written = [place / "skeleton.png", place / "weights.png"]
    names = ("front", "three-quarter", "side", "back")
    still, at_rest = rest_clip(rig), rest_motion(rig.skin.skeleton)
    look: dict[str, Any] = {"names": names, "views": body_views(at_rest, names), "cell": 420, "theme": theme}
    save_png(abreast(still, 1, segments=bone_lines(at_rest), **look), written[0])
    progress(1, 4, "drawing pictures")
    colors = weight_colors(rig.skin.weights, rig.skin.skeleton)
    save_png(abreast(still, 1, colors=colors, **look), written[1])
    progress(2, 4, "drawing pictures")
    if clip is None or clip.n_frames < 2:
        return written
    if clip.n_frames != rig.motion.n_frames:
        raise ValueError(
            f"clip must have the {rig.motion.n_frames} frames of the rig's motion, got {clip.n_frames}"
        )
    V = rig.vertices()
    save_png(rig_sheet(rig, clip, V, theme=theme), place / "frames.png")
    progress(3, 4, "drawing pictures")
    errors = {"skin alone": frame_errors(clip, V)}
    drawing = draw_frame_errors(errors, theme=theme)
    charts = [place / f"frame-errors.{suffix}" for suffix in ("png", "svg")]
    for path in charts:
        save_drawing(drawing, path)
    progress(4, 4, "drawing pictures")
    return [*written, place / "frames.png", *charts]


def rest_clip(rig: Rig) -> MeshClip:
    """Return the bind pose as a clip of one frame.

    Parameters
    ----------
    rig : Rig
        Any.

    Returns
    -------
    MeshClip
        The mesh alone.
    """
    mesh = rig.skin.mesh
    return MeshClip(mesh.vertices[None].astype(np.float32), mesh, rig.motion.fps)


def rig_sheet(
    rig: Rig,
    clip: MeshClip,
    V: FloatArray | None = None,
    frames: int | Sequence[int] = _MOMENTS,
    *,
    views: Sequence[Any] | None = None,
    cell: int = 260,
    theme: str | Theme = "light",
) -> Picture:
    """Show moments of a clip, the skeleton in it, and the skin that follows.

    Parameters
    ----------
    rig : Rig
        Any.
    clip : MeshClip
        T frames, as many as the motion of the rig.
    V : (T, n, 3) float, optional
        The skin in the motion of the rig, where it is known.
    frames : int or sequence of int, default 7
        How many moments, or which.
    views : sequence, optional
        As for `tempose.render.contact_sheet`; by default before the body as it stands half way.
    cell : int, default 260
        Height of a cell, pixels.
    theme : str or Theme, default "light"
        ``"light"`` or ``"dark"``.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.
    """
    skin = MeshClip((rig.vertices() if V is None else V).astype(np.float32), clip.mesh, clip.fps)
    middle = body_views(rig.motion, ("front",), clip.n_frames // 2)
    return contact_sheet(
        [clip, skin],
        frames,
        middle if views is None else views,
        cell=cell,
        names=["clip", "skin alone"],
        segments=[bone_lines(rig.motion), None],
        theme=theme,
        track=True,
    )


def frame_errors(clip: MeshClip, V: FloatArray) -> FloatArray:
    """Root mean square distance of every frame.

    Parameters
    ----------
    clip : MeshClip
        T frames.
    V : (T, n, 3) float
        What stands for them, metres.

    Returns
    -------
    (T,) ndarray
        Percent of the diagonal of the mesh.
    """
    off = [np.sqrt(np.square(v - f).sum(axis=-1).mean()) for v, f in zip(V, clip.vertices)]
    return 100.0 * np.array(off) / clip.mesh.diagonal
