"""Where a skin is bound: joints and mesh in one pose, in the world.

A glTF skin has inverse bind matrices from the space of the mesh to that of each joint, and no word on where
that space lies in the world: the node of a skinned mesh does not move it. If the nodes stand in the bind
pose the joints tell; otherwise the node of the mesh is taken, turned by right angles where it cannot be
meant.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), section 3.7.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from tempose.formats import glb_accessors as accessors
from tempose.formats.glb_container import Document
from tempose.formats.glb_json import Item
from tempose.formats.glb_nodes import Nodes
from tempose.formats.glb_parts import Geometry, Part
from tempose.rotations import angle_between, from_matrix, polar_rotation, procrustes_rotation
from tempose.typing import BoolArray, FloatArray


@dataclass(frozen=True)
class Binding:
    """A skin in its bind pose."""

    joints: tuple[int, ...]
    """Nodes that are its joints."""
    inverse_bind: FloatArray
    """(J, 4, 4) from mesh space to each joint."""
    placing: FloatArray
    """(4, 4) from mesh space to the world, in the bind pose."""
    bind: FloatArray
    """(J, 4, 4) ``T_world_joint`` in the bind pose."""


def read_bindings(
    doc: Document, nodes: Nodes, geometry: Geometry, world: list[FloatArray]
) -> dict[int, Binding]:
    """Bind poses of the skins that move something.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.
    geometry : Geometry
        What the scene draws.
    world : list of (1, 4, 4) float
        World transforms of the nodes as the file leaves them.

    Returns
    -------
    dict of int to Binding
        By index of the skin.
    """
    skins = doc.top.items("skins")
    found: dict[int, Binding] = {}
    for part in geometry.parts:
        if part.skin is not None and part.skin not in found:
            found[part.skin] = _binding(doc, nodes, skins[part.skin], world, part.node)
    return found


def _binding(doc: Document, nodes: Nodes, skin: Item, world: list[FloatArray], node: int) -> Binding:
    joints = skin.integers("joints", limit=len(nodes.items))
    if not joints:
        raise skin.error("expected at least one joint, found none", "joints")
    inverse = np.tile(np.eye(4), (len(joints), 1, 1))
    if skin.has("inverseBindMatrices"):
        index = skin.integer("inverseBindMatrices", limit=len(doc.accessors))
        flat = accessors.floats(doc, index, "MAT4").astype(np.float64)
        if len(flat) < len(joints):
            raise skin.error(f"expected {len(joints)} matrices, found {len(flat)}", "inverseBindMatrices")
        inverse = flat[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    default = np.stack([world[j][0] for j in joints])
    bind, usable = _inverses(inverse)
    finite = np.isfinite(default).all() and np.isfinite(world[node]).all()
    if not finite or not usable.any():
        raise skin.error("expected joints and bind matrices that can be inverted, found none", "joints")
    try:
        placing = _placing(bind[usable], inverse[usable], default[usable], world[node][0])
    except np.linalg.LinAlgError:
        raise skin.error("expected joints of a sensible size, their transforms overflow", "joints") from None
    # a joint without a bind pose of its own stays where its node is
    return Binding(tuple(joints), inverse, placing, np.where(usable[:, None, None], placing @ bind, default))


def _inverses(matrices: FloatArray) -> tuple[FloatArray, BoolArray]:
    result, usable = np.tile(np.eye(4), (len(matrices), 1, 1)), np.zeros(len(matrices), bool)
    for j, matrix in enumerate(matrices):
        try:
            inverse = np.linalg.inv(matrix)
        except np.linalg.LinAlgError:
            continue
        if np.isfinite(inverse).all() and np.abs(inverse @ matrix - np.eye(4)).max() < 1e-6:
            result[j], usable[j] = inverse, True
    return result, usable


def _placing(bind: FloatArray, inverse: FloatArray, default: FloatArray, mesh: FloatArray) -> FloatArray:
    each = default @ inverse
    size = np.linalg.norm(np.ptp(default[:, :3, 3], axis=0)) + np.linalg.norm(default[0, :3, 3])
    turn, shift = each[:, :3, :3], each[:, :3, 3]
    even = np.abs(turn - turn[0]).max() <= 1e-3 * np.abs(turn[0]).max()
    if even and np.abs(shift - shift[0]).max() <= 1e-3 * (size or 1.0):
        return each.mean(axis=0)
    # scale and mirroring are the same in every pose
    volume = float(np.median(np.linalg.det(turn)))
    mirror, scale = np.diag([np.sign(volume) or 1.0, 1.0, 1.0]), float(np.cbrt(abs(volume)))
    p, q = bind[:, :3, 3] @ mirror, default[:, :3, 3]
    spread_p, spread_q = (float(np.linalg.norm(x - x.mean(axis=0))) for x in (p, q))
    if len(p) < 3 or min(spread_p, spread_q, scale) <= 0:
        return mesh
    R, own = procrustes_rotation(p, q), polar_rotation(mesh[:3, :3] @ mirror)
    same_size = abs(np.cbrt(np.linalg.det(mesh[:3, :3] @ mirror)) / scale - 1) < 1e-3
    away = np.linalg.norm(mesh[:3, :3] @ bind[:, :3, 3].mean(axis=0) + mesh[:3, 3] - q.mean(axis=0))
    close = away < 2 * spread_q / np.sqrt(len(q))
    if close and same_size and angle_between(from_matrix(R), from_matrix(own)) < np.pi / 4:
        return mesh
    placing = np.eye(4)
    placing[:3, :3] = scale * own @ _nearest_right_angle(own.T @ R)
    placing[:3, 3] = q.mean(axis=0) - placing[:3, :3] @ p.mean(axis=0)
    placing[:3, :3] = placing[:3, :3] @ mirror
    return placing


def _nearest_right_angle(R: FloatArray) -> FloatArray:
    """Of the 24 rotations of a cube the one nearest to a rotation."""
    turns = [np.eye(3)[list(p)] * s for p in permutations(range(3)) for s in product([1.0, -1.0], repeat=3)]
    proper = [C for C in turns if np.linalg.det(C) > 0]
    return max(proper, key=lambda C: float((C * R).sum()))


def rest_transform(
    nodes: Nodes, part: Part, bindings: dict[int, Binding], world: list[FloatArray]
) -> FloatArray:
    """From the space of a part to the world, everything in the bind pose.

    Parameters
    ----------
    nodes : Nodes
        The node tree.
    part : Part
        What to place.
    bindings : dict of int to Binding
        Skins.
    world : list of (1, 4, 4) float
        World transforms of the nodes as the file leaves them.

    Returns
    -------
    (4, 4) ndarray
        A part without a skin that hangs on a joint goes where the bind pose takes the joint.
    """
    if part.skin is not None:
        return bindings[part.skin].placing
    held = holding_joint(nodes, part.node, bindings)
    if held is not None:
        joint, bind = held
        back, usable = _inverses(world[joint])
        if usable[0]:
            return bind @ back[0] @ world[part.node][0]
    return world[part.node][0]


def holding_joint(nodes: Nodes, node: int, bindings: dict[int, Binding]) -> tuple[int, FloatArray] | None:
    """Nearest joint at or above a node.

    Parameters
    ----------
    nodes : Nodes
        The node tree.
    node : int
        Where to start.
    bindings : dict of int to Binding
        Skins.

    Returns
    -------
    tuple of int and (4, 4) ndarray, or None
        Node of the joint and its bind pose.
    """
    while node >= 0:
        for binding in bindings.values():
            if node in binding.joints:
                return node, binding.bind[binding.joints.index(node)]
        node = nodes.parents[node]
    return None
