"""Write BVH: joints with Euler channels, one row of numbers a frame."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator

import numpy as np

from tempose._files import atomic_path
from tempose.clips import Skeleton, SkeletonClip
from tempose.formats._names import distinct
from tempose.formats.conventions import to_file, y_up_rotation
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import conjugate, from_matrix, multiply, rotate, to_euler_degrees
from tempose.typing import FloatArray

_ORDER = "zxy"
_NUMBER = "%.9g"
_UNFIT = re.compile(r"[\s{}]+")


def write_bvh(
    path: str | os.PathLike[str], clip: SkeletonClip, *, up: str | None = None, unit: float | None = None
) -> None:
    """Write the motion of a skeleton as a BVH file.

    Parameters
    ----------
    path : path-like
        Final name.
    clip : SkeletonClip
        T >= 1 frames of J joints.
    up : str, optional
        Up axis of the file; by default that of ``clip.source``.
    unit : float, optional
        Metres per unit of the file; by default that of ``clip.source``.

    Raises
    ------
    ValueError
        If there is no frame.
    OSError
        If the place cannot be written.

    Notes
    -----
    BVH has no rest rotations: the pose of all channels zero is the rest pose, whatever the bases of the
    joints are, and channels turn away from it. The root has the offset zero and six channels, as programs
    differ on whether its positions add to the offset; every other joint has three angles. Angles do not jump
    by full turns. Spaces and braces in names become underscores; names that become alike get numbers.
    """
    if not clip.n_frames:
        raise ValueError("a BVH file needs at least one frame, got none")
    up, unit = up or clip.source.up, unit or clip.source.unit
    skeleton, rotations = zero_at_rest(*_depth_first(clip.skeleton, clip.rotations))
    turn = conjugate(from_matrix(y_up_rotation(up)))
    rotations = multiply(multiply(turn, rotations), conjugate(turn))
    angles = continuous_angles(to_euler_degrees(rotations, _ORDER))
    root = to_file(clip.root_position, up, unit)
    table = np.concatenate([_clean(root), _clean(angles.reshape(len(root), -1))], axis=1)
    with atomic_path(path) as part, part.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"{line}\n" for line in ["HIERARCHY", *_hierarchy(skeleton, up, unit), "MOTION"])
        file.write(f"Frames: {len(table)}\nFrame Time: {1.0 / clip.fps:.10f}\n")
        np.savetxt(file, table, fmt=_NUMBER)


def zero_at_rest(skeleton: Skeleton, rotations: FloatArray) -> tuple[Skeleton, FloatArray]:
    """Express a motion in bases that are those of the world in the rest pose.

    Parameters
    ----------
    skeleton : Skeleton
        J joints with rest rotations.
    rotations : (..., J, 4) float
        Local rotations wxyz.

    Returns
    -------
    skeleton : Skeleton
        The same joints in the same places at rest; rest rotations are the identity.
    rotations : (..., J, 4) ndarray
        Local rotations of the same motion.
    """
    rest, places = rest_transforms(skeleton)
    parents = skeleton.parents
    world, _ = forward_kinematics(skeleton, rotations, np.zeros(3))
    turned = multiply(world, conjugate(rest))
    local = np.array(turned)
    local[..., 1:, :] = multiply(conjugate(turned[..., parents[1:], :]), turned[..., 1:, :])
    offsets = np.array(places)
    offsets[1:] -= places[parents[1:]]
    assert skeleton.tips is not None
    tips = rotate(rest, np.nan_to_num(skeleton.tips))
    tips[np.isnan(skeleton.tips).any(axis=1)] = np.nan
    return Skeleton(skeleton.names, parents, offsets, tips=tips), local


def continuous_angles(angles: FloatArray) -> FloatArray:
    """Choose the Euler angles of every frame next to those of the frame before.

    Parameters
    ----------
    angles : (T, ..., 3) float
        Degrees about three different moving axes.

    Returns
    -------
    (T, ..., 3) ndarray
        The same rotations, without jumps of full or half turns.
    """
    result = np.array(angles)
    for t in range(1, len(result)):
        here, before = result[t], result[t - 1]
        other = here * [1, -1, 1] + 180.0
        both = np.stack([a + 360.0 * np.round((before - a) / 360.0) for a in (here, other)])
        far = np.abs(both - before).sum(axis=-1)
        result[t] = np.where((far[0] <= far[1])[..., None], both[0], both[1])
    return result


def _depth_first(skeleton: Skeleton, rotations: FloatArray) -> tuple[Skeleton, FloatArray]:
    """Sort the joints as braces nest them: the columns of a BVH stand in this order."""
    order: list[int] = []
    stack = [0]
    while stack:
        order.append(stack.pop())
        stack.extend(reversed(skeleton.children(order[-1]).tolist()))
    assert skeleton.rest_rotations is not None and skeleton.tips is not None
    parents = [-1, *(order.index(skeleton.parents[j]) for j in order[1:])]
    rest, tips = skeleton.rest_rotations[order], skeleton.tips[order]
    names = tuple(skeleton.names[j] for j in order)
    return Skeleton(names, np.array(parents), skeleton.offsets[order], rest, tips), rotations[:, order]


def _hierarchy(skeleton: Skeleton, up: str, unit: float) -> Iterator[str]:
    offsets = _clean(to_file(skeleton.offsets, up, unit))
    offsets[0] = 0.0
    names = distinct([_UNFIT.sub("_", name) for name in skeleton.names])
    assert skeleton.tips is not None
    tips = _clean(np.nan_to_num(to_file(skeleton.tips, up, unit)))
    turns = " ".join(f"{axis.upper()}rotation" for axis in _ORDER)
    depth: list[int] = []
    for j, parent in enumerate(skeleton.parents):
        depth.append(depth[parent] + 1 if j else 0)
        outer, inner = "\t" * depth[j], "\t" * (depth[j] + 1)
        yield f"{outer}{'JOINT' if j else 'ROOT'} {names[j]}"
        yield f"{outer}{{"
        yield f"{inner}OFFSET {_numbers(offsets[j])}"
        yield f"{inner}CHANNELS " + (f"3 {turns}" if j else f"6 Xposition Yposition Zposition {turns}")
        if not len(skeleton.children(j)):
            yield from (f"{inner}End Site", f"{inner}{{")
            yield from (f"{inner}\tOFFSET {_numbers(tips[j])}", f"{inner}}}")
        following = skeleton.parents[j + 1] if j + 1 < skeleton.n_joints else -1
        stays = depth[following] if following >= 0 else -1
        yield from ("\t" * d + "}" for d in range(depth[j], stays, -1))


def _numbers(values: FloatArray) -> str:
    return " ".join(_NUMBER % value for value in values)


def _clean(values: FloatArray) -> FloatArray:
    """Zeros in place of what rounding left of them."""
    return np.where(np.abs(values) < 1e-12 * np.abs(values).max(initial=0.0), 0.0, values)
