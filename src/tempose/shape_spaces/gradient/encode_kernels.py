"""From vertices to rotation and stretch of every face, without a matrix decomposition.

A face and its normal deform by ``T = B' [A 0; 0 s] B^T``, B and B' frames of the face at rest and deformed
whose third axis is the normal: what has to be decomposed is the 2 by 2 matrix A, and its determinant is the
ratio of the areas, never negative. With p, q the images of both axes at rest and n the deformed normal, the
rotation takes the axes to ``(p + q x n) / t``, ``(q + n x p) / t`` and n, t the root of
``|p|^2 + |q|^2 + 2 |p x q|``; the stretch is ``(A^T A + |p x q|) / t``. Nothing is divided by the area, so
slivers do no harm.

Arrays are flat, components first, faces last. Blocks of faces pass through a scratch array, four faces in a
vector register; what does not fit, a face without area or turned half round, is mended one by one.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np

from tempose.linalg.lanes import alike, item, load4, scaled, store
from tempose.shape_spaces.gradient.lanes import at_least, polynomial, root
from tempose.shape_spaces.gradient.mending import log_far, mend_axes
from tempose.shape_spaces.gradient.polynomials import ARCTANGENT, LEAST_COSINE

BLOCK = 128
"""Faces whose scratch fits the fastest cache; a multiple of 4."""
VANISHING = 1e-12
"""Area of a deformed face, as a share of what its edges could span, below which it has no normal."""
AXES, TURNED, STRETCH, LOG, CHECK = (BLOCK * row for row in (0, 6, 15, 19, 22))
"""Where in the scratch begin: images p, q of the axes; turned axes; stretches xx, yy, zz, xy; rotation
vectors; what tells whether a face is to be mended."""
SCRATCH = BLOCK * 23
BESIDE = math.sqrt(2.0)
"""Weight of what stands twice in a symmetric matrix."""


@numba.njit(cache=True, nogil=True)
def gather_axes(V: Any, corners: Any, inverse: Any, begin: Any, count: Any, work: Any) -> None:
    """Take the axes at rest of a block of faces where the deformation takes them.

    Parameters
    ----------
    V : (3 n,) ndarray
        Vertices.
    corners : (3 m,) int ndarray
        First number of each corner in V.
    inverse : (3 m,) ndarray
        Upper triangle of the inverse of the edges at rest.
    begin, count : int
        First face and how many.
    work : (SCRATCH,) ndarray
        AXES are written.
    """
    m = len(corners) // 3
    for i in range(count):
        f = begin + i
        a, b, c = item(corners, f), item(corners, m + f), item(corners, 2 * m + f)
        g, h, k = item(inverse, f), item(inverse, m + f), item(inverse, 2 * m + f)
        for d in range(3):
            x = item(V, a + d)
            along, to_apex = item(V, b + d) - x, item(V, c + d) - x
            work[AXES + d * BLOCK + i] = g * along
            work[AXES + (3 + d) * BLOCK + i] = h * along + k * to_apex


@numba.njit(cache=True, nogil=True, inline="always")
def _three(work: Any, at: Any) -> Any:
    return load4(work, at), load4(work, at + BLOCK), load4(work, at + 2 * BLOCK)


@numba.njit(cache=True, nogil=True, inline="always")
def _cross(ax: Any, ay: Any, az: Any, bx: Any, by: Any, bz: Any) -> Any:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@numba.njit(cache=True, nogil=True)
def split_axes(frames: Any, begin: Any, count: Any, work: Any) -> None:
    """Split the images of the axes into rotation and stretch.

    Parameters
    ----------
    frames : (9 m,) ndarray
        Reference frames, asked where a face has no normal.
    begin, count : int
        First face of the block and how many.
    work : (SCRATCH,) ndarray
        AXES are read; TURNED and STRETCH are written.
    """
    for i in range(0, count, 4):
        px, py, pz = _three(work, AXES + i)
        qx, qy, qz = _three(work, AXES + 3 * BLOCK + i)
        nx, ny, nz = _cross(px, py, pz, qx, qy, qz)
        pp, qq, pq = px * px + py * py + pz * pz, qx * qx + qy * qy + qz * qz, px * qx + py * qy + pz * qz
        one = alike(px, 1.0)
        area = root(nx * nx + ny * ny + nz * nz)
        spread = pp + qq
        k = one / area
        t = one / root(spread + area + area)
        nx, ny, nz = k * nx, k * ny, k * nz
        ux, uy, uz = _cross(qx, qy, qz, nx, ny, nz)
        vx, vy, vz = _cross(nx, ny, nz, px, py, pz)
        at = TURNED + i
        store(work, at, t * (px + ux))
        store(work, at + BLOCK, t * (py + uy))
        store(work, at + 2 * BLOCK, t * (pz + uz))
        store(work, at + 3 * BLOCK, t * (qx + vx))
        store(work, at + 4 * BLOCK, t * (qy + vy))
        store(work, at + 5 * BLOCK, t * (qz + vz))
        store(work, at + 6 * BLOCK, nx)
        store(work, at + 7 * BLOCK, ny)
        store(work, at + 8 * BLOCK, nz)
        store(work, STRETCH + i, t * (pp + area))
        store(work, STRETCH + BLOCK + i, t * (qq + area))
        store(work, STRETCH + 2 * BLOCK + i, root(area))
        store(work, STRETCH + 3 * BLOCK + i, t * pq)
        store(work, CHECK + i, area - scaled(VANISHING, spread))
    m = len(frames) // 9
    for i in range(count):
        if not item(work, CHECK + i) > 0.0:
            mend_axes(work[AXES + i :: BLOCK], frames[begin + i :: m], work[TURNED + i :: BLOCK])


@numba.njit(cache=True, nogil=True)
def log_between(frames: Any, begin: Any, count: Any, work: Any) -> None:
    """Rotation vectors that take the turned axes of a block from the reference, ``log(N^T R)``.

    Parameters
    ----------
    frames : (9 m,) ndarray
        Reference frames N, axis after axis.
    begin, count : int
        First face of the block and how many.
    work : (SCRATCH,) ndarray
        TURNED is read; LOG is written: vectors of length up to pi in the axes of the reference.
    """
    m = len(frames) // 9
    for i in range(0, count, 4):
        # the last faces of all lie in a group of four that ends with the last
        f = begin + i
        ax, ay, az = load4(frames, f), load4(frames, m + f), load4(frames, 2 * m + f)
        bx, by, bz = load4(frames, 3 * m + f), load4(frames, 4 * m + f), load4(frames, 5 * m + f)
        cx, cy, cz = load4(frames, 6 * m + f), load4(frames, 7 * m + f), load4(frames, 8 * m + f)
        px, py, pz = _three(work, TURNED + i)
        qx, qy, qz = _three(work, TURNED + 3 * BLOCK + i)
        nx, ny, nz = _three(work, TURNED + 6 * BLOCK + i)
        one, half = alike(px, 1.0), alike(px, 0.5)
        trace = (ax * px + ay * py + az * pz) + (bx * qx + by * qy + bz * qz) + (cx * nx + cy * ny + cz * nz)
        x = half * ((cx * qx + cy * qy + cz * qz) - (bx * nx + by * ny + bz * nz))
        y = half * ((ax * nx + ay * ny + az * nz) - (cx * px + cy * py + cz * pz))
        z = half * ((bx * px + by * py + bz * pz) - (ax * qx + ay * qy + az * qz))
        # h half the angle: cos^2 h = (1 + trace) / 4, tan(h / 2) = |(x, y, z)| / (2 cos h (1 + cos h))
        cosine = root(at_least(scaled(0.25, one + trace), alike(px, 1e-4)))
        k = half / (cosine * (one + cosine))
        u = k * k * (x * x + y * y + z * z)
        factor = scaled(4.0, k) * polynomial(ARCTANGENT, u)
        store(work, LOG + i, factor * x)
        store(work, LOG + BLOCK + i, factor * y)
        store(work, LOG + 2 * BLOCK + i, factor * z)
        store(work, CHECK + i, trace)
    for i in range(count):
        if item(work, CHECK + i) < 1.0 + 2.0 * LEAST_COSINE:
            log_far(work[TURNED + i :: BLOCK], frames[begin + i :: m], work[LOG + i :: BLOCK])


@numba.njit(cache=True, nogil=True)
def encode_faces(V: Any, corners: Any, inverse: Any, frames: Any, scale: Any, z: Any) -> None:
    """Write rotation and stretch of every face relative to its reference frame.

    Parameters
    ----------
    V : (3 n,) ndarray
        Vertices.
    corners : (3 m,) int ndarray
        First number of each corner in V.
    inverse : (3 m,) ndarray
        Upper triangle of the inverse of the edges at rest.
    frames : (9 m + 3,) ndarray
        Reference frames, and three more numbers.
    scale : (m,) ndarray
        Weight of each face.
    z : (9 m,) ndarray
        Written: rotation vector, stretch less the identity as xx, yy, zz and, times sqrt 2, xy, xz, yz.
    """
    m = len(scale)
    work = np.ones(SCRATCH)
    for begin in range(0, m, BLOCK):
        count = min(BLOCK, m - begin)
        gather_axes(V, corners, inverse, begin, count, work)
        split_axes(frames, begin, count, work)
        log_between(frames, begin, count, work)
        whole = count - count % 4
        for i in range(0, whole, 4):
            f = begin + i
            k = load4(scale, f)
            one = alike(k, 1.0)
            for c in range(3):
                store(z, c * m + f, k * load4(work, LOG + c * BLOCK + i))
                store(z, (3 + c) * m + f, k * (load4(work, STRETCH + c * BLOCK + i) - one))
            store(z, 6 * m + f, scaled(BESIDE, k) * load4(work, STRETCH + 3 * BLOCK + i))
        for i in range(whole, count):
            f = begin + i
            for c in range(3):
                z[c * m + f] = scale[f] * work[LOG + c * BLOCK + i]
                z[(3 + c) * m + f] = scale[f] * (work[STRETCH + c * BLOCK + i] - 1.0)
            z[6 * m + f] = BESIDE * scale[f] * work[STRETCH + 3 * BLOCK + i]


@numba.njit(cache=True, nogil=True)
def turn_faces(V: Any, corners: Any, inverse: Any, frames: Any, out: Any) -> None:
    """Write the turned axes of every face.

    Parameters
    ----------
    V : (3 n,) ndarray
        Vertices.
    corners : (3 m,) int ndarray
        First number of each corner in V.
    inverse : (3 m,) ndarray
        Upper triangle of the inverse of the edges at rest.
    frames : (9 m + 3,) ndarray
        Frames to stay near to where a face has no area, and three more numbers.
    out : (9 m + 3,) ndarray
        Written but for the last three.
    """
    m = len(corners) // 3
    work = np.ones(SCRATCH)
    for begin in range(0, m, BLOCK):
        count = min(BLOCK, m - begin)
        gather_axes(V, corners, inverse, begin, count, work)
        split_axes(frames, begin, count, work)
        for c in range(9):
            for i in range(count):
                out[c * m + begin + i] = work[TURNED + c * BLOCK + i]
