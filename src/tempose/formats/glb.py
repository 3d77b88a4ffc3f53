"""glTF 2.0, binary or text: meshes, skins, morph targets and animations in; still meshes and morphs out.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022).
"""

from __future__ import annotations

import os

import numpy as np

from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.formats.glb_bake import bake
from tempose.formats.glb_clips import animation_names, read_motion
from tempose.formats.glb_container import load
from tempose.formats.glb_joints import bind_skeleton, choose_joints
from tempose.formats.glb_scene import moving_source, open_scene, rest_mesh
from tempose.formats.glb_skeleton import skeleton_moves
from tempose.formats.glb_weights import dense_weights
from tempose.formats.glb_write import Written, write

__all__ = ["Written", "clip_names", "read_clip", "read_mesh", "read_skeleton_clip", "read_skin", "write"]


def clip_names(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """List the animations of a file.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.

    Returns
    -------
    tuple of str
        Distinct names; an unnamed animation is ``clip_0`` and so on by its index.

    Raises
    ------
    FormatError
        If the file is broken.
    """
    return animation_names(load(path))


def read_mesh(path: str | os.PathLike[str], *, up: str | None = None, unit: float | None = None) -> Mesh:
    """Read everything the default scene draws as one mesh.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.
    up : str, optional
        Up axis, for files that do not keep to glTF's Y.
    unit : float, optional
        Metres per unit, for files that do not keep to glTF's metres.

    Returns
    -------
    Mesh
        World positions, a skinned mesh in its bind pose; texture coordinates with their origin at the lower
        left; groups by the names of nodes, meshes and materials. A mesh that `write` wrote comes back with
        its own vertex order, polygons and groups.

    Raises
    ------
    FormatError
        If the file is broken or draws no triangles; the message names the place in the JSON.
    """
    with np.errstate(all="ignore"):
        return rest_mesh(open_scene(path, up, unit))[0]


def read_clip(
    path: str | os.PathLike[str],
    clip: str | None = None,
    fps: float | None = None,
    *,
    up: str | None = None,
    unit: float | None = None,
) -> MeshClip:
    """Bake an animation: skins, morph targets and moving nodes.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.
    clip : str, optional
        Name of the animation; the first if not given.
    fps : float, optional
        Rate to sample at; from the spacing of the keys if not given, else 30.
    up : str, optional
        Up axis, for files that do not keep to glTF's Y.
    unit : float, optional
        Metres per unit, for files that do not keep to glTF's metres.

    Returns
    -------
    MeshClip
        T frames from the first key to the last; its mesh is that of `read_mesh`. A file without animations
        gives one frame, as its nodes stand.

    Raises
    ------
    FormatError
        If the file is broken, or there is no such animation: the message lists the names.

    Notes
    -----
    Rotations are interpolated by slerp, cubic splines by appendix C.5 of [1]_; a vertex is the weighted sum
    of its joints' matrices, section 3.7.3.3.

    References
    ----------
    .. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022).
    """
    with np.errstate(all="ignore"):
        scene = open_scene(path, up, unit)
        assert scene.geometry is not None
        motion = read_motion(scene.doc, scene.nodes, clip, fps)
        mesh, order = rest_mesh(scene)
        V = bake(scene.doc, scene.nodes, scene.geometry, scene.bindings, motion)
        V = V[:, order.first] if order.split else V
    source = moving_source(scene, motion, *mesh.source.notes)
    return MeshClip(V, mesh, motion.fps, source)


def read_skeleton_clip(
    path: str | os.PathLike[str],
    clip: str | None = None,
    fps: float | None = None,
    *,
    up: str | None = None,
    unit: float | None = None,
) -> SkeletonClip:
    """Read an animation as motion of the joints.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.
    clip : str, optional
        Name of the animation; the first if not given.
    fps : float, optional
        Rate to sample at; from the spacing of the keys if not given, else 30.
    up : str, optional
        Up axis, for files that do not keep to glTF's Y.
    unit : float, optional
        Metres per unit, for files that do not keep to glTF's metres.

    Returns
    -------
    SkeletonClip
        Joints of the skins in use (of a file without any: the nodes that move), at rest in the bind pose.
        Scales are in the offsets. Offsets are those of the clip where it holds them constant but unlike the
        bind pose.

    Raises
    ------
    FormatError
        If the file is broken, has no joints, or there is no such animation: the message lists the names.

    Notes
    -----
    A skeleton clip moves only its root. Joints above the first one that carries weight move nothing, so the
    root takes over its path, as with a still root above hips that travel; any other translation is held at
    its mean and `source.notes` states the largest deviation.
    """
    with np.errstate(all="ignore"):
        scene = open_scene(path, up, unit, drawn=False)
        motion = read_motion(scene.doc, scene.nodes, clip, fps)
        moves = skeleton_moves(scene.doc, scene.nodes, scene.geometry, scene.bindings, motion)
    source = moving_source(scene, motion, *moves.notes)
    return SkeletonClip(moves.skeleton, moves.rotations, moves.root, motion.fps, motion.name, source)


def read_skin(
    path: str | os.PathLike[str], *, up: str | None = None, unit: float | None = None
) -> SkinnedMesh:
    """Read a mesh with the skeleton in it and the weights between them.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.
    up : str, optional
        Up axis, for files that do not keep to glTF's Y.
    unit : float, optional
        Metres per unit, for files that do not keep to glTF's metres.

    Returns
    -------
    SkinnedMesh
        Bind pose, from the inverse bind matrices; the same mesh as `read_mesh`, the same joints as
        `read_skeleton_clip`. What hangs on a joint without a skin of its own has weight 1 there; what hangs
        on none has a row of zeros.

    Raises
    ------
    FormatError
        If the file is broken or has no skin in use.
    """
    with np.errstate(all="ignore"):
        scene = open_scene(path, up, unit)
        if not scene.bindings:
            raise scene.doc.top.error("expected a mesh with a skin, found none")
        mesh, order = rest_mesh(scene)
        joints = choose_joints(scene.doc, scene.nodes, scene.bindings, None)
        skeleton = bind_skeleton(scene.doc, joints, scene.bindings, scene.world)
        weights = dense_weights(scene, joints)[order.first]
    return SkinnedMesh(mesh, skeleton, weights)
