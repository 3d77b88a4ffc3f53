"""Films of clips, turntables of meshes, and the file for any of them by its extension."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.render.camera import Camera
from tempose.render.colors import Picture
from tempose.render.follow import clip_cameras
from tempose.render.frame import render_frame
from tempose.render.sheet import contact_sheet
from tempose.render.subject import as_clip, floor_level, frame_choice, wire_of
from tempose.render.text import draw_text
from tempose.render.themes import rgb, theme_named
from tempose.render.video import save_mp4
from tempose.render.workers import in_order
from tempose.render.writers import save_gif, save_png
from tempose.typing import Progress, silent

FORMATS = (".png", ".gif", ".mp4")


def film(
    clip: Mesh | MeshClip,
    view: str | float | tuple[float, float] | Camera = "three-quarter",
    *,
    size: tuple[int, int] = (640, 640),
    frames: Sequence[int] | None = None,
    ground: float | str | None = "auto",
    track: bool | None = None,
    segments: Any = None,
    points: Any = None,
    captions: bool = False,
    workers: int | None = None,
    **look: Any,
) -> Iterator[Picture]:
    """Render the frames of a clip one after the other.

    Parameters
    ----------
    clip : Mesh or MeshClip
        What to show.
    view : str, float, (float, float) or Camera, default "three-quarter"
        Name, azimuth, azimuth and elevation in radians, or a camera for the whole clip.
    size : (int, int), default (640, 640)
        Width and height, pixels.
    frames : sequence of int, optional
        Which frames; else all.
    ground : float, "auto" or None, default "auto"
        Height of the floor, metres; None for no floor.
    track : bool, optional
        Whether the camera goes with the model; None decides by how far it travels.
    segments : (T, k, 2, 3) array_like, optional
        Bones drawn over the frames, metres.
    points : (T, p, 3) array_like, optional
        Markers drawn over the frames, metres.
    captions : bool, default False
        Whether to write frame number and time into the lower left corner.
    workers : int, optional
        Frames rendered at a time; None for one per core, at most four.
    **look
        Passed to `render_frame`.

    Yields
    ------
    (height, width, 3) ndarray of uint8
        sRGB pictures.
    """
    clip = as_clip(clip)
    level = floor_level(clip, ground)
    path = (
        [view] * clip.n_frames
        if isinstance(view, Camera)
        else clip_cameras(clip, view, aspect=size[0] / size[1], track=track)
    )

    def picture(t: int) -> Picture:
        options = dict(look)
        for key, array in (("lines", segments), ("points", points)):
            if array is not None:
                options[key] = array[t]
        options["wire"] = wire_of(clip.mesh, options.get("wire", False))
        done = render_frame(clip.vertices[t], clip.faces, path[t], size=size, ground=level, **options)
        if captions:
            ink = rgb(theme_named(look.get("theme", "light")).text_2)
            draw_text(done, f"{t}   {t / clip.fps:.2f} s", (10, size[1] - 8), 13, ink, anchor="ld")
        return done

    chosen = range(clip.n_frames) if frames is None else frame_choice(frames, clip.n_frames)
    yield from in_order(picture, chosen, workers)


def turntable(
    mesh: Mesh | MeshClip,
    count: int = 48,
    *,
    elevation: float = np.radians(12.0),
    size: tuple[int, int] = (640, 640),
    ground: float | str | None = "auto",
    workers: int | None = None,
    **look: Any,
) -> Iterator[Picture]:
    """Render a mesh while the camera goes once around it.

    Parameters
    ----------
    mesh : Mesh or MeshClip
        What to show; of a clip the first frame.
    count : int, default 48
        Number of pictures.
    elevation : float, default 12 degrees
        Radians above the horizon.
    size : (int, int), default (640, 640)
        Width and height, pixels.
    ground : float, "auto" or None, default "auto"
        Height of the floor, metres; None for no floor.
    workers : int, optional
        Pictures rendered at a time; None for one per core, at most four.
    **look
        Passed to `render_frame`.

    Yields
    ------
    (height, width, 3) ndarray of uint8
        sRGB pictures.
    """
    clip = as_clip(mesh)
    look["wire"] = wire_of(clip.mesh, look.get("wire", False))
    level = floor_level(clip, ground)
    V = clip.vertices[0].astype(np.float64)
    centre = (V.min(axis=0) + V.max(axis=0)) / 2
    reach = np.hypot(V[:, 0] - centre[0], V[:, 2] - centre[2]).max()
    # A box that is the same from every side keeps the camera at one distance.
    low, high = V.min(axis=0), V.max(axis=0)
    low[[0, 2]], high[[0, 2]] = centre[[0, 2]] - 0.75 * reach, centre[[0, 2]] + 0.75 * reach

    def picture(azimuth: float) -> Picture:
        camera = Camera.fit([low, high], azimuth, elevation, aspect=size[0] / size[1])
        return render_frame(V, clip.faces, camera, size=size, ground=level, **look)

    yield from in_order(picture, np.arange(count) * (2 * np.pi / count), workers)


def render(
    clips: Mesh | MeshClip | Sequence[Mesh | MeshClip],
    path: str | os.PathLike[str],
    *,
    progress: Progress = silent,
    **options: Any,
) -> None:
    """Render a clip into a file: PNG is a contact sheet, GIF and MP4 are films.

    Parameters
    ----------
    clips : Mesh, MeshClip or sequence of them
        What to show; several side by side in films, one under the other in sheets.
    path : path-like
        File to write or replace, ``.png``, ``.gif`` or ``.mp4``.
    progress : Progress, default silent
        Called after each picture.
    **options
        Passed to `contact_sheet` or `film`.

    Raises
    ------
    ValueError
        If the extension is another.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        raise ValueError(
            f"{path}: pictures are written as {', '.join(FORMATS)}, got {suffix or 'no extension'!r}"
        )
    if suffix == ".png":
        save_png(contact_sheet(clips, progress=progress, **options), path)
        return
    shown = [as_clip(c) for c in ([clips] if isinstance(clips, (Mesh, MeshClip)) else clips)]
    frames = options.pop("frames", None)
    if frames is None:
        frames = list(range(min(clip.n_frames for clip in shown)))
    films = [film(clip, frames=frames, **options) for clip in shown]
    joined = (np.concatenate(pictures, axis=1) for pictures in zip(*films))
    save = save_gif if suffix == ".gif" else save_mp4
    save(joined, path, shown[0].fps, total=len(frames), progress=progress)
