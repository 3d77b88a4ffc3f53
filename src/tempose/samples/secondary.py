"""Flesh and cloth that follow a skinned body late: what they do depends on what the body did before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats
from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, multiply, rotate, to_matrix
from tempose.samples.oscillators import acceleration, oscillate
from tempose.samples.skirt import swing_skirt
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Flesh:
    """How soft a part of the body is."""

    frequency: float
    """Of its free wobble, Hz."""
    damping: float
    """Part of the critical damping."""
    limit: float
    """Metres that it is never displaced beyond."""


FLESH = {
    "belly": Flesh(3.6, 0.2, 0.05),
    "buttocks": Flesh(5.0, 0.22, 0.03),
    "chest": Flesh(4.6, 0.2, 0.035),
    "cheeks": Flesh(7.0, 0.25, 0.012),
}
"""Softness by name of region; a name that is not here counts as ``"belly"``."""


def secondary_motion(
    skin: SkinnedMesh,
    clip: SkeletonClip,
    V: FloatArray,
    soft: Mapping[str, FloatArray],
    *,
    scale: float = 1.0,
) -> FloatArray:
    """Add the wobble of flesh and the swing of cloth to a skinned clip.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices bound to the joints of the clip.
    clip : SkeletonClip
        T frames.
    V : (T, n, 3) float
        Skinned vertices, metres.
    soft : mapping of str to (n,) float
        How far each vertex takes part, 0 to 1, by name of region; the region called ``"skirt"`` swings as a
        ring of pendulums round the hips wherever its weights would put it, every other wobbles as flesh.
    scale : float, default 1.0
        Factor on all displacements.

    Returns
    -------
    (T, n, 3) ndarray
        Vertices in secondary motion, metres. The displacement is zero while the body stands or moves
        evenly in its rest pose.

    Raises
    ------
    ValueError
        If a mask has the wrong length or leaves 0 to 1.
    """
    moved = np.array(V, dtype=np.float64)
    for name, values in soft.items():
        mask = as_floats(values, f"soft[{name!r}]", (len(skin.mesh.vertices),))
        if mask.size and (mask.min() < 0 or mask.max() > 1):
            raise ValueError(f"soft[{name!r}] must be 0 to 1, got {mask.min():.3g} to {mask.max():.3g}")
        inside = np.flatnonzero(mask > 0)
        if len(inside) == 0:
            continue
        part = SkinnedPart(skin.mesh.vertices[inside], skin.weights[inside], mask[inside])
        if name == "skirt":
            swing = swing_skirt(skin, clip, part.vertices, part.mask, moved[:, inside])
            moved[:, inside] += scale * swing
        else:
            moved[:, inside] += scale * wobble(skin, clip, part, FLESH.get(name, FLESH["belly"]))
    return moved


@dataclass(frozen=True, eq=False)
class SkinnedPart:
    """Some vertices of a skinned mesh."""

    vertices: FloatArray
    """(k, 3) at rest, metres."""
    weights: FloatArray
    """(k, J) skin weights."""
    mask: FloatArray
    """(k,) how far each takes part, 0 to 1."""


def wobble(skin: SkinnedMesh, clip: SkeletonClip, part: SkinnedPart, flesh: Flesh) -> FloatArray:
    """Displacement of flesh: every vertex is a mass on a damped spring at its skinned place.

    Parameters
    ----------
    skin : SkinnedMesh
        The body.
    clip : SkeletonClip
        T frames.
    part : SkinnedPart
        k vertices.
    flesh : Flesh
        Softness.

    Returns
    -------
    (T, k, 3) ndarray
        Metres.

    Notes
    -----
    Skinned vertices are linear in the joints' transforms, and so is the oscillator in its force: it is enough
    to let the transforms oscillate and to skin the vertices with the result.
    """
    world, position = forward_kinematics(skin.skeleton, clip.rotations, clip.root_position)
    bind_rotation, bind_position = rest_transforms(skin.skeleton)
    turn = multiply(world, conjugate(bind_rotation))
    transforms = np.concatenate(
        [to_matrix(turn), (position - rotate(turn, bind_position))[..., None]], axis=-1
    )
    lag = oscillate(-acceleration(transforms, clip.fps), flesh.frequency, flesh.damping, clip.fps)
    V1 = np.column_stack([part.vertices, np.ones(len(part.vertices))])
    lifted = (part.weights[:, :, None] * V1[:, None, :]).reshape(len(V1), -1)
    columns = lag.transpose(0, 1, 3, 2).reshape(len(lag), -1, 3)
    u = np.matmul(lifted, columns)
    length = np.linalg.norm(u, axis=-1, keepdims=True)
    return part.mask[:, None] * u / np.sqrt(1.0 + (length / flesh.limit) ** 2)
