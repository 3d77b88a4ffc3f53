"""A skeleton clip moves a mesh: the stages of the paper's section 5, in order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Mesh, SkeletonClip
from tempose.kinematics.roles import find_roles
from tempose.rotations import multiply
from tempose.transfer.bodies.bones import Bones, make_bones, split_role
from tempose.transfer.bodies.facing import UP
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.feet.feet import Feet, bone_feet, flat_stance
from tempose.transfer.joint_patches import inner_strengths, joint_patches, volume_fill
from tempose.transfer.lead import LEAD, learn_lead
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.pairing.skin_pairs import estimate_joints
from tempose.transfer.solver.fabric import Fabric, weave
from tempose.transfer.solver.fields import HarmonicFields
from tempose.transfer.solver.motion_transfer import Anchor, MotionTransfer
from tempose.transfer.turns.alignment import align_reference
from tempose.transfer.turns.columns import Columns
from tempose.transfer.turns.geodesic_path import path_columns
from tempose.transfer.turns.reference import Reference, bone_motion, choose_reference
from tempose.transfer.turns.references import References, Singular
from tempose.transfer.turns.signs import consistent_signs
from tempose.transfer.turns.twist_columns import twist_columns
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True)
class Prepared:
    """All that is fixed before the first frame is solved."""

    solver: MotionTransfer
    """Factorised target."""
    rotations: FloatArray
    """(T, C, 4) rotations of the target's marks, signs agreeing: the bones first, then those between two."""
    anchor_path: FloatArray
    """(T, 3) movement of the source's anchor from its reference place, metres."""
    feet: Feet
    """Feet of both."""
    leg_ratio: float
    """Leg length of the target over that of the source."""
    source_height: float
    """Metres."""
    owner: IntArray
    """(n,) bone of largest influence on each target vertex."""
    bones: Bones | None = None
    """The B bones, for a skeleton source."""
    columns: Columns | None = None
    """What the C rotations stand for: ``columns.rotations(Q_bones)`` makes them from (T, B, 4)."""
    motion: BonePose | None = None
    """(T, B) the source's bones."""
    target: BonePose | None = None
    """(B,) the target's bones at rest."""
    chosen: str = ""
    """Which reference was taken."""
    first_frame: int = 0
    """First frame of the source that is motion."""
    warnings: tuple[str, ...] = ()
    """What is doubtful."""
    references: References | None = None
    """Frames that serve as reference pose beside the rest."""


def prepare_skeleton(
    clip: SkeletonClip,
    mesh: Mesh,
    pairs: Pairs,
    *,
    mapping: dict[str, str] | None = None,
    rest_clip: SkeletonClip | None = None,
    rest_frame: int | None = None,
    volume: float = 0.0,
    twist: bool = True,
    lead: float = LEAD,
    singular: Singular = "reference",
    fabric: Fabric | None = None,
) -> Prepared:
    """Do everything that comes before the frames.

    Parameters
    ----------
    clip : SkeletonClip
        Source.
    mesh : Mesh
        Target at rest.
    pairs : Pairs
        Of kind ``"joints"``, checked.
    mapping : dict of str to str, optional
        Source joint to body role.
    rest_clip : SkeletonClip, optional
        Clip of the same skeleton that holds the reference pose.
    rest_frame : int, optional
        Frame of the reference pose, in `rest_clip` or the source.
    volume : float, default 0
        See `MotionTransfer`.
    twist : bool, default True
        Whether forearms, upper arms and thighs take up the twist at their ends little by little.
    lead : float, default 0.6
        Share of the limbs' lag behind their bones that is made up for, see `Lead`.
    singular : {"reference", "path", "none"}, default "reference"
        What is done where a bone turns by half a turn against its parent; paths are laid here.
    fabric : Fabric, optional
        See `MotionTransfer`.

    Returns
    -------
    Prepared
        Solver, rotations and paths.

    Raises
    ------
    ValueError
        If the reference clip has another skeleton, or no frame is left.
    """
    roles = find_roles(clip.skeleton, mapping)
    bones = make_bones(clip.skeleton, tuple(dict.fromkeys(pairs.source)), roles)  # type: ignore[arg-type]
    marks = np.array([bones.names.index(str(name)) for name in pairs.source])
    fabric = fabric or weave(mesh)
    target = _target_pose(mesh, bones, pairs, marks, fabric)
    reference = _reference(clip, bones, roles, target, rest_clip, rest_frame)
    moving = clip.frames(slice(reference.first_frame, None))
    motion = bone_motion(moving, bones, roles)
    height = _source_height(reference, motion)
    standing = flat_stance(bones, motion, height, clip.fps)
    K = align_reference(bones, motion, reference.pose, target, standing, reference.upright)
    Q = consistent_signs(multiply(motion.turns, K), bones.parents)
    far = Q if singular == "path" else None
    solver, columns = _solver(mesh, pairs, bones, marks, target, volume, twist, far, fabric)
    basis = solver.basis
    assert basis is not None
    basis = columns.of_bones(basis)
    solver.anchor = _pelvis(mesh, basis, bones, target)
    owner = basis.argmax(axis=1)
    solver.fill = volume_fill(solver, joint_patches(solver, bones, target, owner), volume)
    if lead > 0:
        Q = learn_lead(solver, columns, bones, motion, target, owner, Q).turned(Q, lead)
    return Prepared(
        solver,
        columns.rotations(Q),
        _anchor_points(bones, motion) - _anchor_points(bones, reference.pose),
        bone_feet(bones, motion, target, owner, height, clip.fps, mesh.vertices),
        _leg_ratio(bones, target, motion),
        height,
        owner,
        bones,
        columns,
        motion,
        target,
        reference.chosen,
        reference.first_frame,
        reference.warnings,
    )


