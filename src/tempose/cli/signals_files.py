"""The files that `tempose signals` reads and writes: checked before the work, told of afterwards."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tempose.cli.console import note, progress_bar, writing

if TYPE_CHECKING:
    from tempose.signals import SignalModel


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
    from tempose.signals.pictures import plot_signals

    with progress_bar() as progress, writing(folder):
        written = plot_signals(model, folder, progress=progress)
    note(f"wrote {len(written)} pictures into {folder}")
