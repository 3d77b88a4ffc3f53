"""Joints moved inside the bind pose to where the clip turns about them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import bone_transforms, rest_transforms
from tempose.rigging.pose_fit import PoseFit
from tempose.rigging.pose_fit.fit import fit_moments
from tempose.rigging.pose_fit.moments import FrameMoments, SkinMoments
from tempose.rotations import conjugate, rotate, to_matrix
from tempose.typing import FloatArray, Progress, silent

_PULL = 1e-3


@dataclass(frozen=True, eq=False)
class JointRefinement:
    """A skin whose joints suit a clip, and the clip fitted again."""

    skin: SkinnedMesh
    """Same mesh, weights and names; joints moved."""
    fit: PoseFit
    """Motion of the new skin."""
    rms: FloatArray
    """(rounds + 1,) rms distance of skin and clip before and after every round, metres."""
    moved: FloatArray
    """(J,) how far each joint went in the bind pose, metres."""


def refine_joints(
    skin: SkinnedMesh,
    motion: SkeletonClip | None,
    frames: FloatArray,
    *,
    rounds: int = 3,
    pull: float = _PULL,
    progress: Progress = silent,
) -> JointRefinement:
    """Move the joints of a skin so that it follows a clip better.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices, J joints.
    motion : SkeletonClip, optional
        Motion fitted to the frames with this skin; fitted here if not given.
    frames : (T, n, 3) float
        Clip, metres; an array or a memory map.
    rounds : int, default 3
        Alternations of joints and poses.
    pull : float, default 1e-3
        Holds a joint where it was given, as a mean squared turn (radians) about it would; what the clip does
        not tell, such as a place along the axis of a hinge, stays.
    progress : Progress
        Told about every round.

    Returns
    -------
    JointRefinement
        New skin, motion, errors. The first round that helps no more is undone and ends it.

    Raises
    ------
    ValueError
        If an argument cannot be used; the message names it.

    Notes
    -----
    For given turns R a posed vertex is linear in the joints p and a shift u a frame:
    ``v = sum_k w_k R_k x + u + sum_j s_j (R_parent(j) - R_j) p_j``, s_j the weight of the whole subtree of
    j. One linear least-squares problem over all frames, from moments alone. The root stays.
    """
    if rounds < 0:
        raise ValueError(f"rounds must not be negative, got {rounds}")
    made = SkinMoments(skin)
    seen = made.frames(frames)
    fps = 30.0 if motion is None else motion.fps
    fit = fit_moments(made, seen, fps=fps)
    rms = [_rms(fit)]
    first = rest_transforms(skin.skeleton)[1]
    for k in range(rounds):
        joints = solve_joints(made, seen, fit.motion, pull, first)
        other = with_joints(made.skin, joints)
        again = made.bound_to(other)
        better = fit_moments(again, seen, fps=fps)
        progress(k + 1, rounds, "joints")
        if _rms(better) >= rms[-1]:
            break
        made, fit = again, better
        rms.append(_rms(fit))
    moved = np.linalg.norm(rest_transforms(made.skin.skeleton)[1] - first, axis=1)
    return JointRefinement(made.skin, fit, np.array(rms), moved)


def _rms(fit: PoseFit) -> float:
    return float(np.sqrt((fit.errors**2).mean())) if len(fit.errors) else 0.0


def solve_joints(
    made: SkinMoments,
    seen: FrameMoments,
    motion: SkeletonClip,
    pull: float = _PULL,
    toward: FloatArray | None = None,
) -> FloatArray:
    """Solve for the joints that suit given turns.

    Parameters
    ----------
    made : SkinMoments
        Of the skin, J joints.
    seen : FrameMoments
        Of T frames.
    motion : SkeletonClip
        T frames; only rotations are used.
    pull : float, default 1e-3
        As in `refine_joints`.
    toward : (J, 3) float, optional
        Where the pull goes, metres; by default where the joints are.

    Returns
    -------
    (J, 3) ndarray
        Joints in the bind pose, metres; the root's is the one it had.
    """
    skeleton = made.skin.skeleton
    J, T = skeleton.n_joints, len(seen)
    old = (rest_transforms(skeleton)[1] if toward is None else toward) - made.centre
    turns, _ = bone_transforms(skeleton, motion.rotations, motion.root_position)
    R = to_matrix(turns)
    below = subtrees(skeleton)
    A = made.A.reshape(J, 4, J, 4)
    S = below @ A[:, 3, :, 3] @ below.T
    # what is left for the joints once every bone has turned its vertices about the origin
    left = seen.moments.reshape(T, J, 4, 3)[:, :, 3] - np.einsum("tkab,kbm->tma", R, A[:, :3, :, 3])
    r = np.einsum("jm,tma->tja", below, left)
    S1 = S - np.outer(S[:, 0], S[0]) / S[0, 0]
    r1 = r - S[:, 0, None] / S[0, 0] * r[:, :1]
    D = R[:, skeleton.parents[1:]] - R[:, 1:]
    N = np.einsum("jl,tjba,tlbc->jalc", S1[1:, 1:], D, D, optimize=True)
    b = np.einsum("tjba,tjb->ja", D, r1[:, 1:])
    hold = pull * T * np.diag(S1)[1:] + 1e-12 * S[0, 0]
    N = N.reshape(3 * J - 3, 3 * J - 3) + np.diag(np.repeat(hold, 3))
    b = b + hold[:, None] * old[1:]
    new = np.vstack([old[:1], np.linalg.solve(N, b.ravel()).reshape(-1, 3)])
    return new + made.centre


def subtrees(skeleton: Skeleton) -> FloatArray:
    """Mark what hangs below every joint.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.

    Returns
    -------
    (J, J) ndarray
        1 where the joint of the column is that of the row or below it, else 0.
    """
    below = np.eye(skeleton.n_joints)
    for j in range(skeleton.n_joints - 1, 0, -1):
        below[skeleton.parents[j]] += below[j]
    return below


def with_joints(skin: SkinnedMesh, joints: FloatArray) -> SkinnedMesh:
    """Move the joints of a bind pose; mesh, weights and the ends of the leaf bones stay.

    Parameters
    ----------
    skin : SkinnedMesh
        J joints.
    joints : (J, 3) float
        New places in the bind pose, metres.

    Returns
    -------
    SkinnedMesh
        The same mesh on the moved joints.
    """
    tree = skin.skeleton
    assert tree.tips is not None
    world, old = rest_transforms(tree)
    above = np.maximum(tree.parents, 0)
    offsets = rotate(conjugate(world[above]), joints - joints[above])
    offsets[0] = joints[0]
    tips = tree.tips + rotate(conjugate(world), old - joints)
    return SkinnedMesh(
        skin.mesh, Skeleton(tree.names, tree.parents, offsets, tree.rest_rotations, tips), skin.weights
    )
