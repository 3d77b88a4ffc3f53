"""Write a GLB with a skin: mesh, joints, at most four weights a vertex, a key per frame.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.7.3 and 3.11.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.formats._influences import strongest
from tempose.formats.glb_buffer import VERTEX_DATA, Buffer
from tempose.formats.glb_container import write_container
from tempose.formats.glb_layout import Layout, lay_out
from tempose.formats.glb_write import check_mesh, mesh_head
from tempose.kinematics import rest_transforms
from tempose.rotations import conjugate, continuous, rotate, to_matrix
from tempose.typing import FloatArray, Progress, silent

_STILL = "still"
_MOST_JOINTS = 2**16


def write_skin(
    path: str | os.PathLike[str], skin: SkinnedMesh, motion: SkeletonClip, *, progress: Progress = silent
) -> int:
    """Write a skinned mesh and its motion as a GLB file.

    Parameters
    ----------
    path : path-like
        Final name, ending in ``.glb``.
    skin : SkinnedMesh
        n vertices, J joints.
    motion : SkeletonClip
        T >= 1 frames on the joints of `skin`.
    progress : Progress
        Called while writing.

    Returns
    -------
    int
        Bytes written.

    Raises
    ------
    ValueError
        If glTF cannot hold it: no faces, no frames, other joints, more than 65 536 of them.
    OSError
        If the place cannot be written.

    Notes
    -----
    Every joint has a rotation a frame, the root a path as well. Bone lengths do not change: those of
    `motion` hold where they are unlike the bind pose. What is bound to nothing hangs on a joint of its own
    that never moves. Metres, Y up, as glTF wants it.
    """
    check_mesh(path, skin.mesh)
    if not motion.n_frames:
        raise ValueError("a GLB motion needs at least one frame, got none")
    if skin.skeleton.n_joints >= _MOST_JOINTS:
        raise ValueError(f"a GLB skin holds at most {_MOST_JOINTS - 1} joints, got {skin.skeleton.n_joints}")
    layout, buffer = lay_out(skin.mesh), Buffer()
    head = mesh_head(skin.mesh, layout, buffer)
    _add_skin(head, skin, layout, buffer)
    _add_motion(head, skin, motion, buffer)
    head["accessors"], head["bufferViews"] = buffer.accessors, buffer.views
    head["buffers"] = [{"byteLength": buffer.size}]
    with atomic_path(path) as part, part.open("wb") as file:
        return write_container(file, head, buffer.size, buffer.pieces(progress))


def _add_skin(head: dict[str, Any], skin: SkinnedMesh, layout: Layout, buffer: Buffer) -> None:
    """Joints as nodes 1 to J in the bind pose, weights as attributes."""
    skeleton, k = skin.skeleton, len(layout.vertex_of)
    assert skeleton.rest_rotations is not None
    loose = skin.weights.sum(axis=1) == 0
    weights = np.column_stack([skin.weights, loose]) if loose.any() else skin.weights
    joints, kept = strongest(weights)
    joints, kept = joints[layout.vertex_of], kept[layout.vertex_of].astype(np.float32)
    attributes = head["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = buffer.add(lambda: joints, (k, 4), VERTEX_DATA, dtype="<u2")
    attributes["WEIGHTS_0"] = buffer.add(lambda: kept, (k, 4), VERTEX_DATA)
    nodes = head["nodes"]
    for j, name in enumerate(skeleton.names):
        node: dict[str, Any] = {"name": name, "translation": skeleton.offsets[j].tolist()}
        node["rotation"] = skeleton.rest_rotations[j][[1, 2, 3, 0]].tolist()
        children = skeleton.children(j)
        nodes.append(node | ({"children": (children + 1).tolist()} if len(children) else {}))
    inverse = _inverse_bind(skin)
    roots = [0, 1]
    if loose.any():
        roots.append(len(nodes))
        nodes.append({"name": _STILL})
        inverse = np.concatenate([inverse, np.eye(4)[None]])
    flat = inverse.transpose(0, 2, 1).reshape(-1, 16)
    nodes[0]["skin"] = 0
    bound = {"inverseBindMatrices": buffer.add(lambda: flat, flat.shape, None)}
    head["skins"] = [{"name": skin.mesh.name or "skin", "joints": list(range(1, len(nodes))), **bound}]
    head["scenes"][0]["nodes"] = roots


def _inverse_bind(skin: SkinnedMesh) -> FloatArray:
    turn, place = rest_transforms(skin.skeleton)
    back = conjugate(turn)
    inverse = np.tile(np.eye(4), (len(turn), 1, 1))
    inverse[:, :3, :3] = to_matrix(back)
    inverse[:, :3, 3] = -rotate(back, place)
    return inverse


def _add_motion(head: dict[str, Any], skin: SkinnedMesh, motion: SkeletonClip, buffer: Buffer) -> None:
    T = motion.n_frames
    times = motion.times.astype(np.float32)[:, None]
    every = buffer.add(lambda: times, (T, 1), None, bounds=True)
    once = buffer.add(lambda: times[:1], (1, 1), None, bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def add(joint: int, path: str, keys: int, values: FloatArray) -> None:
        output = buffer.add(lambda: values, values.shape, None)
        channels.append({"sampler": len(samplers), "target": {"node": joint + 1, "path": path}})
        samplers.append({"input": keys, "interpolation": "LINEAR", "output": output})

    add(0, "translation", every, motion.root_position)
    xyzw = continuous(motion.rotations)[..., [1, 2, 3, 0]]
    for j in range(skin.skeleton.n_joints):
        add(j, "rotation", every, xyzw[:, j])
        if j and not np.array_equal(motion.skeleton.offsets[j], skin.skeleton.offsets[j]):
            add(j, "translation", once, motion.skeleton.offsets[[j]])
    head["animations"] = [
        {
            "name": motion.name or "motion",
            "samplers": samplers,
            "channels": channels,
            "extras": {"tempose": {"fps": motion.fps}},
        }
    ]
