"""The joints of a file as one tree, and its bind pose as a skeleton at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton
from tempose.formats._joint_moves import local_offsets, local_rotations, rigid
from tempose.formats._names import distinct
from tempose.formats.glb_binding import Binding
from tempose.formats.glb_clips import Motion
from tempose.formats.glb_container import Document
from tempose.formats.glb_nodes import Nodes, chain
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Joints:
    """J joints, parents first, one root."""

    nodes: tuple[int, ...]
    """Node of each joint; -1 for a root that had to be made."""
    parents: IntArray
    """(J,) parents, -1 for the root."""
    names: tuple[str, ...]
    """J distinct names."""


def choose_joints(doc: Document, nodes: Nodes, bindings: dict[int, Binding], motion: Motion | None) -> Joints:
    """Joints of the skins in use, else of all skins, else the nodes that an animation moves.

    Parameters
    ----------
    doc : Document
        The file.
    nodes : Nodes
        The node tree.
    bindings : dict of int to Binding
        Skins that move something.
    motion : Motion, optional
        Animation, for files without a skin.

    Returns
    -------
    Joints
        With a common root: the nearest node above all of them, or one at the origin.

    Raises
    ------
    FormatError
        If there are none.
    """
    chosen = {node for binding in bindings.values() for node in binding.joints}
    if not chosen:
        skins = doc.top.items("skins")
        chosen = {node for skin in skins for node in skin.integers("joints", limit=len(nodes.items))}
    if not chosen and motion is not None:
        chosen = {c.node for c in motion.channels if c.path in ("rotation", "translation")}
    if not chosen:
        raise doc.top.error("expected a skin with joints, found none")
    tops = [node for node in chosen if not chosen.intersection(chain(nodes, node)[1:])]
    members = [node for node in nodes.order if node in chosen]
    if len(tops) > 1:
        common = set.intersection(*(set(chain(nodes, node)) for node in tops))
        members.insert(0, next((node for node in chain(nodes, tops[0]) if node in common), -1))
    place = {node: j for j, node in enumerate(members)}
    parents = [_parent(nodes, node, place) for node in members]
    names = [nodes.names[node] if node >= 0 else "root" for node in members]
    named = distinct([name or f"joint_{j}" for j, name in enumerate(names)])
    return Joints(tuple(members), np.array(parents, dtype=np.int32), named)


def _parent(nodes: Nodes, node: int, place: dict[int, int]) -> int:
    for above in chain(nodes, node)[1:]:
        if above in place:
            return place[above]
    return place.get(-1, -1) if node != -1 else -1


def bind_matrices(joints: Joints, bindings: dict[int, Binding], world: list[FloatArray]) -> FloatArray:
    """Bind pose of every joint.

    Parameters
    ----------
    joints : Joints
        J joints.
    bindings : dict of int to Binding
        Skins; the first that holds a joint counts.
    world : list of (1, 4, 4) float
        World transforms as the file leaves them, for joints of no skin.

    Returns
    -------
    (J, 4, 4) ndarray
        ``T_world_joint``.
    """
    known: dict[int, FloatArray] = {-1: np.eye(4)}
    for binding in bindings.values():
        for node, matrix in zip(binding.joints, binding.bind):
            known.setdefault(node, matrix)
    return np.stack([known[node] if node in known else world[node][0] for node in joints.nodes])


def rigid_parts(doc: Document, matrices: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotation and place of transforms that may also scale or mirror.

    Parameters
    ----------
    doc : Document
        The file, for the message.
    matrices : (..., 4, 4) float
        Transforms.

    Returns
    -------
    rotations : (..., 4) ndarray
        Nearest rotations, wxyz; of a mirrored basis those of its negative, so that they stay continuous.
    positions : (..., 3) ndarray
        Places.
    """
    if not np.isfinite(matrices).all():
        raise doc.top.error("expected finite joint transforms, found one that overflows")
    return rigid(matrices)


def bind_skeleton(
    doc: Document, joints: Joints, bindings: dict[int, Binding], world: list[FloatArray]
) -> Skeleton:
    """Skeleton whose rest pose is the bind pose.

    Parameters
    ----------
    doc : Document
        The file.
    joints : Joints
        J joints.
    bindings : dict of int to Binding
        Skins.
    world : list of (1, 4, 4) float
        World transforms as the file leaves them.

    Returns
    -------
    Skeleton
        Scales of the joints are in the offsets.
    """
    rotations, positions = rigid_parts(doc, bind_matrices(joints, bindings, world))
    offsets = local_offsets(joints.parents, rotations, positions)
    return Skeleton(joints.names, joints.parents, offsets, local_rotations(joints.parents, rotations))
