"""A small mesh that stands for a large one: skin, clips and residuals go down, residuals come up again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from tempose.clips import Mesh, MeshClip, SkinnedMesh
from tempose.detail.multiresolution.spread import spreading
from tempose.geometry import Collapses, collapse_edges
from tempose.rigging import Rig
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class ControlMesh:
    """A rig and its clips on few vertices."""

    collapses: Collapses
    """How the n vertices of the full mesh became K."""
    skin: SkinnedMesh
    """K vertices on the joints of the full skin."""
    up: csr_matrix
    """(n, K) from values at control vertices to values at all."""

    def clip(self, clip: MeshClip) -> MeshClip:
        """Replay the collapses on every frame of a clip.

        Parameters
        ----------
        clip : MeshClip
            Frames of the full mesh.

        Returns
        -------
        MeshClip
            Frames of the control mesh.
        """
        V = np.stack([self.collapses.replay(np.asarray(f, dtype=np.float64)) for f in clip.vertices])
        return MeshClip(V.astype(np.float32), self.skin.mesh, clip.fps, clip.source)

    def rig(self, rig: Rig) -> Rig:
        """Put the control mesh on the joints and the motion of a rig.

        Parameters
        ----------
        rig : Rig
            Of the full mesh.

        Returns
        -------
        Rig
            The same motion on K vertices.
        """
        return Rig(self.skin, rig.motion, rig.blending, rig.report)

    def raise_values(self, D: FloatArray) -> FloatArray:
        """Carry what the control mesh shows to the full one.

        Parameters
        ----------
        D : (..., K, 3) float
            Such as residuals, in the basis of each vertex.

        Returns
        -------
        (..., n, 3) ndarray
            The same at every vertex.
        """
        if D.ndim == 2:
            return self.up @ D
        return np.stack([self.raise_values(frame) for frame in D])


def make_control(skin: SkinnedMesh, V: FloatArray | None = None, percent: float = 5.0) -> ControlMesh:
    """Collapse edges of one frame until a percentage of the vertices is left.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices.
    V : (n, 3) float, optional
        The frame on which collapses are decided, in [1]_ the first; by default the bind pose.
    percent : float, default 5.0
        Vertices left, above 0 to 100.

    Returns
    -------
    ControlMesh
        For clips and rigs of this mesh.

    Raises
    ------
    ValueError
        If `percent` is out of range or leaves fewer than 8 vertices.

    References
    ----------
    .. [1] De Aguiar and Ukita, "Representing mesh-based character animations", section 6.
    """
    n = len(skin.mesh.vertices)
    if not 0 < percent <= 100:
        raise ValueError(f"percent must be above 0 and at most 100, got {percent}")
    count = round(n * percent / 100)
    if count < 8:
        raise ValueError(
            f"percent must leave 8 vertices or more; {percent} % of {n} are {count}, "
            f"take {800 / n:.3g} or more"
        )
    frame = skin.mesh.vertices if V is None else np.asarray(V, dtype=np.float64)
    collapses = collapse_edges(frame, skin.mesh.faces, count)
    down = collapses.matrix
    mesh = Mesh(down @ skin.mesh.vertices, collapses.faces, name=skin.mesh.name, source=skin.mesh.source)
    control = SkinnedMesh(mesh, skin.skeleton, down @ skin.weights)
    return ControlMesh(collapses, control, way_up(skin, down))


def way_up(skin: SkinnedMesh, down: csr_matrix) -> csr_matrix:
    """Make the way up that belongs to a way down.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices.
    down : (K, n) csr_matrix
        From all vertices to the control vertices.

    Returns
    -------
    (n, K) csr_matrix
        From control vertices to all.
    """
    V, W = skin.mesh.vertices, skin.weights
    return spreading(V, down @ V, W, down @ W)
