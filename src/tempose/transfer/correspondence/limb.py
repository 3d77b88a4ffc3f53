"""The local axis of a cylindrical part, found from its surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from tempose.geometry import face_areas
from tempose.transfer.correspondence.limb_axis import limb_axis
from tempose.transfer.correspondence.section import Loop, Sections, loop_centre
from tempose.typing import FloatArray


@dataclass(frozen=True)
class Limb:
    """A cylindrical part at one place."""

    loop: Loop
    """Its section by the plane through the pick, perpendicular to the axis."""
    centre: FloatArray
    """(3,) centroid of the section, metres."""
    axis: FloatArray
    """(3,) unit vector along the part."""
    distal: float
    """How surely the axis points away from the body, -1 to 1: which side has less surface; 0 if unknown."""


def find_limb(sections: Sections, face: int, axis: FloatArray | None = None) -> Limb | None:
    """Find the part round a face.

    Parameters
    ----------
    sections : Sections
        The mesh.
    face : int
        Face on the part.
    axis : (3,) float, optional
        Its direction where known, such as that of a bone; then it is kept.

    Returns
    -------
    Limb or None
        None where the mesh has no section there, as on a face without area.

    Raises
    ------
    ValueError
        If `axis` has no direction.

    Notes
    -----
    The normals of a cylinder or cone lie on a circle, so the axis is the direction in which they vary
    least; then it is turned until it joins the centres of the sections on both sides. Where that ends in a
    slanting section, as on a belly, the shortest section through the pick is the start instead.
    """
    point = sections.V[sections.F[face]].mean(axis=0)
    if axis is None:
        axis = limb_axis(sections, face)
    length = float(np.linalg.norm(axis))
    if length == 0 or not np.isfinite(length):
        raise ValueError(f"axis must be a direction, got {axis}")
    axis = np.asarray(axis, dtype=np.float64) / length
    loops = sections.cut(point, axis, face)
    if not loops:
        return None
    return Limb(loops[0], loop_centre(loops[0], axis), axis, _distal(sections, loops[0], axis))


def _distal(sections: Sections, loop: Loop, axis: FloatArray) -> float:
    """Compare the surface before and behind a loop that cuts the mesh in two."""
    F, n = sections.F, len(sections.V)
    crossed = F[loop.faces]
    front = (sections.V[crossed] - loop.points[0]) @ axis >= 0
    edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]).astype(np.int64)
    cut = np.concatenate([crossed[:, [0, 1]], crossed[:, [1, 2]], crossed[:, [2, 0]]]).astype(np.int64)
    sides = np.concatenate([front[:, [0, 1]], front[:, [1, 2]], front[:, [2, 0]]])
    cut = np.sort(cut[sides[:, 0] != sides[:, 1]], axis=1)
    keys = edges.min(axis=1) * n + edges.max(axis=1)
    edges = edges[~np.isin(keys, cut[:, 0] * n + cut[:, 1])]
    graph = sp.coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    labels = connected_components(graph, directed=False)[1]
    ahead, behind = int(labels[crossed[front][0]]), int(labels[crossed[~front][0]])
    if ahead == behind:
        return 0.0
    area = np.bincount(labels[F[:, 0]], face_areas(sections.V, F), minlength=labels.max() + 1)
    total = area[ahead] + area[behind]
    return float((area[behind] - area[ahead]) / total) if total > 0 else 0.0
