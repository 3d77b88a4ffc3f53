"""A rig with other proportions: joints, flesh, and a motion whose feet stay on the ground."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import rest_transforms
from tempose.rigging.proportions.factors import read_factors
from tempose.rigging.proportions.stretch import stretches
from tempose.rigging.rig import Rig
from tempose.rotations import conjugate, rotate
from tempose.typing import FloatArray

_BLOCK = 16


def change_proportions(rig: Rig, factors: Mapping[str, Any]) -> Rig:
    """Make bones longer or shorter, thicker or thinner, with the flesh along them.

    Parameters
    ----------
    rig : Rig
        n vertices, J joints, T frames.
    factors : mapping of str to float or mapping
        Joint name to the factor of the length of the bone that starts there, or to ``{"length": a,
        "thickness": b}``; see `tempose.rigging.proportions.read_factors`.

    Returns
    -------
    Rig
        The same rotations on other bones. At every frame the lowest point of the body is as high as it was,
        so that feet stay on the ground; the way travelled grows with the height of the root, so that they
        do not slide. The report lists the ``proportions``.

    Raises
    ------
    ValueError
        If a joint is unknown or a factor is no positive number.

    Notes
    -----
    As in Fig. 6 d, e of [1]_. The space about joint j is stretched by ``S_j``: ``length`` along its bone,
    ``thickness`` across. A child goes to ``p'_child = p'_j + S_j (p_child - p_j)``, a vertex to the blend
    ``sum_j w_j (p'_j + S_j (v - p_j))``, so the flesh is stretched as smoothly as it is bound. Of several
    bones that start at one joint, the middle one (up the spine, to the head) gives the direction; those to
    the sides widen by ``thickness``.

    References
    ----------
    .. [1] de Aguiar and Ukita, "Representing mesh-based character animations", Computers & Graphics 38,
       2014.
    """
    read = read_factors(rig.skin.skeleton, factors)
    listed = {
        name: {"length": f.length, "thickness": f.thickness}
        for name, f in zip(rig.skin.skeleton.names, read)
        if (f.length, f.thickness) != (1.0, 1.0)
    }
    report = {**rig.report, "proportions": [*rig.report.get("proportions", []), listed]}
    S = stretches(rig.skin.skeleton, read)
    skin = _stretched(rig.skin, S)
    moving = _longer(rig.motion.skeleton, S, skin.skeleton.offsets[0])
    motion = replace(rig.motion, skeleton=moving)
    motion = _travelling(motion, _root_height(skin) / _root_height(rig.skin))
    return _grounded(rig, Rig(skin, motion, rig.blending, report))


def _stretched(skin: SkinnedMesh, S: FloatArray) -> SkinnedMesh:
    """Skin with its flesh stretched, its lowest point as high as it was."""
    skeleton = skin.skeleton
    P = rest_transforms(skeleton)[1]
    longer = _longer(skeleton, S, skeleton.offsets[0])
    Q = rest_transforms(longer)[1]
    V = skin.mesh.vertices
    # by differences, so that factors of 1 change nothing, not even the last bit but one
    change = S - np.eye(3)
    shift = (Q - P) - np.einsum("jab,jb->ja", change, P)
    moved = V + skin.weights @ shift
    moved += np.einsum("nj,jab,nb->na", skin.weights, change, V, optimize=True)
    drop = np.array([0.0, V[:, 1].min() - moved[:, 1].min(), 0.0])
    offsets = np.array(longer.offsets)
    offsets[0] += drop
    mesh: Mesh = skin.mesh.with_vertices(moved + drop)
    return SkinnedMesh(mesh, replace(longer, offsets=offsets), skin.weights)


def _longer(skeleton: Skeleton, S: FloatArray, root: FloatArray) -> Skeleton:
    """Skeleton whose bones are stretched by the maps of the joints at which they start."""
    rotations, P = rest_transforms(skeleton)
    assert skeleton.tips is not None
    offsets, tips = np.array(skeleton.offsets), np.array(skeleton.tips)
    same = (S == np.eye(3)).all(axis=(1, 2))
    for j, above in enumerate(skeleton.parents):
        if above >= 0 and not same[above]:
            offsets[j] = rotate(conjugate(rotations[above]), S[above] @ (P[j] - P[above]))
        if not same[j]:
            tips[j] = rotate(conjugate(rotations[j]), S[j] @ rotate(rotations[j], tips[j]))
    offsets[0] = root
    return replace(skeleton, offsets=offsets, tips=tips)


def _root_height(skin: SkinnedMesh) -> float:
    """How high the root is above the lowest vertex at rest; a share of the diagonal where it is not above."""
    least = 0.01 * max(skin.mesh.diagonal, 1e-300)
    return max(float(skin.skeleton.offsets[0, 1] - skin.mesh.vertices[:, 1].min()), least)


def _travelling(motion: SkeletonClip, ratio: float) -> SkeletonClip:
    if motion.n_frames == 0 or ratio == 1.0:
        return motion
    root = np.array(motion.root_position)
    root[:, [0, 2]] += (ratio - 1.0) * (root - root[0])[:, [0, 2]]
    return replace(motion, root_position=root)


def _grounded(before: Rig, after: Rig) -> Rig:
    """Lift or lower the root at every frame until the lowest point is as high as before."""
    root = np.array(after.motion.root_position)
    for start in range(0, len(root), _BLOCK):
        some = slice(start, start + _BLOCK)
        low = [rig.vertices(rig.motion.frames(some))[..., 1].min(axis=1) for rig in (before, after)]
        root[some, 1] += low[0] - low[1]
    return replace(after, motion=replace(after.motion, root_position=root))
