"""One file a model: safetensors with a JSON header that says what it is."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save_file

from tempose._files import atomic_path
from tempose._version import __version__
from tempose.typing import FloatArray

FORMAT_VERSION = 1
"""Raised whenever older programs could misread what newer ones write."""

_KEY = "tempose"
"""The one entry of the metadata of safetensors; its text is the JSON header."""


def save_model(
    path: str | os.PathLike[str], kind: str, arrays: Mapping[str, FloatArray], header: Mapping[str, Any]
) -> Path:
    """Write a model file; the old one of that name stays until the new one is whole.

    Parameters
    ----------
    path : path-like
        Where to; by custom it ends in ``.tempose``. The folder must exist.
    kind : str
        What sort of model it is, such as ``"signals"``.
    arrays : mapping of str to ndarray
        Numbers; types and shapes come back exactly.
    header : mapping
        What JSON can hold: options, what the model was made from. The keys ``kind``, ``format_version`` and
        ``version`` are added.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    OSError
        If the place cannot be written.
    TypeError
        If the header holds what JSON cannot.
    """
    whole = {"kind": kind, "format_version": FORMAT_VERSION, "version": __version__, **header}
    text = json.dumps(whole, sort_keys=True, allow_nan=False)
    stored = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    with atomic_path(path) as part:
        save_file(stored, part, metadata={_KEY: text})
        # safetensors lets only the owner read; a model may be read by whom a new file may
        like = part.with_name("like")
        like.touch()
        part.chmod(like.stat().st_mode)
    return Path(path)


def load_model(path: str | os.PathLike[str], kind: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Read a model file.

    Parameters
    ----------
    path : path-like
        The file.
    kind : str
        The sort of model that is wanted.

    Returns
    -------
    arrays : dict of str to ndarray
        As they were given to `save_model`.
    header : dict
        The same, with ``kind``, ``format_version`` and the ``version`` of Tempose that wrote it.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is cut short, no model, of a newer format or of another kind; the message names it.
    """
    path = Path(path)
    if not path.exists():
        raise FileNotFoundError(f"{path}: no such file")
    if path.is_dir():
        raise ValueError(f"{path}: a folder; a model is one .tempose file")
    try:
        with safe_open(path, framework="numpy") as file:
            header = _header(path, file.metadata(), kind)
            arrays = {name: file.get_tensor(name) for name in file.keys()}
    except SafetensorError as error:
        raise ValueError(
            f"{path}: no Tempose model, or one cut short ({_reason(error)}); expected a .tempose file"
        ) from None
    return arrays, header


def _header(path: Path, metadata: Mapping[str, str] | None, kind: str) -> dict[str, Any]:
    try:
        header = json.loads((metadata or {})[_KEY])
        found, version = str(header["kind"]), int(header["format_version"])
    except (KeyError, TypeError, ValueError):
        raise ValueError(f"{path}: a safetensors file that Tempose did not write: it has no header") from None
    if version > FORMAT_VERSION:
        raise ValueError(
            f"{path}: written in model format {version} by Tempose {header.get('version', '?')}; "
            f"this one, {__version__}, reads up to {FORMAT_VERSION}: update Tempose"
        )
    if found != kind:
        raise ValueError(f"{path}: a model of kind {found!r}, expected {kind!r}")
    return header


def _reason(error: Exception) -> str:
    return str(error).strip().split("\n")[0].removeprefix("Error while deserializing header: ")
