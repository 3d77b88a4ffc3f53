"""A weight that is 1 on one part of a mesh, 0 on another, and smooth between."""

from __future__ import annotations

import numpy as np

from tempose.geometry import weld
from tempose.linalg import harmonic_extension
from tempose.transfer.solver.fabric import field_laplacian
from tempose.transfer.solver.motion_transfer import MotionTransfer
from tempose.typing import FloatArray, IntArray


def limb_field(solver: MotionTransfer, one: IntArray, zero: IntArray) -> FloatArray:
    """Weight by which a displacement of one part is spread over its neighbourhood.

    Parameters
    ----------
    solver : MotionTransfer
        Whose mesh it is: n vertices, pieces linked.
    one : (k,) int
        Vertices of weight 1, such as those of a hand.
    zero : (l,) int
        Vertices of weight 0, such as all that is not the arm; these win over `one`.

    Returns
    -------
    (n,) ndarray
        ``3 h^2 - 2 h^3`` of the harmonic function h, so that it joins both parts without a crease. Exactly 0
        and 1 where asked; all 1 where there is no `zero`, all 0 where there is no `one`.
    """
    mesh = solver.mesh
    first, inverse = weld(mesh.vertices)
    values = np.full(len(first), np.nan)
    values[inverse[one]] = 1.0
    values[inverse[zero]] = 0.0
    known = np.flatnonzero(np.isfinite(values))
    if len(known) == 0 or np.ptp(values[known]) == 0:
        return np.full(len(mesh.vertices), values[known[0]] if len(known) else 0.0)
    V, F = mesh.vertices[first], inverse[mesh.faces]
    L = field_laplacian(V, F, solver.links)
    h = np.clip(harmonic_extension(L, known, values[known][:, None])[:, 0], 0.0, 1.0)
    return (h * h * (3 - 2 * h))[inverse]
