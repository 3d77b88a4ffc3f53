"""The whole way from a clip and a body to a moving body."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import about, clip_of, human_body, rolled, scaled, t_body, t_pose, turned
from transfer_zoo import sphere, wxyz

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.geometry import find_defects
from tempose.rotations import angle_between, conjugate, multiply
from tempose.samples.skeletons import human_skeleton
from tempose.samples.walk import walk
from tempose.transfer import Pairs, TransferResult, pairs_from_skin, transfer_motion
from tempose.transfer.from_skeleton import prepare_skeleton
from tempose.transfer.turns.reference import bone_motion

NUMBERS = (
    "edge_ratio", "edge_ratio_max", "flipped_percent", "folded_percent", "volume_worst", "volume_mean",
    "quaternion_norm_min", "skate", "source_skate",
)  # fmt: skip

FRAMES, FPS = 20, 20.0


@lru_cache
def walking(skeleton: str = "t", frames: int = FRAMES) -> SkeletonClip:
    motion = walk(t_pose() if skeleton == "t" else human_skeleton(), duration=frames / FPS, fps=FPS)
    clip = SkeletonClip(motion.skeleton, motion.rotations, motion.root_position, motion.fps, "walk")
    return clip.frames(slice(0, frames))


@lru_cache
def walked() -> TransferResult:
    return transfer_motion(walking(), human_body())


def same_numbers(a: TransferResult, b: TransferResult, rel: float = 1e-3) -> None:
    for name in NUMBERS:
        assert a.report[name] == pytest.approx(b.report[name], rel=rel, abs=1e-3), name
    assert a.report["bone_direction_deg"]["max"] == pytest.approx(
        b.report["bone_direction_deg"]["max"], abs=0.01
    )
    assert a.report["reference"] == b.report["reference"]


def as_double(result: TransferResult) -> np.ndarray:
    return np.asarray(result.clip.vertices, dtype=np.float64)


# ---- a skeleton drives the body that was made for it


@pytest.mark.parametrize("contacts", [True, False])
def test_at_rest_the_body_rests(contacts: bool) -> None:
    body = human_body()
    still = clip_of(body.skeleton, {}, 3)
    job = prepare_skeleton(still, body.mesh, pairs_from_skin(body.skeleton, body))
    V = job.solver.pose(job.rotations)
    assert_allclose(V, np.broadcast_to(body.mesh.vertices, V.shape), rtol=0, atol=1e-9 * body.mesh.diagonal)
    result = transfer_motion(still, body, contacts=contacts)
    assert_allclose(as_double(result), V, rtol=0, atol=1e-6 * body.mesh.diagonal)
    assert result.report["bone_direction_deg"]["max"] < 1e-3


@pytest.mark.slow
def test_the_built_in_human_rests_when_its_skeleton_does() -> None:
    from tempose.samples.character import human

    body = human(2000)
    still = clip_of(body.skeleton, {}, 2)
    for volume in (0.0, 1.0):
        job = prepare_skeleton(still, body.mesh, pairs_from_skin(body.skeleton, body), volume=volume)
        V = job.solver.pose(job.rotations)
        assert_allclose(
            V, np.broadcast_to(body.mesh.vertices, V.shape), rtol=0, atol=1e-9 * body.mesh.diagonal
        )


def test_marks_turn_exactly_as_the_bones_of_their_own_skeleton() -> None:
    body, clip = human_body(), walking("a")
    job = prepare_skeleton(clip, body.mesh, pairs_from_skin(body.skeleton, body), lead=0)
    motion = bone_motion(clip, job.bones, {})
    assert_allclose(
        angle_between(job.rotations[:, : len(job.bones.names)], motion.turns), 0, rtol=0, atol=1e-7
    )
    # and so do the bones of a skeleton with other local axes, away from their own rest
    other = rolled(clip, np.random.default_rng(3))
    job = prepare_skeleton(other, body.mesh, pairs_from_skin(other.skeleton, body), lead=0)
    assert_allclose(
        angle_between(job.rotations[:, : len(job.bones.names)], motion.turns), 0, rtol=0, atol=1e-6
    )


def test_the_anchor_goes_where_the_hips_go() -> None:
    """The midpoint of the hip joints moves with the pelvis of the source, lengths scaled by the legs'."""
    body, clip = human_body(), walking("a")
    result = transfer_motion(clip, body, contacts=False, measure=False)
    job = prepare_skeleton(clip, body.mesh, pairs_from_skin(body.skeleton, body))
    V = as_double(result)
    anchor = job.solver.anchor
    placed = np.einsum("n,tni->ti", anchor.weights, V)
    arm = anchor.point - anchor.weights @ body.mesh.vertices
    turns = Rotation.from_quat(job.rotations[:, 0][:, [1, 2, 3, 0]])
    joints = placed + turns.apply(arm)
    path = job.anchor_path * [result.report["scale"], result.report["scale_vertical"], result.report["scale"]]
    assert_allclose(np.diff(joints, axis=0), np.diff(path, axis=0), rtol=0, atol=1e-5)
    assert result.report["scale_vertical"] == pytest.approx(1, abs=1e-9)


