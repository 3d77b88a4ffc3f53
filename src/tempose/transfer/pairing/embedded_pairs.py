"""Pairs without a click: a human skeleton placed inside the target says which faces belong to which joint."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.embedding import Embedding, embed_dressed
from tempose.kinematics import rest_transforms
from tempose.kinematics.roles import find_roles
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.pairing.skin_pairs import pairs_from_skin

REFUSED = 1.5
"""Penalty from which a target is taken for no human: people reach 0.8, four-legged animals start at 1.6."""
HOW_TO_GO_ON = "give a pairs file (--pairs) or a target with skin weights"
_FEWEST_ROLES = 4
_SOFT = 0.08
"""Share of the trunk's length over which one of its parts passes into the next."""


def pairs_from_embedding(
    source: Skeleton, mesh: Mesh, mapping: dict[str, str] | None = None
) -> tuple[Pairs, Embedding]:
    """Mark the faces of a human-like target that has no skin weights.

    Parameters
    ----------
    source : Skeleton
        Skeleton that moves.
    mesh : Mesh
        Target in any up axis, scale and heading, in a pose with visible arms and legs.
    mapping : dict of str to str, optional
        Source joint to body role, where the names do not tell.

    Returns
    -------
    pairs : Pairs
        Of kind ``"joints"``, with joints and ends in the target's own axes.
    embedding : Embedding
        The skeleton inside the target, and how far it is to be trusted.

    Raises
    ------
    ValueError
        If the source is no human's skeleton, or the target is clearly no human; the message names the
        measure and how to go on.
    """
    known = find_roles(source, mapping)
    if len(known) < _FEWEST_ROLES:
        raise ValueError(
            f"pairs can be found only for a human's skeleton; of the source's joints ({_some(source.names)}) "
            f"{len(known)} are known as parts of a body; name them with a mapping, or {HOW_TO_GO_ON}"
        )
    skinned, embedding = embed_dressed(mesh)
    if embedding.penalty > REFUSED:
        raise ValueError(
            f"the target does not look human: a skeleton fits into it with penalty {embedding.penalty:.1f}, "
            f"into people with less than 1 ({'; '.join(embedding.reasons)}); {HOW_TO_GO_ON}"
        )
    pairs = pairs_from_skin(source, _slab_trunk(skinned), mapping)
    return replace(pairs, origin="a skeleton placed inside the target"), embedding


def _slab_trunk(skin: SkinnedMesh) -> SkinnedMesh:
    """Share the trunk out by height: to heat, pelvis and ribs are short bones between strong neighbours."""
    index = {name: j for j, name in enumerate(skin.skeleton.names)}
    places = rest_transforms(skin.skeleton)[1]
    hips, spine, chest, neck = (places[index[name]] for name in ("hips", "spine", "chest", "neck"))
    up = (neck - hips) / max(float(np.linalg.norm(neck - hips)), 1e-300)
    V, weights = skin.mesh.vertices, np.array(skin.weights)
    thighs = [index["left_thigh"], index["right_thigh"]]
    above = np.where((V - hips) @ up > 0, 1.0, 0.0)
    trunk = [index[name] for name in ("hips", "spine", "chest")]
    share = weights[:, trunk].sum(axis=1) + above * weights[:, thighs].sum(axis=1)
    weights[:, thighs] *= 1 - above[:, None]
    reach = _SOFT * float(np.linalg.norm(neck - hips))
    low = np.clip(0.5 - (V - spine) @ up / reach, 0, 1)
    high = np.clip(0.5 + (V - chest) @ up / reach, 0, 1)
    weights[:, trunk] = share[:, None] * np.column_stack([low, 1 - low - high, high])
    return replace(skin, weights=np.maximum(weights, 0.0))


def embedding_doubts(embedding: Embedding) -> tuple[str, ...]:
    """Say what is doubtful about an embedding that was used all the same.

    Parameters
    ----------
    embedding : Embedding
        From `pairs_from_embedding`.

    Returns
    -------
    tuple of str
        One warning, or none.
    """
    if not embedding.doubtful:
        return ()
    return (
        f"the skeleton placed inside the target is doubtful (penalty {embedding.penalty:.2f}, sure below 1): "
        f"{'; '.join(embedding.reasons)}; look at the result, or {HOW_TO_GO_ON}",
    )


def embedding_facts(embedding: Embedding) -> dict[str, Any]:
    """Return what a report says about an embedding.

    Parameters
    ----------
    embedding : Embedding
        From `pairs_from_embedding`.

    Returns
    -------
    dict
        ``penalty``, ``confidence``, ``doubtful``, ``reasons`` and ``up``.
    """
    return {
        "penalty": round(float(embedding.penalty), 4),
        "confidence": round(embedding.confidence, 4),
        "doubtful": embedding.doubtful,
        "reasons": list(embedding.reasons),
        "up": embedding.up,
    }


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(names[:6]) + (", ..." if len(names) > 6 else "")
