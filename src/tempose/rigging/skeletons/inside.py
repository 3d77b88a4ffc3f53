"""How much of a skeleton lies inside a mesh."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.clips import Mesh, Skeleton
from tempose.embedding.cells import Cells, make_cells
from tempose.embedding.solid import Solid, make_solid
from tempose.kinematics import rest_transforms
from tempose.rigging.skeletons.bind import joint_bones

_SAMPLES = 24
_TIP = 0.15
"""Share of a bone, at both ends, that does not count: tips and joints may touch the surface."""


def mesh_cells(mesh: Mesh) -> Cells:
    """Find the inside of a mesh.

    Parameters
    ----------
    mesh : Mesh
        Closed or with holes, of one piece or many.

    Returns
    -------
    Cells
        Limbs that touch are apart where that leaves one piece.

    Raises
    ------
    ValueError
        If the mesh encloses nothing.
    """
    solid = make_solid(mesh.vertices, mesh.faces)
    cells = make_cells(solid, solid.walls) or make_cells(solid, None)
    assert cells is not None
    return cells


def share_inside(skeleton: Skeleton, solid: Solid) -> float:
    """Share of the length of all bones that lies inside a mesh.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    solid : Solid
        The inside.

    Returns
    -------
    float
        From 0 to 1; the outer 15 % of a bone do not count. Of bones without length, their joints count.
    """
    segments, _ = joint_bones(skeleton)
    along = np.linspace(_TIP, 1 - _TIP, _SAMPLES)
    points = segments[:, :1] + along[:, None] * (segments[:, 1:] - segments[:, :1])
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    weight = length if length.sum() > 0 else np.ones(len(length))
    return float(np.average((solid.depth_at(points) > 0).mean(axis=1), weights=weight))


def joints_outside(skeleton: Skeleton, solid: Solid) -> list[str]:
    """Names of the joints that do not lie inside a mesh.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    solid : Solid
        The inside.

    Returns
    -------
    list of str
        In the order of the skeleton.
    """
    depth: Any = solid.depth_at(rest_transforms(skeleton)[1])
    return [name for name, d in zip(skeleton.names, depth) if d <= 0]
