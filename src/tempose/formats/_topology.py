"""Frames of one clip share their connectivity; this says when they do not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Mesh
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Frame:
    """One file of a sequence as read, before axes and unit are converted."""

    mesh: Mesh
    """The mesh, in the axes and unit of the file."""
    path: str
    """Where it came from."""
    notes: tuple[str, ...] = ()
    """What was unusual."""
    face_text: bytes = b""
    """The bytes of its faces, to recognise equal ones without parsing; may be empty."""


def same_topology(mesh: Mesh, path: str, first: Frame) -> FloatArray:
    """Return the positions of a mesh that must have the faces of another.

    Parameters
    ----------
    mesh : Mesh
        A later frame.
    path : str
        Its file.
    first : Frame
        The first frame.

    Returns
    -------
    (n, 3) ndarray
        Vertices of `mesh`.

    Raises
    ------
    FormatError
        If counts or faces differ; names both files.
    """
    for what in ("vertices", "faces"):
        ours, theirs = len(getattr(mesh, what)), len(getattr(first.mesh, what))
        if ours != theirs:
            raise other_counts(path, ours, what, first.path, theirs)
    differ = (mesh.faces != first.mesh.faces).any(axis=1)
    if differ.any():
        raise FormatError(
            f"{path}: expected the faces of {first.path}, found another triangle {int(np.argmax(differ))}; "
            "frames of one clip must share their connectivity"
        )
    return mesh.vertices


def other_counts(path: str, ours: int, what: str, first_path: str, theirs: int) -> FormatError:
    """Say that two frames differ in size.

    Parameters
    ----------
    path, first_path : str
        The two files.
    ours, theirs : int
        What each has.
    what : str
        Of what.

    Returns
    -------
    FormatError
        To be raised.
    """
    return FormatError(
        f"{path}: has {ours} {what}, but {first_path} has {theirs}; "
        "frames of one clip must share their connectivity"
    )
