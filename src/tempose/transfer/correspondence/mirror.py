"""The pairs of one side, for the other side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from tempose._validate import as_indices
from tempose.clips import Mesh, Skeleton
from tempose.kinematics.roles import find_roles
from tempose.transfer.correspondence.side_names import swap_side
from tempose.transfer.correspondence.suggest import pair_points
from tempose.transfer.correspondence.symmetry import Symmetry, find_symmetry
from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray, IntArray

_TOO_FAR = 0.03
_TAKEN = 0.004
_ROUGH = 0.01


@dataclass(frozen=True)
class Mirrored:
    """Pairs of both sides."""

    pairs: Pairs
    """The given pairs, then the new ones, whose `how` is ``"mirror"``."""
    added: int
    """How many are new."""
    warnings: tuple[str, ...] = ()
    """What could not be mirrored or is doubtful."""


def mirror_pairs(
    pairs: Pairs,
    target: Mesh,
    source: Mesh | Skeleton | None = None,
    *,
    target_symmetry: Symmetry | None = None,
    source_symmetry: Symmetry | None = None,
) -> Mirrored:
    """Add the symmetric counterpart of every pair.

    Parameters
    ----------
    pairs : Pairs
        Pairs of one side, or of both; what is there stays.
    target : Mesh
        Target at rest.
    source : Mesh or Skeleton, optional
        Source at rest; needed for pairs of faces or vertices, while joints are also exchanged by their
        names alone.
    target_symmetry, source_symmetry : Symmetry, optional
        Known from an earlier call.

    Returns
    -------
    Mirrored
        Applied to its own result it adds nothing.

    Raises
    ------
    ValueError
        If a source mesh is needed and none is given, or a pair names what does not exist.

    Notes
    -----
    Marks on the plane of symmetry and marks whose other side is marked already get no counterpart.
    """
    faces = pairs.kind != "vertices"
    limit = len(target.faces) if faces else len(target.vertices)
    as_indices(pairs.target, "target of pairs", ("k",), limit=limit)
    there = target_symmetry or find_symmetry(target)
    other, error = _opposites(target, pairs.target, pairs.kind, there)
    names, source_error, sure = _other_sources(pairs, source, source_symmetry)
    warnings = _pose_warnings((("target", there),) if sure is None else (("target", there), ("source", sure)))
    error = np.maximum(error, source_error)
    kept = [i for i in _free_sides(pairs, target, other) if error[i] <= _TOO_FAR]
    lost = int((error > _TOO_FAR).sum())
    if lost:
        warnings += (
            f"{lost} marks have no counterpart within {100 * _TOO_FAR:.0f} % of the diagonal: pick them",
        )
    joints, ends = (_mirrored_places(places, there) for places in (pairs.joints, pairs.ends))
    made = replace(
        pairs,
        source=_append(pairs.source, names, kept),
        target=np.concatenate([pairs.target, other[kept]]),
        parts=(*pairs.parts, *(swap_side(pairs.parts[i]) for i in kept)) if pairs.parts else (),
        how=(*(pairs.how or ("picked",) * len(pairs)), *("mirror",) * len(kept)),
        joints=joints,
        ends=ends,
    )
    return Mirrored(made, len(kept), warnings)


def _append(
    source: tuple[str, ...] | IntArray, names: list[str] | IntArray, kept: list[int]
) -> tuple[str, ...] | IntArray:
    if isinstance(source, tuple):
        return (*source, *(str(names[i]) for i in kept))
    return np.concatenate([source, np.asarray(names)[kept].astype(np.int64)])


def _opposites(mesh: Mesh, marks: IntArray, kind: str, symmetry: Symmetry) -> tuple[IntArray, FloatArray]:
    """Opposite marks and how badly they fit; what connectivity tells fits in any pose."""
    if kind != "vertices":
        error = np.where(symmetry.sure[marks], 0.0, symmetry.errors[marks])
        return symmetry.faces[marks], error
    # the corner of the opposite face that fits best among the faces round a vertex
    first = np.zeros(len(mesh.vertices), dtype=np.int64)
    first[mesh.faces.ravel()] = np.repeat(np.arange(len(mesh.faces)), 3)
    corners = mesh.faces[symmetry.faces[first[marks]]]
    wanted = symmetry.reflect(mesh.vertices[marks])
    gap = np.linalg.norm(mesh.vertices[corners] - wanted[:, None], axis=2)
    best = gap.argmin(axis=1)
    rows = np.arange(len(marks))
    return corners[rows, best], gap[rows, best] / mesh.diagonal


def _other_sources(
    pairs: Pairs, source: Mesh | Skeleton | None, symmetry: Symmetry | None
) -> tuple[list[str] | IntArray, FloatArray, Symmetry | None]:
    fine = np.zeros(len(pairs))
    if isinstance(pairs.source, tuple):
        known = source.names if isinstance(source, Skeleton) else ()
        swap = _joint_swap(source) if isinstance(source, Skeleton) else {}
        names = [swap.get(name, swap_side(name)) for name in pairs.source]
        names = [b if not known or b in known else a for a, b in zip(pairs.source, names)]
        return names, fine, None
    if not isinstance(source, Mesh):
        raise ValueError(f"pairs of kind {pairs.kind!r} need the source mesh to be mirrored, got {source}")
    symmetry = symmetry or find_symmetry(source)
    other, error = _opposites(source, pairs.source, pairs.kind, symmetry)
    return other, error, symmetry


def _joint_swap(skeleton: Skeleton) -> dict[str, str]:
    """Joint of the other side by role, where names do not tell."""
    roles = find_roles(skeleton)
    return {
        skeleton.names[j]: skeleton.names[roles[swap_side(role)]]
        for role, j in roles.items()
        if swap_side(role) in roles
    }


def _free_sides(pairs: Pairs, target: Mesh, other: IntArray) -> list[int]:
    """Pairs whose other side bears no mark yet, each new mark once."""
    P = pair_points(target, pairs.target, pairs.kind)
    Q = pair_points(target, other, pairs.kind)
    gap = KDTree(P).query(Q)[0]
    kept: list[int] = []
    taken = set(int(i) for i in pairs.target)
    for i in range(len(pairs)):
        mirrored = bool(pairs.how) and pairs.how[i] == "mirror"
        near = gap[i] < _TAKEN * target.diagonal
        if not mirrored and not near and int(other[i]) not in taken:
            kept.append(i)
            taken.add(int(other[i]))
    return kept


def _mirrored_places(places: Mapping[str, FloatArray], symmetry: Symmetry) -> dict[str, FloatArray]:
    out = dict(places)
    for name, place in places.items():
        other = swap_side(name)
        if other not in out:
            out[other] = symmetry.reflect(place)
    return out


def _pose_warnings(found: tuple[tuple[str, Symmetry], ...]) -> tuple[str, ...]:
    return tuple(
        f"the {name} is not symmetric in this pose (off by {100 * s.residual:.1f} % of its diagonal): "
        "mirrored marks lie at the nearest place, check them"
        for name, s in found
        if s.residual > _ROUGH and not s.sure.all()
    )
