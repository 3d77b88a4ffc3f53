"""Directions to look from, by name."""

from __future__ import annotations

import numpy as np

NAMED_VIEWS = {
    "front": (0.0, 0.0),
    "left": (np.pi / 2, 0.0),
    "side": (np.pi / 2, 0.0),
    "back": (np.pi, 0.0),
    "right": (-np.pi / 2, 0.0),
    "top": (0.0, np.pi / 2),
    "three-quarter": (np.radians(35.0), np.radians(12.0)),
}
"""Azimuth and elevation in radians; ``"left"`` looks at the model's left side, which is +X."""


def view_named(view: str | float | tuple[float, float]) -> tuple[float, float]:
    """Return the direction of a view.

    Parameters
    ----------
    view : str, float or (float, float)
        A name out of `NAMED_VIEWS`, an azimuth, or azimuth and elevation in radians.

    Returns
    -------
    (float, float)
        Azimuth and elevation, radians.

    Raises
    ------
    ValueError
        If there is no view of that name.
    """
    if isinstance(view, str):
        if view not in NAMED_VIEWS:
            raise ValueError(f"a view must be an angle or one of {', '.join(NAMED_VIEWS)}, got {view!r}")
        return NAMED_VIEWS[view]
    if isinstance(view, tuple):
        return float(view[0]), float(view[1])
    return float(view), 0.0


def view_label(view: str | float | tuple[float, float]) -> str:
    """Return the name of a view for a caption.

    Parameters
    ----------
    view : str, float or (float, float)
        As in `tempose.render.clip_cameras`.

    Returns
    -------
    str
        Its name, or its azimuth in degrees.
    """
    if isinstance(view, str):
        return view
    return f"{np.degrees(view[0] if isinstance(view, tuple) else view):.0f}°"
