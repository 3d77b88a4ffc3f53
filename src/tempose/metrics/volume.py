"""The volume that a surface encloses, whole, by component and round a joint."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from tempose._validate import as_floats, as_indices
from tempose.clips.blocks import read_block
from tempose.geometry import face_components
from tempose.metrics._closing import Caps, close_holes
from tempose.metrics._frames import block_slices, check_clip
from tempose.metrics._triangles import coordinates, cross, dot, take
from tempose.typing import FloatArray, IntArray

_NOTHING = 1e-9  # volume over cubed diagonal below which a surface encloses nothing


def volumes(V: FloatArray, F: IntArray) -> FloatArray:
    """Signed volume inside a surface in each frame, holes closed by fans.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces, counter-clockwise seen from outside; closed or not. A few faces of a mesh will do: a *patch*,
        whose rim is closed like any hole.

    Returns
    -------
    (T,) ndarray
        Unit of `V` cubed; negative for a surface turned inside out.

    Raises
    ------
    ValueError
        If a shape is wrong, the clip is empty or holds NaN.

    Notes
    -----
    Sum of the signed tetrahedra over the faces and over fans from the mean vertex of each hole.
    Invariant to rigid motion and to renumbering of vertices and faces.
    """
    V, F = _check(V, F)
    return _sum_tetrahedra(V, F, np.zeros(len(F), dtype=int), 1)[:, 0]


class Enclosed:
    """The volume inside one surface or patch of it, asked for many times.

    Parameters
    ----------
    F : (m, 3) int
        Faces, counter-clockwise seen from outside; what is open is closed by fans.
    n : int
        Number of vertices.
    """

    def __init__(self, F: IntArray, n: int) -> None:
        self.F = as_indices(F, "F", ("m", 3), limit=n)
        self._caps = close_holes(self.F, n)

    def volumes(self, V: FloatArray) -> FloatArray:
        """Signed volume in each frame, as `tempose.metrics.volumes` gives it.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames.

        Returns
        -------
        (T,) ndarray
            Unit of `V` cubed.
        """
        return _tetrahedra(np.asarray(V, dtype=np.float64), self.F, self._caps).sum(axis=1)


def component_volumes(V: FloatArray, F: IntArray) -> FloatArray:
    """Signed volume of every connected component in each frame, holes closed by fans.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces.

    Returns
    -------
    (T, C) ndarray
        Unit of `V` cubed; components in the order of `tempose.geometry.face_components`.

    Raises
    ------
    ValueError
        If a shape is wrong, the clip is empty or holds NaN.
    """
    V, F = _check(V, F)
    count, labels = face_components(F, V.shape[1])
    return _sum_tetrahedra(V, F, labels, count)


def volume_change(V: FloatArray, F: IntArray, V_rest: FloatArray) -> FloatArray:
    """Change of the enclosed volume against the rest pose.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces of the mesh, or of a patch such as `patch_round` gives.
    V_rest : (n, 3) float
        Rest pose.

    Returns
    -------
    (T,) ndarray
        Percent of the rest volume; -100 is a surface that encloses nothing.

    Raises
    ------
    ValueError
        If a shape is wrong, a value is not finite, or the rest pose encloses no volume.
    """
    V, F = _check(V, F)
    V_rest = as_floats(V_rest, "V_rest", V.shape[1:])
    rest = float(volumes(V_rest[None], F)[0])
    if abs(rest) <= _NOTHING * _diagonal(V_rest[np.unique(F)]) ** 3:
        raise ValueError(
            f"V_rest must enclose a volume, got {rest:.3g}: the surface is flat or a closed sheet"
        )
    return 100 * (volumes(V, F) / rest - 1)


def component_volume_change(V: FloatArray, F: IntArray, V_rest: FloatArray) -> FloatArray:
    """Change of the volume of every connected component against the rest pose.

    Parameters
    ----------
    V : (T, n, 3) float
        Clip; an array or a memory map.
    F : (m, 3) int
        Faces.
    V_rest : (n, 3) float
        Rest pose.

    Returns
    -------
    (T, C) ndarray
        Percent of the rest volume; NaN for a component that encloses nothing at rest, such as an eyelash.

    Raises
    ------
    ValueError
        If a shape is wrong, or a value is not finite.
    """
    V, F = _check(V, F)
    V_rest = as_floats(V_rest, "V_rest", V.shape[1:])
    rest = component_volumes(V_rest[None], F)[0]
    _, labels = face_components(F, len(V_rest))
    sizes = np.array([_diagonal(V_rest[np.unique(F[labels == c])]) for c in range(len(rest))])
    solid = np.abs(rest) > _NOTHING * sizes**3
    change = 100 * (component_volumes(V, F) / np.where(solid, rest, 1.0) - 1)
    return np.where(solid, change, np.nan)


def _check(V: Any, F: Any) -> tuple[Any, IntArray]:
    V = check_clip(V, "V")
    return V, as_indices(F, "F", ("m", 3), limit=V.shape[1])


def _diagonal(V: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(V, axis=0))) if len(V) else 0.0


def _sum_tetrahedra(V: Any, F: IntArray, labels: IntArray, count: int) -> FloatArray:
    """Signed volume of faces and fans, summed by the label of the face, (T, count)."""
    T, n, _ = V.shape
    caps = close_holes(F, n)
    of_vertex = np.zeros(n, dtype=int)
    of_vertex[F.ravel()] = np.repeat(labels, 3)
    into = np.concatenate([labels, of_vertex[caps.edges[:, 0]]])
    collect = sp.coo_array(
        (np.ones(len(into)), (np.arange(len(into)), into)), shape=(len(into), count)
    ).tocsr()
    total = np.zeros((T, count))
    for frames in block_slices(T, 18 * (len(F) + len(caps.edges)) + 3 * n):
        total[frames] = _tetrahedra(read_block(V, frames, "V"), F, caps) @ collect
    return total


def _tetrahedra(V: FloatArray, F: IntArray, caps: Caps) -> FloatArray:
    # near the origin the tetrahedra are small, so that little is lost when they cancel
    X = coordinates(V - V.mean(axis=1, keepdims=True))
    a, b, c = (take(X, F[:, k]) for k in range(3))
    start, end = take(X, caps.edges[:, 0]), take(X, caps.edges[:, 1])
    x, y, z = ((caps.apex @ coordinate.T).T[:, caps.hole] for coordinate in X)
    fans = dot(cross(start, end), (x, y, z)) * caps.times
    return np.concatenate([dot(cross(a, b), c), fans], axis=1) / 6
