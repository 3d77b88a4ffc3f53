"""The solver: rotations of marks in, a whole mesh out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.clips import Mesh
from tempose.geometry import cotangent_laplacian, edge_laplacian, weld
from tempose.rotations import rotate
from tempose.transfer.fields import HarmonicFields
from tempose.transfer.glue import PoissonGlue
from tempose.transfer.links import ExtraEdges, inner_edges, link_pieces, shell_edges
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Anchor:
    """A rigid frame on the target by which it is put in its place, such as the pelvis."""

    weights: FloatArray
    """(n,) float, sum 1: which vertices carry it."""
    bone: int | None
    """Bone with which it turns; None for a plain centroid."""
    point: FloatArray
    """(3,) metres, its rest place."""


class MotionTransfer:
    """Move a still mesh by the rotations of a few marked places.

    Everything that does not depend on the motion is factorised here, once; a frame is a thin matrix product,
    one pass over the faces and one back-substitution.

    Parameters
    ----------
    mesh : Mesh
        Target at rest: n vertices, m faces; pieces, holes, duplicated and degenerate faces are survived.
    vertices : (k,) int
        Marked vertices of the target.
    bones : (k,) int
        Which of the B rotations each carries.
    n_bones : int
        Number of rotations B.
    volume : float, default 0
        How strongly inner edges hold the volume at bends; 1 holds most of it.
    anchor : Anchor, optional
        By what the mesh is placed; the centroid of the marked vertices if not given.
    workers : int, default 2
        Threads for clips; the result does not depend on it.

    Raises
    ------
    ValueError
        If there are no faces or no marks, an index is out of range, or the mesh has no extent.

    Notes
    -----
    Each component of a quaternion is a harmonic field, eq. (2) of [1]_, with Dirichlet values at the marks;
    the mesh torn apart by the rotations of its faces is glued by ``L x = u``, eqs. (3)-(4).
    A rotated source gives a rotated target; the identity gives the rest pose.

    References
    ----------
    .. [1] de Aguiar, Zayer, Theobalt, Seidel, Magnor, "A Simple Framework for Natural Animation of Digitized
       Models", SIBGRAPI 2007.
    """

    def __init__(
        self,
        mesh: Mesh,
        vertices: IntArray,
        bones: IntArray,
        n_bones: int,
        *,
        volume: float = 0.0,
        anchor: Anchor | None = None,
        workers: int = 2,
    ) -> None:
        vertices = as_indices(vertices, "vertices", ("k",), limit=len(mesh.vertices))
        bones = as_indices(bones, "bones", (len(vertices),), limit=n_bones)
        if len(mesh.faces) < 2 or mesh.diagonal == 0:
            raise ValueError(f"target must be a surface of at least 2 triangles, got {len(mesh.faces)}")
        self.mesh, self.n_bones, self.workers = mesh, n_bones, workers
        first, self._inverse = weld(mesh.vertices)
        V, F = mesh.vertices[first], self._inverse[mesh.faces]
        self.links = link_pieces(V, F)
        field_matrix = cotangent_laplacian(V, F, clamp=True) + edge_laplacian(
            self.links.pairs, self.links.weights, len(V)
        )
        field_matrix = field_matrix + edge_laplacian(*_slight_edges(F), len(V))
        self.fields = HarmonicFields(field_matrix, self._inverse[vertices], bones, n_bones)
        inner = inner_edges(V, F, volume) if volume > 0 else ExtraEdges.none()
        self._glue = PoissonGlue(V, F, self.links + shell_edges(V, F) + inner)
        self._origin = V[0]
        self.anchor = anchor or _centroid_anchor(mesh, vertices)

    @property
    def basis(self) -> FloatArray | None:
        """(n, B) harmonic weight of each rotation at each vertex, rows sum to 1; None when B is large."""
        basis = self.fields.basis
        return None if basis is None else basis[self._inverse]

    def field(self, Q: FloatArray) -> FloatArray:
        """Spread rotations over the mesh.

        Parameters
        ----------
        Q : (T, B, 4) float
            Unit quaternions with agreeing signs.

        Returns
        -------
        (n, 4, T) ndarray
            Quaternion field at the vertices, not normalised: a short one tells of rotations that contradict
            each other.
        """
        return self._welded_field(Q)[self._inverse]

    def _welded_field(self, Q: FloatArray) -> FloatArray:
        T = len(Q)
        columns = Q.transpose(1, 2, 0).reshape(self.n_bones, 4 * T)
        return self.fields.interpolate(columns).reshape(-1, 4, T)

    def pose(self, Q: FloatArray, place: FloatArray | None = None) -> FloatArray:
        """Move the mesh.

        Parameters
        ----------
        Q : (..., B, 4) float
            Rotation of every bone relative to the target's rest, wxyz, with agreeing signs (see
            `consistent_signs`).
        place : (..., 3) float, optional
            Where the anchor goes, metres; its rest place if not given.

        Returns
        -------
        (..., n, 3) ndarray
            Vertices, metres.

        Raises
        ------
        ValueError
            If a shape is wrong or a value is not finite.
        """
        Q = np.asarray(Q, dtype=np.float64)
        lead = Q.shape[:-2]
        frames = as_floats(Q.reshape(-1, *Q.shape[-2:]), "Q", ("T", self.n_bones, 4))
        out = np.zeros((len(frames), len(self.mesh.vertices), 3))

        def receive(block: slice, V: FloatArray) -> None:
            out[block] = V

        self.pose_blocks(frames, receive)
        if place is not None:
            out += (as_floats(place, "place", (*lead, 3)).reshape(-1, 3) - self.anchor.point)[:, None]
        return out.reshape(*lead, *out.shape[1:])

    def pose_blocks(self, Q: FloatArray, receive: Callable[[slice, FloatArray], None]) -> None:
        """Move the mesh through a clip, some frames at a time, so that memory stays bounded.

        Parameters
        ----------
        Q : (T, B, 4) float
            Rotations with agreeing signs.
        receive : callable
            Called in order with a slice of frames and their (K, n, 3) vertices, the anchor at its rest place.
        """

        def place(block: slice, V: FloatArray) -> None:
            V = V[:, self._inverse]
            V += (self.anchor.point - self._anchor_place(V, Q[block]))[:, None]
            receive(block, V)

        self._glue.solve_blocks(lambda block: self._welded_field(Q[block]), len(Q), self.workers, place)

    def _anchor_place(self, V: FloatArray, Q: FloatArray) -> FloatArray:
        carried = np.einsum("n,tni->ti", self.anchor.weights, V)
        if self.anchor.bone is None:
            return carried
        arm = self.anchor.point - self.anchor.weights @ self.mesh.vertices
        return carried + rotate(Q[:, self.anchor.bone], arm)


def _slight_edges(F: IntArray) -> tuple[IntArray, FloatArray]:
    # clamped weights may leave a vertex without any: a trace of the graph Laplacian keeps it attached
    edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    return edges, np.full(len(edges), 1e-7)


def _centroid_anchor(mesh: Mesh, vertices: IntArray) -> Anchor:
    weights = np.bincount(vertices, minlength=len(mesh.vertices)) / len(vertices)
    return Anchor(weights, None, weights @ mesh.vertices)
