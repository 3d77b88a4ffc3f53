"""The options of `tempose signals`, one name each, and what they mean as text."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

ClipFile = Annotated[
    str, typer.Argument(metavar="CLIP", help="A moving mesh: file, folder of frames, glob, or name.####.obj.")
]
ModelFile = Annotated[Path, typer.Argument(metavar="MODEL", help="What `tempose signals fit` wrote.")]
OutModel = Annotated[
    Path, typer.Option("-o", "--out", metavar="MODEL", help="Where the model goes, by custom NAME.tempose.")
]
Space = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="How shapes are mixed: vertex (fastest), gradient (bends limbs better between frames), patch, "
        "rotation-invariant or edge-dihedral.",
    ),
]
FitTolerance = Annotated[
    float | None,
    typer.Option(
        metavar="P",
        help="How far frames may be off, rms percent of the mesh's diagonal; 0.5 if nothing is said. "
        "k, l and m follow from it.",
    ),
]
K = Annotated[
    int | None,
    typer.Option("-k", metavar="K", help="Control points of the curve: from 4 to frames + 2."),
]
L = Annotated[
    int | None, typer.Option("-l", metavar="L", help="Poses that hold the pose surface: from 3 to frames.")
]
M = Annotated[int | None, typer.Option("-m", metavar="M", help="Modes of deformation: from 0 to frames - 1.")]
Fix = Annotated[
    list[str] | None,
    typer.Option(
        metavar="FRAME=X,Y",
        help="Put a frame (0-based) at a place of the pose plane; the others arrange themselves. Repeatable.",
    ),
]
Between = Annotated[
    str,
    typer.Option(
        metavar="path|dense|paper",
        help="Between frames: path is smooth in time, edits on top; dense and paper play the pose surface.",
    ),
]
Layout = Annotated[
    str,
    typer.Option(
        metavar="auto|mds", help="Places of the frames: auto avoids bad transitions, mds is the paper's."
    ),
]
Placement = Annotated[
    bool,
    typer.Option(
        "--placement/--no-placement",
        help="Keep where the body stands and faces apart from its shape: for walks, so that loops walk on.",
    ),
]
Period = Annotated[
    str,
    typer.Option(
        metavar="auto|none|FRAMES", help="Frames after which a cyclic clip repeats; auto looks for them."
    ),
]
Window = Annotated[
    int, typer.Option(metavar="N", help="Clips of more frames get pose surfaces of so many frames each.")
]
Examples = Annotated[
    list[str] | None,
    typer.Option(
        metavar="FILE",
        help="Poses that span the shape instead of modes found; file, folder or glob. Repeatable.",
    ),
]
HeldOut = Annotated[
    int,
    typer.Option(
        metavar="N",
        help="For the report: fit every N-th frame and measure how well those between come out; 0 does not.",
    ),
]
ReportFile = Annotated[
    Path | None, typer.Option(metavar="R.json", help="Write errors, seconds and warnings.")
]
Plot = Annotated[
    Path | None,
    typer.Option(metavar="FOLDER", help="Write pictures: pose plane, grid of poses, errors, modes, clock."),
]
InputUp = Annotated[
    str | None,
    typer.Option("--up", "--from-up", metavar="x|y|z", help="Up axis of CLIP, where another than guessed."),
]
InputUnit = Annotated[
    str | None,
    typer.Option(
        "--unit",
        "--from-unit",
        metavar="UNIT",
        help="Unit of CLIP: mm, cm, dm, m, in, ft, or metres per unit.",
    ),
]
InputFps = Annotated[
    float | None,
    typer.Option("--fps", "--from-fps", metavar="F", help="Rate of CLIP, where it states none."),
]


def parse_pins(words: list[str] | None) -> dict[int, tuple[float, float]]:
    """Read what was said after --fix.

    Parameters
    ----------
    words : list of str, optional
        ``FRAME=X,Y`` each.

    Returns
    -------
    dict of int to (float, float)
        Frame to place.

    Raises
    ------
    ValueError
        If one is written otherwise, or a frame is named twice.
    """
    pins: dict[int, tuple[float, float]] = {}
    for word in words or []:
        try:
            frame, place = word.split("=")
            x, y = (float(part) for part in place.split(","))
            number = int(frame)
        except ValueError:
            raise ValueError(f"--fix must be FRAME=X,Y such as 12=0.4,-1.5, got {word!r}") from None
        if number in pins:
            raise ValueError(f"--fix names frame {number} twice")
        pins[number] = (x, y)
    return pins


def parse_period(word: str) -> float | str | None:
    """Read what was said after --period.

    Parameters
    ----------
    word : str
        ``"auto"``, ``"none"`` or a number of frames.

    Returns
    -------
    float, str or None
        As `SignalModel` takes it.

    Raises
    ------
    ValueError
        If it is anything else.
    """
    if word in ("auto", "none"):
        return "auto" if word == "auto" else None
    try:
        return float(word)
    except ValueError:
        raise ValueError(f"--period must be auto, none or a number of frames, got {word!r}") from None


def parse_numbers(word: str, count: int, name: str) -> tuple[float, ...]:
    """Read numbers between commas.

    Parameters
    ----------
    word : str
        What was said.
    count : int
        How many there must be.
    name : str
        The option, for the message.

    Returns
    -------
    tuple of float
        The numbers.

    Raises
    ------
    ValueError
        If they are not `count` finite numbers.
    """
    try:
        numbers = tuple(float(part) for part in word.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != count or not all(map(math.isfinite, numbers)):
        raise ValueError(f"{name} must be {count} numbers between commas, got {word!r}")
    return numbers


def merged_options(values: dict[str, Any], *apart: str) -> dict[str, Any]:
    """Return the options a command was given, as a report holds them.

    Parameters
    ----------
    values : dict
        Its local names.
    *apart : str
        Names that are inputs or not options.

    Returns
    -------
    dict
        The rest.
    """
    return {name: value for name, value in values.items() if name not in apart}
