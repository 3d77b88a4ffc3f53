"""The human skeleton of 18 joints inside a mesh."""

from __future__ import annotations

from typing import Any

from tempose.clips import Mesh
from tempose.embedding import Embedding, embed_whole_or_piece
from tempose.embedding.cells import Cells
from tempose.rigging.skeletons.bind import bind
from tempose.rigging.skeletons.bound import Bound
from tempose.rigging.skeletons.inside import joints_outside, mesh_cells, share_inside
from tempose.rigging.skeletons.surface import surface_warnings
from tempose.typing import Progress, silent

REFUSED = 1.5
"""Penalty from which a mesh is taken for no human: people reach 0.8, four-legged animals start at 1.54."""
_MOVING = "--skeleton auto, which finds bones from the motion itself, or --skeleton FILE"
_STILL = "--skeleton FILE with a skeleton of its own (auto needs a clip that moves)"


def human_skin(mesh: Mesh, *, moving: bool = False, progress: Progress = silent) -> Bound:
    """Put a human skeleton of 18 joints inside a mesh and bind the mesh to it.

    Parameters
    ----------
    mesh : Mesh
        A person in any pose in which hands and feet stick out, dressed or not.
    moving : bool, default False
        Whether the mesh is a frame of a clip: decides what the error advises.
    progress : Progress
        Told about every stage.

    Returns
    -------
    Bound
        Skin, measures of the embedding, doubts.

    Raises
    ------
    ValueError
        If the mesh encloses nothing, or is clearly no human; the message names the measure.
    """
    embedding, cells = embed_whole_or_piece(mesh, progress)
    check_human(embedding, moving=moving)
    return human_bound(mesh, embedding, cells, moving=moving)


def human_bound(mesh: Mesh, embedding: Embedding, cells: Cells | None, *, moving: bool) -> Bound:
    """Bind a mesh to the skeleton that was embedded in it.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    embedding : Embedding
        Skeleton inside it.
    cells : Cells or None
        The inside as it was read; None finds it.
    moving : bool
        Whether the mesh is a frame of a clip.

    Returns
    -------
    Bound
        Skin, measures, doubts.
    """
    cells = cells or mesh_cells(mesh)
    skin = bind(mesh, embedding.joint_skeleton, cells=cells, by_role=True)
    warnings = list(surface_warnings(mesh))
    if embedding.doubtful:
        warnings.insert(0, _doubt(embedding, moving))
    if embedding.report.get("skirt"):
        warnings.append(
            "the legs part low, as under a skirt or a long coat: hips and knees were placed by the stature"
        )
    outside = joints_outside(skin.skeleton, cells.solid)
    if outside:
        warnings.append(f"{len(outside)} of 18 joints lie outside the mesh: {', '.join(outside)}")
    facts = embedding_facts(embedding) | {
        "inside_percent": 100 * share_inside(skin.skeleton, cells.solid),
        "joints_outside": outside,
    }
    return Bound(skin, {"embedding": facts}, tuple(warnings), cells)


def check_human(embedding: Embedding, *, moving: bool) -> None:
    """Refuse a mesh that is clearly no human.

    Parameters
    ----------
    embedding : Embedding
        Skeleton inside it.
    moving : bool
        Whether the mesh is a frame of a clip.

    Raises
    ------
    ValueError
        If the penalty is above `REFUSED`.
    """
    if embedding.penalty > REFUSED:
        raise ValueError(
            f"the mesh does not look human: the embedded skeleton is doubtful, with penalty "
            f"{embedding.penalty:.2f} where people have less than 1 ({'; '.join(embedding.reasons)}); "
            f"use {_MOVING if moving else _STILL}"
        )


def embedding_facts(embedding: Embedding) -> dict[str, Any]:
    """Return what a report says about an embedding.

    Parameters
    ----------
    embedding : Embedding
        Skeleton inside a mesh.

    Returns
    -------
    dict
        ``penalty``, ``confidence``, ``doubtful``, ``reasons``, ``up`` and ``reading``.
    """
    return {
        "penalty": round(float(embedding.penalty), 4),
        "confidence": round(embedding.confidence, 4),
        "doubtful": embedding.doubtful,
        "reasons": list(embedding.reasons),
        "up": embedding.up,
        "reading": embedding.report.get("reading", ""),
    }


def _doubt(embedding: Embedding, moving: bool) -> str:
    return (
        f"the embedded skeleton is doubtful (penalty {embedding.penalty:.2f}, sure below 1): "
        f"{'; '.join(embedding.reasons)}; look at the result, or use {_MOVING if moving else _STILL}"
    )
