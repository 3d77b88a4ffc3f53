"""Example poses: the same mesh in several shapes, from files or arrays, rid of where they stand."""

from __future__ import annotations

import glob
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.clips import Mesh, MeshClip
from tempose.formats import load_clip, load_mesh
from tempose.signals.placement import split_placement
from tempose.typing import FloatArray

ROUNDS = 8
"""Rounds of alignment to the mean; the change left after them is far below a percent of a step."""


@dataclass(frozen=True, eq=False)
class PoseSet:
    """Poses of one mesh."""

    vertices: FloatArray
    """(N, n, 3) positions, metres."""
    mesh: Mesh
    """The first of them, with its faces."""

    def __post_init__(self) -> None:
        n = len(self.mesh.vertices)
        object.__setattr__(self, "vertices", read_only(as_floats(self.vertices, "poses", ("N", n, 3))))

    def __len__(self) -> int:
        return len(self.vertices)

    def aligned(self) -> tuple[FloatArray, FloatArray]:
        """Return the poses about their centroids, turned to agree as well as they can.

        Returns
        -------
        bodies : (N, n, 3) ndarray
            Generalised Procrustes: each pose turned to the mean of all, which is turned to the first pose.
        centre : (3,) ndarray
            Where the first pose stands: its centroid, metres.
        """
        _, bodies = split_placement(self.vertices, rounds=ROUNDS)
        return bodies, self.vertices[0].mean(axis=0)


def load_poses(names: Sequence[str], folder: Path, what: str) -> PoseSet:
    """Load example poses.

    Parameters
    ----------
    names : sequence of str
        One file a pose; or a single name: a clip, a folder of frames or a glob.
    folder : Path
        Where the names count from; what is not there is looked for in the working folder.
    what : str
        What the poses are, for messages.

    Returns
    -------
    PoseSet
        In the order of the names.

    Raises
    ------
    ValueError
        If a file cannot be read, or the poses are not of one mesh.
    """
    if len(names) == 1:
        clip = load_clip(locate(names[0], folder))
        return PoseSet(np.asarray(clip.vertices, dtype=np.float64), clip.mesh)
    meshes = [load_mesh(locate(name, folder)) for name in names]
    for name, mesh in zip(names, meshes):
        if not np.array_equal(mesh.faces, meshes[0].faces) or mesh.vertices.shape != meshes[0].vertices.shape:
            raise ValueError(
                f"{what}: {name} has other faces than {names[0]}: {len(mesh.vertices)} vertices and "
                f"{len(mesh.faces)} faces against {len(meshes[0].vertices)} and {len(meshes[0].faces)}; "
                "poses must be of one mesh"
            )
    return PoseSet(np.array([mesh.vertices for mesh in meshes]), meshes[0])


def locate(name: str, folder: Path) -> Path:
    """Return where a file named in a list lies.

    Parameters
    ----------
    name : str
        A file, folder, glob or pattern of frames.
    folder : Path
        Of the list.

    Returns
    -------
    Path
        Beside the list; in the working folder where only that holds it.
    """
    beside = folder / name
    if _matches(beside) or not _matches(Path(name)):
        return beside
    return Path(name)


def _matches(path: Path) -> bool:
    if path.exists():
        return True
    # ####, %04d: the frames of a sequence by their numbers
    pattern = re.sub(r"#+|%\d*d", "*", str(path))
    return next(glob.iglob(pattern), None) is not None


def as_poses(poses: PoseSet | MeshClip | Sequence[Mesh], what: str) -> PoseSet:
    """Return poses given in any form as a set.

    Parameters
    ----------
    poses : PoseSet, MeshClip or sequence of Mesh
        The frames of a clip are poses, too.
    what : str
        What they are, for messages.

    Returns
    -------
    PoseSet
        The poses.

    Raises
    ------
    ValueError
        If there is none, or they are not of one mesh.
    """
    if isinstance(poses, PoseSet):
        return poses
    if isinstance(poses, MeshClip):
        return PoseSet(np.asarray(poses.vertices, dtype=np.float64), poses.mesh)
    meshes = list(poses)
    if not meshes:
        raise ValueError(f"{what} must hold two poses or more, got none")
    for i, mesh in enumerate(meshes):
        if not np.array_equal(mesh.faces, meshes[0].faces):
            raise ValueError(f"{what}[{i}] has other faces than {what}[0]; poses must be of one mesh")
    return PoseSet(np.array([mesh.vertices for mesh in meshes]), meshes[0])
