"""The colour of a surface under light."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

from tempose._validate import as_floats, as_indices
from tempose.render.colors import as_colors, to_linear
from tempose.render.gather import gather_shared
from tempose.render.lights import Lights
from tempose.render.surface import Samples
from tempose.render.themes import Theme, rgb
from tempose.typing import FloatArray, IntArray

KEY, SKY, BOUNCE, SHEEN = 1.25, 0.42, 0.12, 0.05
"""Share of each light in what a white surface sends back, and the sheen of the key light."""


@dataclass(frozen=True, eq=False)
class Paint:
    """What a surface looks like before light falls on it."""

    plain: FloatArray | None
    """(3,) linear colour of everything, or None."""
    corner: FloatArray | None
    """(m, 3, 3) linear colours by face and corner, or None."""
    uv: FloatArray | None
    """(m, 3, 2) texture coordinates by face and corner, or None."""
    checker: int
    """Squares of a chequerboard along each axis of `uv`; 0 for none."""
    wire: FloatArray | None
    """(3,) linear colour of the edges, or None."""
    back: FloatArray | None
    """(3,) linear colour of back faces, or None to paint them like the front."""

    @classmethod
    def checked(
        cls,
        V: FloatArray,
        F: IntArray,
        colors: Any,
        face_colors: Any,
        uv: Any,
        uv_faces: Any,
        checker: int,
        wire: bool,
        show_back: bool,
        tone: Theme,
    ) -> Paint:
        """Check the arguments of `tempose.render.render_frame`.

        Parameters
        ----------
        V : (n, 3) float
            Vertices.
        F : (m, 3) int
            Triangles.
        colors, face_colors, uv, uv_faces, checker, wire, show_back
            As there.
        tone : Theme
            Colours of what was not given.

        Returns
        -------
        Paint
            Ready to shade.

        Raises
        ------
        ValueError
            If one has another shape or is out of range.
        """
        plain = corner = texture = None
        if face_colors is not None:
            each = to_linear(as_colors(face_colors, "face_colors", len(F)))
            corner = np.repeat(each[:, None], 3, axis=1)
        elif colors is None or isinstance(colors, str) or np.ndim(colors) == 1:
            plain = to_linear(as_colors(tone.mesh if colors is None else colors, "colors", 1))[0]
        else:
            corner = to_linear(as_colors(colors, "colors", len(V)))[F]
        if checker:
            if uv is None:
                raise ValueError("checker needs uv, got None")
            at = as_floats(uv, "uv", (len(V) if uv_faces is None else "k", 2))
            G = F if uv_faces is None else as_indices(uv_faces, "uv_faces", (len(F), 3), limit=len(at))
            texture = at[G]
        edge = to_linear(rgb(tone.wire)) if wire else None
        return cls(
            plain, corner, texture, int(checker), edge, to_linear(rgb(tone.back)) if show_back else None
        )

    def shaded(self, samples: Samples, key: FloatArray, lights: Lights | None) -> FloatArray:
        """Return the light that samples send to the eye.

        Parameters
        ----------
        samples : Samples
            Where.
        key : (3,) float
            Unit vector towards the key light.
        lights : Lights, optional
            Light; None for the plain colours.

        Returns
        -------
        (k, 3) ndarray of float64
            Linear light.
        """
        color = self._albedo(samples)
        if lights is not None:
            light = gather_shared(
                samples.pixel, samples.depth, samples.smooth_position, samples.normal, lights
            )
            _shine(color, light, samples.normal, samples.view, samples.back, self.back is not None, key)
        if self.wire is not None:
            cover = 0.7 * np.clip(0.9 - samples.edge, 0.0, 1.0)[:, None]
            color += cover * (self.wire - color)
        return color

    def _albedo(self, samples: Samples) -> FloatArray:
        if self.corner is None:
            color = np.tile(np.zeros(3) if self.plain is None else self.plain, (len(samples.face), 1))
        else:
            color = _mixed(self.corner, samples.face, samples.weights)
        if self.uv is not None:
            at = np.floor(_mixed(self.uv, samples.face, samples.weights) * self.checker)
            color[at.sum(axis=1) % 2 == 1] *= 0.35
        if self.back is not None:
            color[samples.back] = self.back
        return color


@njit(cache=True, nogil=True)
def _mixed(corner, face, weights):
    out = np.zeros((len(face), corner.shape[2]))
    for k in range(len(face)):
        for c in range(3):
            for d in range(corner.shape[2]):
                out[k, d] += weights[k, c] * corner[face[k], c, d]
    return out


@njit(cache=True, nogil=True)
def _shine(color, light, normal, view, back, tinted, key):
    for k in range(len(color)):
        n, v = normal[k], view[k]
        facing = max(n[0] * key[0] + n[1] * key[1] + n[2] * key[2], 0.0)
        diffuse = KEY * light[k, 0] * facing + SKY * light[k, 1] + BOUNCE * light[k, 2]
        if tinted and back[k]:
            # Often deep inside: it keeps a light of its own, or the warning would be black.
            diffuse = max(diffuse, 0.45)
        hx, hy, hz = key[0] + v[0], key[1] + v[1], key[2] + v[2]
        length = max(np.sqrt(hx * hx + hy * hy + hz * hz), 1e-9)
        glance = max((n[0] * hx + n[1] * hy + n[2] * hz) / length, 0.0)
        sheen = SHEEN * light[k, 0] * glance**24 if facing > 0.0 else 0.0
        for c in range(3):
            color[k, c] = color[k, c] * diffuse + sheen


@njit(cache=True, nogil=True)
def blend(picture, depth, pixel, sample_depth, color, per_pixel):
    """Put samples into a picture over what is behind them.

    Parameters
    ----------
    picture : (p, 3) float64
        Linear light of what is behind; written.
    depth : (p,) float64
        Written: the least depth in each pixel.
    pixel : (k,) int64
        Pixel of each sample, ascending.
    sample_depth : (k,) float64
        Metres before the eye.
    color : (k, 3) float64
        Linear light of each sample.
    per_pixel : int
        Samples that fill a pixel.
    """
    k = 0
    while k < len(pixel):
        p, first = pixel[k], k
        r, g, b = 0.0, 0.0, 0.0
        while k < len(pixel) and pixel[k] == p:
            r, g, b = r + color[k, 0], g + color[k, 1], b + color[k, 2]
            depth[p] = min(depth[p], sample_depth[k])
            k += 1
        rest = 1.0 - (k - first) / per_pixel
        picture[p, 0] = r / per_pixel + rest * picture[p, 0]
        picture[p, 1] = g / per_pixel + rest * picture[p, 1]
        picture[p, 2] = b / per_pixel + rest * picture[p, 2]
