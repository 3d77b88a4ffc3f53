"""Everything that comes before the frames, for either kind of source."""

from __future__ import annotations

from typing import get_args

import numpy as np

from tempose.clips import Mesh, MeshClip, SkeletonClip
from tempose.transfer.from_mesh import prepare_mesh
from tempose.transfer.from_skeleton import Prepared, prepare_skeleton
from tempose.transfer.lead import LEAD
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.turns.references import Singular
from tempose.typing import FloatArray


def prepare(
    source: SkeletonClip | MeshClip,
    mesh: Mesh,
    pairs: Pairs,
    *,
    mapping: dict[str, str] | None = None,
    rest: SkeletonClip | Mesh | None = None,
    rest_frame: int | None = None,
    volume: float = 0.0,
    twist: bool = True,
    lead: float = LEAD,
    singular: Singular = "reference",
) -> Prepared:
    """Do everything that comes before the frames, for either kind of source.

    Parameters
    ----------
    source : SkeletonClip or MeshClip
        The motion.
    mesh : Mesh
        Target at rest.
    pairs : Pairs
        Checked.
    mapping : dict of str to str, optional
        Source joint to body role.
    rest : SkeletonClip or Mesh, optional
        Where the source's reference pose stands, if not in the source.
    rest_frame : int, optional
        Frame of the reference pose, in `rest` or else in the source.
    volume : float, default 0
        See `MotionTransfer`.
    twist : bool, default True
        See `prepare_skeleton`; means nothing to a mesh source, nor do the next two.
    lead : float, default 0.6
        See `prepare_skeleton`.
    singular : {"reference", "path", "none"}, default "reference"
        See `prepare_skeleton`.

    Returns
    -------
    Prepared
        Solver, rotations and paths.

    Raises
    ------
    ValueError
        If the reference pose is not of the source's kind or has no such frame, or an option no such value.
    """
    _check_options(volume, lead, singular)
    if isinstance(source, SkeletonClip):
        if isinstance(rest, Mesh):
            raise ValueError("source_rest must be a motion clip of the same skeleton, got a mesh")
        return prepare_skeleton(
            source,
            mesh,
            pairs,
            mapping=mapping,
            rest_clip=rest,
            rest_frame=rest_frame,
            volume=volume,
            twist=twist,
            lead=lead,
            singular=singular,
        )
    if isinstance(rest, SkeletonClip):
        raise ValueError("source_rest must be a mesh like the source, got a skeleton clip")
    return prepare_mesh(source, mesh, pairs, rest=_mesh_rest(source, rest, rest_frame), volume=volume)


def _check_options(volume: float, lead: float, singular: str) -> None:
    if singular not in get_args(Singular):
        raise ValueError(f"singular must be one of {', '.join(get_args(Singular))}, got {singular!r}")
    if not 0 <= lead <= 1:
        raise ValueError(f"lead must be a share from 0 to 1, got {lead}")
    if not 0 <= volume < np.inf:
        raise ValueError(f"volume must be 0 or more, got {volume}")


def _mesh_rest(source: MeshClip, rest: Mesh | None, frame: int | None) -> FloatArray | None:
    if rest is not None:
        n = source.vertices.shape[1]
        if len(rest.vertices) != n:
            raise ValueError(
                f"source_rest must have the {n} vertices of the source, got {len(rest.vertices)}"
            )
        return rest.vertices
    if frame is None:
        return None
    if not 0 <= frame < source.n_frames:
        raise ValueError(f"source_rest must be a frame from 0 to {source.n_frames - 1}, got {frame}")
    return np.asarray(source.vertices[frame], dtype=np.float64)
