"""Joints, weights and motion as UsdSkel prims."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh
from tempose.formats._influences import strongest
from tempose.formats.conventions import to_file, y_up_rotation
from tempose.formats.usd_stage import identifier, modules
from tempose.kinematics import rest_transforms
from tempose.rotations import conjugate, continuous, from_matrix, multiply, to_matrix
from tempose.typing import FloatArray

JOINTS = "joints"
"""Name of the skeleton's prim."""

_STILL = "still"
_METHODS = {"linear": "classicLinear", "dual-quaternion": "dualQuaternion"}


def add_skin(
    stage: Any,
    root: Any,
    mesh: Any,
    skin: SkinnedMesh,
    motion: SkeletonClip,
    up: str,
    unit: float,
    blending: str,
) -> None:
    """Define skeleton and animation, and bind the mesh to them.

    Parameters
    ----------
    stage : pxr.Usd.Stage
        Being written.
    root : pxr.Sdf.Path
        Of the ``SkelRoot``.
    mesh : pxr.UsdGeom.Mesh
        The mesh.
    skin : SkinnedMesh
        J joints.
    motion : SkeletonClip
        T frames.
    up : str
        Up axis of the file.
    unit : float
        Metres per unit of the file.
    blending : str
        ``"linear"`` or ``"dual-quaternion"``.

    Notes
    -----
    The joints of the file are those of the skin; what is bound to nothing hangs on one more that never
    moves. Names that no path can hold are kept in ``jointNames``.
    """
    pxr = modules(str(root))
    loose = skin.weights.sum(axis=1) == 0
    still = [_STILL] if loose.any() else []
    joints = [*_paths(skin.skeleton), *still]
    turn = conjugate(from_matrix(y_up_rotation(up)))
    skeleton = pxr.UsdSkel.Skeleton.Define(stage, root.AppendChild(JOINTS))
    skeleton.CreateJointsAttr(joints)
    skeleton.CreateJointNamesAttr([*skin.skeleton.names, *still])
    skeleton.CreateBindTransformsAttr(_matrices(pxr, _bind(skin.skeleton, turn, up, unit), len(joints)))
    skeleton.CreateRestTransformsAttr(_matrices(pxr, _rest(skin.skeleton, turn, up, unit), len(joints)))
    animation = pxr.UsdSkel.Animation.Define(stage, skeleton.GetPath().AppendChild("motion"))
    animation.CreateJointsAttr(joints)
    _add_motion(pxr, animation, motion, turn, up, unit, len(still))
    pxr.UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(
        [animation.GetPath()]
    )
    binding = pxr.UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
    binding.CreateGeomBindTransformAttr(pxr.Gf.Matrix4d(1.0))
    binding.CreateSkinningMethodAttr(_METHODS[blending])
    weights = np.column_stack([skin.weights, loose]) if still else skin.weights
    most = max(int(np.count_nonzero(weights, axis=1).max(initial=1)), 1)
    index, share = strongest(weights, most)
    binding.CreateJointIndicesPrimvar(False, index.shape[1]).Set(
        pxr.Vt.IntArray.FromNumpy(np.ascontiguousarray(index.ravel(), dtype=np.int32))
    )
    binding.CreateJointWeightsPrimvar(False, index.shape[1]).Set(
        pxr.Vt.FloatArray.FromNumpy(np.ascontiguousarray(share.ravel(), dtype=np.float32))
    )


def _paths(skeleton: Skeleton) -> list[str]:
    """Path of each joint; parts are distinct where names become alike."""
    paths: list[str] = []
    taken: set[str] = set()
    for name, parent in zip(skeleton.names, skeleton.parents):
        plain = identifier(name)
        while plain in taken or plain == _STILL:
            plain += "_"
        taken.add(plain)
        paths.append(plain if parent < 0 else f"{paths[parent]}/{plain}")
    return paths


def _bind(skeleton: Skeleton, turn: FloatArray, up: str, unit: float) -> FloatArray:
    rotations, positions = rest_transforms(skeleton)
    return _transforms(multiply(turn, rotations), to_file(positions, up, unit))


def _rest(skeleton: Skeleton, turn: FloatArray, up: str, unit: float) -> FloatArray:
    assert skeleton.rest_rotations is not None
    rotations, offsets = np.array(skeleton.rest_rotations), skeleton.offsets / unit
    rotations[0], offsets[0] = multiply(turn, rotations[0]), to_file(skeleton.offsets[0], up, unit)
    return _transforms(rotations, offsets)


def _transforms(rotations: FloatArray, positions: FloatArray) -> FloatArray:
    matrices = np.tile(np.eye(4), (len(rotations), 1, 1))
    matrices[:, :3, :3], matrices[:, :3, 3] = to_matrix(rotations), positions
    return matrices


def _matrices(pxr: Any, matrices: FloatArray, count: int) -> Any:
    # row vectors, as everything in USD
    rows = [pxr.Gf.Matrix4d(*matrix.T.ravel().tolist()) for matrix in matrices]
    return pxr.Vt.Matrix4dArray(rows + [pxr.Gf.Matrix4d(1.0)] * (count - len(rows)))


def _add_motion(
    pxr: Any, animation: Any, motion: SkeletonClip, turn: FloatArray, up: str, unit: float, still: int
) -> None:
    rotations = np.array(continuous(motion.rotations))
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    places = np.tile(motion.skeleton.offsets / unit, (motion.n_frames, 1, 1))
    places[:, 0] = to_file(motion.root_position, up, unit)
    if still:
        rotations = np.concatenate([rotations, np.tile([1.0, 0, 0, 0], (len(rotations), 1, 1))], axis=1)
        places = np.concatenate([places, np.zeros((len(places), 1, 3))], axis=1)
    turns, shifts = animation.CreateRotationsAttr(), animation.CreateTranslationsAttr()
    animation.CreateScalesAttr(pxr.Vt.Vec3hArray([pxr.Gf.Vec3h(1, 1, 1)] * rotations.shape[1]))
    for t in range(motion.n_frames):
        quaternions = [pxr.Gf.Quatf(*map(float, q)) for q in rotations[t]]
        turns.Set(pxr.Vt.QuatfArray(quaternions), float(t))
        shifts.Set(pxr.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(places[t], dtype=np.float32)), float(t))