def _reference(
    clip: SkeletonClip,
    bones: Bones,
    roles: dict[str, int],
    target: BonePose,
    rest_clip: SkeletonClip | None,
    rest_frame: int | None,
) -> Reference:
    if rest_clip is None:
        return choose_reference(clip, bones, roles, target, rest_frame)
    if rest_clip.skeleton.names != clip.skeleton.names:
        raise ValueError(
            "source_rest must hold the same joints as the source, got "
            f"{rest_clip.skeleton.n_joints} joints against {clip.skeleton.n_joints}"
        )
    chosen = choose_reference(rest_clip, bones, roles, target, rest_frame)
    return Reference(
        chosen.pose,
        chosen.upright,
        f"{chosen.chosen} of {rest_clip.name or 'source_rest'}",
        warnings=chosen.warnings,
    )


def _solver(
    mesh: Mesh,
    pairs: Pairs,
    bones: Bones,
    marks: IntArray,
    target: BonePose,
    volume: float,
    twist: bool,
    far: FloatArray | None,
    fabric: Fabric,
) -> tuple[MotionTransfer, Columns]:
    marked = mesh.faces[pairs.target]
    columns, of_mark = Columns(len(bones.names)), marks
    if twist:
        columns, of_mark = twist_columns(bones, target, mesh.vertices[marked].mean(axis=1), marks)
    vertices, of_vertex = marked.ravel(), np.repeat(of_mark, 3)
    if far is not None:
        spread = frozenset(e.second for e in columns.between)
        between, along, station = path_columns(
            mesh.vertices, mesh.faces, vertices, np.repeat(marks, 3), bones.parents, far, spread
        )
        vertices = np.concatenate([vertices, along])
        of_vertex = np.concatenate([of_vertex, len(columns) + station])
        columns = Columns(columns.n_bones, columns.between + between)
    strengths = inner_strengths([bones.roles[b] for b in columns.bones], volume)
    solver = MotionTransfer(
        mesh, vertices, of_vertex, len(columns), volume=strengths, precision="single", fabric=fabric
    )
    return solver, columns


def _target_pose(mesh: Mesh, bones: Bones, pairs: Pairs, marks: IntArray, fabric: Fabric) -> BonePose:
    starts, ends = np.zeros((2, len(bones.names), 3))
    if not all(name in pairs.joints and name in pairs.ends for name in bones.names):
        marked = mesh.faces[pairs.target].ravel()
        columns = np.repeat(marks, 3)
        fields = HarmonicFields(
            fabric.field_matrix, fabric.inverse[marked], columns, len(bones.names), fabric.order
        )
        assert fields.basis is not None
        starts, ends = estimate_joints(mesh.vertices, fields.basis[fabric.inverse], bones.parents)
    for b, name in enumerate(bones.names):
        if name in pairs.joints:
            starts[b] = pairs.joints[name]
    for b, name in enumerate(bones.names):
        if name in pairs.ends:
            ends[b] = pairs.ends[name]
    turns = np.tile([1.0, 0, 0, 0], (len(bones.names), 1))
    return BonePose(turns, starts, ends)


def _pelvis(mesh: Mesh, basis: FloatArray, bones: Bones, target: BonePose) -> Anchor:
    """Pelvis: the midpoint of the hip joints, carried by the vertices of the root bone."""
    # only where the root bone alone rules: a skirt hangs on the hips too, but swings with the thighs
    weights = np.where(basis[:, 0] > 0.95, basis[:, 0], 0.0)
    weights = weights if weights.sum() > 0 else np.maximum(basis[:, 0], 1e-9) ** 4
    return Anchor(weights / weights.sum(), 0, _anchor_points(bones, target))


def _anchor_points(bones: Bones, pose: BonePose) -> FloatArray:
    thighs = [b for side in ("left_", "right_") if (b := bones.find(side + "thigh")) is not None]
    return pose.starts[..., thighs or [0], :].mean(axis=-2)


def _leg_ratio(bones: Bones, target: BonePose, motion: BonePose) -> float:
    """Length of thigh and shin in the target over that in the source; of all bones where there are none."""
    ours, theirs = target.lengths, np.median(motion.lengths, axis=0)
    legs = [b for b, role in enumerate(bones.roles) if split_role(role)[1] in ("thigh", "shin")]
    if not legs or theirs[legs].sum() <= 0 or ours[legs].sum() <= 0:
        legs = [b for b in range(len(ours)) if ours[b] > 0 and theirs[b] > 0]
    if not legs:
        return 1.0
    return float(ours[legs].sum() / theirs[legs].sum())


def _source_height(reference: Reference, motion: BonePose) -> float:
    """Height of the source: of its reference pose where that stands, else the tallest of its frames."""

    def extent(pose: BonePose) -> FloatArray:
        points = np.concatenate([pose.starts, pose.ends], axis=-2) @ UP
        return np.ptp(points, axis=-1)

    tallest = float(np.percentile(extent(motion), 95))
    return max(float(extent(reference.pose)), 1e-6) if reference.upright else max(tallest, 1e-6)
