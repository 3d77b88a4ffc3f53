"""Parts of a body that can be adjusted: the point they are held by, what moves them, how far that is felt."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from tempose.geometry import edge_list, weld
from tempose.kinematics import ROLES
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.chains import LimbChain, TurnChain, find_chain
from tempose.transfer.bones import split_role
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.joint_regressor import apply_regressor, regress_points
from tempose.transfer.limb_field import limb_field
from tempose.transfer.limb_ik import bones_below
from tempose.transfer.marks import RIGID_PARTS
from tempose.typing import FloatArray, IntArray

ROOT = "root"
"""Name of the whole body."""
HIPS = "hips"
"""The pelvis: it moves as the whole body does, but the feet stay."""
_UNFELT, _FELT = 0.05, 0.5
"""Share of a limb in a vertex below which it does not move with it, and from which it does so wholly."""
_ONE_LIMB, _RIGID = 0.7, 0.99
_SCULPTED = 0.12
"""Share of the diagonal over which a displacement fades where no bone can make it."""


@dataclass(frozen=True)
class Part:
    """A part, ready to be moved."""

    name: str
    """For messages."""
    bone: int | None
    """Bone that carries it; None for the whole body, and on a body without bones."""
    vertices: IntArray
    """(s,) vertices from which its point is read."""
    weights: FloatArray
    """(s,) their weights, sum 1."""
    chain: LimbChain | TurnChain | None = None
    """What turns to move it; None where nothing can."""

    @property
    def whole(self) -> bool:
        """Whether it is the whole body."""
        return self.name in (ROOT, HIPS)

    def points(self, V: FloatArray) -> FloatArray:
        """Read the part's point off frames.

        Parameters
        ----------
        V : (T, n, 3) float
            Frames.

        Returns
        -------
        (T, 3) ndarray
            Metres.
        """
        return apply_regressor(np.asarray(V), self.vertices[None], self.weights[None])[:, 0]


def find_part(job: Prepared, part: str | Sequence[int] | IntArray) -> Part:
    """Find what an adjustment speaks of.

    Parameters
    ----------
    job : Prepared
        A transfer.
    part : str or sequence of int
        Body role, joint name, ``"root"``, or vertices of the target.

    Returns
    -------
    Part
        The part.

    Raises
    ------
    ValueError
        If the body has no such part; the message lists those it has.
    """
    if not isinstance(part, str):
        return _of_vertices(job, np.array(part, dtype=np.int64))
    rest, anchor = job.solver.mesh.vertices, job.solver.anchor
    if part == ROOT or (part == HIPS and job.bones is not None):
        index, weights = regress_points(rest, anchor.point[None], [np.flatnonzero(anchor.weights)])
        return Part(part, None if job.bones is None else 0, index[0], weights[0])
    if job.bones is None or job.target is None:
        raise ValueError(
            f"part {part!r} needs a skeleton as source; of a body moved by a mesh adjust "
            f"'root' or a list of vertices"
        )
    bone = _find_bone(job, part)
    mine = np.flatnonzero(job.owner == bone)
    mine = mine if len(mine) else np.arange(len(job.owner))
    index, weights = regress_points(rest, job.target.starts[[bone]], [mine])
    chain = find_chain(job.bones, job.target, bone, None, job.rotations[:, : len(job.bones.names)])
    return Part(job.bones.roles[bone] or job.bones.names[bone], bone, index[0], weights[0], chain)


def _find_bone(job: Prepared, part: str) -> int:
    assert job.bones is not None
    bone = job.bones.find(part)
    if bone is not None:
        return bone
    if part in job.bones.names:
        return job.bones.names.index(part)
    known = [role or name for role, name in zip(job.bones.roles, job.bones.names)]
    near = difflib.get_close_matches(part, [*known, *job.bones.names], n=3, cutoff=0.6)
    if part in ROLES:
        raise ValueError(f"this body has no {part!r} of its own; its parts are {', '.join([ROOT, *known])}")
    hint = f"; did you mean {' or '.join(map(repr, near))}?" if near else ""
    raise ValueError(f"no part {part!r}; parts are {', '.join([ROOT, *known])}, or a list of vertices{hint}")


def _of_vertices(job: Prepared, vertices: IntArray) -> Part:
    n = len(job.solver.mesh.vertices)
    if vertices.max() >= n:
        raise ValueError(f"part names vertex {vertices.max()}; the target has vertices 0 to {n - 1}")
    weights = np.full(len(vertices), 1 / len(vertices))
    name = f"vertex {vertices[0]}" if len(vertices) == 1 else f"{len(vertices)} vertices"
    if job.bones is None or job.target is None:
        return Part(name, None, vertices, weights)
    bone = int(bone_basis(job)[vertices].mean(axis=0).argmax())
    point = weights @ job.solver.mesh.vertices[vertices]
    chain = find_chain(job.bones, job.target, bone, point, job.rotations[:, : len(job.bones.names)])
    return Part(name, bone, vertices, weights, chain)


def bone_basis(job: Prepared) -> FloatArray:
    """Field of every bone of a job.

    Parameters
    ----------
    job : Prepared
        A transfer with bones.

    Returns
    -------
    (n, B) ndarray
        Rows sum to 1.
    """
    basis = job.solver.basis
    assert basis is not None
    return basis if job.columns is None else job.columns.of_bones(basis)


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


def follows(part: Part, adjustment: Adjustment | None = None) -> bool:
    """Tell whether a part turns with the bone that moves it.

    Parameters
    ----------
    part : Part
        The part.
    adjustment : Adjustment, optional
        What may say so.

    Returns
    -------
    bool
        By default all but feet do.
    """
    if adjustment is not None and adjustment.follow is not None:
        return adjustment.follow
    if not isinstance(part.chain, LimbChain):
        return True
    return not part.name.endswith(("foot", "toes"))
