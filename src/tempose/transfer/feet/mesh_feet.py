"""Feet of meshes without bones: what is low in both rest poses."""

from __future__ import annotations

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage

from tempose.metrics import detect_contacts
from tempose.transfer.feet.contacts import steady_contacts
from tempose.transfer.feet.feet import NEAR_GROUND, Feet, ground_levels, no_feet
from tempose.transfer.feet.legs import mesh_leg
from tempose.typing import FloatArray, IntArray

_FOOT_GAP = 0.06
"""Low pairs of a mesh nearer than this share of its height are one foot: left and right are further apart."""


def mesh_feet(
    V: FloatArray,
    V_rest: FloatArray,
    source: IntArray,
    V_target: FloatArray,
    F_target: IntArray,
    target: IntArray,
    fps: float,
) -> Feet:
    """Feet of two meshes: clusters of paired vertices that lie near the ground in both rest poses.

    Parameters
    ----------
    V : (T, n, 3) float
        Source frames.
    V_rest : (n, 3) float
        Source at rest.
    source : (k,) int
        Paired source vertices.
    V_target : (n2, 3) float
        Target at rest.
    F_target : (m2, 3) int
        Its faces.
    target : (k,) int
        Paired target vertices.
    fps : float
        Frames per second.

    Returns
    -------
    Feet
        Possibly none.
    """
    height, height2 = float(np.ptp(V_rest[:, 1])), float(np.ptp(V_target[:, 1]))
    low = V_rest[source, 1] < V_rest[:, 1].min() + NEAR_GROUND * height
    low &= V_target[target, 1] < V_target[:, 1].min() + 2 * NEAR_GROUND * height2
    chosen = np.flatnonzero(low)
    if len(chosen) == 0:
        return no_feet(len(V))
    labels = np.ones(1, dtype=int)
    if len(chosen) > 1:
        labels = fcluster(linkage(V_rest[source[chosen]], "single"), _FOOT_GAP * height, "distance")
    points: list[FloatArray] = []
    vertices: list[IntArray] = []
    for label in np.unique(labels):
        mine = chosen[labels == label]
        points.append(np.asarray(V[:, source[mine]], dtype=np.float64).mean(axis=1))
        middle = V_target[target[mine]].mean(axis=0)
        close = np.linalg.norm(V_target - middle, axis=1) < 0.1 * height2
        foot = np.flatnonzero(close & (V_target[:, 1] < middle[1] + 0.05 * height2))
        vertices.append(foot if len(foot) else np.unique(target[mine]))
    trajectories = np.stack(points, axis=1)
    names = tuple(f"foot {i + 1}" for i in range(len(points)))
    every = np.concatenate(vertices)
    legs = tuple(mesh_leg(V_target, foot, np.setdiff1d(every, foot)) for foot in vertices)
    return Feet(
        names,
        trajectories,
        tuple(vertices),
        detect_contacts(trajectories, height, fps),
        legs,
        trajectories,
        steady_contacts([trajectories], height, fps),
        ground_levels(trajectories, height),
    )
