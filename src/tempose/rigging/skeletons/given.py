"""A mesh or clip on a skeleton that is given, with weights or without."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.rigging.skeletons.bind import bind
from tempose.rigging.skeletons.bound import Bound
from tempose.rigging.skeletons.place import place_skeleton
from tempose.rigging.skeletons.surface import surface_warnings


def given_skin(mesh: Mesh, skeleton: Skeleton | SkinnedMesh) -> Bound:
    """Bind a mesh to a given skeleton.

    Parameters
    ----------
    mesh : Mesh
        n vertices.
    skeleton : Skeleton or SkinnedMesh
        A skin of the same n vertices is taken as it is, with its own bind pose. Of a skin of another mesh
        only the skeleton is used. A skeleton is brought inside the mesh, which gets heat weights.

    Returns
    -------
    Bound
        Skin, how the skeleton was placed, warnings.

    Raises
    ------
    ValueError
        If the skeleton lies outside the mesh.
    """
    if isinstance(skeleton, Skeleton):
        return _heated(mesh, skeleton, ())
    theirs = skeleton.mesh
    if len(theirs.vertices) == len(mesh.vertices):
        return _as_it_is(mesh, skeleton)
    return _heated(
        mesh,
        skeleton.skeleton,
        (
            f"the skin is of another mesh ({len(theirs.vertices)} vertices, not {len(mesh.vertices)}): "
            "only its skeleton is used, with new weights",
        ),
    )


def _heated(mesh: Mesh, skeleton: Skeleton, warnings: tuple[str, ...]) -> Bound:
    placed = place_skeleton(skeleton, mesh)
    skin = bind(mesh, placed.skeleton, cells=placed.cells)
    facts = {"placed": placed.how, "inside_percent": 100 * placed.inside}
    return Bound(skin, facts, (*warnings, *placed.warnings, *surface_warnings(mesh)), placed.cells)


def _as_it_is(mesh: Mesh, skin: SkinnedMesh) -> Bound:
    warnings = [note for note in skin.mesh.source.notes if "weight" in note]
    if not np.array_equal(skin.mesh.faces, mesh.faces):
        warnings.append(
            "the skin has the same number of vertices as the clip but other faces: its vertices are taken to "
            "come in the same order"
        )
    unbound = int((skin.weights.sum(axis=1) == 0).sum())
    if unbound:
        warnings.append(
            f"{unbound} of {len(mesh.vertices)} vertices are bound to no joint and stay where they are"
        )
    return Bound(skin, {"placed": "as it is"}, tuple(warnings))
