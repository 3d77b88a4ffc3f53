"""What is shown: a clip, some of its frames, the floor it stands on."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.typing import BoolArray, IntArray


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


def wire_of(mesh: Mesh, wire: Any) -> Any:
    """Return which edges to draw: of a mesh of polygons not the diagonals.

    Parameters
    ----------
    mesh : Mesh
        What is drawn.
    wire : bool or array_like
        As `tempose.render.render_frame` takes it.

    Returns
    -------
    bool or array_like
        The same, but for True and polygons the edges of these.
    """
    if wire is True and mesh.polygons is not None:
        return polygon_edges(mesh.polygons)
    return wire


def polygon_edges(polygons: IntArray) -> BoolArray:
    """Return which edges of fans of triangles are edges of their polygons.

    Parameters
    ----------
    polygons : (p,) int
        Corners of each polygon; one of k corners is a fan of k - 2 triangles around its first.

    Returns
    -------
    (m, 3) ndarray of bool
        By triangle and corner across from the edge.

    Examples
    --------
    >>> polygon_edges(np.array([3, 4])).astype(int)
    array([[1, 1, 1],
           [1, 0, 1],
           [1, 1, 0]])
    """
    sizes = np.asarray(polygons) - 2
    last = np.cumsum(sizes) - 1
    edges = np.ones((int(sizes.sum()), 3), dtype=np.bool_)
    edges[:, 1] = edges[:, 2] = False
    edges[last, 1] = True
    edges[last - sizes + 1, 2] = True
    return edges
