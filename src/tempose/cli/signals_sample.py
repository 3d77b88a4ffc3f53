"""`tempose signals sample`: a model becomes a clip again, at any rate and any moments."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

import tempose
from tempose.cli.console import note, progress_bar, writing
from tempose.cli.options import Tolerance, UnitOption, Up, check_out
from tempose.cli.signals_files import load_signals
from tempose.cli.signals_options import ModelFile
from tempose.cli.transfer_frames import releasing, room_for_frames
from tempose.typing import FloatArray

Out = Annotated[
    Path,
    typer.Option(
        "-o",
        "--out",
        metavar="OUT",
        help="Its ending chooses the format; a folder or name.####.obj takes frames.",
    ),
]
NewFps = Annotated[
    float | None,
    typer.Option(
        metavar="F",
        help="Frames a second of the output; twice as many put one between each two.",
    ),
]
Times = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Text: which moment each frame shows, one time in seconds a line."),
]


def sample(  # numpydoc ignore=PR01
    model_file: ModelFile,
    out: Out,
    fps: NewFps = None,
    times: Times = None,
    up: Up = None,
    unit: UnitOption = None,
    tolerance: Tolerance = None,
) -> None:
    """Play a model into a clip: at its own rate, at another, or at moments of your choice."""
    check_out(out)
    if tolerance is not None and out.suffix.lower() != ".glb":
        raise ValueError(f"{out}: --tolerance is for .glb")
    seconds = None if times is None else read_times(times)
    model = load_signals(model_file)
    if fps is not None and not 0 < fps < math.inf:
        raise ValueError(f"--fps must be positive, got {fps}")
    if seconds is not None:
        beyond = int(((seconds < 0) | (seconds > model.signals_.duration + 1e-9)).sum())
        if beyond:
            note(
                f"note: {beyond} of {len(seconds)} times lie outside 0 to {model.signals_.duration:.6g} s; "
                "the first or the last pose holds there"
            )
    count = len(model.frame_times(fps) if seconds is None else seconds)
    n = len(model.signals_.mesh.vertices)
    with room_for_frames(count, n, out) as scratch, progress_bar() as progress, writing(out):
        room = None if scratch is None else _map(scratch / "frames", (count, n, 3))
        progress(0, 0, "playing")
        clip = model.clip(fps, seconds, out=room)
        tell = progress if scratch is None else releasing(progress, clip)
        if tolerance is None:
            tempose.save(out, clip, up=up, unit=unit, progress=tell)
        else:
            from tempose.formats.glb import write

            write(out, clip, tolerance=tolerance, progress=tell)
    note(f"wrote {out}: {count} frames at {clip.fps:.6g} fps, {n} vertices")


def _map(path: Path, shape: tuple[int, int, int]) -> FloatArray:
    return np.lib.format.open_memmap(path, mode="w+", dtype=np.float32, shape=shape)


def read_times(path: Path) -> FloatArray:
    """Read times from a text file.

    Parameters
    ----------
    path : Path
        One time in seconds a line; empty lines and what follows ``#`` are skipped.

    Returns
    -------
    (K,) ndarray
        Seconds.

    Raises
    ------
    ValueError
        If a line holds anything else, or no line holds a time; the message names the line.
    """
    found: list[float] = []
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError:
        raise ValueError(f"{path}: expected text with one time in seconds a line, found bytes") from None
    for number, line in enumerate(lines, start=1):
        word = line.split("#")[0].strip()
        if not word:
            continue
        try:
            found.append(float(word))
        except ValueError:
            raise ValueError(f"{path}, line {number}: expected one time in seconds, found {word!r}") from None
        if not math.isfinite(found[-1]):
            raise ValueError(f"{path}, line {number}: a time must be finite, found {word!r}")
    if not found:
        raise ValueError(f"{path}: expected one time in seconds a line, found no line with one")
    return np.array(found)
