"""A fitted model of signals as one ``.tempose`` file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tempose.clips.source import Source
from tempose.models import load_model, save_model
from tempose.signals.fit.options import FitOptions
from tempose.signals.saving.tree import from_arrays, to_arrays
from tempose.signals.signals import Signals
from tempose.typing import FloatArray

if TYPE_CHECKING:
    from tempose.signals.model import SignalModel

KIND = "signals"
"""As in the header of the file."""

_PARTS = {"signals_": Signals, "positions_": np.ndarray, "site_frames_": np.ndarray, "source_": Source}


def write_signal_model(model: SignalModel, path: str | os.PathLike[str]) -> Path:
    """Write a fitted model.

    Parameters
    ----------
    model : SignalModel
        Fitted.
    path : path-like
        Where to.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    OSError
        If the place cannot be written.
    """
    arrays: dict[str, FloatArray] = {}
    tree = {name: to_arrays(getattr(model, name), name.strip("_"), arrays) for name in _PARTS}
    header = {
        "options": asdict(model.options),
        "report": model.report_,
        "edits": [_plain(edit) for edit in model.edits_],
        "made_from": model.source_.path,
        "tree": tree,
    }
    return save_model(path, KIND, arrays, header)


def read_signal_model(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Read a fitted model.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    options : dict
        Arguments of the constructor.
    state : dict
        What `fit` and edits have set, by attribute.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is no model of signals, cut short, or of a newer version; the message names it.
    """
    arrays, header = load_model(path, KIND)
    try:
        for name, array in arrays.items():
            if array.dtype.kind == "f" and not np.isfinite(array).all():
                raise ValueError(f"{name} must be finite")
        options = asdict(FitOptions(**header["options"]))
        state = {name: from_arrays(header["tree"][name], arrays) for name in _PARTS}
        for name, expected in _PARTS.items():
            if not isinstance(state[name], expected):
                raise ValueError(f"{name} is {type(state[name]).__name__}, not {expected.__name__}")
        signals = state["signals_"]
        if not (0 < signals.fps < np.inf and 0 < signals.rate < np.inf):
            raise ValueError(f"fps and rate must be positive, got {signals.fps} and {signals.rate}")
        state["report_"], state["edits_"] = dict(header["report"]), tuple(header["edits"])
    except (AttributeError, LookupError, OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: a model of signals whose parts do not fit together: {error}") from None
    return options, state


def _plain(value: Any) -> Any:
    """Return an operation as JSON would give it back: scripts write arrays and paths into theirs."""
    if isinstance(value, Mapping):
        return {str(key): _plain(v) for key, v in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, Path) else value
