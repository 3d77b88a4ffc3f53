"""How far a change of a part is felt over the surface: a weight a vertex."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from tempose.geometry import edge_list, weld
from tempose.transfer.adjustments.parts import Part, bone_basis
from tempose.transfer.bodies.bones import split_role
from tempose.transfer.bodies.limb_ik import Limb, bones_below
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.pairing.marks import RIGID_PARTS
from tempose.transfer.solver.limb_field import limb_field
from tempose.typing import FloatArray, IntArray

_UNFELT, _FELT = 0.05, 0.5
"""Share of a limb in a vertex below which it does not move with it, and from which it does so wholly."""
_ONE_LIMB, _RIGID = 0.7, 0.99
_HALF, _CARRIED = 0.5, 0.9
_SCULPTED = 0.12
"""Share of the diagonal over which a displacement fades where no bone can make it."""


def turned_field(job: Prepared, top: int) -> FloatArray:
    """Where the change is felt when a bone and all below it turn.

    Parameters
    ----------
    job : Prepared
        A transfer with bones.
    top : int
        The uppermost bone that turns.

    Returns
    -------
    (n,) ndarray
        1 on the limb, 0 on all other limbs and on the trunk away from the joint, so that nothing moves there
        at all; the glue alone would shift the whole body by some millimetres.
    """
    assert job.bones is not None
    share = bone_basis(job)[:, bones_below(job.bones.parents, top)].sum(axis=1)
    s = np.clip((share - _UNFELT) / (_FELT - _UNFELT), 0.0, 1.0)
    return s * s * (3 - 2 * s)


def carried_field(job: Prepared, limb: Limb) -> FloatArray:
    """Weight of what a limb carries without turning it.

    Parameters
    ----------
    job : Prepared
        A transfer with bones.
    limb : Limb
        A limb of it.

    Returns
    -------
    (n,) ndarray
        1 on the hand or foot, 0 on the rest.
    """
    share = bone_basis(job)[:, limb.carried].sum(axis=1)
    s = np.clip((share - _HALF) / (_CARRIED - _HALF), 0.0, 1.0)
    return s * s * (3 - 2 * s)


def rigid_vertices(job: Prepared, bone: int) -> IntArray:
    """Vertices by which the turn of a part is measured.

    Parameters
    ----------
    job : Prepared
        A transfer with bones.
    bone : int
        A bone.

    Returns
    -------
    (k,) ndarray of int
        Those that move with a head, hand or foot alone; none for parts that bend, whose turn is spread.
    """
    assert job.bones is not None
    if split_role(job.bones.roles[bone])[1] not in RIGID_PARTS:
        return np.zeros(0, dtype=np.int64)
    mine = np.flatnonzero(bone_basis(job)[:, bone] > _RIGID)
    return mine if len(mine) > 2 else np.zeros(0, dtype=np.int64)


def residual_field(job: Prepared, part: Part) -> FloatArray:
    """Weight by which the surface takes up what the bones leave: 1 on the part, 0 beyond the chain.

    Parameters
    ----------
    job : Prepared
        A transfer.
    part : Part
        A part of it.

    Returns
    -------
    (n,) ndarray
        The part's point moves exactly as the displacement does.

    Raises
    ------
    ValueError
        If the vertices of the part lie on several limbs.
    """
    one = part.vertices
    if part.chain is not None and job.bones is not None:
        basis, parents = bone_basis(job), job.bones.parents
        assert part.bone is not None
        mine = basis[:, bones_below(parents, part.bone)].sum(axis=1) >= 0.5
        zero = np.flatnonzero(basis[:, bones_below(parents, part.chain.top)].sum(axis=1) < 0.5)
        one = np.union1d(one, np.flatnonzero(mine))
    else:
        zero = _beyond(job, one)
    field = limb_field(job.solver, one, zero)
    share = float(part.weights @ field[part.vertices])
    if share < _ONE_LIMB:
        raise ValueError(f"the vertices of a part must lie on one limb, got {part.name} on several")
    return field / share


def _beyond(job: Prepared, vertices: IntArray) -> IntArray:
    """Vertices further away along the surface than a displacement is felt."""
    mesh = job.solver.mesh
    first, inverse = weld(mesh.vertices)
    V, n = mesh.vertices[first], len(first)
    edges = np.concatenate([edge_list(inverse[mesh.faces]), job.solver.links.pairs])
    length = np.maximum(np.linalg.norm(V[edges[:, 0]] - V[edges[:, 1]], axis=1), 1e-12)
    graph = sp.coo_array((length, (edges[:, 0], edges[:, 1])), shape=(n, n)).tocsr()
    reach = _SCULPTED * mesh.diagonal
    away = dijkstra(graph, directed=False, indices=inverse[vertices], min_only=True, limit=reach)
    return np.flatnonzero(~np.isfinite(away[inverse]))