# ---- another body


def test_a_t_pose_source_moves_an_a_pose_body_bone_by_bone() -> None:
    report = walked().report
    assert report["bone_direction_deg"]["mean"] < 3
    assert report["bone_direction_deg"]["max"] < 8
    assert report["flipped_percent"] == 0
    assert report["volume_worst"] > -5
    assert report["quaternion_norm_min"] > 0.9
    assert report["skate"] < 5
    assert report["warnings"] == []


def test_standing_soles_lie_on_the_ground() -> None:
    body, result = human_body(), walked()
    job = prepare_skeleton(walking(), body.mesh, pairs_from_skin(walking().skeleton, body))
    standing = job.feet.contact.any(axis=1)
    lowest = as_double(result)[standing, :, 1].min(axis=1) - body.mesh.vertices[:, 1].min()
    assert np.abs(lowest).max() < 0.01 * body.mesh.height
    assert standing.sum() > 10


@pytest.mark.parametrize("degrees", [90, 180, -57])
def test_a_turned_source_gives_the_turned_body_and_the_same_report(degrees: float) -> None:
    turn = about("y", degrees)
    other = transfer_motion(turned(walking(), turn), human_body())
    R = Rotation.from_quat(turn[[1, 2, 3, 0]]).as_matrix()
    V, expected = as_double(other), as_double(walked()) @ R.T
    shift = (V - expected).mean(axis=(0, 1))
    D = human_body().mesh.diagonal
    assert_allclose(V, expected + shift, rtol=0, atol=1e-5 * D)
    assert abs(shift[1]) < 1e-5 * D
    same_numbers(other, walked())
    assert other.report["scale"] == pytest.approx(walked().report["scale"], rel=1e-6)


def test_a_source_in_centimetres_says_the_same() -> None:
    other = transfer_motion(scaled(walking(), 100.0), human_body())
    assert_allclose(as_double(other), as_double(walked()), rtol=0, atol=1e-5 * human_body().mesh.diagonal)
    same_numbers(other, walked())
    assert 100 * other.report["scale"] == pytest.approx(walked().report["scale"], rel=1e-6)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_a_target_in_another_unit_moves_the_same(unit: float) -> None:
    body = human_body()
    s = body.skeleton
    skeleton = Skeleton(s.names, s.parents, unit * s.offsets, s.rest_rotations, unit * s.tips)
    mesh = Mesh(unit * body.mesh.vertices, body.mesh.faces)
    other = transfer_motion(walking(), SkinnedMesh(mesh, skeleton, body.weights))
    expected = unit * as_double(walked())
    assert_allclose(as_double(other), expected, rtol=0, atol=1e-5 * mesh.diagonal)
    same_numbers(other, walked())
    assert other.report["scale"] == pytest.approx(unit * walked().report["scale"], rel=1e-6)
    assert other.report["root_correction_m"] == pytest.approx(
        unit * walked().report["root_correction_m"], rel=1e-4
    )


