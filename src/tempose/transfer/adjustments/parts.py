"""Parts of a body that can be adjusted: the point they are held by, what moves them, how far that is felt."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tempose.kinematics import ROLES
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.chains import LimbChain, TurnChain, find_chain
from tempose.transfer.bodies.joint_regressor import apply_regressor, regress_points
from tempose.transfer.bodies.limb_ik import bones_below
from tempose.transfer.from_skeleton import Prepared
from tempose.typing import FloatArray, IntArray

ROOT = "root"
"""Name of the whole body."""
HIPS = "hips"
"""The pelvis: it moves as the whole body does, but the feet stay."""

_SURE, _FEW = 0.9, 12


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
    index, weights = regress_points(rest, job.target.starts[[bone]], [_own_vertices(job, bone)])
    chain = find_chain(job.bones, job.target, bone, None, job.rotations[:, : len(job.bones.names)])
    return Part(job.bones.roles[bone] or job.bones.names[bone], bone, index[0], weights[0], chain)


def _own_vertices(job: Prepared, bone: int) -> IntArray:
    """Vertices that tell where a bone is: those it moves without the bones above, if there are enough."""
    assert job.bones is not None
    mine = np.flatnonzero(job.owner == bone)
    share = bone_basis(job)[mine][:, bones_below(job.bones.parents, bone)].sum(axis=1)
    sure = mine[share > _SURE]
    mine = sure if len(sure) >= _FEW else mine
    return mine if len(mine) else np.arange(len(job.owner))


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
