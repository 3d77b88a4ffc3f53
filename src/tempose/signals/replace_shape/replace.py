"""A clip's motion on another mesh by pairs of example poses (section 4.3 of the paper)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, MeshClip
from tempose.curves import interpolating_spline
from tempose.shape_spaces import shape_space
from tempose.signals.placement import placed, placement_spline
from tempose.signals.pose.fit import fit_pose_signal
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.replace_shape.mixtures import Mixtures, best_mixtures
from tempose.signals.replace_shape.poses import PoseSet, as_poses
from tempose.signals.replace_shape.reading import PoseReader
from tempose.signals.shape.examples import shape_from_examples
from tempose.signals.signals import Signals
from tempose.signals.windows.pose import WindowedPose
from tempose.typing import FloatArray

ILL_CONDITIONED = 1e8
"""Beyond this some poses are nearly mixtures of others, and multiples of them grow without meaning."""


@dataclass(frozen=True, eq=False)
class ShapeTransfer:
    """A clip on another mesh, and how far to trust it."""

    signals: Signals
    """Playing the target."""
    mixtures: Mixtures
    """The frames of the clip in terms of the source poses."""
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
    count = _check_poses(signals, q, r, use)
    name = space or signals.shape.space.name
    bodies, centre = q.aligned()
    reader = PoseReader(shape_space(name, bodies[0], q.mesh.faces, bodies), bodies)
    ticks = _path_ticks(signals)
    products, placements = reader.read(_unedited(signals, ticks))
    mixtures = best_mixtures(products, count, ridge)
    bodies, centre_r = r.aligned()
    space_r = shape_space(name, bodies[0], r.mesh.faces, bodies)
    placements[:, 4:] = centre_r + _travel_scale(scale, q, r) * (placements[:, 4:] - centre)
    new = replace(
        signals,
        shape=shape_from_examples(space_r, space_r.encode(bodies[list(mixtures.used)])),
        path=None if signals.path is None else interpolating_spline(ticks, mixtures.coordinates),
        pose=_replaced_pose(signals, reader, mixtures, ridge),
        placement=placement_spline(placements, ticks),
        mesh=r.mesh,
    )
    return ShapeTransfer(new, mixtures, _warnings(mixtures, q, r, scale))


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


def _replaced_pose(signals: Signals, reader: PoseReader, mixtures: Mixtures, ridge: float) -> Any:
    # a pose signal is known by its values at its sites: these are shown, read as mixtures, and refitted
    def replaced(pose: PoseSignal) -> PoseSignal:
        products, _ = reader.read(signals.shape.vertices(pose(pose.sites)))
        return fit_pose_signal(pose.sites, products.mix(mixtures.used, ridge).coordinates, pose.sites)

    pose = signals.pose
    if isinstance(pose, WindowedPose):
        return replace(pose, windows=tuple(replaced(window) for window in pose.windows))
    return replaced(pose)


def _warnings(mixtures: Mixtures, q: PoseSet, r: PoseSet, scale: float | str) -> tuple[str, ...]:
    found = [
        f"{len(mixtures.used)} of {len(q)} pairs used ({', '.join(map(str, mixtures.used))}); their mixtures "
        f"leave {mixtures.residual:.2f} of the motion's spread (rms) that they cannot show"
    ]
    if mixtures.condition > ILL_CONDITIONED:
        found.append(
            f"the poses are nearly mixtures of one another (condition {mixtures.condition:.1e}): leave one "
            "out or give a ridge such as 0.001"
        )
    ratio = r.mesh.diagonal / q.mesh.diagonal
    if scale == 1 and not 2 / 3 < ratio < 1.5:
        found.append(
            f'the target is {ratio:.3g} times as large and travels as far; "scale": "size" changes that'
        )
    return tuple(found)