def test_local_axes_of_the_source_mean_nothing(rng) -> None:
    other = transfer_motion(rolled(walking(), rng), human_body(), measure=False)
    assert_allclose(as_double(other), as_double(walked()), rtol=0, atol=1e-5 * human_body().mesh.diagonal)


def test_the_same_input_gives_the_same_bytes() -> None:
    again = transfer_motion(walking(), human_body(), measure=False)
    assert again.clip.vertices.tobytes() == walked().clip.vertices.tobytes()


def test_a_t_pose_in_frame_0_is_dropped() -> None:
    clip = walking()
    skeleton = clip.skeleton
    q = np.concatenate([np.asarray(skeleton.rest_rotations)[None], clip.rotations])
    first = SkeletonClip(skeleton, q, np.concatenate([skeleton.offsets[:1], clip.root_position]), clip.fps)
    result = transfer_motion(first, human_body(), measure=False)
    assert result.report["first_frame"] == 1 and result.clip.n_frames == clip.n_frames
    assert_allclose(as_double(result), as_double(walked()), rtol=0, atol=1e-5 * human_body().mesh.diagonal)


def test_the_reference_may_stand_in_another_clip() -> None:
    clip = walking()
    other = clip_of(clip.skeleton, {}, 4)
    result = transfer_motion(clip, human_body(), source_rest=other, rest_frame=2, measure=False)
    assert "frame 2 of" in result.report["reference"] and result.clip.n_frames == clip.n_frames
    assert_allclose(as_double(result), as_double(walked()), rtol=0, atol=1e-5 * human_body().mesh.diagonal)


def test_joints_are_estimated_where_pairs_state_none() -> None:
    """Pairs from a plain file know faces only; the pose stays right to a few degrees."""
    body = human_body()
    full = pairs_from_skin(walking().skeleton, body)
    bare = Pairs("joints", full.source, full.target)
    report = transfer_motion(walking(), body.mesh, bare).report
    # judged by the true joints
    job = prepare_skeleton(walking(), body.mesh, bare)
    truth = prepare_skeleton(walking(), body.mesh, full)
    B = len(job.bones.names)
    angle = np.degrees(angle_between(job.rotations[:, :B], truth.rotations[:, :B]))
    assert np.median(angle) < 12
    assert report["flipped_percent"] < 0.5


def test_volume_edges_keep_the_body_fuller() -> None:
    crouch = clip_of(
        t_pose(),
        {s + "_thigh": about("x", -95) for s in ("left", "right")}
        | {s + "_shin": about("x", 110) for s in ("left", "right")},
        1,
    )
    without = transfer_motion(crouch, human_body(), contacts=False).report["volume_worst"]
    with_ = transfer_motion(crouch, human_body(), contacts=False, volume=1.0).report["volume_worst"]
    assert without < -1 and with_ > 0.6 * without


def test_a_limb_wound_up_is_warned_of() -> None:
    angle = np.radians(np.linspace(0, 300, 31))
    wound = {"left_shin": wxyz(Rotation.from_rotvec(angle[:, None] * [0, 1.0, 0]))}
    report = transfer_motion(clip_of(t_pose(), wound, 31), human_body(), singular="none").report
    assert report["quaternion_norm_min"] < 0.5
    assert any("shortest quaternion" in w for w in report["warnings"])


@pytest.mark.parametrize("frames", [1, 2])
def test_clips_of_a_frame_or_two(frames: int) -> None:
    result = transfer_motion(walking().frames(slice(0, frames)), human_body())
    assert result.clip.n_frames == frames
    assert np.isfinite(result.clip.vertices).all()
    low = as_double(result)[:, :, 1].min(axis=1) - human_body().mesh.vertices[:, 1].min()
    assert np.abs(low).max() < 0.01


# ---- what comes back


