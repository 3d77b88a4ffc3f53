"""All frames of a clip: moments once, several starts a frame, joint Gauss-Newton."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import local_rotations, rest_transforms
from tempose.rigging.pose_fit.dual_descent import descend_dual
from tempose.rigging.pose_fit.moments import FrameMoments, SkinMoments, about_joints
from tempose.rigging.pose_fit.starts import bone_sums
from tempose.rigging.pose_fit.sweep import sweep_back, sweep_forward
from tempose.rotations import continuous, from_matrix, rotate
from tempose.typing import BoolArray, FloatArray, IntArray, Progress, silent

_AT_ONCE = 64


@dataclass(frozen=True, eq=False)
class PoseFit:
    """Motion fitted to a clip."""

    motion: SkeletonClip
    """T frames."""
    errors: FloatArray
    """(T,) rms distance of skin and frame, metres; known to about 1e-8 of the size of the mesh."""
    iterations: IntArray
    """(T,) Newton steps, from all starts together."""
    converged: BoolArray
    """(T,) whether the last step could not lower the error any more."""


def fit_poses(
    skin: SkinnedMesh,
    frames: FloatArray,
    *,
    fps: float = 30.0,
    blending: str = "linear",
    skeleton: Skeleton | None = None,
    steps: int = 30,
    tolerance: float = 1e-6,
    progress: Progress = silent,
) -> PoseFit:
    """Fit the motion of a skeleton to frames.

    Parameters
    ----------
    skin : SkinnedMesh
        n vertices bound to J joints.
    frames : (T, n, 3) float
        Target positions, metres; an array or a memory map.
    fps : float, default 30.0
        Frames per second.
    blending : str, default "linear"
        ``"linear"`` or ``"dual-quaternion"``.
    skeleton : Skeleton, optional
        The joints of the skin with the bone lengths that they have in the clip; by default those of the bind
        pose. Files know skins whose clips were made on slightly other bones.
    steps : int, default 30
        Largest number of Newton steps from one start.
    tolerance : float, default 1e-6
        A frame is done when a step can lower its squared error by no more than this part.
    progress : Progress
        Told about every block of frames.

    Returns
    -------
    PoseFit
        Motion and how well it fits. Rotations keep the sign of the frame before.

    Raises
    ------
    ValueError
        If an argument cannot be used; the message names it.

    Notes
    -----
    Minimises the squared distance of all vertices in the turns of all joints and the place of the root, bone
    lengths fixed. The energy of linear blend skinning is a quadratic in the bone
    matrices, so that vertices are visited once (`SkinMoments`). Every frame starts from the frames before
    and from a closed form of its own; tracking alone can lose a limb for the rest of a clip.
    """
    if steps < 1:
        raise ValueError(f"steps must be at least 1, got {steps}")
    if blending not in ("linear", "dual-quaternion"):
        raise ValueError(f"blending must be 'linear' or 'dual-quaternion', got {blending!r}")
    made = SkinMoments(skin)
    seen = made.frames(frames)
    dual = frames if blending == "dual-quaternion" else None
    return _fit(made, seen, skeleton, dual, fps, steps, tolerance, progress)


def fit_moments(
    made: SkinMoments,
    seen: FrameMoments,
    *,
    fps: float = 30.0,
    steps: int = 30,
    tolerance: float = 1e-6,
    progress: Progress = silent,
) -> PoseFit:
    """Fit the motion of a skeleton to frames of which only the moments are left.

    Parameters
    ----------
    made : SkinMoments
        Of the skin, n vertices and J joints.
    seen : FrameMoments
        Of T frames.
    fps : float, default 30.0
        Frames per second.
    steps : int, default 30
        Largest number of Newton steps from one start.
    tolerance : float, default 1e-6
        A frame is done when a step can lower its squared error by no more than this part.
    progress : Progress
        Told about every block of frames.

    Returns
    -------
    PoseFit
        Motion and how well it fits.
    """
    return _fit(made, seen, None, None, fps, steps, tolerance, progress)


def _fit(
    made: SkinMoments,
    seen: FrameMoments,
    posed: Skeleton | None,
    frames: FloatArray | None,
    fps: float,
    steps: int,
    tolerance: float,
    progress: Progress,
) -> PoseFit:
    skeleton = made.skin.skeleton
    joints = rest_transforms(skeleton)[1] - made.centre
    parents = skeleton.parents.astype(np.int64)
    bones = bone_steps(skeleton, posed or skeleton)
    A, B = about_joints(made.A, seen.moments, joints)
    T, J = len(seen), len(parents)
    R, root, values = np.zeros((T, J, 3, 3)), np.zeros((T, 3)), np.zeros(T)
    iterations, converged = np.zeros(T, dtype=np.int64), np.zeros(T, dtype=np.bool_)
    known = (A, B, seen.energies)
    found = (R, root, values, iterations, converged, steps, tolerance)
    sums = bone_sums(A)
    for t in range(0, T, _AT_ONCE):
        stop = min(t + _AT_ONCE, T)
        sweep_forward(t, stop, *known, sums, parents, bones, *found)
        progress(stop, T, "poses")
    sweep_back(*known, parents, bones, *found)
    if frames is not None:
        descend_dual(made, seen, frames, A, bones, *found, progress)
    squares = np.maximum(values, 0.0) + seen.loose
    errors = np.sqrt(squares / len(made.skin.mesh.vertices))
    rotations = continuous(local_rotations(skeleton, from_matrix(R)))
    motion = SkeletonClip(posed or skeleton, rotations, root + seen.centres, fps)
    return PoseFit(motion, errors, iterations, converged)


def bone_steps(bind: Skeleton, posed: Skeleton) -> FloatArray:
    """Take the steps from parent to joint that the turn of the parent's bone carries into the world.

    Parameters
    ----------
    bind : Skeleton
        J joints in the bind pose.
    posed : Skeleton
        The same joints, perhaps with other bone lengths.

    Returns
    -------
    (J, 3) ndarray
        Metres, in the axes of the bind pose; zero for the root.

    Raises
    ------
    ValueError
        If the joints differ.
    """
    if posed.names != bind.names or (posed.parents != bind.parents).any():
        raise ValueError(
            f"skeleton must have the {bind.n_joints} joints of the skin in their order, "
            f"got {posed.n_joints}, first {posed.names[0]!r}"
        )
    steps = rotate(rest_transforms(bind)[0][np.maximum(bind.parents, 0)], posed.offsets)
    steps[0] = 0
    return steps
