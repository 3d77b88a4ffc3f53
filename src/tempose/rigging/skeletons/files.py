"""A skeleton or a skin from any file that holds one."""

from __future__ import annotations

import os
from pathlib import Path

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.formats import load_skeleton_clip, load_skin
from tempose.formats.conventions import FormatError
from tempose.models import load_model
from tempose.rigging.saving import KIND, rig_from_arrays

_RIG, _WEIGHTS = ".tempose", ".mhw"
_SKINS = (".glb", ".gltf", ".usd", ".usda", ".usdc", ".usdz")


def read_skeleton(path: str | os.PathLike[str], mesh: Mesh | None = None) -> Skeleton | SkinnedMesh:
    """Read the skeleton that a mesh or clip shall have.

    Parameters
    ----------
    path : path-like
        A saved rig; a GLB, glTF or USD file, whose skin is taken if it has one; MakeHuman weights; or a
        skeleton's motion, such as BVH, of which the rest pose is taken.
    mesh : Mesh, optional
        The mesh that MakeHuman weights are for.

    Returns
    -------
    Skeleton or SkinnedMesh
        As the file has it.

    Raises
    ------
    FormatError
        If there is no skeleton in it.
    ValueError
        If it is a broken model; the message names it.
    """
    suffix = Path(path).suffix.lower()
    if suffix == _RIG:
        arrays, header = load_model(path, KIND)
        try:
            return rig_from_arrays(arrays, header).skin
        except (LookupError, TypeError, ValueError) as error:
            raise ValueError(f"{path}: a rig whose parts do not fit together: {error}") from None
    if suffix == _WEIGHTS:
        return load_skin(path, mesh=mesh)
    if suffix in _SKINS:
        try:
            return load_skin(path)
        except FormatError as error:
            try:
                return load_skeleton_clip(path).skeleton
            except FormatError:
                raise error from None
    return load_skeleton_clip(path).skeleton
