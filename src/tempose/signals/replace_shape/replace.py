"""A clip's motion on another mesh by pairs of example poses (section 4.3 of the paper)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.curves import interpolating_spline
from tempose.shape_spaces import GradientSpace, ShapeSpace, VertexSpace, shape_space
from tempose.signals.placement import placed, placement_spline
from tempose.signals.pose.fit import fit_pose_signal
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.replace_shape.local import LocalMap, fit_local_map
from tempose.signals.replace_shape.mixtures import Mixtures, best_mixtures
from tempose.signals.replace_shape.notes import transfer_notes
from tempose.signals.replace_shape.poses import PoseSet, as_poses
from tempose.signals.replace_shape.reading import PoseReader, Reading
from tempose.signals.replace_shape.regions import regions_of
from tempose.signals.replace_shape.synthesis import RegionalShapes
from tempose.signals.shape.examples import shape_from_examples
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.signals import Signals
from tempose.signals.windows.pose import WindowedPose
from tempose.typing import FloatArray

REGIONS = 60
"""Regions of a mesh where the user names no number: a body's limbs get a few each."""

LEAST_PAIRS = 4
"""Fewer pairs cannot tell which regions move alike."""


@dataclass(frozen=True, eq=False)
class ShapeTransfer:
    """A clip on another mesh, and how far to trust it."""

    signals: Signals
    """Playing the target."""
    mixtures: Mixtures
    """The frames of the clip in terms of the source poses."""
    local: LocalMap | None
    """How regions of the target follow regions of the source; None: the mesh has one set of multiples."""
    warnings: tuple[str, ...]
    """What a person should know."""


def replace_shape(
    signals: Signals,
    source: PoseSet | MeshClip | Sequence[Mesh],
    target: PoseSet | MeshClip | Sequence[Mesh],
    *,
    space: str | None = None,
    use: int | None = None,
    ridge: float = 0.0,
    scale: float | str = 1.0,
    regions: int | None = None,
) -> ShapeTransfer:
    """Replace the shape signal by one of another mesh, through pairs of example poses.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    source, target : PoseSet, MeshClip or sequence of Mesh
        Pose i of the clip's mesh looks as pose i of the target does; the target may have any vertices and
        faces. The first pair is the reference.
    space : str, optional
        Name of the shape space for both; that of the clip by default.
    use : int, optional
        How many pairs to use: those by which the clip is told best. All by default.
    ridge : float, default 0
        Relative to the mean diagonal of the normal equation; above 0 the motion is damped.
    scale : float or "size", default 1
        How many times as far the target travels; ``"size"``: the ratio of the reference poses' diagonals.
    regions : int, optional
        In how many regions source and target are compared, each region of the target with multiples of its
        own; 0 is the paper: one set of multiples for the whole mesh. By default 60, and 0 for fewer than
        4 pairs or a space whose coordinates are not local.

    Returns
    -------
    ShapeTransfer
        The time signal is the same; path and pose signal run over multiples of poses.

    Raises
    ------
    ValueError
        If there are not as many source as target poses, fewer than two, poses that are mixtures of
        others, or the source poses are not of the clip's mesh.

    Notes
    -----
    Both sets of poses are aligned separately by generalised Procrustes, and every frame of the clip to the
    mean of the source poses. The frames become ``q_0 + sum_j x_j (q_j - q_0)`` by the normal equation
    ``H^T H X = H^T Y^T``, and ``r_0 + sum_j x_j (r_j - r_0)`` of the target shows them; then it is moved as
    the frame was.

    References
    ----------
    .. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with
       separate signals for time, pose and shape", Computer Graphics Forum 31, 2012, section 4.3.
    .. [2] Baran, Vlasic, Grinspun and Popovic, "Semantic deformation transfer", SIGGRAPH 2009.
    """
    q, r = as_poses(source, "source"), as_poses(target, "target")
    count, travel = _check_poses(signals, q, r, use), _travel_scale(scale, q, r)
    name = space or signals.shape.space.name
    bodies, centre = q.aligned()
    space_q = shape_space(name, bodies[0], q.mesh.faces, bodies)
    wanted = _regions_wanted(regions, count, space_q)
    covered = regions_of(space_q, bodies[0], q.mesh.faces, wanted) if wanted else None
    reader = PoseReader(space_q, bodies, covered)
    ticks = _path_ticks(signals)
    captured = reader.read(_unedited(signals, ticks))
    mixtures = best_mixtures(captured.products, count, ridge)
    readings = [captured, *(reader.read(V) for V in _site_meshes(signals))]
    bodies, centre_r = r.aligned()
    space_r = shape_space(name, bodies[0], r.mesh.faces, bodies)
    if covered is None:
        shape, X = _as_a_whole(readings, mixtures, ridge, space_r, bodies)
        local = None
    else:
        covered_r = regions_of(space_r, bodies[0], r.mesh.faces, wanted)
        shape, X, local = _by_regions(readings, reader, mixtures, space_r, bodies, covered_r)
    placements = captured.placements
    placements[:, 4:] = centre_r + travel * (placements[:, 4:] - centre)
    new = replace(
        signals,
        shape=shape,
        path=None if signals.path is None else interpolating_spline(ticks, X[0]),
        pose=_replaced_pose(signals.pose, X[1:]),
        placement=placement_spline(placements, ticks),
        mesh=r.mesh,
    )
    return ShapeTransfer(new, mixtures, local, transfer_notes(mixtures, local, q, r, scale))


