"""Small pictures of meshes without a background, to be put beside marks and into grids."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tempose.render import Camera, Theme, render_frame
from tempose.render.lights import Quality
from tempose.render.themes import rgb
from tempose.signals.pictures.views import telling_view
from tempose.typing import FloatArray, IntArray

FINE = 3
"""Pixels rendered for each pixel shown, along each axis."""
_QUALITY = Quality(samples=1, key=4, sky=14, resolution=128)
_NOWHERE = "#ff00fe"
"""A colour that no shaded surface has: where it stays, there is no mesh."""


@dataclass(frozen=True, eq=False)
class Studio:
    """A camera that sees every mesh at one scale, and the size of its pictures."""

    camera: Camera
    """Looks at the origin."""
    size: tuple[int, int]
    """Width and height shown, pixels."""
    tone: Theme
    """Colour of the surface."""

    def picture(self, V: FloatArray, F: IntArray) -> npt.NDArray[np.uint8]:
        """Take a picture of a mesh, wherever it stands.

        Parameters
        ----------
        V : (n, 3) float
            Vertices, metres.
        F : (m, 3) int
            Triangles.

        Returns
        -------
        (height, width, 4) ndarray of uint8
            sRGB and opacity, `FINE` times as fine as `size`.
        """
        size = (FINE * self.size[0], FINE * self.size[1])
        theme = replace(self.tone, view=_NOWHERE)
        seen = render_frame(
            V - _middle(V), F, self.camera, size=size, theme=theme, quality=_QUALITY, show_back=False
        )
        solid = (seen != np.round(255 * rgb(_NOWHERE)).astype(np.uint8)).any(axis=2)
        return np.dstack([seen, np.where(solid, np.uint8(255), np.uint8(0))])


def make_studio(
    V: FloatArray, tone: Theme, size: tuple[int, int], view: tuple[float, float] | None = None
) -> Studio:
    """Set a camera up for meshes.

    Parameters
    ----------
    V : (T, n, 3) float
        What shall fit into the pictures, metres.
    tone : Theme
        Colours.
    size : (int, int)
        Width and height, pixels.
    view : (float, float), optional
        Azimuth and elevation, radians; None looks from where most of the motion is seen.

    Returns
    -------
    Studio
        With a parallel camera: size in the picture does not depend on the place.
    """
    centred = V - np.stack([_middle(v) for v in V])[:, None]
    azimuth, elevation = telling_view(V) if view is None else view
    corners = np.concatenate([centred.min(axis=1), centred.max(axis=1)])
    box = np.stack([corners.min(axis=0), corners.max(axis=0)])
    camera = Camera.fit(box, azimuth, elevation, 0.0, aspect=size[0] / size[1], margin=0.02)
    return Studio(camera, size, tone)


def _middle(V: FloatArray) -> FloatArray:
    return 0.5 * (V.min(axis=0) + V.max(axis=0))
