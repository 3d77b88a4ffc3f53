"""Source, target and pairs held against each other before anything is worked out."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics.roles import find_roles
from tempose.transfer.from_mesh import prepare_mesh
from tempose.transfer.from_skeleton import Prepared, prepare_skeleton
from tempose.transfer.lead import LEAD
from tempose.transfer.pairs import Pairs
from tempose.transfer.references import Singular
from tempose.transfer.skin_pairs import pairs_from_skin
from tempose.transfer.upright import stand_up, turned_pairs
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Matched:
    """A target and pairs that fit it and the source."""

    mesh: Mesh
    """The target, standing upright."""
    pairs: Pairs
    """Checked against the source and `mesh`."""
    listed: Pairs
    """The same pairs for the target as it was given, to be saved."""
    warnings: tuple[str, ...] = ()
    """What is doubtful."""
    facts: dict[str, Any] = field(default_factory=dict[str, Any])
    """What the report shall say about how the pairs were found."""


@dataclass(frozen=True)
class Found:
    """Pairs, and how far they are to be trusted."""

    pairs: Pairs
    """In the axes of the target as it was given."""
    warnings: tuple[str, ...] = ()
    """What is doubtful."""
    facts: dict[str, Any] = field(default_factory=dict[str, Any])
    """``embedding``: penalty, confidence and reasons, where a skeleton was placed inside the target."""


def find_pairs(
    source: Skeleton,
    target: Mesh | SkinnedMesh,
    mapping: dict[str, str] | None = None,
    embed: bool = False,
) -> Found:
    """Find which faces of a target belong to which joint, without a click.

    Parameters
    ----------
    source : Skeleton
        Skeleton that moves.
    target : Mesh or SkinnedMesh
        What shall move: with skin weights anything that shares joints with the source, without them a
        human-like body in any axes, scale and heading.
    mapping : dict of str to str, optional
        Source joint to body role, where the names do not tell.
    embed : bool, default False
        Whether skin weights are left alone and a skeleton is placed inside the target.

    Returns
    -------
    Found
        Pairs of kind ``"joints"``, warnings and measures.

    Raises
    ------
    ValueError
        If no joints correspond, the source is no human's skeleton, or the target is clearly no human; the
        message names the measure and how to go on.
    """
    if isinstance(target, SkinnedMesh) and not embed:
        return Found(pairs_from_skin(source, target, mapping))
    from tempose.transfer.embedded_pairs import embedding_doubts, embedding_facts, pairs_from_embedding

    mesh = target.mesh if isinstance(target, SkinnedMesh) else target
    pairs, embedding = pairs_from_embedding(source, mesh, mapping)
    return Found(pairs, embedding_doubts(embedding), {"embedding": embedding_facts(embedding)})


def match(
    source: SkeletonClip | MeshClip,
    target: Mesh | SkinnedMesh,
    pairs: Pairs | None = None,
    mapping: dict[str, str] | None = None,
    embed: bool = False,
) -> Matched:
    """Check what was given and find the pairs if none were.

    Parameters
    ----------
    source : SkeletonClip or MeshClip
        The motion.
    target : Mesh or SkinnedMesh
        What shall move.
    pairs : Pairs, optional
        Correspondences; from the target's skin weights if not given, else from a skeleton placed inside it.
    mapping : dict of str to str, optional
        Source joint to body role.
    embed : bool, default False
        Whether skin weights are left alone.

    Returns
    -------
    Matched
        Target and pairs.

    Raises
    ------
    ValueError
        If the source is empty, the target is no body, or the pairs do not fit; the message says which.
    """
    mesh = target.mesh if isinstance(target, SkinnedMesh) else target
    _check_bodies(source, mesh)
    if isinstance(source, MeshClip):
        pairs = _mesh_pairs(source, mesh, pairs)
        return Matched(mesh, pairs, pairs)
    found = Found(pairs) if pairs is not None else find_pairs(source.skeleton, target, mapping, embed)
    pairs = found.pairs
    if pairs.kind != "joints":
        raise ValueError(f"pairs of kind {pairs.kind!r} need a mesh clip as source, got a skeleton")
    pairs.check(0, len(mesh.faces), source.skeleton.names)
    roles = {source.skeleton.names[j]: role for role, j in find_roles(source.skeleton, mapping).items()}
    standing = stand_up(mesh, pairs, roles)
    notes = [*found.warnings, standing.note, _foot_note(set(roles.values()))]
    kept = tuple(note for note in notes if note)
    return Matched(standing.mesh, turned_pairs(pairs, standing.turn), pairs, kept, found.facts)


def _foot_note(roles: set[str]) -> str:
    ankles = {"left_shin", "right_shin"} <= roles and not {"left_foot", "right_foot"} & roles
    said = "the source's skeleton has no feet: its ankles are held instead, and the target's do not bend"
    return said if ankles else ""


def _check_bodies(source: SkeletonClip | MeshClip, mesh: Mesh) -> None:
    if source.n_frames == 0:
        raise ValueError("source must have at least one frame, got none")
    if len(mesh.faces) < 2:
        raise ValueError(f"target must be a surface of at least 2 triangles, got {len(mesh.faces)}")
    if np.linalg.matrix_rank(mesh.vertices - mesh.vertices.mean(axis=0), tol=1e-6 * mesh.diagonal) < 3:
        raise ValueError("target must have volume, got a mesh whose vertices lie in one plane")


def _mesh_pairs(source: MeshClip, mesh: Mesh, pairs: Pairs | None) -> Pairs:
    if pairs is None:
        raise ValueError("a mesh that moves another needs pairs of faces or vertices; give a pairs file")
    if pairs.kind == "joints":
        raise ValueError("pairs of kind 'joints' need a skeleton as source, got a mesh clip")
    sizes = (len(source.faces), len(mesh.faces))
    if pairs.kind == "vertices":
        sizes = (source.vertices.shape[1], len(mesh.vertices))
    pairs.check(*sizes)
    return pairs


def prepare(
    source: SkeletonClip | MeshClip,
    mesh: Mesh,
    pairs: Pairs,
    *,
    mapping: dict[str, str] | None = None,
    rest: SkeletonClip | Mesh | None = None,
    rest_frame: int | None = None,
    volume: float = 0.0,
    twist: bool = True,
    lead: float = LEAD,
    singular: Singular = "reference",
) -> Prepared:
    """Do everything that comes before the frames, for either kind of source.

    Parameters
    ----------
    source : SkeletonClip or MeshClip
        The motion.
    mesh : Mesh
        Target at rest.
    pairs : Pairs
        Checked.
    mapping : dict of str to str, optional
        Source joint to body role.
    rest : SkeletonClip or Mesh, optional
        Where the source's reference pose stands, if not in the source.
    rest_frame : int, optional
        Frame of the reference pose, in `rest` or else in the source.
    volume : float, default 0
        See `MotionTransfer`.
    twist : bool, default True
        See `prepare_skeleton`; means nothing to a mesh source, nor do the next two.
    lead : float, default 0.6
        See `prepare_skeleton`.
    singular : {"reference", "path", "none"}, default "reference"
        See `prepare_skeleton`.

    Returns
    -------
    Prepared
        Solver, rotations and paths.

    Raises
    ------
    ValueError
        If the reference pose is not of the source's kind, or has no such frame.
    """
    if isinstance(source, SkeletonClip):
        if isinstance(rest, Mesh):
            raise ValueError("source_rest must be a motion clip of the same skeleton, got a mesh")
        return prepare_skeleton(
            source,
            mesh,
            pairs,
            mapping=mapping,
            rest_clip=rest,
            rest_frame=rest_frame,
            volume=volume,
            twist=twist,
            lead=lead,
            singular=singular,
        )
    if isinstance(rest, SkeletonClip):
        raise ValueError("source_rest must be a mesh like the source, got a skeleton clip")
    return prepare_mesh(source, mesh, pairs, rest=_mesh_rest(source, rest, rest_frame), volume=volume)


def _mesh_rest(source: MeshClip, rest: Mesh | None, frame: int | None) -> FloatArray | None:
    if rest is not None:
        n = source.vertices.shape[1]
        if len(rest.vertices) != n:
            raise ValueError(
                f"source_rest must have the {n} vertices of the source, got {len(rest.vertices)}"
            )
        return rest.vertices
    if frame is None:
        return None
    if not 0 <= frame < source.n_frames:
        raise ValueError(f"source_rest must be a frame from 0 to {source.n_frames - 1}, got {frame}")
    return np.asarray(source.vertices[frame], dtype=np.float64)
