"""Built-in characters at any resolution, with joints, weights, texture coordinates and soft regions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.clips import Mesh, SkinnedMesh
from tempose.samples.animal import sculpt_animal
from tempose.samples.human import sculpt_human
from tempose.samples.remesh import Surface, remesh
from tempose.samples.sculpture import Sculpture
from tempose.samples.skin_weights import node_shares, skin_weights
from tempose.samples.uv import texture_atlas
from tempose.samples.uv_charts import chart_labels
from tempose.typing import FloatArray

FEWEST, MOST = 2_000, 1_000_000
"""Numbers of triangles that a character can be asked for."""
FINE = 8_000
"""Triangles from which on the human has separate fingers and a hollow skirt."""


@dataclass(frozen=True, eq=False)
class Character:
    """A skinned mesh and the parts of it that are soft."""

    skin: SkinnedMesh
    """Mesh in its rest pose, joints and weights."""
    regions: Mapping[str, FloatArray]
    """Name to (n,) softness, 0 where a vertex follows its joints, up to 1."""

    def __post_init__(self) -> None:
        n = len(self.skin.mesh.vertices)
        regions = {k: read_only(as_floats(v, f"regions[{k!r}]", (n,))) for k, v in self.regions.items()}
        object.__setattr__(self, "regions", MappingProxyType(regions))


def human_character(triangles: int = 20_000) -> Character:
    """Make the built-in human: 1.75 m, in a skirt, arms 45 degrees down.

    Parameters
    ----------
    triangles : int, default 20000
        Wanted number of triangles, 2000 to a million; the mesh has that many within five percent.

    Returns
    -------
    Character
        With the soft regions ``"belly"`` and ``"skirt"``. The mesh is a sphere topologically, at every
        resolution; the same number gives the same mesh.

    Raises
    ------
    ValueError
        If `triangles` is out of range.
    """
    return _character("human", triangles)


def animal_character(triangles: int = 20_000) -> Character:
    """Make the built-in animal: a pony, 1.1 m at the withers.

    Parameters
    ----------
    triangles : int, default 20000
        Wanted number of triangles, 2000 to a million; the mesh has that many within five percent.

    Returns
    -------
    Character
        With the soft region ``"belly"``. The mesh is a sphere topologically, at every resolution; the same
        number gives the same mesh.

    Raises
    ------
    ValueError
        If `triangles` is out of range.
    """
    return _character("animal", triangles)


def human(triangles: int = 20_000) -> SkinnedMesh:
    """Make the skinned mesh of the built-in human.

    Parameters
    ----------
    triangles : int, default 20000
        As for `human_character`.

    Returns
    -------
    SkinnedMesh
        Mesh with texture coordinates, joints, weights.
    """
    return human_character(triangles).skin


def animal(triangles: int = 20_000) -> SkinnedMesh:
    """Make the skinned mesh of the built-in animal.

    Parameters
    ----------
    triangles : int, default 20000
        As for `animal_character`.

    Returns
    -------
    SkinnedMesh
        Mesh with texture coordinates, joints, weights.
    """
    return animal_character(triangles).skin


CHARACTERS: Mapping[str, Callable[[int], SkinnedMesh]] = MappingProxyType({"human": human, "animal": animal})
"""The built-in characters by name."""


@lru_cache(maxsize=3)
def _sculpture(name: str, coarse: bool) -> Sculpture:
    return sculpt_human(coarse) if name == "human" else sculpt_animal()


@lru_cache(maxsize=4)
def _character(name: str, triangles: int) -> Character:
    if not FEWEST <= triangles <= MOST:
        raise ValueError(f"triangles must be {FEWEST} to {MOST}, got {triangles}")
    sculpture = _sculpture(name, triangles < FINE)
    field = sculpture.field
    V, F = sculpture.first_mesh
    detail = np.array([part.detail for part in sculpture.parts])
    longest = np.array([part.longest for part in sculpture.parts])
    V, F = remesh(Surface(field, detail, longest), V, F, triangles)
    weights = skin_weights(
        field, sculpture.nodes, sculpture.skeleton, V, sculpture.softness, sculpture.special_weights
    )
    shares = node_shares(field, V)
    labels = chart_labels(V, F, shares, sculpture.nodes, sculpture.parts, sculpture.charts)
    uv, uv_faces = texture_atlas(V, F, labels)
    mesh = Mesh(V, F, uv=uv, uv_faces=uv_faces, name=name)
    return Character(SkinnedMesh(mesh, sculpture.skeleton, weights), _regions(sculpture, V, shares))


def _regions(sculpture: Sculpture, V: FloatArray, shares: FloatArray) -> dict[str, FloatArray]:
    names = [node.name for node in sculpture.nodes]
    return {
        region: np.clip(shares[:, names.index(node)] * softness(V), 0.0, 1.0)
        for region, (node, softness) in sculpture.regions.items()
    }
