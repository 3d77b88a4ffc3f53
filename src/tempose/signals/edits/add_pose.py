"""A sculpted mesh given a place in the pose plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tempose._validate import as_floats
from tempose.clips import Mesh
from tempose.curves import Spline
from tempose.signals.placement import fit_placements, in_body
from tempose.signals.pose.fit import fit_pose_signal
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.examples import shape_coordinates
from tempose.signals.shape.signal import ShapeSignal
from tempose.signals.signals import Signals
from tempose.signals.windows.pose import WindowedPose
from tempose.typing import FloatArray

NOTHING_NEW = 1e-9
"""A mesh this near to the shape subspace, of its distance to the mean, needs no further component."""

TOO_NEAR = 1e-6
"""Places nearer than this part of the plane's radius are one place, which cannot have two poses."""


def add_pose(signals: Signals, mesh: Mesh | FloatArray, at: Sequence[float] | FloatArray) -> Signals:
    """Add a pose to the pose space; a curve that is moved there shows it.

    Parameters
    ----------
    signals : Signals
        What is edited; stays as it is.
    mesh : Mesh or (n, 3) float
        The pose, with the vertices of the clip's mesh, metres.
    at : (2,) float
        Its place in the pose plane.

    Returns
    -------
    Signals
        The pose signal has a site there, and keeps its values at all others; the shape signal has a component
        more, unless its mixtures show the pose already. With a path, frames whose curve nobody moved are the
        same bit for bit.

    Raises
    ------
    ValueError
        If the mesh has other vertices, or another pose has that place.
    """
    V = as_floats(mesh.vertices if isinstance(mesh, Mesh) else mesh, "mesh", ("n", 3))
    if len(V) != len(signals.mesh.vertices):
        raise ValueError(f"the pose must have {len(signals.mesh.vertices)} vertices, got {len(V)}")
    place = as_floats(at, "at", (2,))
    if signals.placement is not None:
        V = in_body(V, fit_placements(V[None], signals.shape.space.decode(signals.shape.mean), rounds=1)[0])
    shape, x = _with_component(signals.shape, signals.shape.space.encode(V))
    path = signals.path
    if path is not None:
        path = Spline(path.knots, _widened(path.controls, len(x)))
    if isinstance(signals.pose, WindowedPose):
        windows = tuple(_with_site(window, place, x) for window in signals.pose.windows)
        return replace(signals, shape=shape, path=path, pose=replace(signals.pose, windows=windows))
    return replace(signals, shape=shape, path=path, pose=_with_site(signals.pose, place, x))


def _with_component(shape: ShapeSignal, z: FloatArray) -> tuple[ShapeSignal, FloatArray]:
    x = shape_coordinates(shape, z) if len(shape.components) else np.zeros(0)
    left = z - shape.mean - x @ shape.components
    length = float(np.linalg.norm(left))
    if length <= NOTHING_NEW * float(np.linalg.norm(z - shape.mean)):
        return shape, x
    components = np.concatenate([shape.components, left[None] / length])
    return ShapeSignal(shape.space, shape.mean, components), np.append(x, length)


def _with_site(pose: PoseSignal, place: FloatArray, x: FloatArray) -> PoseSignal:
    gaps = np.linalg.norm(pose.sites - place, axis=1)
    if len(gaps) and gaps.min() <= TOO_NEAR * pose.radius:
        raise ValueError(
            f"at must be a place without a pose, got {np.round(place, 6).tolist()}, where one "
            "stands already; move it a little"
        )
    sites = np.concatenate([pose.sites, place[None]])
    values = np.concatenate([_widened(pose(pose.sites), len(x)), x[None]])
    return fit_pose_signal(sites, values, sites)


def _widened(values: FloatArray, m: int) -> FloatArray:
    return np.pad(values, ((0, 0), (0, m - values.shape[1])))
