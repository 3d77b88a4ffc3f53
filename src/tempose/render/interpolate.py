"""From triangles to samples: the compiled part of `tempose.render.surface`."""

# pyright: reportMissingParameterType=false
from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def interpolate(
    faces,
    top,
    s,
    P,
    V,
    F,
    N,
    counted,
    parallel,
    eye,
    pixel,
    face,
    weights,
    edge,
    position,
    smooth,
    normal,
    view,
    back,
):
    """Fill in what the samples of some rows see; the fields of `tempose.render.surface.Samples` are written.

    Parameters
    ----------
    faces : (rows * s, width * s) int32
        Triangle seen by each sample, -1 for none.
    top : int
        First row.
    s : int
        Samples per pixel along each axis.
    P : (n, 3) float64
        Vertices on the screen: x, y in samples, and nearness.
    V : (n, 3) float64
        Vertices, metres.
    F : (m, 3) int32
        Triangles.
    N : (m, 3, 3) float64
        Corner normals.
    counted : (m, 3) bool
        Edges that count for `edge`.
    parallel : bool
        Whether the camera is parallel.
    eye : (3,) float64
        The eye, or the direction towards it for a parallel camera.
    pixel, face, weights, edge, position, smooth, normal, view, back : ndarray
        Written, a row for each covered sample.
    """
    height, width = faces.shape[0] // s, faces.shape[1] // s
    k = 0
    for j in range(height):
        for i in range(width):
            for sub in range(s * s):
                y, x = j * s + sub // s, i * s + sub % s
                f = faces[y, x]
                if f < 0:
                    continue
                pixel[k], face[k] = (top + j) * width + i, f
                edge[k] = _weights(P, F, f, counted, x + 0.5, top * s + y + 0.5, parallel, weights, k) / s
                for c in range(3):
                    for d in range(3):
                        position[k, d] += weights[k, c] * V[F[f, c], d]
                        normal[k, d] += weights[k, c] * N[f, c, d]
                back[k] = _turn(V, F, f, parallel, eye, position, normal, view, k)
                _bulge(V, F, f, N, weights, position, normal, smooth, k)
                k += 1


@njit(cache=True, nogil=True)
def _weights(P, F, f, counted, x, y, parallel, weights, k):
    # Corners are snapped to 1/256 pixel when drawn: clip what this leaves outside the triangle.
    a, b, c = F[f, 0], F[f, 1], F[f, 2]
    ax, ay, bx, by, cx, cy = P[a, 0], P[a, 1], P[b, 0], P[b, 1], P[c, 0], P[c, 1]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    scale = 1.0 / area if area != 0.0 else 0.0
    wb = max(((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) * scale, 0.0)
    wc = max(((bx - ax) * (y - ay) - (by - ay) * (x - ax)) * scale, 0.0)
    wa = max(1.0 - wb - wc, 0.0)
    edge = abs(area) * min(
        wa / max(np.hypot(cx - bx, cy - by), 1e-9) if counted[f, 0] else np.inf,
        wb / max(np.hypot(ax - cx, ay - cy), 1e-9) if counted[f, 1] else np.inf,
        wc / max(np.hypot(bx - ax, by - ay), 1e-9) if counted[f, 2] else np.inf,
    )
    if not parallel:
        wa, wb, wc = wa * P[a, 2], wb * P[b, 2], wc * P[c, 2]
    total = wa + wb + wc
    weights[k, 0], weights[k, 1], weights[k, 2] = wa / total, wb / total, wc / total
    return edge


@njit(cache=True, nogil=True)
def _turn(V, F, f, parallel, eye, position, normal, view, k):
    # Turn the normal to the side that is seen; say whether that is the back.
    a, b, c = F[f, 0], F[f, 1], F[f, 2]
    ux, uy, uz = V[b, 0] - V[a, 0], V[b, 1] - V[a, 1], V[b, 2] - V[a, 2]
    vx, vy, vz = V[c, 0] - V[a, 0], V[c, 1] - V[a, 1], V[c, 2] - V[a, 2]
    length = normal_length = 0.0
    for d in range(3):
        view[k, d] = eye[d] if parallel else eye[d] - position[k, d]
        length += view[k, d] ** 2
        normal_length += normal[k, d] ** 2
    length, normal_length = np.sqrt(length), np.sqrt(normal_length)
    for d in range(3):
        view[k, d] /= length
    facing = (uy * vz - uz * vy) * view[k, 0] + (uz * vx - ux * vz) * view[k, 1]
    facing += (ux * vy - uy * vx) * view[k, 2]
    side = -1.0 if facing < 0.0 else 1.0
    for d in range(3):
        normal[k, d] = side * normal[k, d] / normal_length if normal_length > 1e-12 else view[k, d]
    return facing < 0.0


@njit(cache=True, nogil=True)
def _bulge(V, F, f, N, weights, position, normal, smooth, k):
    for d in range(3):
        smooth[k, d] = position[k, d]
    for c in range(3):
        agrees = below = 0.0
        for d in range(3):
            agrees += N[f, c, d] * normal[k, d]
            below += (position[k, d] - V[F[f, c], d]) * N[f, c, d]
        side = 1.0 if agrees > 0.0 else -1.0
        if side * below < 0.0:
            for d in range(3):
                smooth[k, d] -= weights[k, c] * below * N[f, c, d]
