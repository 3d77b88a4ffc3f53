"""Motion of the joints as rotations and a root path: what a skeleton clip can hold of a glTF animation."""

from __future__ import annotations

import numpy as np

from tempose.formats._joint_moves import Moves, reduce_moves
from tempose.formats.glb_binding import Binding
from tempose.formats.glb_clips import Motion
from tempose.formats.glb_container import Document
from tempose.formats.glb_joints import Joints, bind_skeleton, choose_joints, rigid_parts
from tempose.formats.glb_nodes import Nodes, world_matrices
from tempose.formats.glb_parts import Geometry
from tempose.typing import FloatArray, IntArray

_BLOCK = 512


def skeleton_moves(
    doc: Document, nodes: Nodes, geometry: Geometry | None, bindings: dict[int, Binding], motion: Motion
) -> Moves:
    """Sample the joints and reduce them to rotations and a root path.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.
    geometry : Geometry or None
        What the scene draws; tells which joints carry weight.
    bindings : dict of int to Binding
        Skins.
    motion : Motion
        T frames.

    Returns
    -------
    Moves
        Exact for all joints that carry weight where translations and scales are constant below their
        common ancestor.
    """
    joints = choose_joints(doc, nodes, bindings, motion)
    rotations, positions = _sampled(doc, nodes, joints, motion)
    rest = bind_skeleton(doc, joints, bindings, world_matrices(nodes, {}))
    return reduce_moves(
        rest, rotations, positions, None if geometry is None else _carrying(geometry, bindings, joints)
    )


def _sampled(doc: Document, nodes: Nodes, joints: Joints, motion: Motion) -> tuple[FloatArray, FloatArray]:
    T, J = len(motion.times), len(joints.nodes)
    rotations, positions = np.zeros((T, J, 4)), np.zeros((T, J, 3))
    for start in range(0, T, _BLOCK):
        frames = slice(start, min(start + _BLOCK, T))
        world = world_matrices(nodes, motion.at(frames))
        shape = (frames.stop - start, 4, 4)
        moving = [np.broadcast_to(np.eye(4) if i < 0 else world[i], shape) for i in joints.nodes]
        rotations[frames], positions[frames] = rigid_parts(doc, np.stack(moving, axis=1))
    return rotations, positions


def _carrying(geometry: Geometry, bindings: dict[int, Binding], joints: Joints) -> IntArray:
    """Joints that move a vertex; all of them if none does."""
    found: set[int] = set()
    for part in geometry.parts:
        if part.skin is not None:
            used = np.unique(part.joints[part.weights > 0])
            found.update(bindings[part.skin].joints[j] for j in used)
    return np.array([j for j, node in enumerate(joints.nodes) if node in found or not found], dtype=np.int64)
