"""Source, target and pairs held against each other before anything is worked out."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.kinematics.roles import find_roles
from tempose.transfer.pairing.found_pairs import Found, find_pairs
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.pairing.upright import stand_up, turned_pairs


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
    if embed and pairs is not None:
        raise ValueError(
            "embed places a skeleton to find pairs by, and pairs are given; leave one of them out"
        )
    if embed and isinstance(source, MeshClip):
        raise ValueError("embed needs a skeleton as source, got a mesh clip; give pairs of faces or vertices")
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
