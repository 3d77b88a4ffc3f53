"""Meshes of a wanted size, for timing."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh


def bumpy_body(triangles: int) -> Mesh:
    """Make a closed, uneven ellipsoid of about so many triangles, 1.7 m tall."""
    rows = max(4, int(np.sqrt(triangles / 4)))
    columns = 2 * rows
    theta = np.linspace(0, np.pi, rows + 1)[1:-1]
    phi = np.arange(columns) * 2 * np.pi / columns
    t, p = np.meshgrid(theta, phi, indexing="ij")
    radius = 1 + 0.05 * np.sin(9 * p) * np.sin(7 * t)
    ring = np.stack([0.25 * np.sin(t) * np.cos(p), 0.85 * np.cos(t), 0.25 * np.sin(t) * np.sin(p)], axis=-1)
    V = np.vstack([[0, 0.85, 0], (ring * radius[..., None]).reshape(-1, 3), [0, -0.85, 0]])
    at = 1 + np.arange(len(theta) * columns).reshape(len(theta), columns)
    right = np.roll(at, -1, axis=1)
    faces = [np.column_stack([np.zeros(columns, int), right[0], at[0]])]
    for i in range(len(theta) - 1):
        faces.append(np.column_stack([at[i], right[i], at[i + 1]]))
        faces.append(np.column_stack([right[i], right[i + 1], at[i + 1]]))
    faces.append(np.column_stack([np.full(columns, len(V) - 1), at[-1], right[-1]]))
    return Mesh(V, np.vstack(faces))
