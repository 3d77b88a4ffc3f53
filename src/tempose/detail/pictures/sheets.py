"""Frames side by side: the clip and what a model makes of it, before and after an edit, how sure it is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tempose.clips import MeshClip, SkeletonClip
from tempose.render import contact_sheet
from tempose.render.colors import Picture
from tempose.rigging import Rig
from tempose.rigging.pictures import bone_lines
from tempose.rigging.pictures.views import body_views
from tempose.typing import FloatArray

_MOMENTS = 7


def detail_sheet(
    clip: MeshClip,
    skin: MeshClip,
    detailed: MeshClip,
    motion: SkeletonClip,
    frames: int | Sequence[int] = _MOMENTS,
    **look: Any,
) -> Picture:
    """Show a clip, the skin alone and the skin with detail (Fig. 6 of the paper).

    Parameters
    ----------
    clip, skin, detailed : MeshClip
        T frames each.
    motion : SkeletonClip
        T frames; tells where the front is.
    frames : int or sequence of int, default 7
        How many moments, or which.
    **look
        Passed to `tempose.render.contact_sheet`.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.
    """
    options: dict[str, Any] = {**_look(motion), **look}
    return contact_sheet(
        [clip, skin, detailed], frames, names=["clip", "skin alone", "with detail"], **options
    )


def edit_sheet(
    before: MeshClip,
    after: MeshClip,
    motion: SkeletonClip,
    edited: SkeletonClip,
    frames: int | Sequence[int] = _MOMENTS,
    *,
    moved: bool = True,
    **look: Any,
) -> Picture:
    """Show a clip before and after its skeleton was edited.

    Parameters
    ----------
    before, after : MeshClip
        T frames each.
    motion, edited : SkeletonClip
        The skeleton before and after.
    frames : int or sequence of int, default 7
        How many moments, or which.
    moved : bool, default True
        Whether a third row shows how far each vertex has moved.
    **look
        Passed to `tempose.render.contact_sheet`.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.
    """
    options: dict[str, Any] = {**_look(motion), **look}
    clips, names = [before, after], ["before", "after"]
    lines, scalars = [bone_lines(motion), bone_lines(edited)], [None, None]
    if moved:
        far = np.linalg.norm(np.asarray(after.vertices, dtype=np.float64) - before.vertices, axis=-1)
        clips, names = [*clips, after], [*names, "moved by"]
        lines, scalars = [*lines, None], [*scalars, 100.0 * far]
        options |= {"scalars": scalars, "scalar_label": "moved, cm"}
    return contact_sheet(clips, frames, names=names, segments=lines, **options)


def variance_sheet(
    detailed: MeshClip,
    variance: FloatArray,
    motion: SkeletonClip,
    frames: int | Sequence[int] = _MOMENTS,
    **look: Any,
) -> Picture:
    """Show how sure detail is: the error expected of every vertex as a colour.

    Parameters
    ----------
    detailed : MeshClip
        T posed frames.
    variance : (T, n) float
        Predicted variance of a coordinate, metres squared.
    motion : SkeletonClip
        T frames; tells where the front is.
    frames : int or sequence of int, default 7
        How many moments, or which.
    **look
        Passed to `tempose.render.contact_sheet`.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.
    """
    spread = 1000.0 * np.sqrt(np.maximum(variance, 0.0))
    options: dict[str, Any] = {**_look(motion), **look}
    label = "error expected of a coordinate, mm"
    return contact_sheet(
        [detailed], frames, names=["variance"], scalars=[spread], scalar_label=label, **options
    )


def _look(motion: SkeletonClip) -> dict[str, Any]:
    return {"cell": 260, "views": body_views(motion, ("front",), motion.n_frames // 2), "track": True}


def skin_clip(rig: Rig, motion: SkeletonClip) -> MeshClip:
    """Pose the skin alone.

    Parameters
    ----------
    rig : Rig
        n vertices.
    motion : SkeletonClip
        T frames.

    Returns
    -------
    MeshClip
        float32, to be looked at.
    """
    return MeshClip(rig.vertices(motion).astype(np.float32), rig.skin.mesh, motion.fps)
