"""A parsed file with everything at rest: what all readers start from."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import Mesh, Source
from tempose.formats.conventions import FormatError
from tempose.formats.glb_bake import check_finite, morphed, transformed
from tempose.formats.glb_binding import Binding, read_bindings, rest_transform
from tempose.formats.glb_clips import Motion
from tempose.formats.glb_container import Document, load
from tempose.formats.glb_mesh import assemble
from tempose.formats.glb_nodes import Nodes, file_frame, read_nodes, world_matrices
from tempose.formats.glb_parts import Geometry, read_geometry
from tempose.formats.glb_restore import Order, read_order
from tempose.typing import FloatArray

_USUAL_HEIGHT = (0.02, 20.0)


@dataclass(frozen=True)
class Scene:
    """A file, parsed."""

    doc: Document
    """Container and JSON."""
    nodes: Nodes
    """Node tree, in metres, Y up."""
    world: list[FloatArray]
    """(1, 4, 4) world transform of each node as the file leaves it."""
    geometry: Geometry | None
    """What the scene draws; None if it was not asked for and is not there."""
    bindings: dict[int, Binding]
    """Skins that move something."""
    source: Source
    """What the file says."""


def open_scene(
    path: str | os.PathLike[str], up: str | None, unit: float | None, *, drawn: bool = True
) -> Scene:
    """Parse a file.

    Parameters
    ----------
    path : path-like
        A ``.glb`` or ``.gltf`` file.
    up : str, optional
        Up axis of the file; ``"y"`` as glTF says if not given.
    unit : float, optional
        Metres per unit; 1 as glTF says if not given.
    drawn : bool, default True
        Whether there must be a mesh.

    Returns
    -------
    Scene
        Everything at rest.

    Raises
    ------
    FormatError
        If the file is broken.
    """
    if up not in (None, "x", "y", "z"):
        raise ValueError(f"up must be 'x', 'y' or 'z', got {up!r}")
    if unit is not None and not 1e-9 <= unit <= 1e9:
        raise ValueError(f"unit must be a positive number of metres, got {unit}")
    doc = load(path)
    source = Source(str(path), doc.kind, up or "y", unit or 1.0)
    nodes = read_nodes(doc, file_frame(source.up, source.unit))
    world = world_matrices(nodes, {})
    geometry = _geometry(doc, nodes, drawn)
    bindings = {} if geometry is None else read_bindings(doc, nodes, geometry, world)
    return Scene(doc, nodes, world, geometry, bindings, source)


def _geometry(doc: Document, nodes: Nodes, drawn: bool) -> Geometry | None:
    try:
        return read_geometry(doc, nodes)
    except FormatError:
        if drawn or any(item.has("mesh") for item in nodes.items):
            raise
        return None


def rest_mesh(scene: Scene) -> tuple[Mesh, Order]:
    """Join everything the scene draws, in the bind pose.

    Parameters
    ----------
    scene : Scene
        A file with a mesh.

    Returns
    -------
    mesh : Mesh
        Metres, Y up.
    order : Order
        How its vertices stand to those of the file.
    """
    doc, geometry = scene.doc, scene.geometry
    assert geometry is not None
    order = read_order(doc, geometry)
    V = np.zeros((geometry.n, 3))
    mirrored: set[int] = set()
    for p, part in enumerate(geometry.parts):
        place = rest_transform(scene.nodes, part, scene.bindings, scene.world)
        local = morphed(doc, part, part.morph[None])
        V[part.start : part.start + len(part.base)] = transformed(place[None], local)[0]
        if np.linalg.det(place[:3, :3]) < 0:
            mirrored.add(p)
    V = V[order.first]
    check_finite(doc, V.astype(np.float32)[None])
    source = replace(scene.source, notes=scene.source.notes + geometry.notes + _size_note(V))
    return assemble(doc, scene.nodes, geometry, order, V, mirrored, source), order


def _size_note(V: FloatArray) -> tuple[str, ...]:
    tall = float(np.ptp(V, axis=0).max())
    if _USUAL_HEIGHT[0] <= tall <= _USUAL_HEIGHT[1]:
        return ()
    return (f"glTF is in metres, which makes this {tall:.3g} m across; give the unit if that is wrong.",)


def moving_source(scene: Scene, motion: Motion, *notes: str) -> Source:
    """Say what the file says, with its rate.

    Parameters
    ----------
    scene : Scene
        The file.
    motion : Motion
        The clip in it.
    *notes : str
        More notes.

    Returns
    -------
    Source
        Rate, whether it was guessed, and notes of the motion.
    """
    guessed = ("fps",) if motion.guessed else ()
    return replace(
        scene.source, fps=motion.found, guessed=guessed, notes=(*scene.source.notes, *motion.notes, *notes)
    )
