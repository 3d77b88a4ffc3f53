"""glTF accessors to arrays; no count, offset or stride of the file is believed before it is checked.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), section 3.6.2.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.formats.glb_container import Document
from tempose.formats.glb_json import Item
from tempose.typing import FloatArray, IntArray

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def accessor_count(doc: Document, index: int) -> int:
    """How many elements an accessor says it has.

    Parameters
    ----------
    doc : Document
        The file.
    index : int
        Accessor, checked to exist.

    Returns
    -------
    int
        Its count.
    """
    return doc.accessors[index].integer("count", low=1)


def floats(doc: Document, index: int, *types: str) -> FloatArray:
    """Decode an accessor of numbers.

    Parameters
    ----------
    doc : Document
        The file.
    index : int
        Accessor, checked to exist.
    *types : str
        Allowed element types, such as ``"VEC3"``.

    Returns
    -------
    (count, width) ndarray
        float32 as stored, or float64 from integers; normalised integers become -1 to 1 or 0 to 1.
    """
    item, raw = _raw(doc, index, types)
    if raw.dtype.kind == "f":
        if not np.isfinite(raw).all():
            row = int(np.argwhere(~np.isfinite(raw))[0, 0])
            raise item.error(f"expected finite numbers, found {raw[row].tolist()} at element {row}")
        return raw
    values = raw.astype(np.float64)
    if item.fields.get("normalized"):
        values = np.maximum(values / np.iinfo(raw.dtype).max, -1.0)
    return values


def integers(doc: Document, index: int, *types: str) -> IntArray:
    """Decode an accessor of indices.

    Parameters
    ----------
    doc : Document
        The file.
    index : int
        Accessor, checked to exist.
    *types : str
        Allowed element types.

    Returns
    -------
    (count, width) ndarray of int64
        The indices.
    """
    item, raw = _raw(doc, index, types)
    if raw.dtype.kind != "u":
        raise item.error(f"expected unsigned integers, found {raw.dtype}", "componentType")
    return raw.astype(np.int64)


def _raw(doc: Document, index: int, types: tuple[str, ...]) -> tuple[Item, Any]:
    item = doc.accessors[index]
    kind = item.text("type")
    if kind not in types:
        raise item.error(f"expected {' or '.join(types)}, found {kind!r}", "type")
    dtype, width = _dtype(item), _WIDTHS[kind]
    count = accessor_count(doc, index)
    if item.has("bufferView"):
        values = _strided(doc, item, item, dtype, (count, width))
    elif count > sum(map(len, doc.buffers)):
        # zeros by definition: take the size of the file for the measure of what can be meant
        raise item.error(f"expected no more elements than the file has bytes, found {count}", "count")
    else:
        values = np.zeros((count, width), dtype)
    if item.has("sparse"):
        values = _substitute(doc, item.child("sparse"), values)
    return item, values


def _dtype(item: Item) -> np.dtype[Any]:
    code = item.integer("componentType")
    if code not in _COMPONENTS:
        raise item.error(f"expected one of {', '.join(map(str, _COMPONENTS))}, found {code}", "componentType")
    return np.dtype(_COMPONENTS[code])


def _strided(doc: Document, item: Item, owner: Item, dtype: np.dtype[Any], shape: tuple[int, int]) -> Any:
    view = doc.views[item.integer("bufferView", limit=len(doc.views))]
    buffer = doc.buffers[view.integer("buffer", limit=len(doc.buffers))]
    start, length = view.integer("byteOffset", 0), view.integer("byteLength")
    if start + length > len(buffer):
        raise view.error(f"ends at byte {start + length}, its buffer at {len(buffer)}")
    element = dtype.itemsize * shape[1]
    stride = view.integer("byteStride", element, low=1, limit=2**31)
    offset = item.integer("byteOffset", 0)
    if stride < element:
        raise view.error(f"expected at least {element}, found {stride}", "byteStride")
    if offset + (shape[0] - 1) * stride + element > length:
        raise owner.error(
            f"{shape[0]} elements of {element} bytes do not fit into the {length} bytes of {view.place}"
        )
    strided = np.ndarray(shape, dtype, buffer, start + offset, (stride, dtype.itemsize))
    return np.array(strided, order="C")


def _substitute(doc: Document, sparse: Item, values: Any) -> Any:
    count = sparse.integer("count", low=1, limit=len(values) + 1)
    where, what = sparse.child("indices"), sparse.child("values")
    rows = _strided(doc, where, sparse, _dtype(where), (count, 1))[:, 0]
    if rows.dtype.kind != "u" or rows.max() >= len(values):
        raise where.error(f"expected unsigned integers below {len(values)}, found {rows.max()}")
    values[rows] = _strided(doc, what, sparse, values.dtype, (count, values.shape[1]))
    return values
