"""What `tempose transfer` is given, loaded: motion, target, pairs, reference pose, joint names."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import tempose
from tempose._tables import read_table
from tempose.cli.console import note, progress_bar

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
    from tempose.transfer import Pairs

_SKELETON_FILES = (".bvh", ".amc", ".glb", ".gltf")
_SCENES = (".glb", ".gltf")


def load_pairs(path: Path | None) -> Pairs | None:
    """Load a list of pairs; skin weights are none.

    Parameters
    ----------
    path : Path or None
        What ``--pairs`` was given.

    Returns
    -------
    Pairs or None
        The list; None where pairs come from skin weights.
    """
    if path is None or path.suffix.lower() == ".mhw":
        return None
    return tempose.transfer.load_pairs(path)


def load_motion(path: str, pairs: Pairs | None, **options: Any) -> SkeletonClip | MeshClip:
    """Load the source: a skeleton's motion, unless the pairs speak of a mesh.

    Parameters
    ----------
    path : str
        File, folder or pattern.
    pairs : Pairs or None
        What says which of the two is wanted.
    **options
        ``up``, ``unit``, ``fps`` and ``clip``, as for `tempose.load`.

    Returns
    -------
    SkeletonClip or MeshClip
        The motion.
    """
    of_joints = pairs is None or pairs.kind == "joints"
    if of_joints and Path(path).suffix.lower() in _SKELETON_FILES:
        motion: SkeletonClip | MeshClip = tempose.formats.load_skeleton_clip(path, **options)
    else:
        with progress_bar() as progress:
            motion = tempose.formats.load_clip(path, progress=progress, **options)
    note(tempose.formats.describe(motion))
    return motion


def load_target(path: str, weights: Path | None, group: str | None, **options: Any) -> Mesh | SkinnedMesh:
    """Load the target, with its skin weights where there are any.

    Parameters
    ----------
    path : str
        File of the target.
    weights : Path or None
        MakeHuman weights (``.mhw``) for it; anything else is not looked at.
    group : str or None
        Keep only this group of faces.
    **options
        ``up`` and ``unit``, as for `tempose.load`.

    Returns
    -------
    Mesh or SkinnedMesh
        The target at rest.
    """
    target = _skinned_scene(path, group, options) if Path(path).suffix.lower() in _SCENES else None
    if target is None:
        target = tempose.formats.load_mesh(path, group=group, **options)
        if weights is not None and weights.suffix.lower() == ".mhw":
            target = tempose.formats.load_skin(weights, mesh=target)
    note(tempose.formats.describe(target))
    return target


def _skinned_scene(path: str, group: str | None, options: dict[str, Any]) -> SkinnedMesh | None:
    try:
        skinned = tempose.formats.load_skin(path, **options)
    except tempose.formats.FormatError:
        return None  # without a usable skin it may still be a mesh, whose reader says what is wrong
    if group is None:
        return skinned
    from dataclasses import replace

    from tempose.clips.mesh_parts import keep_group

    part, kept = keep_group(skinned.mesh, group)
    return replace(skinned, mesh=part, weights=skinned.weights[kept])


def load_rest(given: str | None, motion: SkeletonClip | MeshClip) -> dict[str, Any]:
    """Find the reference pose of the source.

    Parameters
    ----------
    given : str or None
        What ``--source-rest`` was given: a frame of the source, or a file.
    motion : SkeletonClip or MeshClip
        The whole source.

    Returns
    -------
    dict
        ``source_rest`` and ``rest_frame``, as `tempose.transfer.transfer_motion` takes them.

    Raises
    ------
    ValueError
        If the source has no such frame.
    """
    if given is None:
        return {}
    still = isinstance(motion, tempose.SkeletonClip)
    if not given.isdecimal():
        return {"source_rest": load_motion(given, None) if still else tempose.formats.load_mesh(given)}
    frame = int(given)
    if frame >= motion.n_frames:
        raise ValueError(
            f"--source-rest must be a file or a frame from 0 to {motion.n_frames - 1}, got {frame}"
        )
    if isinstance(motion, tempose.SkeletonClip):
        return {"source_rest": motion, "rest_frame": frame}
    return {"source_rest": motion.mesh.with_vertices(motion.vertices[frame])}


def load_mapping(path: Path | None) -> dict[str, str] | None:
    """Load joint names: source joint to body role.

    Parameters
    ----------
    path : Path or None
        JSON or TOML file of one flat table.

    Returns
    -------
    dict or None
        The table; None without a file.

    Raises
    ------
    ValueError
        If the file holds anything else.
    """
    if path is None:
        return None
    table = read_table(path)
    if not all(isinstance(value, str) for value in table.values()):
        raise ValueError(f'{path}: expected one table such as {{"LeftForeArm": "left_forearm"}}')
    return table