def _as_a_whole(
    readings: list[Reading], mixtures: Mixtures, ridge: float, space: ShapeSpace, bodies: FloatArray
) -> tuple[ShapeSignal, list[FloatArray]]:
    shape = shape_from_examples(space, space.encode(bodies[list(mixtures.used)]))
    return shape, [reading.products.mix(mixtures.used, ridge).coordinates for reading in readings]


def _by_regions(
    readings: list[Reading],
    reader: PoseReader,
    mixtures: Mixtures,
    space: ShapeSpace,
    bodies: FloatArray,
    regions: Any,
) -> tuple[ShapeSignal, list[FloatArray], LocalMap]:
    used = np.array(mixtures.used)
    R = space.encode(bodies[used])
    local = fit_local_map(reader.pose_products()[:, used][:, :, used], regions.products(R - R[0], R - R[0]))
    multiples = [local.multiples(reading.regional[:, :, used]) for reading in readings]
    shape, X = RegionalShapes(space, regions, R).signal(np.concatenate(multiples, axis=1))
    ends = np.cumsum([a.shape[1] for a in multiples])[:-1]
    return shape, np.split(X, ends), local


def _regions_wanted(regions: int | None, count: int, space: ShapeSpace) -> int:
    able = isinstance(space, VertexSpace | GradientSpace)
    if regions is None:
        return REGIONS if able and count >= LEAST_PAIRS else 0
    if regions < 0 or regions == 1:
        raise ValueError(f"regions must be 0 or 2 or more, got {regions}")
    if regions and not able:
        raise ValueError(f"regions need the space vertex or gradient, got {space.name}")
    if regions and count < LEAST_PAIRS:
        raise ValueError(f"regions need {LEAST_PAIRS} pairs or more, got {count}")
    return regions


def _check_poses(signals: Signals, q: PoseSet, r: PoseSet, use: int | None) -> int:
    if len(q) != len(r):
        raise ValueError(f"source and target must hold the same poses in pairs, got {len(q)} and {len(r)}")
    if len(q) < 2:
        raise ValueError("source and target must hold two poses or more, got one")
    n, m = len(signals.mesh.vertices), len(signals.mesh.faces)
    if (q.vertices.shape[1], len(q.mesh.faces)) != (n, m):
        raise ValueError(
            f"source must hold poses of the clip's mesh, {n} vertices and {m} faces, got "
            f"{q.vertices.shape[1]} and {len(q.mesh.faces)}"
        )
    if use is not None and not 2 <= use <= len(q):
        raise ValueError(f"use must be from 2 to {len(q)} pairs, got {use}")
    return len(q) if use is None else use


def _travel_scale(scale: float | str, q: PoseSet, r: PoseSet) -> float:
    if scale == "size":
        return r.mesh.diagonal / q.mesh.diagonal
    if isinstance(scale, str) or isinstance(scale, bool) or not 0 < scale < math.inf:
        raise ValueError(f'scale must be a positive number or "size", got {scale!r}')
    return float(scale)


def _path_ticks(signals: Signals) -> FloatArray:
    if signals.path is not None:
        return np.unique(signals.path.knots)
    first, last = signals.time.pace.domain
    return np.linspace(first, last, round(last - first) + 1)


def _unedited(signals: Signals, ticks: FloatArray) -> FloatArray:
    # what was captured, in the world: edits of the curve come on top of it, whatever mesh plays them
    if signals.path is not None:
        x = signals.path(ticks)
    else:
        captured = ticks if signals.origin is None else signals.origin(ticks)
        x = signals.pose(signals.time.before_edits(ticks), captured)
    return placed(signals.shape.vertices(x), signals.placement, ticks)


def _site_meshes(signals: Signals) -> list[FloatArray]:
    # a pose signal is known by its values at its sites: these are shown, read as mixtures, and refitted
    return [signals.shape.vertices(pose(pose.sites)) for pose in _windows(signals.pose)]


def _windows(pose: Any) -> tuple[PoseSignal, ...]:
    return pose.windows if isinstance(pose, WindowedPose) else (pose,)


def _replaced_pose(pose: Any, X: list[FloatArray]) -> Any:
    fitted = tuple(fit_pose_signal(g.sites, x, g.sites) for g, x in zip(_windows(pose), X))
    return replace(pose, windows=fitted) if isinstance(pose, WindowedPose) else fitted[0]
