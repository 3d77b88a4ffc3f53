"""Where the camera stands through a clip: still, or beside the model as it walks."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from tempose.clips import Mesh, MeshClip
from tempose.render.camera import Camera, box_corners, view_named
from tempose.typing import FloatArray


def as_clip(model: Mesh | MeshClip) -> MeshClip:
    """Return a still mesh as a clip of one frame, and a clip as it is.

    Parameters
    ----------
    model : Mesh or MeshClip
        What to show.

    Returns
    -------
    MeshClip
        At least one frame.

    Raises
    ------
    ValueError
        If the clip has no frames.
    TypeError
        If it is neither.
    """
    if isinstance(model, Mesh):
        return MeshClip(model.vertices[None].astype(np.float32), model)
    if not isinstance(model, MeshClip):
        raise TypeError(f"a Mesh or a MeshClip is needed, got {type(model).__name__}")
    if model.n_frames == 0:
        raise ValueError(f"clip {model.name!r} has no frames to show")
    return model


def floor_level(clip: MeshClip, ground: float | str | None) -> float | None:
    """Return the height of the floor that was asked for.

    Parameters
    ----------
    clip : MeshClip
        What stands on it.
    ground : float, "auto" or None
        Metres, a guess by `ground_level`, or no floor.

    Returns
    -------
    float or None
        Metres.

    Raises
    ------
    ValueError
        If it is another word.
    """
    if not isinstance(ground, str):
        return ground
    if ground != "auto":
        raise ValueError(f"ground must be a height in metres, 'auto' or None, got {ground!r}")
    return ground_level(clip)


def ground_level(clip: MeshClip) -> float:
    """Guess the height of the floor: 0 if the model stands about there, otherwise its lowest point.

    Parameters
    ----------
    clip : MeshClip
        What stands on it.

    Returns
    -------
    float
        Metres.
    """
    V = clip.vertices[..., 1]
    if V.size == 0:
        return 0.0
    low, height = float(V.min()), float(np.ptp(V[0]))
    return 0.0 if abs(low) <= 0.06 * height else low


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


def frame_choice(frames: Any, n_frames: int) -> list[int]:
    """Return the frames to show.

    Parameters
    ----------
    frames : int or sequence of int
        How many, evenly spread from the first to the last; or which.
    n_frames : int
        Number of frames of the clip.

    Returns
    -------
    list of int
        Frame numbers.

    Raises
    ------
    ValueError
        If a frame does not exist or none is asked for.
    """
    if isinstance(frames, (int, np.integer)):
        if frames < 1:
            raise ValueError(f"frames must be at least 1, got {frames}")
        count = min(int(frames), n_frames)
        return [int(t) for t in np.round(np.linspace(0, n_frames - 1, count))]
    chosen = [int(t) for t in frames]
    bad = [t for t in chosen if not 0 <= t < n_frames]
    if bad or not chosen:
        raise ValueError(f"frames must be from 0 to {n_frames - 1}, got {bad or chosen}")
    return chosen
