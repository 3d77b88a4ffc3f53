"""From where a body is looked at: before its face, not before an axis of the room."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tempose.clips import SkeletonClip
from tempose.kinematics import find_roles, forward_kinematics
from tempose.render import contact_sheet
from tempose.render.colors import Picture
from tempose.render.views import NAMED_VIEWS

_SIDES = (("left_thigh", "right_thigh"), ("left_upper_arm", "right_upper_arm"))


def facing_azimuth(motion: SkeletonClip, frame: int = 0) -> float:
    """Return the azimuth from which a body is seen from the front.

    Parameters
    ----------
    motion : SkeletonClip
        Any; a skeleton without legs or arms of two sides counts as facing +Z.
    frame : int, default 0
        The moment.

    Returns
    -------
    float
        Radians, as cameras count them: 0 looks at what faces +Z.
    """
    try:
        roles = find_roles(motion.skeleton)
    except ValueError:
        return 0.0
    moment = motion.frames(np.array([frame]))
    places = forward_kinematics(motion.skeleton, moment.rotations, moment.root_position)[1][0]
    for left, right in _SIDES:
        if left in roles and right in roles:
            way = places[roles[left]] - places[roles[right]]
            if np.hypot(way[0], way[2]) > 1e-9:
                # the left hand points to +X where the body faces +Z
                return float(np.arctan2(-way[2], way[0]))
    return 0.0


def body_views(motion: SkeletonClip, names: Sequence[str], frame: int = 0) -> list[tuple[float, float]]:
    """Turn named views with the body.

    Parameters
    ----------
    motion : SkeletonClip
        Any.
    names : sequence of str
        Out of `tempose.render.NAMED_VIEWS`.
    frame : int, default 0
        The moment whose front counts.

    Returns
    -------
    list of (float, float)
        Azimuth and elevation, radians.
    """
    turn = facing_azimuth(motion, frame)
    return [(NAMED_VIEWS[name][0] + turn, NAMED_VIEWS[name][1]) for name in names]


def abreast(
    clip: Any, frames: int | Sequence[int], names: Sequence[str], views: Sequence[Any], **look: Any
) -> Picture:
    """Put views of a clip side by side, where a contact sheet puts them below one another.

    Parameters
    ----------
    clip : Mesh or MeshClip
        What to show.
    frames : int or sequence of int
        As for `tempose.render.contact_sheet`.
    names : sequence of str
        Caption of each view.
    views : sequence
        As for `tempose.render.contact_sheet`.
    **look
        Passed on.

    Returns
    -------
    (height, width, 3) ndarray of uint8
        sRGB picture.
    """
    sheets = [contact_sheet(clip, frames, (view,), names=[name], **look) for name, view in zip(names, views)]
    return np.concatenate(sheets, axis=1)
