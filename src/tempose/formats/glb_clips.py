"""Which animation to play and at which times: glTF has keys but no frame rate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.formats._names import distinct
from tempose.formats.glb_container import Document
from tempose.formats.glb_json import Item
from tempose.formats.glb_keys import Channel, read_channels, sample
from tempose.formats.glb_nodes import Nodes
from tempose.formats.glb_rate import key_rate, stated_rate
from tempose.typing import FloatArray

_GUESS = 30.0
_SNAP = 1e-3


@dataclass(frozen=True)
class Motion:
    """An animation and the times at which it is sampled."""

    name: str
    """Name of the animation, empty if the file has none."""
    channels: tuple[Channel, ...]
    """What moves."""
    times: FloatArray
    """(T,) seconds in the time of the file."""
    fps: float
    """Frames per second of `times`."""
    found: float | None
    """Rate read from the file, None where its keys show none."""
    notes: tuple[str, ...]
    """What was unusual."""
    guessed: bool
    """Whether `fps` is a guess."""

    def at(self, frames: slice) -> dict[tuple[int, str], FloatArray]:
        """Sample all channels.

        Parameters
        ----------
        frames : slice
            Frames to sample.

        Returns
        -------
        dict of (node, path) to (T, width) ndarray
            As `tempose.formats.glb_nodes.world_matrices` wants them.
        """
        # float32 keys are coarser than that late in a long clip
        times, snap = self.times[frames], max(_SNAP / self.fps, 2.4e-7 * float(np.abs(self.times[-1])))
        return {(c.node, c.path): sample(c, times, snap) for c in self.channels}


def animation_names(doc: Document) -> tuple[str, ...]:
    """Names of the animations, made distinct.

    Parameters
    ----------
    doc : Document
        The file.

    Returns
    -------
    tuple of str
        One a clip; unnamed ones are ``clip_0`` and so on by their index.
    """
    return distinct([item.text("name") or f"clip_{i}" for i, item in enumerate(doc.top.items("animations"))])


def read_motion(doc: Document, nodes: Nodes, clip: str | None, fps: float | None) -> Motion:
    """Choose an animation and its frame times.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.
    clip : str, optional
        Name of the animation; the first if not given.
    fps : float, optional
        Rate to sample at; from the keys if not given.

    Returns
    -------
    Motion
        With one frame if the file has no animation.

    Raises
    ------
    FormatError
        If there is no such animation; the message lists the names.
    ValueError
        If `fps` is not positive.
    """
    if fps is not None and not 0 < fps <= 1e4:
        raise ValueError(f"fps must be positive and at most 10000, got {fps}")
    names = animation_names(doc)
    if clip is not None and clip not in names:
        known = f"the file has {', '.join(map(repr, names))}" if names else "the file has no animation"
        raise doc.top.error(f"no clip named {clip!r}; {known}")
    if not names:
        return Motion("", (), np.zeros(1), fps or _GUESS, None, ("No animation: one frame.",), fps is None)
    index = 0 if clip is None else names.index(clip)
    animation = doc.top.items("animations")[index]
    channels = read_channels(doc, animation, nodes)
    return _timed(animation, names[index], channels, fps)


def _timed(animation: Item, name: str, channels: tuple[Channel, ...], fps: float | None) -> Motion:
    keys = np.unique(np.concatenate([[], *(c.times for c in channels)]))
    if not len(keys):
        return Motion(name, channels, np.zeros(1), fps or _GUESS, None, ("No keys: one frame.",), fps is None)
    found, even = stated_rate(animation, keys), True
    if found is None:
        found, even = key_rate(keys)
    rate = fps or found or _GUESS
    frames = int((keys[-1] - keys[0]) * rate + _SNAP) + 1
    if frames > 20_000 + 100 * len(keys):
        raise animation.error(
            f"{len(keys)} keys from {keys[0]:g} to {keys[-1]:g} s would make {frames} frames at {rate:g} fps"
        )
    notes: list[str] = []
    if not even:
        usual = f"are not evenly spaced; most are 1/{found:g} s apart" if found else "show no frame rate"
        notes.append(f"Keys {usual}.")
    if keys[0] > _SNAP / rate:
        notes.append(f"Keys start at {keys[0]:.4g} s, which is frame 0 here.")
    times = keys[0] + np.arange(frames) / rate
    known = found if even else None
    return Motion(name, channels, times, rate, known, tuple(notes), fps is None and known is None)
