"""Gaussian curvature of the surface of poses."""

from __future__ import annotations

import numpy as np

from tempose.signals.pose.signal import PoseSignal
from tempose.typing import FloatArray


def gaussian_curvature(pose: PoseSignal, p: FloatArray) -> FloatArray:
    """Return the Gaussian curvature of the surface ``g(plane)`` in the space of shape coordinates.

    Parameters
    ----------
    pose : PoseSignal
        The pose signal g.
    p : (..., 2) float
        Places in the pose plane, none of them a site.

    Returns
    -------
    (...) ndarray
        ``(II_11 . II_22 - II_12 . II_12) / det I``, II the part of the second derivatives normal to the
        surface; 0 where the surface has no tangent plane. Negative values are saddles. The paper hopes that
        they point out bad transitions; measured, they do not: use `find_bad_transitions`.
    """
    J, H = pose.jacobian(p), pose.second_derivatives(p)
    metric = np.swapaxes(J, -1, -2) @ J
    det = np.linalg.det(metric)
    # det I of a degenerate tangent plane is rounding
    flat = det <= 1e-14 * np.square(np.trace(metric, axis1=-2, axis2=-1))
    safe = np.where(flat[..., None, None], np.eye(2), metric)
    second = H.reshape(*H.shape[:-2], 4)
    normal = second - J @ np.linalg.solve(safe, np.swapaxes(J, -1, -2) @ second)
    xx, xy, yy = normal[..., 0], normal[..., 1], normal[..., 3]
    curvature = (xx * yy).sum(axis=-1) - (xy * xy).sum(axis=-1)
    return np.where(flat, 0.0, curvature / np.where(flat, 1.0, det))
