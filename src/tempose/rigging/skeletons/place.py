"""A given skeleton brought into a mesh: as it is, posed like the body in it, or moved and scaled."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import Mesh, Skeleton
from tempose.embedding import Embedding, embed_whole_or_piece
from tempose.embedding.cells import Cells
from tempose.kinematics import find_roles
from tempose.rigging.skeletons.bind import joint_bones
from tempose.rigging.skeletons.human import REFUSED
from tempose.rigging.skeletons.inside import joints_outside, mesh_cells, share_inside
from tempose.rigging.skeletons.posed import posed_like
from tempose.rotations import from_rotation_vector, multiply, rotate
from tempose.typing import FloatArray

_GOOD, _LEAST = 0.9, 0.5
"""Share of the bones inside from which a skeleton is taken without a word, and below which it is refused."""
_NEEDED = ("left_upper_arm", "right_upper_arm", "left_thigh", "right_thigh", "hips")


@dataclass(frozen=True)
class Placed:
    """A skeleton inside a mesh."""

    skeleton: Skeleton
    """Its rest pose is that of the mesh."""
    how: str
    """``"as it is"``, ``"posed"`` or ``"moved and scaled"``."""
    inside: float
    """Share of the length of its bones that lies inside."""
    cells: Cells
    """The inside."""
    warnings: tuple[str, ...] = ()
    """What a person should know."""


def place_skeleton(skeleton: Skeleton, mesh: Mesh) -> Placed:
    """Bring a skeleton into a mesh.

    Parameters
    ----------
    skeleton : Skeleton
        J joints of any maker, anywhere.
    mesh : Mesh
        What it shall move.

    Returns
    -------
    Placed
        The first of three that has nine tenths of its bones inside: the skeleton as it is; if it is a
        human's and so is the mesh, with its joints where an embedded skeleton has them; moved, scaled and
        turned about Y until it fits the box of the mesh. Else the one with most inside.

    Raises
    ------
    ValueError
        If less than half of it can be brought inside.
    """
    cells = mesh_cells(mesh)
    asis = Placed(skeleton, "as it is", share_inside(skeleton, cells.solid), cells)
    if asis.inside >= _GOOD:
        return _said(asis, asis)
    tries = [asis]
    posed = _posed(skeleton, mesh, cells)
    tries += [] if posed is None else [posed]
    if tries[-1].inside < _GOOD:
        tries += [_boxed(skeleton, mesh, cells, quarter) for quarter in range(4)]
    best = max(tries, key=lambda placed: placed.inside)
    if best.inside < _LEAST:
        raise ValueError(
            f"the skeleton lies outside the mesh: {100 * asis.inside:.0f} % of the length of its bones is "
            f"inside, and {100 * best.inside:.0f} % after moving and scaling it (at least "
            f"{100 * _LEAST:.0f} % is needed); move it into the mesh, or use --skeleton human or auto"
        )
    return _said(best, asis)


def _said(placed: Placed, asis: Placed) -> Placed:
    warnings: list[str] = []
    if placed.how != "as it is":
        done = {"posed": "posed like the body in the mesh", "moved and scaled": "moved and scaled"}
        warnings.append(
            f"only {100 * asis.inside:.0f} % of the skeleton's bones lay inside the mesh; "
            f"it was {done[placed.how]}, now {100 * placed.inside:.0f} % do"
        )
    if placed.inside < _GOOD:
        outside = joints_outside(placed.skeleton, placed.cells.solid)
        warnings.append(
            f"parts of the skeleton lie outside the mesh: {100 * placed.inside:.0f} % of the length of its "
            f"bones is inside; joints outside: {', '.join(outside[:8]) or 'none'}"
        )
    return replace(placed, warnings=tuple(warnings))


def _posed(skeleton: Skeleton, mesh: Mesh, cells: Cells) -> Placed | None:
    roles = find_roles(skeleton)
    if not set(_NEEDED) <= set(roles):
        return None
    embedding = _human(mesh)
    if embedding is None:
        return None
    posed = posed_like(skeleton, roles, embedding)
    return Placed(posed, "posed", share_inside(posed, cells.solid), cells)


def _human(mesh: Mesh) -> Embedding | None:
    try:
        embedding = embed_whole_or_piece(mesh)[0]
    except ValueError:
        return None
    return embedding if embedding.penalty <= REFUSED else None


def _boxed(skeleton: Skeleton, mesh: Mesh, cells: Cells, quarter: int) -> Placed:
    turn = from_rotation_vector(np.array([0.0, 0.5 * np.pi * quarter, 0.0]))
    P = rotate(turn, joint_bones(skeleton)[0].reshape(-1, 3))
    inner = cells.points
    low, high = inner.min(axis=0), inner.max(axis=0)
    # bones end inside the surface, by about a twentieth of the height
    height = 0.95 * float(high[1] - low[1])
    extent = float(np.ptp(P[:, 1]))
    scale = height / extent if extent > 0 else height / max(float(np.ptp(P, axis=0).max()), 1e-300)
    middle = (P.min(axis=0) + P.max(axis=0)) / 2
    shift = (low + high) / 2 - scale * middle
    moved = similar_skeleton(skeleton, turn, scale, shift)
    return Placed(moved, "moved and scaled", share_inside(moved, cells.solid), cells)


def similar_skeleton(skeleton: Skeleton, turn: FloatArray, scale: float, shift: FloatArray) -> Skeleton:
    """Turn, scale and move a skeleton as a whole.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    turn : (4,) float
        Rotation wxyz about the origin.
    scale : float
        Factor about the origin.
    shift : (3,) float
        Added last, metres.

    Returns
    -------
    Skeleton
        The same joints with other offsets and another rest rotation of the root.
    """
    assert skeleton.rest_rotations is not None and skeleton.tips is not None
    offsets = scale * skeleton.offsets
    offsets[0] = rotate(turn, offsets[0]) + shift
    rest = np.array(skeleton.rest_rotations)
    rest[0] = multiply(turn, rest[0])
    return replace(skeleton, offsets=offsets, rest_rotations=rest, tips=scale * skeleton.tips)
