"""Bytes of a file, refused early and in one line when they cannot be what the name claims."""

from __future__ import annotations

import os
from pathlib import Path

from tempose.formats.conventions import FormatError

_MAGIC = {
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"GIF8": "a GIF picture",
    b"%PDF": "a PDF document",
    b"PK\x03\x04": "a zip archive (.npz, .usdz)",
    b"\x1f\x8b": "gzip-compressed data; unpack it first",
    b"glTF": "a binary glTF (.glb)",
    b"Kaydara FBX": "an FBX scene",
    b"Ogawa": "an Alembic cache (.abc)",
    b"\x93NUMPY": "a numpy array (.npy)",
    b"POINTCACHE2": "a PC2 point cache",
    b"PXR-USDC": "a USD scene (.usdc)",
    b"HIERARCHY": "BVH motion capture (.bvh)",
    b"ply": "a PLY mesh (.ply)",
}


def read_bytes(path: str | os.PathLike[str], expected: str, *own_magic: bytes, text: bool = True) -> bytes:
    """Read a whole file and refuse what is plainly another kind of file.

    Parameters
    ----------
    path : path-like
        File to read.
    expected : str
        What the caller expects, for messages, such as ``"an OBJ mesh"``.
    *own_magic : bytes
        First bytes that are right although the table of foreign files lists them.
    text : bool, default True
        Whether the file must be text: no zero bytes near its start.

    Returns
    -------
    bytes
        The content, at least one byte.

    Raises
    ------
    FormatError
        If the file is missing, a folder, unreadable, empty or of another kind.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise FormatError(unreadable(path, error)) from None
    if not data.strip(b"\0 \t\r\n"):
        raise FormatError(f"{path}: expected {expected}, found an empty file")
    for magic, kind in _MAGIC.items():
        if magic not in own_magic and data.startswith(magic):
            raise FormatError(f"{path}: expected {expected}, found {kind}")
    if text and b"\0" in data[:4096]:
        raise FormatError(
            f"{path}: expected {expected}, found binary data (zero byte at byte {data.index(0)})"
        )
    return data


def unreadable(path: str | os.PathLike[str], error: OSError) -> str:
    """Say in one line why a file cannot be opened.

    Parameters
    ----------
    path : path-like
        The file.
    error : OSError
        What the system said.

    Returns
    -------
    str
        The message.
    """
    if isinstance(error, FileNotFoundError):
        return f"{path}: no such file"
    if isinstance(error, IsADirectoryError):
        return f"{path}: is a folder, expected a file"
    return f"{path}: cannot be read: {error.strerror or error}"


def excerpt(line: bytes, width: int = 40) -> str:
    """Quote a piece of a file for a message: short, printable, on one line.

    Parameters
    ----------
    line : bytes
        Any bytes.
    width : int, default 40
        Longest quotation in characters.

    Returns
    -------
    str
        Quoted text.
    """
    text = line.strip().decode("utf-8", "replace")
    return repr(text if len(text) <= width else text[: width - 3] + "...")
