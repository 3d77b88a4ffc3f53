"""A small skinned mesh with everything a format could lose: seams, quads, groups, odd names, odd bases."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import rest_transforms
from tempose.rotations import from_rotation_vector, multiply, normalise


def odd_skeleton(size: float = 1.0, seed: int = 0) -> Skeleton:
    """Six joints, not depth first, with rest rotations, a tip and names that are no identifiers."""
    rng = np.random.default_rng(seed)
    names = ("root", "left arm.001", "right:arm", "left arm_001", "7th", "tail")
    parents = np.array([-1, 0, 0, 1, 2, 1])
    rest = from_rotation_vector(rng.normal(size=(6, 3)))
    offsets = size * rng.normal(size=(6, 3)) * 0.4
    tips = np.full((6, 3), np.nan)
    tips[5] = size * np.array([0.1, 0.2, 0.3])
    return Skeleton(names, parents, offsets, rest, tips)


def sheet(size: float = 1.0, n: int = 4) -> Mesh:
    """Quads over a bumpy sheet with a UV seam, a group and colours."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    V = size * np.column_stack([x.ravel(), y.ravel(), np.sin(x.ravel() + 2 * y.ravel())]) / n
    index = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1).reshape(-1, 4)
    F = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    right = (quads[:, 0] >= index[n // 2, 0]).repeat(2)
    uv = np.concatenate([V[:, :2], V[:, :2] * 0.5]) / size
    C = F + right[:, None] * len(V)
    used = np.unique(C)
    return Mesh(
        V,
        F,
        uv=uv[used],
        uv_faces=np.searchsorted(used, C),
        groups={"left side": np.flatnonzero(~right)},
        polygons=np.full(len(quads), 4),
        name="my sheet",
    )


def odd_skin(size: float = 1.0, influences: int = 4, loose: int = 0, seed: int = 0) -> SkinnedMesh:
    """The sheet bound to the skeleton, `influences` joints a vertex, the first `loose` ones to nothing."""
    rng = np.random.default_rng(seed)
    mesh, skeleton = sheet(size), odd_skeleton(size, seed)
    weights = np.zeros((len(mesh.vertices), skeleton.n_joints))
    for row in weights:
        chosen = rng.permutation(skeleton.n_joints)[:influences]
        row[chosen] = rng.dirichlet(np.ones(influences))
    weights[:loose] = 0
    return SkinnedMesh(mesh, skeleton, weights)


def wild_motion(skeleton: Skeleton, frames: int = 12, fps: float = 25.0, seed: int = 1) -> SkeletonClip:
    """Turns of any size about any axis, quaternion signs at random, a root that travels."""
    rng = np.random.default_rng(seed)
    rate = rng.normal(size=(skeleton.n_joints, 3))
    turns = from_rotation_vector(np.linspace(0, 5, frames)[:, None, None] * rate)
    rotations = multiply(np.asarray(skeleton.rest_rotations), turns)
    rotations = normalise(rotations) * rng.choice([-1.0, 1.0], size=(frames, skeleton.n_joints, 1))
    size = float(np.abs(rest_transforms(skeleton)[1]).max())
    root = skeleton.offsets[0] + size * np.cumsum(rng.normal(size=(frames, 3)), axis=0) * 0.2
    return SkeletonClip(skeleton, rotations, root, fps, "wild")
