"""A rig as named arrays and a header, and as one ``.tempose`` file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose._validate import as_floats, as_indices
from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.models import load_model, save_model
from tempose.rigging.motion_arrays import motion_from_arrays, motion_to_arrays, source_from
from tempose.rigging.rig import Rig
from tempose.typing import FloatArray

KIND = "rig"
"""As in the header of the file."""
_OPTIONAL = ("uv", "uv_faces", "colors", "polygons")


def save_rig(rig: Rig, path: str | os.PathLike[str]) -> Path:
    """Write a rig.

    Parameters
    ----------
    rig : Rig
        Skin, motion, report.
    path : path-like
        Where to; by custom it ends in ``.tempose``.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    OSError
        If the place cannot be written.
    """
    arrays, header = rig_to_arrays(rig)
    return save_model(path, KIND, arrays, header)


def load_rig(path: str | os.PathLike[str]) -> Rig:
    """Read a rig.

    Parameters
    ----------
    path : path-like
        A file that `save_rig` wrote.

    Returns
    -------
    Rig
        Equal to what was saved, to the last bit.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is no rig, cut short, or of a newer version; the message names it.
    """
    arrays, header = load_model(path, KIND)
    try:
        return rig_from_arrays(arrays, header)
    except (AttributeError, LookupError, OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: a rig whose parts do not fit together: {error}") from None


def rig_to_arrays(rig: Rig) -> tuple[dict[str, FloatArray], dict[str, Any]]:
    """Take a rig apart into what a model file holds.

    Parameters
    ----------
    rig : Rig
        Skin, motion, report.

    Returns
    -------
    arrays : dict of str to ndarray
        Weights without their zeros, mesh, skeleton, motion.
    header : dict
        The rest, as JSON can hold it.
    """
    mesh, skeleton, motion = rig.skin.mesh, rig.skin.skeleton, rig.motion
    weights = sp.csr_array(rig.skin.weights)
    assert skeleton.rest_rotations is not None and skeleton.tips is not None
    arrays: dict[str, Any] = {
        "mesh/vertices": mesh.vertices,
        "mesh/faces": mesh.faces,
        "skeleton/parents": skeleton.parents,
        "skeleton/offsets": skeleton.offsets,
        "skeleton/rest_rotations": skeleton.rest_rotations,
        "skeleton/tips": skeleton.tips,
        "weights/values": weights.data,
        "weights/joints": weights.indices.astype(np.uint16),
        "weights/counts": np.diff(weights.indptr).astype(np.uint16),
        **motion_to_arrays(motion, skeleton, "motion"),
    }
    arrays |= {f"mesh/{name}": v for name in _OPTIONAL if (v := getattr(mesh, name)) is not None}
    arrays |= {f"group/{k}": faces for k, faces in enumerate(mesh.groups.values())}
    header = {
        "joints": list(skeleton.names),
        "groups": list(mesh.groups),
        "mesh_name": mesh.name,
        "mesh_source": asdict(mesh.source),
        "fps": motion.fps,
        "motion_name": motion.name,
        "motion_source": asdict(motion.source),
        "blending": rig.blending,
        "report": dict(rig.report),
    }
    return arrays, header


def rig_from_arrays(arrays: Mapping[str, Any], header: Mapping[str, Any]) -> Rig:
    """Put a rig together again.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        From `rig_to_arrays`.
    header : mapping
        From there as well.

    Returns
    -------
    Rig
        The same rig.

    Raises
    ------
    ValueError
        If parts do not fit together.
    LookupError
        If a part is missing.
    """
    groups = {name: arrays[f"group/{k}"] for k, name in enumerate(header["groups"])}
    mesh = Mesh(
        arrays["mesh/vertices"],
        arrays["mesh/faces"],
        groups=groups,
        name=header["mesh_name"],
        source=source_from(header["mesh_source"]),
        **{name: arrays[f"mesh/{name}"] for name in _OPTIONAL if f"mesh/{name}" in arrays},
    )
    skeleton = Skeleton(
        tuple(header["joints"]),
        arrays["skeleton/parents"],
        arrays["skeleton/offsets"],
        arrays["skeleton/rest_rotations"],
        arrays["skeleton/tips"],
    )
    facts = {"fps": header["fps"], "name": header["motion_name"], "source": header["motion_source"]}
    motion = motion_from_arrays(arrays, facts, skeleton, "motion")
    if header["blending"] not in ("linear", "dual-quaternion"):
        raise ValueError(f"blending must be 'linear' or 'dual-quaternion', got {header['blending']!r}")
    weights = _dense(arrays, len(mesh.vertices), skeleton.n_joints)
    return Rig(SkinnedMesh(mesh, skeleton, weights), motion, header["blending"], header["report"])


def _dense(arrays: Mapping[str, Any], n: int, J: int) -> FloatArray:
    values = as_floats(arrays["weights/values"], "weights/values", ("k",))
    joints = as_indices(arrays["weights/joints"], "weights/joints", (len(values),), limit=J)
    counts = as_indices(arrays["weights/counts"], "weights/counts", (n,), limit=J + 1)
    if int(counts.sum()) != len(values):
        raise ValueError(f"weights/counts must sum to {len(values)}, got {int(counts.sum())}")
    weights = np.zeros((n, J))
    weights[np.repeat(np.arange(n), counts), joints] = values
    return weights
