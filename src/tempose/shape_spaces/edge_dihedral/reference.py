"""What lengths, angles and places of a mesh are counted from, and how much each counts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from tempose._validate import as_floats, as_indices, read_only
from tempose.rotations import from_matrix, mean_rotation, to_matrix
from tempose.shape_spaces.edge_dihedral.hinges import find_hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals
from tempose.shape_spaces.edge_dihedral.parts import rigid_fit, steady_weights
from tempose.shape_spaces.edge_dihedral.pinches import split_pinches
from tempose.typing import FloatArray, IntArray

_SAMPLES = 48


@dataclass(frozen=True, eq=False)
class Reference:
    """Reference mesh of a shape space, the same arrays that are saved."""

    vertices: FloatArray
    """(n', 3) metres: rest, turned to the mean rotation of the clip, with the copies of `split_pinches`."""
    faces: IntArray
    """(m, 3) int64, of the mesh with copies."""
    lengths: FloatArray
    """(E,) metres: mean over the clip."""
    dihedrals: FloatArray
    """(n_slots,) radians: circular mean over the clip; angles of single meshes lie within pi of it."""
    spread: FloatArray
    """(n_slots,) radians squared: circular variance of the angles over the clip, 0 without a clip."""
    steadiness: FloatArray
    """(n',) weight of each vertex in the frame of its part."""
    source: IntArray
    """(n',) int64: which vertex of the mesh each one is a copy of."""

    @property
    def n_vertices(self) -> int:
        """Number n of vertices of the mesh, copies not counted."""
        return int(self.source[-1]) + 1

    def state(self) -> dict[str, FloatArray]:
        """Return the arrays by name.

        Returns
        -------
        dict of str to ndarray
            One entry a field, float64.
        """
        return {field.name: np.array(getattr(self, field.name), dtype=np.float64) for field in fields(self)}

    @classmethod
    def from_state(cls, state: Mapping[str, FloatArray]) -> Reference:
        """Make the reference that was saved.

        Parameters
        ----------
        state : mapping of str to ndarray
            As `state` gave it.

        Returns
        -------
        Reference
            The same arrays.

        Raises
        ------
        ValueError
            If an array is missing.
        """
        state = {
            "source": np.arange(len(state.get("vertices", ())), dtype=np.float64),
            **state,
        }  # as all once were
        missing = [field.name for field in fields(cls) if field.name not in state]
        if missing:
            raise ValueError(f"state must hold {', '.join(missing)}, found {', '.join(state) or 'nothing'}")
        kinds = {"faces": np.int64, "source": np.int64}
        arrays = {
            field.name: np.array(state[field.name], dtype=kinds.get(field.name, np.float64))
            for field in fields(cls)
        }
        return cls(**{name: read_only(array) for name, array in arrays.items()})


def make_reference(rest: FloatArray, faces: IntArray, frames: FloatArray | None) -> Reference:
    """Measure a mesh and its clip.

    Parameters
    ----------
    rest : (n, 3) float
        Rest vertices, metres.
    faces : (m, 3) int
        Faces.
    frames : (T, n, 3) float, optional
        Clip or poses; of a long clip 48 frames are read.

    Returns
    -------
    Reference
        What the space counts from.

    Raises
    ------
    ValueError
        If there is no face, a face names a vertex twice, an edge has no length, or a shape is wrong.
    """
    V = as_floats(rest, "rest", ("n", 3))
    F = check_faces(faces, len(V))
    poses = sample_poses(V, frames)
    F, source = split_pinches(F, len(V))
    V, poses = V[source], poses[:, source]
    hinges = find_hinges(F)
    lengths, sines, cosines = 0.0, 0.0, 0.0
    for X in poses:
        measured, angles = lengths_and_dihedrals(X, F, hinges)
        lengths = lengths + measured / len(poses)
        sines, cosines = sines + np.sin(angles), cosines + np.cos(angles)
    weights = steady_weights(V, F, poses)
    turned = _turned_to_mean(V, poses, weights)
    together = np.hypot(sines, cosines) / len(poses)
    spread = -2 * np.log(np.clip(together, 1e-6, 1.0))
    arrays = (turned, F, np.asarray(lengths), np.arctan2(sines, cosines), spread, weights, source)
    return Reference(*(read_only(np.array(array)) for array in arrays))


def check_faces(faces: IntArray, n: int) -> IntArray:
    """Check that faces are triangles of three vertices each.

    Parameters
    ----------
    faces : (m, 3) int
        Faces.
    n : int
        Number of vertices.

    Returns
    -------
    (m, 3) ndarray of int64
        The same faces.

    Raises
    ------
    ValueError
        If there is none, an index is out of range, or a face names a vertex twice.
    """
    F = as_indices(faces, "faces", ("m", 3), limit=n).astype(np.int64)
    if len(F) == 0:
        raise ValueError("faces must hold at least one face: this shape space measures edges; use 'vertex'")
    twice = np.flatnonzero((F == np.roll(F, 1, axis=1)).any(axis=1))
    if len(twice):
        raise ValueError(
            f"faces must name three vertices each, got {F[twice[0]].tolist()} at index {twice[0]} "
            f"(and {len(twice) - 1} more); remove such faces, or use space 'vertex'"
        )
    return F


def sample_poses(rest: FloatArray, frames: FloatArray | None) -> FloatArray:
    """Choose the meshes that a reference is measured on.

    Parameters
    ----------
    rest : (n, 3) float
        Rest vertices, metres.
    frames : (T, n, 3) float, optional
        Clip or poses.

    Returns
    -------
    (k, n, 3) ndarray of float64
        At most 48 of the frames, evenly spread; rest alone without frames.

    Raises
    ------
    ValueError
        If the frames have another shape or hold NaN.
    """
    n = len(rest)
    if frames is None:
        return np.asarray(rest, dtype=np.float64)[None]
    if np.ndim(frames) != 3 or np.shape(frames)[1:] != (n, 3) or len(frames) == 0:
        raise ValueError(f"frames must have shape (T, {n}, 3) with T > 0, got {np.shape(frames)}")
    at = np.unique(np.linspace(0, len(frames) - 1, min(_SAMPLES, len(frames))).round().astype(int))
    return as_floats(np.stack([np.asarray(frames[t], dtype=np.float64) for t in at]), "frames", ("T", n, 3))


def _turned_to_mean(V: FloatArray, poses: FloatArray, weights: FloatArray) -> FloatArray:
    if len(poses) == 1 and np.array_equal(poses[0], V):
        return V
    turns = np.stack([from_matrix(rigid_fit(V, X, weights)[0]) for X in poses])
    return V @ to_matrix(mean_rotation(turns)).T
