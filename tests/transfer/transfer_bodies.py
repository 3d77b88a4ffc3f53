"""Skeletons, motions and bodies of known truth."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation
from transfer_zoo import wxyz

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh
from tempose.geometry import vertex_adjacency
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, multiply, rotate
from tempose.samples.skeletons import human_skeleton

IDENTITY = np.array([1.0, 0, 0, 0])


def about(axis: str, degrees: float) -> np.ndarray:
    return wxyz(Rotation.from_euler(axis, degrees, degrees=True))


def t_pose(skeleton: Skeleton | None = None) -> Skeleton:
    """The human with its arms straight out to the sides and its legs straight down."""
    A = skeleton or human_skeleton()
    J = rest_transforms(A)[1]
    P = np.array(J)
    for side, x in (("left_", 1.0), ("right_", -1.0)):
        for chain, along in (
            (("upper_arm", "forearm", "hand"), np.array([x, 0, 0])),
            (("thigh", "shin", "foot"), np.array([0, -1.0, 0])),
        ):
            joints = [A.index(side + part) for part in chain]
            for a, b in pairwise(joints):
                P[b] = P[a] + np.linalg.norm(J[b] - J[a]) * along
        foot, toes = A.index(side + "foot"), A.index(side + "toes")
        P[toes] = P[foot] + J[toes] - J[foot]
    tips = np.array(A.tips)
    for side, x in (("left_", 1.0), ("right_", -1.0)):
        hand = A.index(side + "hand")
        tips[hand] = [x * np.linalg.norm(tips[hand]), 0, 0]
    parents = np.asarray(A.parents)
    offsets = np.where(parents[:, None] < 0, P, P - P[parents])
    return Skeleton(A.names, parents, offsets, tips=tips)


def clip_of(skeleton: Skeleton, turns: dict[str, np.ndarray], T: int, fps: float = 30.0) -> SkeletonClip:
    """Local rotations of some joints ((4,) or (T, 4)); the others and the root rest."""
    rotations = np.tile(skeleton.rest_rotations, (T, 1, 1))
    for name, q in turns.items():
        rotations[:, skeleton.index(name)] = q
    return SkeletonClip(skeleton, rotations, np.tile(skeleton.offsets[0], (T, 1)), fps)


def turned(clip: SkeletonClip, turn: np.ndarray) -> SkeletonClip:
    """The whole motion turned about the origin."""
    rotations = np.array(clip.rotations)
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    return SkeletonClip(clip.skeleton, rotations, rotate(turn, clip.root_position), clip.fps)


def scaled(clip: SkeletonClip, unit: float) -> SkeletonClip:
    s = clip.skeleton
    skeleton = Skeleton(s.names, s.parents, unit * s.offsets, s.rest_rotations, unit * s.tips)
    return SkeletonClip(skeleton, clip.rotations, unit * clip.root_position, clip.fps)


def rolled(clip: SkeletonClip, rng: np.random.Generator) -> SkeletonClip:
    """The same motion of a skeleton whose joints carry other, meaningless local axes."""
    s = clip.skeleton
    axes = wxyz(Rotation.random(s.n_joints, rng=rng))
    parents = np.asarray(s.parents)
    above = np.where(parents[:, None] < 0, IDENTITY, axes[parents])
    offsets = rotate(conjugate(above), s.offsets)
    rest = multiply(multiply(conjugate(above), s.rest_rotations), axes)
    tips = rotate(conjugate(axes), np.nan_to_num(s.tips)) + np.where(np.isnan(s.tips), np.nan, 0)
    rotations = multiply(multiply(conjugate(above), clip.rotations), axes)
    skeleton = Skeleton(s.names, parents, offsets, rest, tips)
    return SkeletonClip(skeleton, rotations, clip.root_position, clip.fps)


def segments(skeleton: Skeleton) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """Every joint with the stretches of bone that hang on it, at rest."""
    turns, P = rest_transforms(skeleton)
    found = []
    for j, parent in enumerate(skeleton.parents):
        if parent >= 0:
            found.append((int(parent), P[parent], P[j]))
        if np.isfinite(skeleton.tips[j]).all():
            found.append((j, P[j], P[j] + rotate(turns[j], skeleton.tips[j])))
    return found


def _distance(points: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    s = np.clip((points - a) @ (b - a) / max((b - a) @ (b - a), 1e-12), 0, 1)
    return np.linalg.norm(points - a - s[:, None] * (b - a), axis=1)


_RADII = {
    "hips": 0.13,
    "spine": 0.13,
    "chest": 0.1,
    "neck": 0.065,
    "head": 0.085,
    "thigh": 0.075,
    "shin": 0.055,
}


def _radius(name: str) -> float:
    return _RADII.get(name.split("_", 1)[-1], 0.045)


def inflate(skeleton: Skeleton, step: float = 0.04) -> SkinnedMesh:
    """A closed body round the bones: boundary of the cells near them, smoothed; weights by nearness."""
    bones = segments(skeleton)
    ends = np.concatenate([np.stack([a, b]) for _, a, b in bones])
    low = ends.min(axis=0) - 0.2
    shape = np.ceil((ends.max(axis=0) + 0.2 - low) / step).astype(int)
    cells = np.stack(np.meshgrid(*[np.arange(k) for k in shape], indexing="ij"), axis=-1).reshape(-1, 3)
    centres = low + (cells + 0.5) * step
    inside = np.zeros(len(cells), dtype=bool)
    for j, a, b in bones:
        inside |= _distance(centres, a, b) < _radius(skeleton.names[j])
    V, F = _skin_of_cells(inside.reshape(shape))
    mesh = Mesh(low + _smoothed(V, F) * step, F)
    weights = np.zeros((len(V), skeleton.n_joints))
    for j, a, b in bones:
        near = (_distance(mesh.vertices, a, b) + 0.005) ** -8.0
        weights[:, j] = np.maximum(weights[:, j], near)
    return SkinnedMesh(mesh, skeleton, weights / weights.sum(axis=1, keepdims=True))


def _skin_of_cells(solid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    solid = np.pad(solid, 1)
    quads = []
    for axis in range(3):
        for side in (1, -1):
            open_ = solid & ~np.roll(solid, -side, axis)
            i = np.argwhere(open_) - 1
            u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
            corner = i + (np.eye(3, dtype=int)[axis] if side > 0 else 0)
            loop = [corner, corner + u, corner + u + v, corner + v]
            quads.append(np.stack(loop if side > 0 else loop[::-1], axis=1))
    corners = np.concatenate(quads)
    V, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    Q = index.reshape(-1, 4)
    return V.astype(float), np.concatenate([Q[:, [0, 1, 2]], Q[:, [0, 2, 3]]])


def _smoothed(V: np.ndarray, F: np.ndarray, times: int = 6) -> np.ndarray:
    A = vertex_adjacency(F, len(V))
    degree = np.asarray(A.sum(axis=1)).ravel()[:, None]
    for _ in range(times):
        V = 0.5 * V + 0.5 * (A @ V) / degree
    return V


@lru_cache
def human_body() -> SkinnedMesh:
    return inflate(human_skeleton())


@lru_cache
def t_body() -> SkinnedMesh:
    return inflate(t_pose())


def world_of(clip: SkeletonClip) -> tuple[np.ndarray, np.ndarray]:
    return forward_kinematics(clip.skeleton, clip.rotations, clip.root_position)
