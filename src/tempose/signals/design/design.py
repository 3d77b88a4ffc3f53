"""A clip from nothing but poses, places for them and a drawn curve (section 4.4 of the paper)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tempose._validate import as_floats
from tempose.clips import Mesh, MeshClip
from tempose.curves import MonotoneMap, Spline
from tempose.shape_spaces import shape_space
from tempose.signals.pose.fit import fit_pose_signal
from tempose.signals.replace_shape.poses import PoseSet, as_poses
from tempose.signals.shape.fit import fit_shape
from tempose.signals.signals import Signals
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray


def design(
    poses: PoseSet | MeshClip | Sequence[Mesh],
    places: Sequence[Sequence[float]] | FloatArray,
    curve: Sequence[Sequence[float]] | FloatArray,
    fps: float = 30.0,
    seconds: float = 2.0,
    *,
    space: str = "gradient",
    closed: bool = False,
    align: bool = False,
) -> Signals:
    """Make a clip by drawing a curve through poses laid out by hand.

    Parameters
    ----------
    poses : PoseSet, MeshClip or sequence of Mesh
        N poses of one mesh, N >= 2.
    places : (N, 2) float
        Where they lie in the pose plane, no two at one place.
    curve : (k, 2) float
        Control points of the curve. It begins at the first and ends at the last, k >= 4; a closed one comes
        back, k >= 3.
    fps : float, default 30
        Frames a second.
    seconds : float, default 2
        How long the curve takes from begin to end; of a closed one, once round.
    space : str, default "gradient"
        Name of the shape space in which poses are mixed.
    closed : bool, default False
        Whether the curve is closed.
    align : bool, default False
        Whether to turn and move the poses so that they agree as well as they can.

    Returns
    -------
    Signals
        Playing ``h(g(f))`` alone, as in the paper; at the place of a pose the curve shows that pose.

    Raises
    ------
    ValueError
        If there are too few poses or points, not as many places as poses, or two at one place.

    Notes
    -----
    The knots of the curve are uniform, as is its pace.
    """
    given = as_poses(poses, "poses")
    places = _checked_places(places, len(given))
    points = as_floats(curve, "curve", ("k", 2))
    for name, value in (("fps", fps), ("seconds", seconds)):
        if isinstance(value, bool) or not 0 < value < math.inf:
            raise ValueError(f"{name} must be positive, got {value!r}")
    spline = _closed_curve(points) if closed else _open_curve(points)
    bodies, centre = given.aligned()
    V = bodies + centre if align else given.vertices
    shapes = shape_space(space, V[0], given.mesh.faces, V)
    fitted = fit_shape(shapes, shapes.encode(V), None, 0.0, 1.0)
    pose = fit_pose_signal(places, fitted.X, places)
    first, last = spline.domain
    ends = np.array([0.0, seconds * fps])
    pace = MonotoneMap(ends, np.array([first, last]), np.full(2, (last - first) / ends[1]))
    time = TimeSignal(spline, spline, pace)
    return Signals(fitted.shape, pose, time, None, None, (), float(fps), float(fps), given.mesh)


def _checked_places(places: Sequence[Sequence[float]] | FloatArray, n: int) -> FloatArray:
    checked = as_floats(places, "places", ("N", 2))
    if n < 2:
        raise ValueError(f"poses must hold two or more, got {n}")
    if len(checked) != n:
        raise ValueError(f"places must hold one place for each of the {n} poses, got {len(checked)}")
    gaps = np.linalg.norm(checked[:, None] - checked[None], axis=2)
    i, j = np.nonzero(np.triu(gaps <= 1e-9 * gaps.max(), 1))
    if len(i):
        raise ValueError(f"places must differ, those of poses {i[0]} and {j[0]} are {checked[i[0]].tolist()}")
    return checked


def _open_curve(points: FloatArray) -> Spline:
    if len(points) < 4:
        raise ValueError(
            f"curve must hold 4 or more control points, got {len(points)}; a closed one 3 or more"
        )
    inner = np.arange(len(points) - 2, dtype=np.float64)
    return Spline(np.concatenate([[0.0] * 3, inner, [inner[-1]] * 3]), points)


def _closed_curve(points: FloatArray) -> Spline:
    if len(points) < 3:
        raise ValueError(f"a closed curve must hold 3 or more control points, got {len(points)}")
    wrapped = np.concatenate([points, points[:3]])
    return Spline(np.arange(-3.0, len(wrapped) + 1), wrapped)
