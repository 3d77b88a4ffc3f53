"""Positions of every vertex at given frames: morph targets, skins and node transforms.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.7.2.2 and 3.7.3.3.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy import sparse

from tempose.formats import glb_accessors as accessors
from tempose.formats.glb_binding import Binding
from tempose.formats.glb_clips import Motion
from tempose.formats.glb_container import Document
from tempose.formats.glb_nodes import Nodes, world_matrices
from tempose.formats.glb_parts import Geometry, Part
from tempose.typing import FloatArray

_BLOCK = 4_000_000
_MOST_BYTES = 32 * 2**30


def bake(
    doc: Document, nodes: Nodes, geometry: Geometry, bindings: dict[int, Binding], motion: Motion
) -> FloatArray:
    """Positions of all vertices in all frames.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.
    geometry : Geometry
        What the scene draws.
    bindings : dict of int to Binding
        Skins.
    motion : Motion
        T frames.

    Returns
    -------
    (T, n, 3) ndarray of float32
        Metres, Y up.

    Raises
    ------
    FormatError
        If the clip would be too big or a position is not finite.
    """
    T, n = len(motion.times), geometry.n
    if T * n * 12 > _MOST_BYTES:
        raise doc.top.error(f"{T} frames of {n} vertices are more than 32 GB; read it with a lower fps")
    result = np.zeros((T, n, 3), np.float32)
    step = max(1, _BLOCK // (12 * n))
    for start in range(0, T, step):
        frames = slice(start, start + step)
        moving = motion.at(frames)
        world = world_matrices(nodes, moving)
        for part in geometry.parts:
            target = result[frames, part.start : part.start + len(part.base)]
            target[:] = _posed(doc, part, bindings, world, moving)
        check_finite(doc, result[frames], start)
    return result


def check_finite(doc: Document, V: FloatArray, start: int = 0) -> None:
    """Refuse positions that overflowed.

    Parameters
    ----------
    doc : Document
        The file.
    V : (T, n, 3) float
        Positions.
    start : int, default 0
        Frame number of the first, for the message.
    """
    if not np.isfinite(V).all():
        t, v = np.argwhere(~np.isfinite(V))[0][:2]
        raise doc.top.error(f"expected finite positions, vertex {v} of frame {start + t} overflows")


def _posed(
    doc: Document,
    part: Part,
    bindings: dict[int, Binding],
    world: list[FloatArray],
    moving: Mapping[tuple[int, str], FloatArray],
) -> FloatArray:
    local = morphed(doc, part, moving.get((part.node, "weights"), part.morph[None]))
    if part.skin is None:
        return transformed(world[part.node], local)
    binding = bindings[part.skin]
    joint = [world[j] for j in binding.joints]
    frames = max(len(matrices) for matrices in joint)
    moved = (
        np.stack([np.broadcast_to(matrices, (frames, 4, 4)) for matrices in joint])
        @ binding.inverse_bind[:, None]
    )
    n, k = part.joints.shape
    rows = np.repeat(np.arange(n), k)
    weights = sparse.csr_array(
        (part.weights.ravel(), (rows, part.joints.ravel())), shape=(n, len(joint)), dtype=np.float64
    )
    # one matrix a vertex and frame
    blend = (
        (weights @ moved[..., :3, :].reshape(len(joint), -1)).reshape(n, frames, 3, 4).transpose(1, 0, 2, 3)
    )
    return np.einsum("tnij,tnj->tni", blend[..., :3], local, optimize=False) + blend[..., 3]


def morphed(doc: Document, part: Part, weights: FloatArray) -> FloatArray:
    """Positions of a part under its morph targets.

    Parameters
    ----------
    doc : Document
        The file.
    part : Part
        n vertices and K targets.
    weights : (T, K) float
        Weights per frame.

    Returns
    -------
    (T, n, 3) ndarray
        Positions in the space of the mesh.
    """
    if weights.shape[1] != len(part.targets):
        raise part.item.error(
            f"expected {len(part.targets)} animated weights, one a morph target, found {weights.shape[1]}",
            "targets",
        )
    result = np.repeat(part.base[None], len(weights), axis=0)
    for k in np.flatnonzero((weights != 0).any(axis=0)):
        index = part.targets[k]
        if index is not None:
            offsets = accessors.floats(doc, index, "VEC3")
            rows = np.flatnonzero(weights[:, k])
            result[rows] += weights[rows, k, None, None] * offsets
    return result


def transformed(matrices: FloatArray, points: FloatArray) -> FloatArray:
    """Apply affine transforms to points.

    Parameters
    ----------
    matrices : (T or 1, 4, 4) float
        Transforms.
    points : (T or 1, n, 3) float
        Points.

    Returns
    -------
    (T or 1, n, 3) ndarray
        Transformed points.
    """
    return points @ matrices[:, :3, :3].transpose(0, 2, 1) + matrices[:, None, :3, 3]
