"""Shape spaces by name."""

from __future__ import annotations

from collections.abc import Mapping

from tempose.shape_spaces.edge_dihedral import EdgeDihedralSpace
from tempose.shape_spaces.gradient import GradientSpace
from tempose.shape_spaces.patch import PatchSpace
from tempose.shape_spaces.rotation_invariant import RotationInvariantSpace
from tempose.shape_spaces.space import ShapeSpace
from tempose.shape_spaces.vertex import VertexSpace
from tempose.typing import FloatArray, IntArray

SPACES: dict[str, type[ShapeSpace]] = {
    space.name: space
    for space in (VertexSpace, GradientSpace, PatchSpace, EdgeDihedralSpace, RotationInvariantSpace)
}
"""Class of each name, in the order in which a person would try them."""


def shape_space(name: str, rest: FloatArray, faces: IntArray, frames: FloatArray | None = None) -> ShapeSpace:
    """Make a shape space for a mesh by name.

    Parameters
    ----------
    name : str
        A key of `SPACES`.
    rest : (n, 3) float
        Rest vertices, metres.
    faces : (m, 3) int
        Faces.
    frames : (T, n, 3) float, optional
        A clip or poses that the space shall suit.

    Returns
    -------
    ShapeSpace
        Ready to encode and decode.

    Raises
    ------
    ValueError
        If no space has that name, or the mesh does not allow it.
    """
    return _named(name).from_clip(rest, faces, frames)


def space_from_state(name: str, state: Mapping[str, FloatArray]) -> ShapeSpace:
    """Make the space that was saved.

    Parameters
    ----------
    name : str
        A key of `SPACES`.
    state : mapping of str to ndarray
        As `ShapeSpace.state` gave it.

    Returns
    -------
    ShapeSpace
        The same space.

    Raises
    ------
    ValueError
        If no space has that name.
    """
    return _named(name).from_state(state)


def _named(name: str) -> type[ShapeSpace]:
    if name not in SPACES:
        raise ValueError(f"space must be one of {', '.join(SPACES)}, got {name!r}")
    return SPACES[name]
