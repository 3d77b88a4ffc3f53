"""The solver: rotations of marks in, a whole mesh out."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.clips import Mesh
from tempose.rotations import conjugate, multiply, rotate, to_matrix
from tempose.transfer.solver.blocks import solve_blocks
from tempose.transfer.solver.fabric import Fabric, weave
from tempose.transfer.solver.fields import HarmonicFields
from tempose.transfer.solver.fill import VolumeFill
from tempose.transfer.solver.frame_kernels import spread_1, spread_8, write_frames
from tempose.transfer.solver.glue import LANES, PoissonGlue, Precision
from tempose.transfer.solver.links import inner_edges
from tempose.transfer.solver.welded import Welded
from tempose.transfer.turns.references import References
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
    volume : float or (B,) float, default 0
        How strongly inner edges hold the volume at bends, the same everywhere or by rotation; 1 holds most
        of it.
    anchor : Anchor, optional
        By what the mesh is placed; the centroid of the marked vertices if not given.
    workers : int, default 2
        Threads for clips; the result does not depend on it.
    precision : {"double", "single"}, default "double"
        In which frames are solved. Single is faster and drifts from double by less than 5e-6 of the height;
        in both the identity gives the rest pose to rounding of double.

    fabric : Fabric, optional
        What `tempose.transfer.solver.fabric.weave` made of this very mesh before; saves most of the set-up
        when only marks change.

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
        volume: float | FloatArray = 0.0,
        anchor: Anchor | None = None,
        workers: int = 2,
        precision: Precision = "double",
        fabric: Fabric | None = None,
    ) -> None:
        if precision not in ("double", "single"):
            raise ValueError(f"precision must be 'double' or 'single', got {precision!r}")
        vertices = as_indices(vertices, "vertices", ("k",), limit=len(mesh.vertices))
        bones = as_indices(bones, "bones", (len(vertices),), limit=n_bones)
        if len(mesh.faces) < 2 or mesh.diagonal == 0:
            raise ValueError(f"target must be a surface of at least 2 triangles, got {len(mesh.faces)}")
        self.mesh, self.n_bones, self.workers = mesh, n_bones, workers
        if fabric is None or fabric.mesh is not mesh:
            fabric = weave(mesh)
        V, F, first, order = fabric.V, fabric.F, fabric.first, fabric.order
        self._inverse, self.links = fabric.inverse, fabric.links
        marked = self._inverse[vertices]
        # neither factor waits for the other
        with ThreadPoolExecutor(1) as pool:
            fields = pool.submit(HarmonicFields, fabric.field_matrix, marked, bones, n_bones, order)
            inner = inner_edges(V, F, _strengths(volume, fields))
            extra = self.links + fabric.shell + inner
            self._glue = PoissonGlue(V, F, extra, precision, None if len(inner.pairs) else order)
            self.fields = fields.result()
        self._rows = self._glue.rows[self._inverse]
        self._rest = mesh.vertices - mesh.vertices[0]
        if self.fields.basis is not None:
            ordered = np.zeros(self.fields.basis.shape, dtype=self._glue.dtype)
            ordered[self._glue.rows] = self.fields.basis
            self._basis = ordered.reshape(-1)
        self.anchor = anchor or _centroid_anchor(mesh, vertices)
        self.welded = Welded(V, F, first, self._inverse)
        self.fill: VolumeFill | None = None

    @property
    def basis(self) -> FloatArray | None:
        """(n, B) harmonic weight of each rotation at each vertex, rows sum to 1; None when B is large."""
        basis = self.fields.basis
        return None if basis is None else basis[self._inverse]

    def field(self, Q: FloatArray, references: References | None = None, start: int = 0) -> FloatArray:
        """Spread rotations over the mesh.

        Parameters
        ----------
        Q : (T, B, 4) float
            Unit quaternions with agreeing signs.
        references : References, optional
            Reference poses of the clip from which these frames are, if there are others than the rest.
        start : int, default 0
            Which frame of that clip is the first.

        Returns
        -------
        (n, 4, T) ndarray
            Quaternion field at the vertices, not normalised: a short one tells of rotations that contradict
            each other.
        """
        if references is not None:
            return references.field(self.spread, slice(start, start + len(Q)))[self._inverse]
        return self.spread(Q)[self._inverse]

    def spread(self, Q: FloatArray) -> FloatArray:
        """Spread rotations over the welded mesh.

        Parameters
        ----------
        Q : (T, B, 4) float
            Unit quaternions with agreeing signs.

        Returns
        -------
        (w, 4, T) ndarray
            Quaternion field at the vertices of ``welded``, not normalised.
        """
        columns = Q.transpose(1, 2, 0).reshape(self.n_bones, 4 * len(Q))
        return self.fields.interpolate(columns).reshape(-1, 4, len(Q))

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
        to = np.tile(self.anchor.point, (len(frames), 1))
        if place is not None:
            to = as_floats(place, "place", (*lead, 3)).reshape(-1, 3)

        def solve(block: slice) -> FloatArray:
            return self._solve(frames[block], None, to[block], out[block])

        solve_blocks(solve, len(frames), self.workers, lambda block, V: None)
        return out.reshape(*lead, *out.shape[1:])

    def pose_blocks(
        self,
        Q: FloatArray,
        receive: Callable[[slice, FloatArray], None],
        references: References | None = None,
    ) -> None:
        """Move the mesh through a clip, some frames at a time, so that memory stays bounded.

        Parameters
        ----------
        Q : (T, B, 4) float
            Rotations with agreeing signs.
        receive : callable
            Called in order with a slice of frames and their (K, n, 3) vertices, the anchor at its rest place.
        references : References, optional
            Reference poses other than the rest (`choose_references`).
        """

        def solve(block: slice) -> FloatArray:
            K = len(Q[block])
            field = references.field(self.spread, block) if references else None
            out = np.zeros((K, *self.mesh.vertices.shape))
            return self._solve(Q[block], field, np.tile(self.anchor.point, (K, 1)), out)

        solve_blocks(solve, len(Q), self.workers, receive)

    def _solve(self, Q: FloatArray, field: FloatArray | None, to: FloatArray, out: FloatArray) -> FloatArray:
        """Write frames to `out`, the anchor at `to`."""
        # what all bones share is applied at the end: large turns of the whole cost no accuracy
        common = _common_rotation(Q)
        if field is None:
            rows = self._spread(multiply(conjugate(common)[:, None], Q))
        else:
            turned = multiply(conjugate(common), np.moveaxis(field, 1, 2))
            rows = self._glue.in_rows(np.moveaxis(turned, 1, 2))
        u = self._glue.displacements(rows)
        goal = np.array(to)
        if self.anchor.bone is not None:
            arm = self.anchor.point - self.anchor.weights @ self.mesh.vertices
            goal -= rotate(Q[:, self.anchor.bone], arm)
        wide, R = u.shape[1], to_matrix(common)
        step = 1 if wide == 4 else wide // 3
        write_frames(u.reshape(-1), wide, step, self._rows, self._rest, R, self.anchor.weights, goal, out)
        if self.fill is not None:
            self.fill.apply(out)
        return out

    def _spread(self, Q: FloatArray) -> FloatArray:
        """Quaternion field in rows of the factor, see `frame_kernels`."""
        n, K, B = self._glue.n, len(Q), self.n_bones
        if self.fields.basis is None:
            columns = Q.transpose(1, 2, 0).reshape(B, 4 * K)
            return self._glue.in_rows(self.fields.interpolate(columns).reshape(n, 4, K))
        if K == 1:
            q = np.zeros((n + 1, 4), dtype=self._glue.dtype)
            spread_1(self._basis, Q[0][:, [1, 2, 3, 0]].astype(q.dtype).reshape(-1), B, q.reshape(-1))
            return q
        frames = np.zeros((B, 4, -(-K // LANES) * LANES), dtype=self._glue.dtype)
        frames[:, :, :K] = Q.transpose(1, 2, 0)
        wide = 4 * frames.shape[2]
        q = np.zeros((n + 1, wide), dtype=self._glue.dtype)
        spread_8(self._basis, frames.reshape(-1), B, wide, q.reshape(-1))
        return q


def _strengths(volume: float | FloatArray, fields: Future[HarmonicFields]) -> float | FloatArray:
    """Strength of the inner edges at every vertex."""
    if np.ndim(volume) == 0 or not np.any(volume) or fields.result().basis is None:
        return float(np.max(volume))
    return np.clip(fields.result().basis @ np.asarray(volume), 0, None)


def _common_rotation(Q: FloatArray) -> FloatArray:
    """Take the unit mean of the rotations of each frame, the first where they cancel out."""
    mean = Q.mean(axis=1)
    mean = np.where(np.linalg.norm(mean, axis=1, keepdims=True) > 0.1, mean, Q[:, 0])
    return mean / np.linalg.norm(mean, axis=1, keepdims=True)


def _centroid_anchor(mesh: Mesh, vertices: IntArray) -> Anchor:
    weights = np.bincount(vertices, minlength=len(mesh.vertices)) / len(vertices)
    return Anchor(weights, None, weights @ mesh.vertices)
