"""UsdSkel: joints, bind pose, weights and motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.clips import Skeleton
from tempose.formats._joint_moves import local_offsets, local_rotations, rigid
from tempose.formats._names import distinct
from tempose.formats.usd_mesh import Part
from tempose.formats.usd_stage import Stage, modules
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Rigged:
    """A skeleton of the stage and what it moves."""

    prim: Any
    """The skeleton's prim."""
    query: Any
    """Its ``UsdSkel.SkeletonQuery``."""
    skinned: dict[str, Any]
    """Path of a mesh to its ``UsdSkel.SkinningQuery``."""
    kept: IntArray
    """(J,) joint of the file for each of ours; -1 for a root that had to be made."""
    parents: IntArray
    """(J,) parents, first come first."""
    names: tuple[str, ...]
    """(J,) distinct names."""


def read_rigged(stage: Stage) -> Rigged:
    """Find the skeleton that moves most.

    Parameters
    ----------
    stage : Stage
        The file.

    Returns
    -------
    Rigged
        The skeleton of most skinned meshes; of a file without any, the first that is animated.

    Raises
    ------
    FormatError
        If there is none.
    """
    skel = modules(stage.place).UsdSkel
    cache, found = skel.Cache(), list[tuple[int, Any, dict[str, Any]]]()
    predicate = modules(stage.place).Usd.PrimDefaultPredicate
    for prim in stage.usd.Traverse():
        if prim.IsA(skel.Root):
            root = skel.Root(prim)
            cache.Populate(root, predicate)
            for binding in cache.ComputeSkelBindings(root, predicate):
                meshes = {str(q.GetPrim().GetPath()): q for q in binding.GetSkinningTargets()}
                found.append((len(meshes), binding.GetSkeleton(), meshes))
        if prim.IsA(skel.Skeleton):
            found.append((0, skel.Skeleton(prim), {}))
    found = [each for each in found if each[1].GetJointsAttr().Get()]
    if not found:
        raise stage.error("expected a skeleton (UsdSkel), found none")
    best = max(found, key=lambda each: each[0])
    query = cache.GetSkelQuery(best[1])
    if not query:
        raise stage.error(f"expected a sound skeleton, {best[1].GetPrim().GetPath()} cannot be read")
    joints = [str(joint) for joint in query.GetJointOrder()]
    named = list(best[1].GetJointNamesAttr().Get() or [])
    if len(named) != len(joints) or len(set(named)) != len(named):
        named = [joint.rsplit("/", 1)[-1] for joint in joints]
    parents = np.array(query.GetTopology().GetParentIndices(), dtype=np.int64)
    kept, parents = _one_root(stage, parents)
    names = distinct([str(named[k]) if k >= 0 else "root" for k in kept])
    return Rigged(best[1].GetPrim(), query, best[2], kept, parents, names)


def _one_root(stage: Stage, parents: IntArray) -> tuple[IntArray, IntArray]:
    if (parents >= np.arange(len(parents))).any():
        raise stage.error("expected joints after their parents, found one before")
    if (parents < 0).sum() == 1:
        if parents[0] < 0:
            return np.arange(len(parents)), parents
    return np.arange(-1, len(parents)), np.concatenate([[-1], parents + 1])


def bind_transforms(stage: Stage, rigged: Rigged) -> FloatArray:
    """Bind pose of every joint.

    Parameters
    ----------
    stage : Stage
        The file.
    rigged : Rigged
        J joints.

    Returns
    -------
    (J, 4, 4) ndarray
        ``T_world_joint``, metres.
    """
    earliest = modules(stage.place).Usd.TimeCode.EarliestTime()
    matrices = rigged.query.GetJointWorldBindTransforms() if rigged.query.HasBindPose() else None
    if matrices is None or len(matrices) == 0:
        matrices = rigged.query.ComputeJointSkelTransforms(earliest, True)
    if matrices is None or len(matrices) != len(rigged.query.GetJointOrder()):
        raise stage.error("expected a bind or rest transform a joint, found other numbers of them")
    bind = np.array(matrices, dtype=np.float64).reshape(-1, 4, 4).transpose(0, 2, 1)
    return _placed(stage, rigged, bind, place_of(stage, rigged.prim, None))


def joint_transforms(stage: Stage, rigged: Rigged, codes: FloatArray) -> FloatArray:
    """Joints over time.

    Parameters
    ----------
    stage : Stage
        The file.
    rigged : Rigged
        J joints.
    codes : (T,) float
        Time codes.

    Returns
    -------
    (T, J, 4, 4) ndarray
        ``T_world_joint``, metres.
    """
    frames: list[FloatArray] = []
    for code in codes:
        matrices = rigged.query.ComputeJointSkelTransforms(float(code))
        if matrices is None or len(matrices) != len(rigged.query.GetJointOrder()):
            raise stage.error(f"expected a transform a joint, found none at time code {code:g}")
        skel = np.array(matrices, dtype=np.float64).reshape(-1, 4, 4).transpose(0, 2, 1)
        frames.append(_placed(stage, rigged, skel, place_of(stage, rigged.prim, float(code))))
    return np.stack(frames)


