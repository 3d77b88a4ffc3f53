"""A motion of any skeleton on the joints of ours."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.kinematics import find_roles, forward_kinematics, rest_transforms
from tempose.rigging.motions.pairing import JointPairs, listed, pair_joints
from tempose.rigging.motions.rests import Rests, axes_turn, compare_rests
from tempose.rigging.motions.travel import root_path
from tempose.rotations import conjugate, continuous, multiply, rotate, slerp
from tempose.typing import FloatArray

_WORTH_SAYING = 10.0
_DOUBTFUL = 40.0


@dataclass(frozen=True)
class MotionMatch:
    """A motion on our joints, and what had to be done for it."""

    motion: SkeletonClip
    """T frames on our joints, at the rate of the source."""
    pairs: JointPairs
    """Which joint moves which."""
    rest_angles: FloatArray
    """(J,) degrees between the bones of both rest poses, NaN where there is no pair of bones."""
    scale: float
    """What the travel of the root was multiplied by."""
    warnings: tuple[str, ...]
    """What is doubtful, one sentence each."""


def match_motion(
    skeleton: Skeleton,
    motion: SkeletonClip,
    mapping: Mapping[str, str] | None = None,
    *,
    missing: Literal["error", "rest"] = "error",
) -> SkeletonClip:
    """Put the motion of another skeleton, or of ours from a file, onto our joints.

    Parameters
    ----------
    skeleton : Skeleton
        Ours, J joints.
    motion : SkeletonClip
        T frames of theirs.
    mapping : mapping of str to str, optional
        Their joint to ours, where names do not tell.
    missing : str, default "error"
        What to do where a joint that matters moves nothing: ``"error"``, or ``"rest"`` to leave it at rest.

    Returns
    -------
    SkeletonClip
        T frames on our joints; warnings stand in ``source.notes``.

    Raises
    ------
    ValueError
        If joints that matter are missing, or the mapping is wrong; the message lists both sides.

    See Also
    --------
    matched_motion : The same with a full account.
    """
    return matched_motion(skeleton, motion, mapping, missing=missing).motion


def matched_motion(
    skeleton: Skeleton,
    motion: SkeletonClip,
    mapping: Mapping[str, str] | None = None,
    *,
    missing: Literal["error", "rest"] = "error",
) -> MotionMatch:
    """Put a motion onto our joints, and say which moves which and what is doubtful.

    Parameters
    ----------
    skeleton, motion, mapping, missing
        As for `match_motion`.

    Returns
    -------
    MotionMatch
        The motion and the account.

    Raises
    ------
    ValueError
        As for `match_motion`.

    Notes
    -----
    Joints turn in the world as theirs do, relative to a pose that both skeletons can take: ours at rest with
    its bones laid along theirs. So it does not matter in which pose either is at rest, nor along which axes
    its joints have their bases. The root goes where theirs goes, in proportion to the legs.
    """
    if missing not in ("error", "rest"):
        raise ValueError(f"missing must be 'error' or 'rest', got {missing!r}")
    source = motion.skeleton
    pairs = pair_joints(skeleton, source, mapping)
    warnings = _leftovers(skeleton, source, pairs, missing)
    turn = axes_turn(skeleton, source, pairs.source)
    if turn is not None:
        motion = _turned(motion, turn)
        warnings.append("The motion lay along other axes than the rig; it was turned by right angles to fit.")
    rests = compare_rests(skeleton, motion, pairs.source)
    local = _rotations(skeleton, motion, pairs, rests)
    places = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)[1]
    root = root_path(skeleton, local, places, pairs.source, rests)
    warnings += _rest_warnings(skeleton, rests)
    notes = (*motion.source.notes, *warnings)
    moved = SkeletonClip(
        skeleton, continuous(local), root, motion.fps, motion.name, replace(motion.source, notes=notes)
    )
    return MotionMatch(moved, pairs, rests.angles, rests.scale, tuple(warnings))


def _leftovers(skeleton: Skeleton, source: Skeleton, pairs: JointPairs, missing: str) -> list[str]:
    needed = list(pairs.needed)
    if needed and (missing == "error" or not pairs.source or 0 not in pairs.source):
        raise ValueError(
            f"the motion has no joints for {listed(needed)} of the rig; it has {listed(source.names)}. "
            "Name them in a mapping, {their joint: ours}"
        )
    warnings: list[str] = []
    if pairs.missing:
        warnings.append(f"Nothing moves {listed(pairs.missing)}: held at rest against the joints above.")
    if pairs.by_role:
        names = [f"{source.names[pairs.source[skeleton.index(n)]]} for {n}" for n in pairs.by_role]
        warnings.append(f"Taken by the part they play: {listed(names)}.")
    return warnings


def _turned(motion: SkeletonClip, turn: FloatArray) -> SkeletonClip:
    """Turn a whole motion about the origin."""
    source = motion.skeleton
    rest, rotations = np.array(source.rest_rotations), np.array(motion.rotations)
    rest[0], rotations[:, 0] = multiply(turn, rest[0]), multiply(turn, rotations[:, 0])
    offsets = np.array(source.offsets)
    offsets[0] = rotate(turn, offsets[0])
    turned = replace(source, offsets=offsets, rest_rotations=rest)
    return replace(
        motion, skeleton=turned, rotations=rotations, root_position=rotate(turn, motion.root_position)
    )


def _rotations(skeleton: Skeleton, motion: SkeletonClip, pairs: JointPairs, rests: Rests) -> FloatArray:
    """Local rotations (T, J, 4) of our joints."""
    source = motion.skeleton
    theirs = forward_kinematics(source, motion.rotations, motion.root_position)[0]
    relative = multiply(theirs, conjugate(rests.reference.rotations))
    posed = multiply(rests.turns, rest_transforms(skeleton)[0])
    halfway = {} if rests.same else _bent_spine(skeleton, source, pairs)
    assert skeleton.rest_rotations is not None
    local = np.tile(skeleton.rest_rotations, (motion.n_frames, 1, 1))
    world = np.array(local)
    for j, parent in enumerate(skeleton.parents):
        above = world[:, parent] if j else np.array([1.0, 0, 0, 0])
        if j in pairs.source:
            k = pairs.source[j]
            moved = (
                relative[:, k] if j not in halfway else slerp(relative[:, k], relative[:, halfway[j]], 0.5)
            )
            world[:, j] = multiply(moved, posed[j])
            local[:, j] = multiply(conjugate(above), world[:, j])
        else:
            world[:, j] = multiply(above, local[:, j])
    return local


def _bent_spine(skeleton: Skeleton, source: Skeleton, pairs: JointPairs) -> dict[int, int]:
    """Our spine that stands for two of theirs goes half way with each."""
    ours, theirs = find_roles(skeleton), find_roles(source)
    if "chest" in ours or "spine" not in ours or "chest" not in theirs:
        return {}
    return {ours["spine"]: theirs["chest"]} if ours["spine"] in pairs.source else {}


def _rest_warnings(skeleton: Skeleton, rests: Rests) -> list[str]:
    notes = [rests.reference.note] if rests.reference.note else []
    if rests.same or np.isnan(rests.angles).all() or np.nanmax(rests.angles) < _WORTH_SAYING:
        return notes
    worst = int(np.nanargmax(rests.angles))
    line = f"Rest poses differ by up to {rests.angles[worst]:.0f} degrees, at {skeleton.names[worst]}"
    if rests.angles[worst] < _DOUBTFUL:
        return [*notes, f"{line}; the motion is carried over relative to the pose that both can take."]
    return [
        *notes,
        f"{line}: look at the result; a source at rest in a pose nearer to the rig's follows better.",
    ]
