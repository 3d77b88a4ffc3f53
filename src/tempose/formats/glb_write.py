"""Write a GLB: a still mesh, or a clip as morph targets that play in any viewer.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.6, 3.7 and 3.11.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose._version import __version__
from tempose.clips import Mesh, MeshClip
from tempose.formats.glb_buffer import INDEX_DATA, VERTEX_DATA, AnyArray, Buffer
from tempose.formats.glb_container import write_container
from tempose.formats.glb_layout import Layout, lay_out, mesh_extras
from tempose.formats.glb_normals import UnitNormals
from tempose.formats.glb_targets import Targets, basis_targets, frame_targets
from tempose.typing import Progress, silent

_MOST_EXACT = 2**24


@dataclass(frozen=True)
class Written:
    """What went into a file."""

    frames: int
    """Frames; 0 for a still mesh."""
    targets: int
    """Morph targets."""
    bytes: int
    """Size of the file."""
    largest_percent: float
    """Largest distance of a vertex from where it was, percent of the diagonal of the rest pose."""
    rms_percent: float
    """Root of the mean squared distance, percent of the same."""


def write(
    path: str | os.PathLike[str],
    thing: Mesh | MeshClip,
    *,
    up: str | None = None,
    unit: float | None = None,
    tolerance: float | None = None,
    normals: bool = True,
    progress: Progress = silent,
) -> Written:
    """Write a GLB file.

    Parameters
    ----------
    path : path-like
        Final name, ending in ``.glb``.
    thing : Mesh or MeshClip
        A still mesh, or a clip: one morph target for every new frame and a key per frame, weights linear
        between.
    up : str, optional
        Only ``"y"``: glTF has no other.
    unit : float, optional
        Only 1: glTF is in metres.
    tolerance : float, optional
        Percent of the diagonal of the rest pose by which a vertex may be off; allows a compact basis of
        principal components in place of one target a frame.
    normals : bool, default True
        Whether the targets move the normals too. Without them files are half as big and shading goes wrong
        where a part turns.
    progress : Progress, optional
        Called while writing; raising from it leaves no file.

    Returns
    -------
    Written
        Targets, size and error of what was written, as a reader will see it.

    Raises
    ------
    ValueError
        If glTF cannot hold it: no faces, no frames, other axes or units, more than 4 GB.
    OSError
        If the place cannot be written.

    Notes
    -----
    Vertices are split where texture coordinates are; the attributes ``_VERTEX`` and ``_UV`` and the extras
    of the mesh keep vertex order, polygons and groups, which `tempose.formats.glb.read_mesh` restores.
    """
    _check(path, thing, up, unit, tolerance)
    mesh = thing.mesh if isinstance(thing, MeshClip) else thing
    diagonal = mesh.diagonal or 1.0
    layout = lay_out(mesh)
    buffer = Buffer()
    head = mesh_head(mesh, layout, buffer)
    off = np.linalg.norm(mesh.vertices.astype(np.float32) - mesh.vertices, axis=1)
    frames, K, largest, rms = 0, 0, float(off.max()), float(np.sqrt((off**2).mean()))
    if isinstance(thing, MeshClip):
        targets = _targets(thing, None if tolerance is None else tolerance / 100 * diagonal, progress)
        frames, K = targets.weights.shape
        largest, rms = targets.largest, targets.rms
        _add_animation(head, thing, targets, layout, buffer, normals, diagonal)
    head["accessors"], head["bufferViews"] = buffer.accessors, buffer.views
    head["buffers"] = [{"byteLength": buffer.size}]
    with atomic_path(path) as part, part.open("wb") as file:
        size = write_container(file, head, buffer.size, buffer.pieces(progress))
    return Written(frames, K, size, 100 * largest / diagonal, 100 * rms / diagonal)


def _check(path: Any, thing: Any, up: str | None, unit: float | None, tolerance: float | None) -> None:
    if not isinstance(thing, Mesh | MeshClip):
        raise ValueError(f"thing must be a Mesh or a MeshClip to go into a GLB, got {type(thing).__name__}")
    if up not in (None, "y") or unit not in (None, 1.0):
        raise ValueError(f"a GLB is always Y up and in metres, got up {up!r} and unit {unit}; leave them out")
    if tolerance is not None and not 0 < tolerance < float("inf"):
        raise ValueError(f"tolerance must be a positive percentage, got {tolerance}")
    check_mesh(path, thing.mesh if isinstance(thing, MeshClip) else thing)
    if isinstance(thing, MeshClip) and not thing.n_frames:
        raise ValueError("a GLB clip needs at least one frame, got none")


def check_mesh(path: str | os.PathLike[str], mesh: Mesh) -> None:
    """Refuse what no GLB file can hold.

    Parameters
    ----------
    path : path-like
        Final name.
    mesh : Mesh
        What is to be written.

    Raises
    ------
    ValueError
        If the name does not end in ``.glb``, there is no face, or there are too many or too large numbers.
    """
    if not str(path).lower().endswith(".glb"):
        raise ValueError(f"path must end in .glb, got {os.fspath(path)!r}")
    if not len(mesh.faces):
        raise ValueError("a GLB needs at least one face, got none")
    if np.abs(mesh.vertices).max() > np.finfo(np.float32).max:
        raise ValueError("vertices must fit into float32 to go into a GLB")
    if len(mesh.vertices) > _MOST_EXACT:
        raise ValueError(f"a GLB from here holds at most {_MOST_EXACT} vertices, got {len(mesh.vertices)}")


def _targets(clip: MeshClip, tolerance: float | None, progress: Progress) -> Targets:
    if tolerance is not None:
        compact = basis_targets(clip, tolerance, progress)
        if compact.largest <= tolerance and compact.weights.shape[1] < clip.n_frames:
            return compact
    return frame_targets(clip, progress)


def mesh_head(mesh: Mesh, layout: Layout, buffer: Buffer) -> dict[str, Any]:
    """Describe the still mesh in JSON, its arrays queued in `buffer`.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    layout : Layout
        How its vertices are split.
    buffer : Buffer
        Takes its arrays.

    Returns
    -------
    dict
        One scene of one node, whose mesh has one primitive; accessors and buffers are still to be added.
    """
    k = len(layout.vertex_of)
    V = mesh.vertices.astype(np.float32)[layout.vertex_of]
    N = UnitNormals(mesh.faces, len(mesh.vertices))(mesh.vertices)[layout.vertex_of]
    attributes = {
        "POSITION": buffer.add(lambda: V, (k, 3), VERTEX_DATA, bounds=True),
        "NORMAL": buffer.add(lambda: N, (k, 3), VERTEX_DATA),
    }
    scalars = {"_VERTEX": layout.vertex_of if layout.split else None, "_UV": layout.uv_of}
    columns = {
        "TEXCOORD_0": layout.uv,
        "COLOR_0": None if mesh.colors is None else mesh.colors[layout.vertex_of],
        **{name: None if values is None else values[:, None] for name, values in scalars.items()},
    }
    for name, values in columns.items():
        if values is not None:
            attributes[name] = buffer.add(lambda v=values: v, (k, values.shape[1]), VERTEX_DATA)
    corners = layout.faces.reshape(-1, 1)
    indices = buffer.add(lambda: corners, (len(corners), 1), INDEX_DATA)
    primitive = {"attributes": attributes, "indices": indices, "mode": 4, "material": 0}
    name = mesh.name or "mesh"
    shading = {"metallicFactor": 0.0, "roughnessFactor": 0.8}
    return {
        "asset": {"version": "2.0", "generator": f"Tempose {__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": name}],
        "meshes": [{"name": name, "primitives": [primitive], "extras": {"tempose": mesh_extras(mesh)}}],
        "materials": [{"name": "surface", "pbrMetallicRoughness": shading, "doubleSided": True}],
    }


def _add_animation(
    head: dict[str, Any],
    clip: MeshClip,
    targets: Targets,
    layout: Layout,
    buffer: Buffer,
    normals: bool,
    diagonal: float,
) -> None:
    k, (T, K) = len(layout.vertex_of), targets.weights.shape
    mesh = head["meshes"][0]
    described: list[dict[str, int]] = []
    for i in range(K):
        move: Callable[[], AnyArray] = lambda i=i: targets.offsets(i)[layout.vertex_of]  # noqa: E731
        described.append({"POSITION": buffer.add(move, (k, 3), VERTEX_DATA, bounds=True)})
        if normals:
            turn: Callable[[], AnyArray] = lambda i=i: targets.normals(i)[layout.vertex_of]  # noqa: E731
            described[i]["NORMAL"] = buffer.add(turn, (k, 3), VERTEX_DATA)
    mesh["primitives"][0]["targets"] = described
    mesh["weights"] = [0.0] * K
    mesh["extras"]["targetNames"] = list(targets.names)
    times = clip.times.astype(np.float32)[:, None]
    weights = targets.weights.reshape(-1, 1)
    sampler = {
        "input": buffer.add(lambda: times, (T, 1), None, bounds=True),
        "interpolation": "LINEAR",
        "output": buffer.add(lambda: weights, (T * K, 1), None),
    }
    error = {"largest_percent": 100 * targets.largest / diagonal, "rms_percent": 100 * targets.rms / diagonal}
    head["animations"] = [
        {
            "name": clip.name or "clip",
            "samplers": [sampler],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
            "extras": {"tempose": {"fps": clip.fps, **error}},
        }
    ]
