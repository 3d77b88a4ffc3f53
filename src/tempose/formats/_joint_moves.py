"""Sampled joint transforms reduced to what a skeleton clip holds: rotations and the path of the root."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import forward_kinematics
from tempose.rotations import conjugate, continuous, from_matrix, multiply, polar_rotation, rotate
from tempose.typing import BoolArray, FloatArray, IntArray

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


def rigid(matrices: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Rotation and place of transforms that may also scale or mirror.

    Parameters
    ----------
    matrices : (..., 4, 4) float
        Finite transforms.

    Returns
    -------
    rotations : (..., 4) ndarray
        Nearest rotations, wxyz; of a mirrored basis those of its negative, so that they stay continuous.
    positions : (..., 3) ndarray
        Places.
    """
    # singular values of huge numbers overflow: only the direction matters
    linear = matrices[..., :3, :3]
    linear = linear / np.maximum(np.abs(linear).max(axis=(-1, -2), keepdims=True), 1e-300)
    sign = np.where(np.linalg.det(linear) < 0, -1.0, 1.0)[..., None, None]
    return from_matrix(polar_rotation(linear * sign)), matrices[..., :3, 3]


def local_rotations(parents: IntArray, rotations: FloatArray) -> FloatArray:
    """World rotations to rotations relative to the parent.

    Parameters
    ----------
    parents : (J,) int
        Parents, -1 for the root.
    rotations : (..., J, 4) float
        World rotations wxyz.

    Returns
    -------
    (..., J, 4) ndarray
        Local rotations.
    """
    local = np.array(rotations)
    local[..., 1:, :] = multiply(conjugate(rotations[..., parents[1:], :]), rotations[..., 1:, :])
    return local


def local_offsets(parents: IntArray, rotations: FloatArray, positions: FloatArray) -> FloatArray:
    """World positions to offsets in the basis of the parent.

    Parameters
    ----------
    parents : (J,) int
        Parents, -1 for the root.
    rotations : (..., J, 4) float
        World rotations wxyz.
    positions : (..., J, 3) float
        World positions.

    Returns
    -------
    (..., J, 3) ndarray
        Offsets; of the root its position.
    """
    offsets = np.array(positions)
    bone = positions[..., 1:, :] - positions[..., parents[1:], :]
    offsets[..., 1:, :] = rotate(conjugate(rotations[..., parents[1:], :]), bone)
    return offsets


def reduce_moves(
    rest: Skeleton, rotations: FloatArray, positions: FloatArray, carrying: IntArray | None
) -> Moves:
    """Reduce sampled joints to rotations and a root path.

    Parameters
    ----------
    rest : Skeleton
        J joints in the bind pose.
    rotations : (T, J, 4) float
        World rotations wxyz.
    positions : (T, J, 3) float
        World positions, metres.
    carrying : (k,) int or None
        Joints that carry weight; None if nothing is drawn.

    Returns
    -------
    Moves
        Exact for all joints that carry weight where translations and scales are constant below their
        common ancestor.
    """
    parents = rest.parents
    offsets = local_offsets(parents, rotations, positions)
    size = float(np.linalg.norm(rest.offsets[1:], axis=1).sum()) or 1.0
    fixed = np.array(rest.offsets)
    moved = np.abs(offsets - fixed).max(axis=(0, 2)) > _STILL * size
    varies = np.ptp(offsets, axis=0).max(axis=1) > _STILL * size
    anchor = _first_traveller(parents, varies) if carrying is None else _anchor(parents, carrying)
    # what lies between root and anchor keeps its bind pose: the root path makes up for it
    moved[_path(parents, anchor)] = False
    fixed[moved] = offsets[:, moved].mean(axis=0)
    root = _root_path(parents, anchor, rotations, positions, fixed)
    if np.abs(root - positions[:, 0]).max() <= _STILL * size:
        root = positions[:, 0]
    skeleton = replace(rest, offsets=fixed)
    local = continuous(local_rotations(parents, rotations))
    _, reached = forward_kinematics(skeleton, local, root)
    counted = np.arange(rest.n_joints) if carrying is None else carrying
    notes = _deviation(reached - positions, counted, skeleton, size)
    if not np.array_equal(root, positions[:, 0]):
        notes = (f"The root follows {rest.names[anchor]!r}, the first joint that carries weight.", *notes)
    return Moves(skeleton, local, root, notes)


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
