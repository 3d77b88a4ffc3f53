"""The options of `tempose signals`, one name each, and what they mean as text."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tempose.cli.console import note, progress_bar

if TYPE_CHECKING:
    from tempose.signals import SignalModel

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


def check_model_out(path: Path) -> None:
    """Refuse a place for a model before the work is done that makes it.

    Parameters
    ----------
    path : Path
        Where the model shall go.

    Raises
    ------
    ValueError
        If its ending belongs to clips or pictures, or it is a folder.
    FileNotFoundError
        If its folder does not exist.
    """
    import tempose

    known = {*tempose.formats.FORMATS, ".png", ".gif", ".mp4", ".json", ".toml"}
    if path.suffix.lower() in known:
        raise ValueError(
            f"{path}: a model is written as NAME.tempose; `tempose signals sample` makes clips of it"
        )
    if path.is_dir():
        raise ValueError(f"{path}: is a folder; name a file for the model, such as {path / 'clip.tempose'}")
    check_folder(path)


def check_folder(path: Path) -> None:
    """Refuse an output in a folder that does not exist.

    Parameters
    ----------
    path : Path
        A file or folder to be written.

    Raises
    ------
    FileNotFoundError
        If its parent does not exist.
    """
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path.parent}: no such folder to write {path.name!r} in; create it first")


def load_signals(path: Path) -> SignalModel:
    """Load a model and say in one line what it is.

    Parameters
    ----------
    path : Path
        What `tempose signals fit` wrote.

    Returns
    -------
    SignalModel
        The model.

    Raises
    ------
    ValueError
        If the file holds anything else.
    """
    from tempose.signals import SignalModel

    if path.is_dir():
        raise ValueError(f"{path}: is a folder, expected a model that `tempose signals fit` wrote")
    model = SignalModel.load(path)
    note(describe(model))
    return model


def describe(model: SignalModel) -> str:
    """Say what a model plays.

    Parameters
    ----------
    model : SignalModel
        Any.

    Returns
    -------
    str
        One line.
    """
    signals = model.signals_
    edits = f", {len(model.edits_)} edits" if len(model.edits_) else ""
    return (
        f"signals of {signals.mesh.name or 'a clip'}: {signals.n_frames} frames at {signals.fps:.6g} fps "
        f"({signals.duration:.4g} s), {len(signals.mesh.vertices)} vertices, "
        f"{len(signals.time.curve.controls)} control points{edits}"
    )


def write_plots(model: SignalModel, folder: Path) -> None:
    """Draw a model into a folder, with a progress bar.

    Parameters
    ----------
    model : SignalModel
        What to draw.
    folder : Path
        Where; its parent must exist.
    """
    from tempose.cli.console import writing
    from tempose.signals.pictures import plot_signals

    with progress_bar() as progress, writing(folder):
        written = plot_signals(model, folder, progress=progress)
    note(f"wrote {len(written)} pictures into {folder}")


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
