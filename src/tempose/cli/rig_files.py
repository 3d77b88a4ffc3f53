"""The files that `tempose rig` and `tempose detail` read: checked before the work, told of afterwards."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import tempose
from tempose.cli.console import note, progress_bar

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, Skeleton, SkinnedMesh
    from tempose.detail import DetailModel
    from tempose.rigging import Rig

_WORDS = ("human", "auto")
RIG_ENDINGS = (".bvh", ".glb", ".usda", ".usd", ".usdc")
"""What `tempose rig export` writes."""


def check_kept_out(path: Path, kind: str) -> None:
    """Refuse a place for a rig or a model before the work is done that makes it.

    Parameters
    ----------
    path : Path
        Where it shall go.
    kind : str
        ``"rig"`` or ``"model"``, for the message.

    Raises
    ------
    ValueError
        If its ending belongs to clips or pictures, or it is a folder.
    FileNotFoundError
        If its folder does not exist.
    """
    known = {*tempose.formats.FORMATS, ".usdc", ".fbx", ".png", ".gif", ".mp4", ".json", ".toml"}
    if path.suffix.lower() in known:
        how = (
            "`tempose rig export` makes BVH, GLB and USD of it"
            if kind == "rig"
            else "`tempose detail pose` plays it"
        )
        raise ValueError(f"{path}: a {kind} is written as NAME.tempose; {how}")
    if path.is_dir():
        raise ValueError(f"{path}: is a folder; name a file for the {kind}, such as {path / 'body.tempose'}")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"{path.parent}: no such folder to write {path.name!r} in; create it first")


def load_body(path: str, **reading: Any) -> Mesh | MeshClip:
    """Load what shall be rigged.

    Parameters
    ----------
    path : str
        File, folder or pattern.
    **reading
        As for `tempose.load`.

    Returns
    -------
    Mesh or MeshClip
        A clip where it moves.

    Raises
    ------
    ValueError
        If it is the motion of a skeleton.
    """
    with progress_bar() as progress:
        body = tempose.load(path, progress=progress, **reading)
    note(tempose.formats.describe(body))
    if isinstance(body, tempose.SkeletonClip):
        raise ValueError(
            f"{path}: holds a skeleton without a mesh; name the mesh first, and this as --skeleton {path}"
        )
    return body


def check_skeleton(word: str) -> None:
    """Refuse what --skeleton was given before a long clip is read.

    Parameters
    ----------
    word : str
        ``"human"``, ``"auto"`` or a file.

    Raises
    ------
    ValueError
        If it is no such word and no such file.
    """
    if word not in _WORDS and not Path(word).is_file():
        raise ValueError(f"--skeleton must be human, auto or a file, found no file {word!r}")


def load_skeleton(word: str, body: Mesh | MeshClip) -> str | SkinnedMesh | Skeleton:
    """Read what --skeleton was given.

    Parameters
    ----------
    word : str
        ``"human"``, ``"auto"`` or a file.
    body : Mesh or MeshClip
        What shall have it.

    Returns
    -------
    str, SkinnedMesh or Skeleton
        As `tempose.rigging.fit_rig` takes it.
    """
    from tempose.clips import MeshClip, SkinnedMesh
    from tempose.rigging.skeletons import read_skeleton

    if word in _WORDS:
        return word
    path = Path(word)
    if path.suffix.lower() == ".tempose":
        return load_rig(path).skin
    found = read_skeleton(path, body.mesh if isinstance(body, MeshClip) else body)
    bound = isinstance(found, SkinnedMesh)
    joints = (found.skeleton if bound else found).n_joints
    note(f"{path.name}: {joints} joints, {'with' if bound else 'without'} weights")
    return found


def load_rig(path: Path) -> Rig:
    """Load a rig, also out of a model of detail.

    Parameters
    ----------
    path : Path
        What `tempose rig fit` or `tempose detail fit` wrote.

    Returns
    -------
    Rig
        The rig.
    """
    from tempose.rigging import Rig

    if path.is_dir():
        raise ValueError(f"{path}: is a folder, expected a rig that `tempose rig fit` wrote")
    if path.is_file() and model_kind(path) == "detail":
        return load_detail(path).rig_
    rig = Rig.load(path)
    note(describe_rig(rig))
    return rig


def load_detail(path: Path) -> DetailModel:
    """Load a model of detail and say in one line what it is.

    Parameters
    ----------
    path : Path
        What `tempose detail fit` wrote.

    Returns
    -------
    DetailModel
        The model.
    """
    from tempose.detail import DetailModel

    if path.is_dir():
        raise ValueError(f"{path}: is a folder, expected a model that `tempose detail fit` wrote")
    model = DetailModel.load(path)
    note(f"detail of a {describe_rig(model.rig_)}")
    return model


def model_kind(path: Path) -> str:
    """Say what kind of model a file holds.

    Parameters
    ----------
    path : Path
        Any file.

    Returns
    -------
    str
        ``"rig"``, ``"detail"``...; empty where it is no model.
    """
    import json

    try:
        with path.open("rb") as file:
            size = int.from_bytes(file.read(8), "little")
            header = json.loads(file.read(min(size, 1 << 24)))
        return str(json.loads(header["__metadata__"]["tempose"])["kind"])
    except (KeyError, TypeError, ValueError, OSError):
        return ""


def describe_rig(rig: Rig) -> str:
    """Say what a rig moves.

    Parameters
    ----------
    rig : Rig
        Any.

    Returns
    -------
    str
        One line.
    """
    skin, motion = rig.skin, rig.motion
    return (
        f"rig of {skin.mesh.name or 'a mesh'}: {skin.skeleton.n_joints} joints, "
        f"{len(skin.mesh.vertices)} vertices, {rig.blending} blending, "
        f"{motion.n_frames} frames at {motion.fps:.6g} fps"
    )