def test_the_result_is_the_target_moving() -> None:
    body, result = human_body(), walked()
    clip = result.clip
    assert clip.fps == walking().fps and clip.vertices.dtype == np.float32
    assert clip.n_frames == walking().n_frames
    assert_array_equal(clip.faces, body.mesh.faces)
    assert_array_equal(clip.rest, body.mesh.vertices)
    assert result.report["pairs"]["count"] == len(result.pairs) and result.report["pairs"]["kind"] == "joints"
    total = result.report["seconds"].pop("total")
    assert total == pytest.approx(sum(result.report["seconds"].values()))
    result.report["seconds"]["total"] = total
    assert len(result.report["volume"]) == clip.n_frames


def test_the_source_is_given_back_as_closed_bones() -> None:
    source = walked().source
    assert source.n_frames == walked().clip.n_frames and source.fps == walking().fps
    defects = find_defects(source.rest, source.faces)
    assert defects.boundary_edges == 0 and defects.pieces == len(set(walked().pairs.source))


def test_measures_can_be_left_out() -> None:
    result = transfer_motion(walking().frames(slice(0, 3)), human_body(), measure=False)
    assert "edge_ratio" not in result.report and "skate" not in result.report
    assert {"seconds", "scale", "reference", "warnings"} <= set(result.report)


def test_progress_counts_all_frames_and_may_cancel() -> None:
    told: list[tuple[int, int, str]] = []
    transfer_motion(walking(), human_body(), progress=lambda *step: told.append(step), measure=False)
    frames = [done for done, _, stage in told if stage == "frames"]
    assert frames == sorted(frames) and frames[-1] == FRAMES
    assert all(total == FRAMES for _, total, _ in told)

    def cancel(done: int, total: int, stage: str) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        transfer_motion(walking(), human_body(), progress=cancel)


# ---- what is refused


def one_plane() -> Mesh:
    x, z = np.meshgrid(np.arange(5.0), np.arange(5.0))
    V = np.stack([x.ravel(), 0.5 * x.ravel() + z.ravel(), z.ravel()], axis=1)
    return Mesh(V, [[0, 1, 5], [1, 6, 5], [6, 7, 12]])


