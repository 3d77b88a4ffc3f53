"""The skin round a joint is pushed out until it encloses as much as at rest: what a bend cost comes back.

Inner edges hold the volume of elbows, knees and hips, but not of a raised shoulder, and they stretch skin.
Pushing out what is still missing, smoothly and along the normals, costs one pass over the faces near joints.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.metrics import Enclosed
from tempose.transfer.solver._fill_kernel import fill_patch
from tempose.transfer.solver.welded import Welded
from tempose.typing import FloatArray, IntArray

REACH = 0.5
"""Radius of a patch in lengths of the bone that starts at the joint."""
CAP = 0.25
"""Furthest push in radii of the patch; it is approached softly, so that there is no jump in time."""
SMOOTH = 4
"""How often the directions of the push are averaged over the faces."""


@dataclass(frozen=True)
class Patch:
    """The surface round a joint."""

    vertices: IntArray
    """(p,) vertices of the mesh, one for each position."""
    faces: IntArray
    """(q, 3) faces as places in `vertices`."""
    bump: FloatArray
    """(p,) share of the push that each vertex takes: 1 at the joint, 0 at the rim."""
    radius: float
    """Metres."""
    copies: tuple[IntArray, IntArray]
    """(c,) all vertices of the mesh at these positions, and their place in `vertices`."""


def make_patch(welded: Welded, allowed: IntArray, joint: FloatArray, radius: float) -> Patch | None:
    """Cut the surface round a joint out of a mesh.

    Parameters
    ----------
    welded : Welded
        The mesh at rest, its seams closed.
    allowed : (k,) int
        Faces of the bones that meet at the joint: a hand that hangs beside the hip is not part of it.
    joint : (3,) float
        Metres.
    radius : float
        Faces with all corners nearer than this count.

    Returns
    -------
    Patch or None
        None where no surface lies within the radius.
    """
    away = np.linalg.norm(welded.vertices - joint, axis=1) / radius
    near = welded.faces[allowed]
    near = near[(away[near] < 1).all(axis=1)]
    if len(near) == 0:
        return None
    chosen, local = np.unique(near, return_inverse=True)
    place = np.full(len(welded.vertices), -1, dtype=np.int64)
    place[chosen] = np.arange(len(chosen))
    copies = np.flatnonzero(place[welded.inverse] >= 0)
    return Patch(
        welded.first[chosen],
        local.reshape(-1, 3),
        (1 - away[chosen] ** 2) ** 2,
        radius,
        (copies, place[welded.inverse[copies]]),
    )


class VolumeFill:
    """Push the skin out where a patch encloses less than at rest, and in where it encloses more.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices of the mesh, metres.
    patches : list of Patch
        One a joint.
    strength : float, default 1
        Share of the loss that is given back.

    Notes
    -----
    The volume inside a patch, its rim closed by fans, grows at the rate ``sum bump_i d_i . g_i`` when vertex
    i moves by ``bump_i d_i``, with g the gradient of the volume (a third of the area vectors of the faces
    round i) and d its direction, averaged over the faces so that creases open instead of folding. One Newton
    step, bounded by a share of the radius.
    """

    def __init__(self, V: FloatArray, patches: list[Patch], strength: float = 1.0) -> None:
        self.patches, self.strength = patches, strength
        self._meters = [Enclosed(patch.faces, len(patch.vertices)) for patch in patches]
        self._rest = [
            float(meter.volumes(V[patch.vertices][None])[0]) for meter, patch in zip(self._meters, patches)
        ]

    def apply(self, V: FloatArray) -> None:
        """Fill frames, in place.

        Parameters
        ----------
        V : (K, n, 3) float
            Frames, metres.
        """
        for patch, meter, rest in zip(self.patches, self._meters, self._rest):
            X = np.ascontiguousarray(V[:, patch.vertices])
            missing = self.strength * (rest - meter.volumes(X))
            fill_patch(X, patch.faces, patch.bump, missing, CAP * patch.radius, SMOOTH)
            at, place = patch.copies
            V[:, at] = X[:, place]
