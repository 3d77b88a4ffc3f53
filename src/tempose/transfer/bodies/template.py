"""The template mesh: every bone of a moving skeleton as a closed triangle mesh."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.rotations import conjugate, rotate, shortest_rotation
from tempose.transfer.bodies.pose import BonePose
from tempose.typing import FloatArray, IntArray

_SIDES = 8
_PROFILE = np.array([[0.0, 0.0], [0.06, 0.5], [0.2, 1.0], [0.6, 0.75], [0.94, 0.45], [1.0, 0.0]])
"""Along the bone, and radius as a share of the largest."""


def bone_mesh(length: float, radius: float) -> tuple[FloatArray, IntArray]:
    """Make a closed spindle along +Y from the origin.

    Parameters
    ----------
    length, radius : float
        Metres.

    Returns
    -------
    V : (n, 3) ndarray
        Vertices.
    F : (m, 3) ndarray of int
        Faces, counter-clockwise seen from outside.
    """
    rings = _PROFILE[1:-1]
    angle = np.arange(_SIDES) * 2 * np.pi / _SIDES
    circle = np.column_stack([np.sin(angle), np.zeros(_SIDES), np.cos(angle)])
    body = [circle * radius * r + [0, length * y, 0] for y, r in rings]
    V = np.vstack([[0, 0, 0], *body, [0, length, 0]])
    k, following = np.arange(_SIDES), (np.arange(_SIDES) + 1) % _SIDES
    faces = [np.column_stack([np.zeros(_SIDES, dtype=int), 1 + following, 1 + k])]
    for ring in range(len(rings) - 1):
        low, high = 1 + ring * _SIDES, 1 + (ring + 1) * _SIDES
        faces.append(np.column_stack([low + k, low + following, high + following]))
        faces.append(np.column_stack([low + k, high + following, high + k]))
    top, last = len(V) - 1, 1 + (len(rings) - 1) * _SIDES
    faces.append(np.column_stack([last + k, last + following, np.full(_SIDES, top)]))
    return V, np.vstack(faces).astype(np.int32)


def template_clip(names: tuple[str, ...], motion: BonePose, fps: float, name: str = "template") -> MeshClip:
    """Carry a closed mesh a bone through a motion, rigidly, by forward kinematics.

    Parameters
    ----------
    names : tuple of str
        B names, which become groups of faces.
    motion : BonePose
        (T, B) bones in the world; a bone without length becomes a small spindle.
    fps : float
        Frames per second.
    name : str
        Name of the mesh.

    Returns
    -------
    MeshClip
        T frames; its rest is frame 0. The rotation of any face is exactly that of its bone.
    """
    lengths = np.median(motion.lengths, axis=0)
    typical = float(np.median(lengths[lengths > 0])) if (lengths > 0).any() else 0.1
    local, faces, groups, first = [], [], {}, 0
    m = 0
    for b, bone in enumerate(names):
        length = float(lengths[b]) if lengths[b] > 0 else 0.3 * typical
        V, F = bone_mesh(length, min(0.16 * length + 0.03 * typical, 0.3 * typical))
        axis = rotate(conjugate(motion.turns[0, b]), _direction(motion, b))
        local.append(rotate(shortest_rotation(np.array([0.0, 1.0, 0.0]), axis), V))
        faces.append(F + first)
        groups[bone] = np.arange(m, m + len(F))
        first, m = first + len(V), m + len(F)
    bone_of = np.repeat(np.arange(len(names)), [len(V) for V in local])
    points = np.vstack(local)
    frames = rotate(motion.turns[:, bone_of], points) + motion.starts[:, bone_of]
    mesh = Mesh(frames[0], np.vstack(faces), groups=groups, name=name)
    return MeshClip(frames.astype(np.float32), mesh, fps)


def _direction(motion: BonePose, b: int) -> FloatArray:
    """Direction of a bone in frame 0; one of unknown end continues the bone that ends where it starts."""
    directions = motion.directions[0]
    if not directions[b].any():
        gap = np.linalg.norm(motion.ends[0] - motion.starts[0, b], axis=1)
        gap[motion.lengths[0] == 0] = np.inf
        b = int(gap.argmin())
    return directions[b] if directions[b].any() else np.array([0.0, 1.0, 0.0])
