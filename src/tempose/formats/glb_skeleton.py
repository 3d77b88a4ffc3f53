"""Motion of the joints as rotations and a root path: what a skeleton clip can hold of a glTF animation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import Skeleton
from tempose.formats.glb_binding import Binding
from tempose.formats.glb_clips import Motion
from tempose.formats.glb_container import Document
from tempose.formats.glb_joints import (
    Joints,
    bind_skeleton,
    choose_joints,
    local_offsets,
    local_rotations,
    rigid_parts,
)
from tempose.formats.glb_nodes import Nodes, world_matrices
from tempose.formats.glb_parts import Geometry
from tempose.kinematics import forward_kinematics
from tempose.rotations import continuous, rotate
from tempose.typing import BoolArray, FloatArray, IntArray

_BLOCK = 512
_STILL = 1e-6


@dataclass(frozen=True)
class Moves:
    """A skeleton in motion."""

    skeleton: Skeleton
    """J joints; bone lengths are those of the clip."""
    rotations: FloatArray
    """(T, J, 4) local rotations."""
    root: FloatArray
    """(T, 3) path of the root."""
    notes: tuple[str, ...]
    """What a skeleton clip cannot hold."""


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
    offsets = local_offsets(joints.parents, rotations, positions)
    size = float(np.linalg.norm(rest.offsets[1:], axis=1).sum()) or 1.0
    fixed = np.array(rest.offsets)
    moved = np.abs(offsets - fixed).max(axis=(0, 2)) > _STILL * size
    carrying = _carrying(geometry, bindings, joints)
    varies = np.ptp(offsets, axis=0).max(axis=1) > _STILL * size
    anchor = (
        _first_traveller(joints.parents, varies) if geometry is None else _anchor(joints.parents, carrying)
    )
    # what lies between root and anchor keeps its bind pose: the root path makes up for it
    moved[_path(joints.parents, anchor)] = False
    fixed[moved] = offsets[:, moved].mean(axis=0)
    root = _root_path(joints.parents, anchor, rotations, positions, fixed)
    if np.abs(root - positions[:, 0]).max() <= _STILL * size:
        root = positions[:, 0]
    skeleton = replace(rest, offsets=fixed)
    local = continuous(local_rotations(joints.parents, rotations))
    _, reached = forward_kinematics(skeleton, local, root)
    notes = _deviation(reached - positions, carrying, skeleton, size)
    if not np.array_equal(root, positions[:, 0]):
        notes = (f"The root follows {joints.names[anchor]!r}, the first joint that carries weight.", *notes)
    return Moves(skeleton, local, root, notes)


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


def _carrying(geometry: Geometry | None, bindings: dict[int, Binding], joints: Joints) -> IntArray:
    """Joints that move a vertex; all of them if nothing is drawn."""
    found: set[int] = set()
    for part in geometry.parts if geometry is not None else ():
        if part.skin is not None:
            used = np.unique(part.joints[part.weights > 0])
            found.update(bindings[part.skin].joints[j] for j in used)
    return np.array([j for j, node in enumerate(joints.nodes) if node in found or not found], dtype=np.int64)


def _anchor(parents: IntArray, carrying: IntArray) -> int:
    """Nearest common ancestor of the joints that carry weight."""
    common: list[int] | None = None
    for j in carrying:
        path = _path(parents, int(j))
        common = path if common is None else [i for i in common if i in set(path)]
    return common[0] if common else 0


def _path(parents: IntArray, joint: int) -> list[int]:
    """Joint, parent, and so on up to the root."""
    path = [joint]
    while parents[path[-1]] >= 0:
        path.append(int(parents[path[-1]]))
    return path


def _first_traveller(parents: IntArray, varies: BoolArray) -> int:
    """Joint that travels below a chain of still ones; the root if there is none."""
    best, at = 0, 0
    while len(children := np.flatnonzero(parents == at)) == 1:
        at = int(children[0])
        best = at if varies[at] else best
    return best


def _root_path(
    parents: IntArray, anchor: int, rotations: FloatArray, positions: FloatArray, offsets: FloatArray
) -> FloatArray:
    # joints above the anchor move nothing, so the root may stand wherever it puts the anchor right:
    # exporters keep a still root above hips that travel
    root = np.array(positions[:, anchor])
    for j in _path(parents, anchor)[:-1]:
        root -= rotate(rotations[:, parents[j]], offsets[j])
    return root


def _deviation(error: FloatArray, carrying: IntArray, skeleton: Skeleton, size: float) -> tuple[str, ...]:
    off = np.linalg.norm(error[:, carrying], axis=-1).max(axis=0)
    worst = int(off.argmax())
    if off[worst] <= 1e-5 * size:
        return ()
    name = skeleton.names[int(carrying[worst])]
    return (f"Joint translations vary and are held constant: {name!r} is off by up to {off[worst]:.4g} m.",)
