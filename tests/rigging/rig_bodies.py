"""Bodies and rigs for the tests of rigging: small, with everything known."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh
from tempose.rigging import Rig
from tempose.rotations import conjugate, from_rotation_vector, multiply, rotate
from tempose.samples import human_character


@lru_cache
def human_skin() -> SkinnedMesh:
    """The built-in human at low resolution, with its true skeleton and weights."""
    return human_character(4000).skin


def random_rig(skin: SkinnedMesh, frames: int = 5, size: float = 0.3, seed: int = 3) -> Rig:
    """A rig with smooth random turns of all joints and a root that travels."""
    rng = np.random.default_rng(seed)
    skeleton = skin.skeleton
    J = skeleton.n_joints
    turns = np.linspace(0, 1, frames)[:, None, None] * rng.normal(scale=size, size=(J, 3))
    rest = np.broadcast_to(skeleton.rest_rotations, (frames, J, 4))
    rotations = multiply(rest, from_rotation_vector(turns))
    way = np.cumsum(rng.normal(scale=0.1, size=(frames, 3)), axis=0)
    return Rig(skin, SkeletonClip(skeleton, rotations, skeleton.offsets[0] + way, 25.0))


def tube(length: float = 2.0, radius: float = 0.15, rings: int = 24, around: int = 12) -> Mesh:
    """A closed tube along Y from 0 to `length`."""
    y = np.linspace(0, length, rings)
    a = 2 * np.pi * np.arange(around) / around
    ring = np.column_stack([radius * np.cos(a), np.zeros(around), radius * np.sin(a)])
    caps = np.array([[0, 0, 0], [0, length, 0]])
    V = np.concatenate([*(ring + np.array([0, h, 0]) for h in y), caps])
    faces: list[tuple[int, int, int]] = []
    for r in range(rings - 1):
        for k in range(around):
            p, q = r * around + k, r * around + (k + 1) % around
            faces += [(p, p + around, q), (q, p + around, q + around)]
    low, high, last = rings * around, rings * around + 1, (rings - 1) * around
    for k in range(around):
        faces += [(low, k, (k + 1) % around), (high, last + (k + 1) % around, last + k)]
    return Mesh(V, np.array(faces))


def chain(lengths: tuple[float, ...] = (0.6, 0.7, 0.5), start: float = 0.1) -> Skeleton:
    """A chain of joints up along Y, with rest rotations that are not the identity."""
    rng = np.random.default_rng(5)
    J = len(lengths)
    rest = from_rotation_vector(rng.normal(size=(J, 3)))
    world = np.array(rest)
    for j in range(1, J):
        world[j] = multiply(world[j - 1], rest[j])
    offsets = [np.array([0.0, start, 0.0])]
    offsets += [rotate(conjugate(world[j - 1]), np.array([0.0, lengths[j - 1], 0.0])) for j in range(1, J)]
    tips = np.full((J, 3), np.nan)
    tips[-1] = rotate(conjugate(world[-1]), np.array([0.0, lengths[-1], 0.0]))
    names = tuple(f"part_{j}" for j in range(J))
    return Skeleton(names, np.arange(-1, J - 1), np.array(offsets), rest, tips)
