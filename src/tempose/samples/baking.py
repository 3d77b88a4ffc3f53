"""A built-in character in a built-in motion."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np

from tempose.clips import MeshClip, SkeletonClip
from tempose.kinematics.skinning import bake
from tempose.samples.character import Character, animal_character, human_character
from tempose.samples.motions import find_motion
from tempose.samples.secondary import secondary_motion
from tempose.typing import FloatArray

SETTLE = 3.0
"""Seconds after which flesh and cloth have forgotten how a loop began."""


def sample_clip(
    character: str = "human",
    motion: str = "walk",
    *,
    triangles: int = 20_000,
    fps: float = 30.0,
    secondary: bool | float = True,
    loop: bool = False,
    **options: Any,
) -> MeshClip:
    """Make a clip from nothing.

    Parameters
    ----------
    character : str, default "human"
        ``"human"`` or ``"animal"``.
    motion : str, default "walk"
        One of its motions, see `tempose.samples.MOTIONS`.
    triangles : int, default 20000
        Wanted number of triangles.
    fps : float, default 30.0
        Frames per second.
    secondary : bool or float, default True
        Whether flesh wobbles and cloth swings; a number is a factor on how much.
    loop : bool, default False
        For walk, run, gallop and idle: whole strides, in which flesh and cloth repeat, too.
    **options
        What the motion takes: ``duration``, ``speed``, ``seed`` and so on.

    Returns
    -------
    MeshClip
        Its rest pose is that of the character; the same call gives the same clip.

    Raises
    ------
    ValueError
        If there is no such character or motion, or a number is out of range.

    Examples
    --------
    >>> sample_clip("human", "run", triangles=2000, duration=0.5).n_frames  # doctest: +SKIP
    16
    """
    make = find_motion(character, motion)
    body = (human_character if character == "human" else animal_character)(triangles)
    if loop:
        options["loop"] = True
    clip: SkeletonClip = make(body.skin.skeleton, fps=fps, **options)
    amount = float(secondary)
    if not (loop and amount):
        return _clip(body, clip, _vertices(body, clip, amount))
    n = clip.n_frames
    times = 1 + ceil(SETTLE * fps / n)
    long: SkeletonClip = make(body.skin.skeleton, fps=fps, **{**options, "duration": times * n / fps})
    V = _vertices(body, long, amount)[-n:]
    return _clip(body, clip, V - (long.root_position[-n] - clip.root_position[0]))


def _vertices(body: Character, clip: SkeletonClip, amount: float) -> FloatArray:
    V = bake(body.skin, clip)
    return secondary_motion(body.skin, clip, V, body.regions, scale=amount) if amount else V


def _clip(body: Character, clip: SkeletonClip, V: FloatArray) -> MeshClip:
    return MeshClip(V.astype(np.float32), body.skin.mesh, clip.fps)
