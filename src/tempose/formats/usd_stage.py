"""A USD file opened: axes, unit, the times of its frames."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import Source
from tempose.formats.conventions import FormatError, y_up_rotation
from tempose.typing import FloatArray

_USUAL_RATE = 24.0
_SLOWEST, _FASTEST = 5.0, 1000.0
_MOST_EMPTY = 20_000


@dataclass(frozen=True)
class Stage:
    """A stage and how its coordinates become ours."""

    usd: Any
    """The ``pxr.Usd.Stage``."""
    place: str
    """The file, for messages."""
    frame: FloatArray
    """(4, 4) from the axes and unit of the file to metres, Y up."""
    source: Source
    """What the file says, without the rate."""

    def error(self, message: str) -> FormatError:
        """Make an error that names the file.

        Parameters
        ----------
        message : str
            What was expected and what was found.

        Returns
        -------
        FormatError
            To be raised.
        """
        return FormatError(f"{self.place}: {message}")


@dataclass(frozen=True)
class FrameTimes:
    """Which moments of a stage become frames."""

    codes: FloatArray
    """(T,) time codes."""
    fps: float
    """Frames per second."""
    found: float | None
    """Rate that the file states or shows; None where nothing moves."""


def modules(place: str) -> Any:
    """Import usd-core.

    Parameters
    ----------
    place : str
        The file it is wanted for.

    Returns
    -------
    module
        ``pxr``, with its submodules Usd, UsdGeom, UsdSkel, Gf, Vt, Sdf and Tf.

    Raises
    ------
    FormatError
        If it is not installed.
    """
    try:
        import pxr
        from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdSkel, Vt  # noqa: F401  # pyright: ignore
    except ImportError:
        raise FormatError(f'{place}: USD files need usd-core; pip install "tempose[usd]"') from None
    return pxr


def identifier(name: str) -> str:
    """Make a name that a path in USD may hold.

    Parameters
    ----------
    name : str
        Any name.

    Returns
    -------
    str
        Letters, digits and underscores, not starting with a digit.

    Examples
    --------
    >>> identifier("left arm.001")
    'left_arm_001'
    """
    plain = re.sub(r"[^0-9A-Za-z_]", "_", name) or "_"
    return f"_{plain}" if plain[0].isdigit() else plain


def open_stage(path: str | os.PathLike[str], up: str | None, unit: float | None) -> Stage:
    """Open a file.

    Parameters
    ----------
    path : path-like
        A ``.usda``, ``.usdc`` or ``.usd`` file.
    up : str, optional
        Up axis where it is other than stated.
    unit : float, optional
        Metres per unit where it is other than stated.

    Returns
    -------
    Stage
        With everything loaded.

    Raises
    ------
    FormatError
        If it is no USD file, or usd-core is missing.
    """
    place = os.fspath(path)
    pxr = modules(place)
    if not Path(place).is_file():
        raise FormatError(f"{place}: no such file")
    try:
        usd = pxr.Usd.Stage.Open(place)
    except pxr.Tf.ErrorException as error:
        reason = str(error).strip().splitlines()[-1].strip(" \t'")[:200]
        raise FormatError(f"{place}: expected a USD scene, found one that cannot be read: {reason}") from None
    stated_up = str(pxr.UsdGeom.GetStageUpAxis(usd)).lower()
    stated_unit = float(pxr.UsdGeom.GetStageMetersPerUnit(usd))
    metres = unit or stated_unit
    if not 0 < metres < float("inf"):
        raise FormatError(f"{place}: expected metersPerUnit above 0, found {stated_unit}; state the unit")
    guessed = [] if unit or usd.HasAuthoredMetadata("metersPerUnit") else ["unit"]
    frame = np.eye(4)
    frame[:3, :3] = y_up_rotation(up or stated_up) * metres
    source = Source(place, "usd", up or stated_up, metres, None, tuple(guessed))
    return Stage(usd, place, frame, source)


def frame_times(stage: Stage, samples: set[float], fps: float | None) -> FrameTimes:
    """Choose the moments that become frames.

    Parameters
    ----------
    stage : Stage
        The file.
    samples : set of float
        Time codes at which something is sampled.
    fps : float, optional
        Rate to sample at.

    Returns
    -------
    FrameTimes
        From the stated start to the stated end, else from the first sample to the last; at the rate of the
        samples where they are even, else at one frame a time code. One frame where nothing moves.

    Raises
    ------
    FormatError
        If that would be absurdly many frames.
    """
    usd = stage.usd
    codes = np.array(sorted(samples))
    per_second = float(usd.GetTimeCodesPerSecond()) or _USUAL_RATE
    if len(codes) < 2:
        return FrameTimes(codes if len(codes) else np.zeros(1), fps or per_second, None)
    start, end = codes[0], codes[-1]
    if usd.HasAuthoredTimeCodeRange() and usd.GetStartTimeCode() < usd.GetEndTimeCode():
        # a range beside the samples is a leftover
        first, last = max(start, usd.GetStartTimeCode()), min(end, usd.GetEndTimeCode())
        start, end = (first, last) if first < last else (start, end)
    gaps = np.diff(codes)
    even = np.ptp(gaps) < 1e-3 * gaps.max()
    shown = per_second / gaps.mean() if even else per_second
    rate = fps or (shown if _SLOWEST <= shown <= _FASTEST else per_second)
    step = per_second / rate
    count = int((end - start) / step + 1e-3) + 1
    if count > _MOST_EMPTY + 100 * len(codes):
        raise stage.error(
            f"{len(codes)} samples from {start:g} to {end:g} would make {count} frames at {rate:g} fps"
        )
    return FrameTimes(start + step * np.arange(count), float(rate), float(shown) if even else None)
