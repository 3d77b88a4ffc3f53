"""The glTF 2.0 container: GLB chunks, or JSON with buffers beside it.

The container is 20 bytes of header, so it is read with ``struct`` and ``json``: decoding every JSON object
into a dataclass takes seconds for a character with a dozen clips.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.6 and 4.4.
"""

from __future__ import annotations

import base64
import binascii
import json
import os
import struct
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO
from urllib.parse import unquote

from tempose.formats.conventions import FormatError
from tempose.formats.glb_json import Item

_MAGIC = b"glTF"
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


@dataclass(frozen=True)
class Document:
    """A parsed file: the JSON and the bytes it points into."""

    path: Path
    """The file."""
    kind: str
    """``"glb"`` or ``"gltf"``."""
    top: Item
    """The whole JSON object."""
    buffers: tuple[bytes, ...]
    """Contents of each buffer."""
    views: tuple[Item, ...]
    """Buffer views."""
    accessors: tuple[Item, ...]
    """Accessors."""


def load(path: str | os.PathLike[str]) -> Document:
    """Read the container and the JSON in it.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.

    Returns
    -------
    Document
        Parsed, with the bytes of all buffers.

    Raises
    ------
    FormatError
        If it is neither, is cut short, or needs a decompressor.
    OSError
        If the file cannot be read.
    """
    path = Path(path)
    data = path.read_bytes()
    kind = "glb" if data[:4] == _MAGIC else "gltf"
    if kind == "glb":
        text, chunk = _chunks(path, data)
    elif path.suffix.lower() == ".glb":
        raise FormatError(f"{path}: expected a GLB that starts with b'glTF', found {data[:4]!r}")
    else:
        text, chunk = data, None
    top = Item(str(path), "", _parse(path, text))
    if not top.child("asset").text("version").startswith("2."):
        raise FormatError(
            f"{path}: asset.version: expected 2.0, found {top.child('asset').text('version')!r}"
        )
    required = top.fields.get("extensionsRequired")
    for name in _COMPRESSED:
        if isinstance(required, list) and name in required:
            raise FormatError(f"{path}: is compressed by {name}; export it without compression")
    buffers = tuple(_buffer(path, item, chunk) for item in top.items("buffers"))
    return Document(path, kind, top, buffers, tuple(top.items("bufferViews")), tuple(top.items("accessors")))


def _chunks(path: Path, data: bytes) -> tuple[bytes, bytes | None]:
    if len(data) < 20:
        raise FormatError(f"{path}: expected a GLB header of 20 bytes, the file has {len(data)}")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2:
        raise FormatError(f"{path}: expected GLB version 2, found {version}")
    if length > len(data):
        raise FormatError(f"{path}: is cut short: the header says {length} bytes, the file has {len(data)}")
    found: dict[int, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        if at + 8 + size > length:
            raise FormatError(
                f"{path}: the chunk at byte {at} says {size} bytes, there are {length - at - 8} left"
            )
        found.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    if _JSON not in found:
        raise FormatError(f"{path}: expected a JSON chunk, found none")
    return found[_JSON], found.get(_BIN)


def _parse(path: Path, text: bytes) -> object:
    try:
        return json.loads(text.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise FormatError(f"{path}: expected glTF JSON: {error}") from None


def _buffer(path: Path, item: Item, chunk: bytes | None) -> bytes:
    size = item.integer("byteLength")
    uri = item.text("uri")
    if not uri:
        data = chunk
        if data is None:
            raise item.error("expected the binary chunk of a GLB or a 'uri', found neither")
    elif uri.startswith("data:"):
        try:
            data = base64.b64decode(uri.partition(",")[2], validate=True)
        except (binascii.Error, ValueError) as error:
            raise item.error(f"expected base64 data: {error}", "uri") from None
    else:
        data = _beside(path, item, unquote(uri))
    if size > len(data):
        raise item.error(f"says {size} bytes, there are {len(data)}", "byteLength")
    return data


def _beside(path: Path, item: Item, name: str) -> bytes:
    folder = path.parent.resolve()
    # a file from elsewhere must not make us read what lies outside its own folder
    try:
        inside = "://" not in name and (folder / name).resolve().is_relative_to(folder)
        if inside:
            return (folder / name).read_bytes()
    except (OSError, RuntimeError, ValueError) as error:
        raise item.error(f"cannot read {name!r}: {error}", "uri") from None
    raise item.error(f"expected a file beside {path.name}, found {name!r}", "uri")


def write_container(
    file: BinaryIO, head: dict[str, object], size: int, pieces: Iterable[bytes | memoryview]
) -> int:
    """Write a GLB of one JSON and one binary chunk.

    Parameters
    ----------
    file : binary file
        Open for writing.
    head : dict
        The glTF JSON.
    size : int
        Bytes of the binary chunk, a multiple of 4.
    pieces : iterable of bytes
        The binary chunk, written as it comes; must add up to `size`.

    Returns
    -------
    int
        Bytes written.

    Raises
    ------
    ValueError
        If the file would pass 4 GB, more than a GLB can hold, or a number is not finite.
    """
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    length = 12 + 8 + len(text) + 8 + size
    if length >= 2**32:
        raise ValueError(
            f"a GLB holds at most 4 GB, this clip needs {length / 2**30:.1f} GB; "
            "allow a tolerance, leave out normals, or write fewer frames"
        )
    file.write(_MAGIC + struct.pack("<II", 2, length))
    file.write(struct.pack("<II", len(text), _JSON) + text)
    file.write(struct.pack("<II", size, _BIN))
    written = sum(file.write(piece) for piece in pieces)
    assert written == size, f"{written} bytes instead of {size}"
    return length
