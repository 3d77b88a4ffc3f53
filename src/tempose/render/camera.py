"""A pinhole or parallel camera, and where to put it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Camera:
    """Where the picture is taken from; it looks along minus its third axis."""

    position: FloatArray
    """(3,) float64, metres: the eye. A parallel camera sees things behind it too."""
    axes: FloatArray
    """(3, 3) float64, orthonormal rows: right, up and backwards (towards the viewer), in the world."""
    fov: float = np.radians(30.0)
    """Vertical angle of view in radians; 0 for a parallel (orthographic) camera."""
    half_height: float = 1.0
    """Half of the visible height in metres; of a parallel camera only."""

    def __post_init__(self) -> None:
        position = as_floats(self.position, "position", (3,))
        axes = as_floats(self.axes, "axes", (3, 3))
        if np.abs(axes @ axes.T - np.eye(3)).max() > 1e-6 or np.linalg.det(axes) < 0:
            raise ValueError("axes must be orthonormal and right-handed rows: right, up, backwards")
        if not 0 <= self.fov < np.pi:
            raise ValueError(f"fov must be an angle in radians from 0 to below pi, got {self.fov}")
        if not 0 < self.half_height < float("inf"):
            raise ValueError(f"half_height must be a positive number of metres, got {self.half_height}")
        object.__setattr__(self, "position", read_only(position))
        object.__setattr__(self, "axes", read_only(axes))

    @classmethod
    def fit(
        cls,
        points: Any,
        azimuth: float = 0.0,
        elevation: float = 0.0,
        fov: float = np.radians(30.0),
        *,
        aspect: float = 1.0,
        margin: float = 0.08,
    ) -> Camera:
        """Look from a direction at some points, as near as possible.

        Parameters
        ----------
        points : (k, 3) array_like
            What must be seen, metres; the two corners of a box stand for all eight.
        azimuth : float, default 0
            Radians about Y: 0 looks at the front (from +Z), pi / 2 at the left side (from +X).
        elevation : float, default 0
            Radians above the horizon.
        fov : float, default 30 degrees
            Vertical angle of view in radians; 0 for a parallel camera.
        aspect : float, default 1
            Width of the picture over its height.
        margin : float, default 0.08
            Empty border, as a share of the half picture.

        Returns
        -------
        Camera
            The nearest camera whose picture holds every point.

        Raises
        ------
        ValueError
            If `points` is empty, not finite or of another shape.
        """
        P = box_corners(as_floats(points, "points", ("k", 3)))
        axes = axes_towards(azimuth, elevation)
        Q = P @ axes.T
        size = max(float(np.ptp(Q, axis=0).max()), 1e-6)
        if fov == 0:
            low, high = Q.min(axis=0), Q.max(axis=0)
            half = max((high[1] - low[1]) / 2, (high[0] - low[0]) / 2 / aspect, 1e-6) / (1 - margin)
            eye = np.array([*((low + high) / 2)[:2], high[2] + size])
            return cls(eye @ axes, axes, 0.0, float(half))
        ty = np.tan(fov / 2) * (1 - margin)
        x, zx = _apex(Q[:, 0], Q[:, 2], ty * aspect)
        y, zy = _apex(Q[:, 1], Q[:, 2], ty)
        eye = np.array([x, y, max(zx, zy, Q[:, 2].max() + 1e-3 * size)])
        return cls(eye @ axes, axes, fov)

    def moved(self, offset: Any) -> Camera:
        """Return the same camera elsewhere.

        Parameters
        ----------
        offset : (3,) array_like
            By how much, metres.

        Returns
        -------
        Camera
            Looking in the same direction.
        """
        return replace(self, position=self.position + as_floats(offset, "offset", (3,)))

    def project(self, points: Any, size: tuple[int, int]) -> FloatArray:
        """Project points into a picture.

        Parameters
        ----------
        points : (k, 3) array_like
            Metres.
        size : (int, int)
            Width and height of the picture, pixels.

        Returns
        -------
        (k, 3) ndarray of float64
            x to the right and y downwards in pixels from the upper left corner (pixel 0 has its centre
            at 0.5), and the distance before the eye along the line of sight in metres.
        """
        Q = (as_floats(points, "points", ("k", 3)) - self.position) @ self.axes.T
        depth = -Q[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = self.pixels_per_metre(size) / (depth if self.fov else np.ones_like(depth))
            return np.column_stack([size[0] / 2 + scale * Q[:, 0], size[1] / 2 - scale * Q[:, 1], depth])

    def pixels_per_metre(self, size: tuple[int, int]) -> float:
        """Return the scale of the picture at one metre from the eye (anywhere, for a parallel camera).

        Parameters
        ----------
        size : (int, int)
            Width and height of the picture, pixels.

        Returns
        -------
        float
            Pixels per metre.
        """
        return size[1] / 2 / (np.tan(self.fov / 2) if self.fov else self.half_height)


def axes_towards(azimuth: float, elevation: float) -> FloatArray:
    """Return the axes of a camera that sits in a direction and looks back at the origin.

    Parameters
    ----------
    azimuth, elevation : float
        Radians, as in `Camera.fit`.

    Returns
    -------
    (3, 3) ndarray of float64
        Orthonormal rows: right, up, backwards.
    """
    ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
    return np.array([[ca, 0.0, -sa], [-sa * se, ce, -ca * se], [sa * ce, se, ca * ce]])


def box_corners(points: FloatArray) -> FloatArray:
    """Return the eight corners of a box given by two, and any other points as they are.

    Parameters
    ----------
    points : (k, 3) ndarray
        Metres.

    Returns
    -------
    (k or 8, 3) ndarray
        Points.

    Raises
    ------
    ValueError
        If there are none.
    """
    if len(points) == 0:
        raise ValueError("points must hold at least one point to look at, got none")
    if len(points) != 2:
        return points
    return np.array([[x, y, z] for x in points[:, 0] for y in points[:, 1] for z in points[:, 2]])


def _apex(x: FloatArray, z: FloatArray, slope: float) -> tuple[float, float]:
    # The lowest wedge |x - ex| <= (ez - z) * slope over all points: two lines, one from each side.
    a, b = float((z + x / slope).max()), float((z - x / slope).max())
    return slope * (a - b) / 2, (a + b) / 2
