"""The fragmented mesh glued together again, eqs. (3)-(4)."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import scipy.sparse as sp

from tempose.geometry import cotangent_laplacian, cotangents, edge_laplacian
from tempose.linalg import SparseCholesky
from tempose.transfer._kernels import add_edge_fragments, add_face_fragments
from tempose.transfer.links import ExtraEdges
from tempose.typing import FloatArray, IntArray

BLOCK = 16
"""Frames solved together: one entry of the factor is loaded once for all of them."""


class PoissonGlue:
    """Find the mesh whose differential coordinates are those of its turned faces.

    The Laplacian is factorised once; all work on a frame happens in the order of the factor.

    Parameters
    ----------
    V : (n, 3) float
        Rest vertices, metres.
    F : (m, 3) int
        Faces; with `extra` one connected component.
    extra : ExtraEdges
        Links between pieces and inner edges.

    Raises
    ------
    ValueError
        If mesh and links are more than one component, or a vertex has no edge.
    """

    def __init__(self, V: FloatArray, F: IntArray, extra: ExtraEdges) -> None:
        n = len(V)
        L = cotangent_laplacian(V, F) + edge_laplacian(extra.pairs, extra.weights, n)
        # the rows sum to zero, so that pulling one vertex to the origin holds it there exactly
        pull = np.zeros(n)
        pull[0] = L.diagonal().mean()
        self._solver = SparseCholesky(L + sp.diags_array(pull))
        self._place = self._solver.permutation
        self._F = self._place[F].astype(np.int64)
        self._edges = np.stack([V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 1]]], axis=1)
        self._weights = cotangents(V, F)
        self._pairs = self._place[extra.pairs].reshape(-1, 2).astype(np.int64)
        self._vectors = V[extra.pairs[:, 0]] - V[extra.pairs[:, 1]]
        self._pair_weights = np.ascontiguousarray(extra.weights, dtype=np.float64)

    def solve(self, q: FloatArray) -> FloatArray:
        """Glue K frames.

        Parameters
        ----------
        q : (n, 4, K) float
            Quaternion field at the vertices; need not be normalised.

        Returns
        -------
        (K, n, 3) ndarray
            Vertices, each frame with vertex 0 at the origin.
        """
        n, _, K = q.shape
        ordered = np.zeros(q.shape)
        ordered[self._place] = q
        rhs = np.zeros((n, 3, K))
        add_face_fragments(ordered, self._F, self._edges, self._weights, rhs)
        if len(self._pairs):
            add_edge_fragments(ordered, self._pairs, self._vectors, self._pair_weights, rhs)
        self._solver.solve_ordered(rhs.reshape(n, 3 * K))
        return rhs[self._place].transpose(2, 0, 1)

    def solve_blocks(
        self,
        field: Callable[[slice], FloatArray],
        n_frames: int,
        workers: int,
        receive: Callable[[slice, FloatArray], None],
    ) -> None:
        """Glue a clip block by block on several threads.

        Parameters
        ----------
        field : callable
            Frames (a slice) to their (n, 4, K) quaternion field.
        n_frames : int
            Number of frames.
        workers : int
            Number of threads; the result does not depend on it.
        receive : callable
            Called with each slice and its (K, n, 3) vertices, in order.
        """
        blocks = [slice(t, min(t + BLOCK, n_frames)) for t in range(0, n_frames, BLOCK)]
        if workers <= 1:
            for block in blocks:
                receive(block, self.solve(field(block)))
            return
        with ThreadPoolExecutor(workers) as pool:
            # a window of pending blocks bounds the memory whatever the length of the clip
            pending = [(b, pool.submit(lambda b: self.solve(field(b)), b)) for b in blocks[: 2 * workers]]
            for following in blocks[2 * workers :] + [None] * len(pending):
                block, future = pending.pop(0)
                receive(block, future.result())
                if following is not None:
                    pending.append((following, pool.submit(lambda b: self.solve(field(b)), following)))
