"""Attributes of vertices, among them the joints that hold them.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.7.2 and 3.7.3.
"""

from __future__ import annotations

import numpy as np

from tempose.formats import glb_accessors as accessors
from tempose.formats.glb_container import Document
from tempose.formats.glb_json import Item
from tempose.typing import FloatArray, IntArray


def vertex_attribute(
    doc: Document, attributes: Item, name: str, n: int | None, *types: str
) -> FloatArray | None:
    """Decode one value per vertex.

    Parameters
    ----------
    doc : Document
        The file.
    attributes : Item
        Attributes of a primitive.
    name : str
        Such as ``"TEXCOORD_0"``.
    n : int or None
        How many there must be.
    *types : str
        Allowed element types.

    Returns
    -------
    (n, width) ndarray or None
        None if there is no such attribute.
    """
    if not attributes.has(name):
        return None
    values = accessors.floats(doc, attributes.integer(name, limit=len(doc.accessors)), *types)
    if n is not None and len(values) != n:
        raise attributes.error(f"expected {n} values, one a vertex, found {len(values)}", name)
    return values


def influences(
    doc: Document, primitive: Item, n: int, joints: int
) -> tuple[IntArray, FloatArray, FloatArray]:
    """Decode the skin weights of a primitive.

    Parameters
    ----------
    doc : Document
        The file.
    primitive : Item
        The primitive.
    n : int
        Number of its vertices.
    joints : int
        Number of joints of its skin.

    Returns
    -------
    joints : (n, k) ndarray of int64
        Indices into the joints of the skin; k is 4 for each pair of attributes, 0 without any.
    weights : (n, k) ndarray of float64
        Rows sum to 1; a vertex bound to nothing is held by the first joint.
    sums : (n,) ndarray of float64
        What they summed to in the file; 1 without any.

    Raises
    ------
    FormatError
        If a joint is out of range or a weight negative.
    """
    attributes = primitive.child("attributes")
    indices: list[IntArray] = [np.zeros((n, 0), np.int64)]
    weights: list[FloatArray] = [np.zeros((n, 0))]
    for k in range(len(attributes.fields)):
        share = vertex_attribute(doc, attributes, f"WEIGHTS_{k}", n, "VEC4")
        if share is None or not attributes.has(f"JOINTS_{k}"):
            break
        index = attributes.integer(f"JOINTS_{k}", limit=len(doc.accessors))
        which = accessors.integers(doc, index, "VEC4")
        if len(which) != n:
            raise attributes.error(f"expected {n} values, one a vertex, found {len(which)}", f"JOINTS_{k}")
        if (share < 0).any():
            raise attributes.error(f"expected weights from 0, found {share.min():g}", f"WEIGHTS_{k}")
        beyond = (which >= joints) & (share > 0)
        if beyond.any():
            v = int(beyond.any(axis=1).argmax())
            found = f"expected joints below {joints}, found {which[v].tolist()} at vertex {v}"
            raise attributes.error(found, f"JOINTS_{k}")
        indices.append(np.where(share > 0, which, 0))
        weights.append(share.astype(np.float64))
    which, share = np.concatenate(indices, axis=1), np.concatenate(weights, axis=1)
    sums = share.sum(axis=1) if share.shape[1] else np.ones(n)
    if share.shape[1]:
        # bound to nothing: hold it by the first joint rather than let it collapse to the origin
        share[share.sum(axis=1) == 0, 0] = 1.0
        share /= share.sum(axis=1, keepdims=True)
    return which, share, sums
