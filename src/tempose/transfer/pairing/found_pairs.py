"""Pairs that nobody picked: from skin weights, or from a skeleton placed inside the target."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.kinematics.roles import find_roles
from tempose.transfer.pairing.embedded_pairs import embedding_doubts, embedding_facts, pairs_from_embedding
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.pairing.skin_pairs import pairs_from_skin


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
        What shall move: with skin weights anything that shares joints with the source; without them, or
        where their joints have names that say nothing, a human-like body in any axes, scale and heading.
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
    if isinstance(target, SkinnedMesh) and not embed and not _meaningless(source, target.skeleton):
        return Found(pairs_from_skin(source, target, mapping))
    mesh = target.mesh if isinstance(target, SkinnedMesh) else target
    pairs, embedding = pairs_from_embedding(source, mesh, mapping)
    doubts = embedding_doubts(embedding)
    if isinstance(target, SkinnedMesh) and not embed:
        doubts = (f"the joints of the target's skin ({', '.join(target.skeleton.names[:3])}, ...) are not "
                  "known by their names: a skeleton was placed inside it instead", *doubts)  # fmt: skip
    return Found(pairs, doubts, {"embedding": embedding_facts(embedding)})


def _meaningless(source: Skeleton, skin: Skeleton) -> bool:
    return not find_roles(skin) and not set(source.names) & set(skin.names) and len(find_roles(source)) > 0