JOINT_PAIRS = Pairs("joints", ("hips", "head", "chest"), [0, 5, 9])
FACE_PAIRS = Pairs("faces", [0, 5, 9], [0, 5, 9])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"source": "empty"}, "source must have at least one frame, got none"),
        ({"target": Mesh(np.eye(3), [[0, 1, 2]])}, "at least 2 triangles, got 1"),
        ({"target": Mesh(np.eye(3), np.zeros((0, 3), int))}, "at least 2 triangles, got 0"),
        ({"target": one_plane()}, "target must have volume"),
        ({"embed": True}, "pairs are given; leave one of them out"),
        ({"source": "other", "pairs": None}, "human's skeleton; of the source's joints"),
        ({"source": "mesh", "pairs": None, "embed": True}, "embed needs a skeleton as source"),
        ({"pairs": FACE_PAIRS}, "pairs of kind 'faces' need a mesh clip as source, got a skeleton"),
        ({"pairs": Pairs("joints", ("hips", "knee"), [0, 1])}, "names joint 'knee'"),
        ({"pairs": Pairs("joints", ("hips", "head"), [0, 80])}, "target has 80"),
        ({"pairs": Pairs("joints", ("hips", "head", "head"), [0, 2, 2])}, "a second time"),
        ({"pairs": Pairs("joints", ("hips", "hips"), [0, 2])}, "too few"),
        ({"rest_frame": FRAMES}, f"source_rest must be a frame from 0 to {FRAMES - 1}, got {FRAMES}"),
        ({"rest_frame": -1}, f"source_rest must be a frame from 0 to {FRAMES - 1}, got -1"),
        ({"source_rest": sphere(1)}, "motion clip of the same skeleton, got a mesh"),
        ({"source_rest": "other"}, "source_rest must hold the same joints"),
        ({"source": "mesh"}, "pairs of kind 'joints' need a skeleton as source, got a mesh clip"),
        ({"source": "mesh", "pairs": None}, "needs pairs of faces or vertices"),
        ({"source": "mesh", "pairs": FACE_PAIRS, "rest_frame": 2}, "frame from 0 to 1, got 2"),
        ({"source": "mesh", "pairs": FACE_PAIRS, "source_rest": sphere(2)}, "must have the 42 vertices"),
        ({"source": "mesh", "pairs": FACE_PAIRS, "source_rest": "other"}, "must be a mesh like the source"),
        ({"source": "mesh", "pairs": Pairs("faces", [0, 1, 80], [0, 1, 2])}, "source triangle 80"),
        ({"source": "mesh", "pairs": Pairs("vertices", [0, 1, 2], [0, 1, 42])}, "target vertex 42"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(change: dict[str, object], message: str) -> None:
    ball = sphere(1)
    clips = {
        "empty": walking().frames(slice(0, 0)),
        "mesh": MeshClip(np.stack([ball.vertices] * 2), ball, 30.0),
        "other": clip_of(Skeleton(("a",), np.array([-1]), np.zeros((1, 3))), {}, 2),
    }
    given: dict[str, object] = {"source": walking(), "target": ball, "pairs": JOINT_PAIRS, **change}
    given = {k: clips.get(v, v) if isinstance(v, str) else v for k, v in given.items()}
    with pytest.raises(ValueError, match=message) as caught:
        transfer_motion(**given)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_what_fits_is_taken() -> None:
    ball = sphere(1)
    assert transfer_motion(walking(), ball, JOINT_PAIRS).clip.n_frames == FRAMES
    clip = MeshClip(np.stack([ball.vertices] * 2), ball, 30.0)
    for rest in ({}, {"rest_frame": 1}, {"source_rest": ball}):
        result = transfer_motion(clip, ball, FACE_PAIRS, **rest)
        assert_allclose(as_double(result), np.stack([ball.vertices] * 2), atol=1e-5)


def test_a_body_in_t_pose_and_one_in_a_pose_walk_alike() -> None:
    """The same motion on two bodies: their forearms point the same way although their rests differ."""
    a, t = walked(), transfer_motion(walking(), t_body())
    for report in (a.report, t.report):
        assert report["bone_direction_deg"]["mean"] < 3
    jobs = [
        prepare_skeleton(walking(), b.mesh, pairs_from_skin(walking().skeleton, b), lead=0)
        for b in (human_body(), t_body())
    ]
    for role in ("left_forearm", "right_upper_arm", "left_shin"):
        b = jobs[0].bones.roles.index(role)
        turns = [Rotation.from_quat(job.rotations[:, b][:, [1, 2, 3, 0]]) for job in jobs]
        pointing = [R.apply(job.target.directions[b]) for R, job in zip(turns, jobs)]
        assert_allclose(pointing[0], pointing[1], rtol=0, atol=1e-6)


def test_a_mapping_moves_a_body_whose_source_has_no_names() -> None:
    clip, body = walking(), human_body()
    s = clip.skeleton
    names = tuple(f"j{k}" for k in range(s.n_joints))
    blank = replace(clip, skeleton=Skeleton(names, s.parents, s.offsets, s.rest_rotations, s.tips))
    mapping = {f"j{k}": name for k, name in enumerate(s.names)}
    other = transfer_motion(blank, body, mapping=mapping, measure=False)
    assert_allclose(as_double(other), as_double(walked()), rtol=0, atol=1e-5 * body.mesh.diagonal)


def test_relative_turns_are_those_of_the_source_when_both_stand_alike() -> None:
    body, clip = t_body(), walking()
    job = prepare_skeleton(clip, body.mesh, pairs_from_skin(clip.skeleton, body), lead=0)
    knee = [job.bones.roles.index(r) for r in ("left_thigh", "left_shin")]
    relative = multiply(conjugate(job.rotations[:, knee[0]]), job.rotations[:, knee[1]])
    local = clip.rotations[:, clip.skeleton.index("left_shin")]
    assert_allclose(angle_between(relative, local), 0, atol=1e-6)
