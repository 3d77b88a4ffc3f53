"""Light from many directions, each with its own depth map: soft shadow, occlusion, no noise.

A surface point gathers light from a fixed set of directions, and is in the shadow of one when the depth map
drawn from there holds something nearer. The sky gives ambient occlusion, a narrow cone of directions
around the key light its soft shadow, the lower half sphere the light that the ground throws back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import read_only
from tempose.render.raster import fill, snapped
from tempose.typing import FloatArray, IntArray

KEY, SKY, BOUNCE = 0, 1, 2


@dataclass(frozen=True)
class Quality:
    """How much work goes into a picture."""

    samples: int
    """Samples per pixel along each axis."""
    key: int
    """Directions in the cone of the key light."""
    sky: int
    """Directions of the sky; a third as many come from below."""
    resolution: int
    """Pixels of a depth map along each axis."""

    def __post_init__(self) -> None:
        if self.samples < 1 or self.key < 1 or self.sky < 3 or self.resolution < 16:
            raise ValueError(f"a quality needs at least samples=1, key=1, sky=3, resolution=16, got {self}")


QUALITIES = {
    "draft": Quality(samples=1, key=2, sky=15, resolution=144),
    "good": Quality(samples=2, key=12, sky=42, resolution=256),
    "best": Quality(samples=3, key=32, sky=120, resolution=448),
}


def quality_named(quality: str | Quality) -> Quality:
    """Find a quality by name.

    Parameters
    ----------
    quality : str or Quality
        ``"draft"``, ``"good"``, ``"best"`` or one's own.

    Returns
    -------
    Quality
        The numbers.

    Raises
    ------
    ValueError
        If there is none of that name.
    """
    if isinstance(quality, Quality):
        return quality
    if quality not in QUALITIES:
        raise ValueError(f"quality must be one of {', '.join(QUALITIES)}, got {quality!r}")
    return QUALITIES[quality]


@dataclass(frozen=True, eq=False)
class Lights:
    """Directions of light, K of them, and what stands in their way."""

    directions: FloatArray
    """(K, 3) float64 unit vectors towards the light."""
    weights: FloatArray
    """(K,) float64; those of the key, and of the sky, light an open horizontal plane with 1."""
    kind: IntArray
    """(K,) int32: `KEY`, `SKY` or `BOUNCE`."""
    frames: FloatArray
    """(K, 2, 4) float64: u = frames[k, 0] . (x, y, z, 1) in depth-map pixels, and v."""
    maps: FloatArray
    """(K, R, R) float32: largest distance along the direction, minus infinity where nothing is."""
    texel: float
    """Metres of the widest depth-map pixel."""


def light_directions(key: FloatArray, quality: Quality) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return the directions light comes from.

    Parameters
    ----------
    key : (3,) float
        Unit vector towards the key light.
    quality : Quality
        How many.

    Returns
    -------
    directions : (K, 3) ndarray of float64
        Unit vectors.
    weights : (K,) ndarray of float64
        As in `Lights`.
    kind : (K,) ndarray of int32
        As in `Lights`.
    """
    cone = _cone(key, quality.key, half_angle=np.radians(7.0))
    sky = _half_sphere(quality.sky)
    below = _half_sphere(quality.sky // 3) * [1.0, -1.0, 1.0]
    weights = [
        np.full(len(cone), 1.0 / len(cone)),
        np.full(len(sky), 1.0 / sky[:, 1].sum()),
        np.full(len(below), 1.0 / -below[:, 1].sum()),
    ]
    kind = np.repeat([KEY, SKY, BOUNCE], [len(cone), len(sky), len(below)]).astype(np.int32)
    return np.concatenate([cone, sky, below]), np.concatenate(weights), kind


def make_lights(V: FloatArray, F: IntArray, key: FloatArray, quality: Quality) -> Lights:
    """Draw the depth maps of a mesh from every direction of light.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, metres.
    F : (m, 3) int
        Triangles.
    key : (3,) float
        Unit vector towards the key light.
    quality : Quality
        How many directions, and how fine.

    Returns
    -------
    Lights
        Ready for look-up.
    """
    directions, weights, kind = light_directions(key, quality)
    R = quality.resolution
    maps = np.full((len(directions), R, R), -np.inf, dtype=np.float32)
    frames = np.zeros((len(directions), 2, 4))
    Q = np.ascontiguousarray(V[np.unique(F)].T if len(F) else np.zeros((3, 1)))
    F = np.searchsorted(np.unique(F), F).astype(np.int32)
    texel, no_faces = 0.0, np.zeros((0, 0), dtype=np.int32)
    for k, d in enumerate(directions):
        u, v = _plane_axes(d)
        for axis, a in enumerate((u, v)):
            x = a @ Q
            # Two pixels of border: a look-up beyond the map is in the light.
            scale = (R - 4) / max(float(x.max() - x.min()), 1e-9)
            frames[k, axis] = [*(a * scale), 2.0 - float(x.min()) * scale]
            texel = max(texel, 1 / scale)
        on_map = frames[k, :, :3] @ Q + frames[k, :, 3:]
        fill(snapped(on_map[0]), snapped(on_map[1]), d @ Q, F, no_faces, maps[k])
    return Lights(
        *(read_only(array) for array in (directions, weights, kind, frames, maps)),
        texel=texel,
    )


def _plane_axes(d: FloatArray) -> tuple[FloatArray, FloatArray]:
    up = np.array([0.0, 1.0, 0.0]) if abs(d[1]) < 0.99 else np.array([0.0, 0.0, 1.0])
    u = np.cross(up, d)
    u /= np.linalg.norm(u)
    return u, np.cross(d, u)


def _half_sphere(count: int) -> FloatArray:
    # Equal areas of the half sphere y > 0, by the golden angle.
    y = (np.arange(count) + 0.5) / count
    angle = np.arange(count) * (np.pi * (3.0 - np.sqrt(5.0)))
    r = np.sqrt(1 - y**2)
    return np.column_stack([r * np.cos(angle), y, r * np.sin(angle)])


def _cone(axis: FloatArray, count: int, half_angle: float) -> FloatArray:
    side = np.cross(axis, [0.0, 1.0, 0.0] if abs(axis[1]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    other = np.cross(axis, side)
    r = np.tan(half_angle) * np.sqrt(np.arange(count) / max(count, 1))
    angle = np.arange(count) * (np.pi * (3.0 - np.sqrt(5.0)))
    D = axis + np.outer(r * np.cos(angle), side) + np.outer(r * np.sin(angle), other)
    return D / np.linalg.norm(D, axis=1, keepdims=True)