def place_of(stage: Stage, prim: Any, code: float | None) -> FloatArray:
    """Transform from the space of a prim to ours.

    Parameters
    ----------
    stage : Stage
        The file.
    prim : pxr.Usd.Prim
        Any prim.
    code : float or None
        Time code; None for the earliest.

    Returns
    -------
    (4, 4) ndarray
        Metres, Y up.
    """
    pxr = modules(stage.place)
    time = pxr.Usd.TimeCode.EarliestTime() if code is None else pxr.Usd.TimeCode(code)
    matrix = pxr.UsdGeom.Imageable(prim).ComputeLocalToWorldTransform(time)
    return stage.frame @ np.array(matrix, dtype=np.float64).reshape(4, 4).T


def _placed(stage: Stage, rigged: Rigged, matrices: FloatArray, place: FloatArray) -> FloatArray:
    placed = place @ matrices
    if rigged.kept[0] < 0:
        placed = np.concatenate([np.eye(4)[None], placed])
    if not np.isfinite(placed).all():
        raise stage.error("expected finite joint transforms, found one that is not")
    return placed


def bind_skeleton(stage: Stage, rigged: Rigged) -> Skeleton:
    """Skeleton whose rest pose is the bind pose.

    Parameters
    ----------
    stage : Stage
        The file.
    rigged : Rigged
        J joints.

    Returns
    -------
    Skeleton
        Scales of the joints are in the offsets.
    """
    rotations, positions = rigid(bind_transforms(stage, rigged))
    offsets = local_offsets(rigged.parents, rotations, positions)
    rest = local_rotations(rigged.parents, rotations)
    return Skeleton(rigged.names, rigged.parents, offsets, rest)


def sample_times(rigged: Rigged) -> set[float]:
    """Time codes at which the joints are sampled.

    Parameters
    ----------
    rigged : Rigged
        The skeleton.

    Returns
    -------
    set of float
        Empty where there is no animation.
    """
    animation = rigged.query.GetAnimQuery()
    return set(animation.GetJointTransformTimeSamples()) if animation else set()


def skin_weights(stage: Stage, rigged: Rigged, parts: list[Part]) -> FloatArray:
    """Weights of every vertex that is drawn.

    Parameters
    ----------
    stage : Stage
        The file.
    rigged : Rigged
        J joints.
    parts : list of Part
        The meshes.

    Returns
    -------
    (n, J) ndarray
        Rows sum to 1, or to 0 for what the skeleton does not move.

    Raises
    ------
    FormatError
        If a joint is out of range, a weight negative, or numbers are missing.
    """
    weights = stated_weights(stage, rigged, parts)
    sums = weights.sum(axis=1, keepdims=True)
    return weights / np.where(sums > 0, sums, 1.0)


def stated_weights(stage: Stage, rigged: Rigged, parts: list[Part]) -> FloatArray:
    """Weights of every vertex as the file states them.

    Parameters
    ----------
    stage, rigged, parts
        As for `skin_weights`.

    Returns
    -------
    (n, J) ndarray
        Not normalised.

    Raises
    ------
    FormatError
        As for `skin_weights`.
    """
    J = len(rigged.kept)
    first = int(rigged.kept[0] < 0)
    weights = np.zeros((parts[-1].start + parts[-1].n, J))
    for part in parts:
        query = rigged.skinned.get(str(part.prim.GetPath()))
        if query is None or not query.HasJointInfluences():
            continue
        found = query.ComputeVaryingJointInfluences(part.n)
        width = query.GetNumInfluencesPerComponent()
        joints, shares = (np.array(values).reshape(-1, width) for values in found)
        mapper = query.GetJointMapper()
        if mapper and not mapper.IsIdentity():
            own = _own_joints(stage, rigged, query)
        else:
            own = np.arange(J - first)
        where = f"{part.prim.GetPath()}: "
        if len(joints) != part.n:
            raise stage.error(f"{where}expected weights of {part.n} vertices, found {len(joints)}")
        if ((joints < 0) | (joints >= len(own))).any():
            raise stage.error(
                f"{where}expected joints below {len(own)}, found {joints.min()}..{joints.max()}"
            )
        if not (np.isfinite(shares).all() and (shares >= 0).all()):
            raise stage.error(f"{where}expected weights from 0, found {shares.min():g}")
        rows = np.arange(part.start, part.start + part.n)[:, None]
        np.add.at(weights, (rows, own[joints] + first), shares.astype(np.float64))
    return weights


def _own_joints(stage: Stage, rigged: Rigged, query: Any) -> IntArray:
    """Joint of the skeleton for each of those that a mesh lists itself."""
    place = {str(joint): k for k, joint in enumerate(rigged.query.GetJointOrder())}
    listed = [str(joint) for joint in query.GetJointOrder()]
    unknown = [joint for joint in listed if joint not in place]
    if unknown:
        raise stage.error(f"expected joints of the skeleton, found {unknown[0]!r} listed by a mesh")
    return np.array([place[joint] for joint in listed])
