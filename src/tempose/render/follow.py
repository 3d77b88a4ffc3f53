"""Where the camera stands through a clip: still, or beside the model as it walks."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from tempose.clips import MeshClip
from tempose.render.camera import Camera, box_corners
from tempose.render.views import view_named
from tempose.typing import FloatArray


def frame_boxes(clip: MeshClip) -> FloatArray:
    """Return the bounding box of each frame.

    Parameters
    ----------
    clip : MeshClip
        A clip with vertices.

    Returns
    -------
    (T, 2, 3) ndarray of float64
        Lower and upper corner, metres.
    """
    if clip.vertices.shape[1] == 0:
        return np.tile([[-1.0] * 3, [1.0] * 3], (clip.n_frames, 1, 1))
    return np.stack([[v.min(axis=0), v.max(axis=0)] for v in clip.vertices]).astype(np.float64)


def root_path(clip: MeshClip, smooth: float = 0.25) -> FloatArray:
    """Return where the middle of the model is over the floor, smoothed.

    Parameters
    ----------
    clip : MeshClip
        A clip.
    smooth : float, default 0.25
        Standard deviation in seconds.

    Returns
    -------
    (T, 3) ndarray of float64
        Metres, relative to the first frame; y is 0.
    """
    if clip.vertices.shape[1] == 0:
        return np.zeros((clip.n_frames, 3))
    path = np.stack([v.mean(axis=0, dtype=np.float64) for v in clip.vertices])
    path = gaussian_filter1d(path, max(smooth * clip.fps, 1e-6), axis=0, mode="nearest")
    return (path - path[0]) * [1.0, 0.0, 1.0]


def clip_cameras(
    clip: MeshClip,
    view: str | float | tuple[float, float] = "three-quarter",
    *,
    aspect: float = 1.0,
    track: bool | None = None,
    fov: float = np.radians(28.0),
    elevation: float | None = None,
    margin: float = 0.08,
    roam: float = 1.0,
) -> list[Camera]:
    """Place a camera for every frame of a clip.

    Parameters
    ----------
    clip : MeshClip
        What to look at.
    view : str, float or (float, float), default "three-quarter"
        Name, azimuth, or azimuth and elevation in radians.
    aspect : float, default 1
        Width over height of the picture.
    track : bool, optional
        Whether the camera goes with the model over the floor. None: if that travels more than `roam` times
        its size.
    fov : float, default 28 degrees
        Vertical angle of view in radians; 0 for a parallel camera.
    elevation : float, optional
        Radians; takes the place of that of the view.
    margin : float, default 0.08
        Empty border, as a share of the half picture.
    roam : float, default 1
        See `track`.

    Returns
    -------
    list of Camera
        One per frame; all the same unless tracked.
    """
    azimuth, up = view_named(view)
    boxes, path = frame_boxes(clip), root_path(clip)
    if track is None:
        size = float(np.ptp(boxes, axis=1).max())
        track = bool(np.ptp(path, axis=0).max() > roam * size)
    moved = boxes - path[:, None] if track else boxes
    corners = np.concatenate([box_corners(box) for box in moved])
    camera = Camera.fit(
        corners, azimuth, up if elevation is None else elevation, fov, aspect=aspect, margin=margin
    )
    return [camera.moved(p) if track else camera for p in path]


def good_aspect(clip: MeshClip, view: str | float | tuple[float, float], low: float, high: float) -> float:
    """Return the width over height that suits what a camera sees of a clip.

    Parameters
    ----------
    clip : MeshClip
        What to look at.
    view : str, float or (float, float)
        As in `clip_cameras`.
    low, high : float
        Limits.

    Returns
    -------
    float
        Width over height.
    """
    moved = frame_boxes(clip) - root_path(clip)[:, None]
    camera = Camera.fit([moved.min(axis=(0, 1)), moved.max(axis=(0, 1))], *view_named(view), 0.0)
    extent = np.ptp(
        box_corners(np.array([moved.min(axis=(0, 1)), moved.max(axis=(0, 1))])) @ camera.axes.T, axis=0
    )
    return float(np.clip(extent[0] / max(extent[1], 1e-9), low, high))
