"""Edits that read meshes from files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tempose.formats import load_mesh
from tempose.signals.edits.add_pose import add_pose
from tempose.signals.replace_shape import load_poses, locate, replace_shape
from tempose.signals.signals import Signals
from tempose.typing import FloatArray


def add_pose_from(signals: Signals, file: str, at: FloatArray, folder: Path, notes: list[str]) -> Signals:
    """Add the pose in a file; see `tempose.signals.edits.add_pose.add_pose`.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    file : str
        Name of the mesh.
    at : (2,) float
        Its place in the pose plane.
    folder : Path
        Where the name counts from.
    notes : list of str
        Gets what became of the shape signal.

    Returns
    -------
    Signals
        With one pose more.
    """
    result = add_pose(signals, load_mesh(locate(file, folder)), at)
    m, before = len(result.shape.components), len(signals.shape.components)
    notes.append(
        f"the shape signal has {m} components" + (", one of them new" if m > before else " as before")
    )
    return result


def replace_shape_from(
    signals: Signals, source: list[str], target: list[str], folder: Path, notes: list[str], **options: Any
) -> Signals:
    """Replace the shape signal through poses in files; see `tempose.signals.replace_shape.replace_shape`.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    source, target : list of str
        Names of the poses, pair by pair.
    folder : Path
        Where the names count from.
    notes : list of str
        Gets how far the poses can show the motion.
    **options
        As of the function.

    Returns
    -------
    Signals
        Playing the target.
    """
    poses = load_poses(source, folder, "source"), load_poses(target, folder, "target")
    result = replace_shape(signals, *poses, **options)
    notes.extend(result.warnings)
    return result.signals
