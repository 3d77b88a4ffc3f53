"""Adjustments of a moving body: exact at their keys, smooth, local, and gone outside their windows."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import about, clip_of, human_body, scaled, t_pose, turned
from transfer_zoo import sphere, wxyz

from tempose.clips import Mesh, MeshClip, SkeletonClip, SkinnedMesh
from tempose.rotations import angle_between, procrustes_rotation, rotate
from tempose.samples.walk import walk
from tempose.transfer import Adjustment, Pairs, TransferResult, adjust, transfer_motion
from tempose.transfer.adjustments.parts import Part, bone_basis, find_part

FPS, FRAMES, KEY = 20.0, 30, 15
EASE: dict[str, Any] = {"ease_in": 0.3, "ease_out": 0.3}
"""Six frames."""


@lru_cache
def walking() -> SkeletonClip:
    motion = walk(t_pose(), duration=FRAMES / FPS, fps=FPS)
    clip = SkeletonClip(motion.skeleton, motion.rotations, motion.root_position, motion.fps, "walk")
    return clip.frames(slice(0, FRAMES))


@lru_cache
def base() -> TransferResult:
    return transfer_motion(walking(), human_body(), measure=False)


def frames(result: TransferResult) -> np.ndarray:
    return np.asarray(result.clip.vertices, dtype=np.float64)


def part_of(result: TransferResult, part: Any) -> Part:
    assert result.job is not None
    return find_part(result.job, part)


def move(part: Any, by: Any, frame: int = KEY, **more: Any) -> Adjustment:
    return Adjustment(part, frame=frame, move=by, **(EASE | more))


def moved(result: TransferResult, *adjustments: Adjustment) -> TransferResult:
    return adjust(result, adjustments, measure=False)


def distance(result: TransferResult, other: TransferResult | None = None) -> np.ndarray:
    return np.linalg.norm(frames(result) - frames(other or base()), axis=-1)


def owned(part: str) -> np.ndarray:
    job = base().job
    assert job is not None and job.bones is not None
    return np.flatnonzero(job.owner == job.bones.find(part))


def ruled(part: str, share: float) -> np.ndarray:
    """Vertices that move with one bone alone."""
    job = base().job
    assert job is not None
    return np.flatnonzero(bone_basis(job)[:, part_of(base(), part).bone] > share)


# ---- a part is where it was asked


@pytest.mark.parametrize(
    ("part", "by"),
    [
        ("left_hand", (0.1, 0.15, 0.1)),
        ("right_hand", (-0.05, 0.1, 0.15)),
        ("left_foot", (0.05, 0.12, 0.0)),
        ("right_toes", (0.0, 0.1, -0.05)),
        ("head", (0.05, 0.0, 0.04)),
        ("chest", (0.0, 0.0, 0.04)),
        ("hips", (0.02, -0.06, 0.0)),
        ("root", (3.0, 1.0, -2.0)),
    ],
)
def test_a_part_moves_by_what_was_asked(part: str, by: tuple[float, ...]) -> None:
    result = moved(base(), move(part, by))
    point = part_of(base(), part)
    step = point.points(frames(result)) - point.points(frames(base()))
    assert_allclose(step[KEY], by, rtol=0, atol=1e-6)
    assert result.report["adjustments"]["unmet"] == []
    # frame by frame it follows the window, on both sides alike
    s = np.array([1, 2, 3, 4, 5]) / 6
    weight = s**3 * (s * (6 * s - 15) + 10)
    assert_allclose(step[KEY - 5 : KEY], np.outer(weight, by), rtol=0, atol=1e-6)
    assert_allclose(step[KEY + 1 : KEY + 6], np.outer(weight[::-1], by), rtol=0, atol=1e-6)


@pytest.mark.parametrize(("part", "held"), [("left_hand", 4), ("left_foot", 2), ("head", 3)])
def test_a_part_goes_to_a_place_and_stays(part: str, held: int) -> None:
    point = part_of(base(), part)
    place = point.points(frames(base()))[KEY] + np.array([0.03, 0.01, 0.04])
    result = moved(base(), Adjustment(part, frame=KEY, to=place, hold=held / FPS, **EASE))
    there = point.points(frames(result))[KEY : KEY + held + 1]
    assert_allclose(there, np.tile(place, (held + 1, 1)), rtol=0, atol=1e-6)
    assert result.report["adjustments"]["unmet"] == []


def test_vertices_are_a_part_too() -> None:
    fingers = owned("left_hand")[::7]
    knee = owned("right_shin")[:3]
    belly = owned("hips")[:1]
    for vertices, by in ((fingers, (0.05, 0.1, 0.1)), (knee, (0, 0.02, 0.02)), (belly, (0, 0, 0.03))):
        result = moved(base(), move(vertices, by))
        step = (frames(result) - frames(base()))[:, vertices].mean(axis=1)
        assert_allclose(step[KEY], by, rtol=0, atol=1e-6)


def test_joint_names_mean_the_same_as_roles() -> None:
    names = {name: f"J{i}" for i, name in enumerate(t_pose().names)}
    skeleton = replace(t_pose(), names=tuple(names.values()))
    source = replace(walking(), skeleton=skeleton)
    result = transfer_motion(
        source, human_body(), mapping={new: old for old, new in names.items()}, measure=False
    )
    by_role = moved(result, move("left_hand", (0, 0.1, 0)))
    by_name = moved(result, move(names["left_hand"], (0, 0.1, 0)))
    assert_array_equal(frames(by_role), frames(by_name))


def test_a_turned_head_is_turned_by_that_much_and_comes_back() -> None:
    a = Adjustment("head", frame=KEY, turn=(0, 30, 0), **EASE)
    result = moved(base(), a)
    mine = ruled("head", 0.99)
    before, after = frames(base())[KEY, mine], frames(result)[KEY, mine]
    turn = procrustes_rotation(before, after)
    assert_allclose(turn, Rotation.from_euler("y", 30, degrees=True).as_matrix(), rtol=0, atol=2e-3)
    assert_array_equal(frames(result)[KEY + 6], frames(base())[KEY + 6])


def test_turns_in_the_parts_own_axes_turn_with_it() -> None:
    """A man who walks to the left nods as one who walks ahead."""
    quarter = turned(walking(), about("y", 90))
    ahead, aside = base(), transfer_motion(quarter, human_body(), measure=False)
    for axes in ("part", "body"):
        nod = Adjustment("head", frame=KEY, turn=(25, 0, 0), axes=axes, **EASE)
        a, b = moved(ahead, nod), moved(aside, nod)
        steps = [frames(x)[KEY] - frames(y)[KEY] for x, y in ((a, ahead), (b, aside))]
        assert_allclose(steps[1], rotate(about("y", 90), steps[0]), rtol=0, atol=1e-5)
        assert np.abs(steps[0]).max() > 0.03


@pytest.mark.parametrize("part", ["left_hand", "right_foot", "head"])
def test_body_axes_turn_with_the_body(part: str) -> None:
    quarter = transfer_motion(turned(walking(), about("y", 90)), human_body(), measure=False)
    a = moved(base(), move(part, (0.05, 0.05, 0.05), axes="body"))
    b = moved(quarter, move(part, (0.05, 0.05, 0.05), axes="body"))
    turn = about("y", 90)
    assert_allclose(frames(b) - frames(quarter), rotate(turn, frames(a) - frames(base())), rtol=0, atol=2e-5)


# ---- and nothing else is


def test_outside_the_window_nothing_changes_at_all() -> None:
    result = moved(
        base(), move("left_hand", (0.1, 0.1, 0.1)), Adjustment("head", frame=KEY, turn=(0, 9, 0), **EASE)
    )
    same = np.r_[0 : KEY - 5, KEY + 6 : FRAMES]
    assert_array_equal(result.clip.vertices[same], base().clip.vertices[same])
    assert result.report["adjustments"]["frames_changed"] == 11
    assert (distance(result)[KEY - 5 : KEY + 6] > 0).any(axis=1).all()


def test_without_adjustments_the_result_is_the_result() -> None:
    assert adjust(base(), ()) is base()
    assert_array_equal(moved(base(), move("left_hand", (0, 0, 0))).clip.vertices, base().clip.vertices)


@pytest.mark.parametrize(
    ("part", "kept"),
    [
        ("left_hand", ["right_hand", "right_forearm", "left_foot", "left_shin", "right_thigh", "head"]),
        ("right_foot", ["left_foot", "left_shin", "left_thigh", "left_hand", "head", "chest"]),
        ("head", ["left_foot", "right_shin", "left_thigh"]),
    ],
)
def test_other_limbs_do_not_move_at_all(part: str, kept: list[str]) -> None:
    result = moved(base(), move(part, (0.03, 0.08, 0.04)))
    for other in kept:
        mine = ruled(other, 0.95)
        assert len(mine) > 5
        assert_array_equal(result.clip.vertices[:, mine], base().clip.vertices[:, mine], other)


def test_the_surface_is_not_torn() -> None:
    """Edges keep their length as well as they do in a transfer itself, round the joint too."""
    moves = {"left_hand": (0.1, 0.2, 0.1), "right_foot": (0, 0.15, 0.1), "head": (0.05, 0, 0.05)}
    for part, by in moves.items():
        F = base().clip.faces
        before, after = (x.clip.vertices[KEY] for x in (base(), moved(base(), move(part, by))))
        lengths = [np.linalg.norm(V[F] - V[np.roll(F, 1, axis=1)], axis=-1) for V in (before, after)]
        low, high = np.quantile(lengths[1] / lengths[0], [0.01, 0.99])
        assert 0.75 < low and high < 1.25


def test_feet_stay_when_the_hips_move() -> None:
    for a in (
        move("hips", (0.03, -0.07, 0.02)),
        Adjustment("hips", frame=KEY, turn=(0, 12, 0), **EASE),
        Adjustment("hips", frame=KEY, move=(0, -0.05, 0), turn=(8, 0, 0), **EASE),
    ):
        result = moved(base(), a)
        assert result.report["adjustments"]["unmet"] == []
        for foot in ("left_foot", "right_foot"):
            point = part_of(base(), foot)
            gap = point.points(frames(result)) - point.points(frames(base()))
            assert_allclose(gap, 0, rtol=0, atol=1e-6)
            assert distance(result)[:, ruled(foot, 0.9)].max() < (5e-3 if a.turn else 1e-6)


@pytest.mark.parametrize(("side", "out"), [("left", 1.0), ("right", -1.0)])
@pytest.mark.parametrize(("end", "middle"), [("hand", "forearm"), ("foot", "shin")])
def test_elbows_and_knees_swivel_outwards(side: str, out: float, end: str, middle: str) -> None:
    a = Adjustment(f"{side}_{end}", frame=KEY, swivel=25, **EASE)
    result = moved(base(), a)
    joint, tip, first = (
        part_of(base(), f"{side}_{part}") for part in (middle, end, "upper_arm" if end == "hand" else "thigh")
    )
    V, W = frames(base()), frames(result)
    assert_allclose(tip.points(W), tip.points(V), rtol=0, atol=1e-6)
    step = (joint.points(W) - joint.points(V))[KEY]
    assert out * step[0] > 0.005
    axis = tip.points(V)[KEY] - first.points(V)[KEY]
    assert abs(step @ axis) < 0.2 * np.linalg.norm(step) * np.linalg.norm(axis)
    assert_array_equal(W[KEY + 6 :], V[KEY + 6 :])


def test_only_limbs_swivel() -> None:
    for part in ("head", "left_forearm", "root"):
        with pytest.raises(ValueError, match="has no elbow or knee to swivel; name a hand or a foot"):
            moved(base(), Adjustment(part, frame=KEY, swivel=10))


def test_the_whole_body_turns_rigidly() -> None:
    result = moved(base(), Adjustment("root", frame=KEY, turn=(0, 70, 0), **EASE))
    V, W = frames(base())[KEY], frames(result)[KEY]
    turn = wxyz(Rotation.from_euler("y", 70, degrees=True))
    centre = part_of(base(), "root").points(V[None])[0]
    assert_allclose(W, centre + rotate(turn, V - centre), rtol=0, atol=1e-5)
    job, before = result.job, base().job
    assert job is not None and before is not None
    assert_allclose(
        angle_between(job.rotations[KEY], before.rotations[KEY]), np.radians(70), rtol=0, atol=1e-6
    )


# ---- smooth


def test_the_motion_stays_smooth() -> None:
    """What is added accelerates no more than its window does, by some factor for the bending limb."""
    still = clip_of(t_pose(), {"left_forearm": about("y", -40)}, 61, 60.0)
    result = transfer_motion(still, human_body(), measure=False)
    after = adjust(
        result, [Adjustment("left_hand", frame=30, move=(-0.1, 0.15, 0.05), ease_in=0.4, ease_out=0.4)]
    )
    path = frames(after)[:, owned("left_forearm")]
    acceleration = np.linalg.norm(np.diff(path, 2, axis=0), axis=-1)
    window_peak = 0.19 * 5.78 / 24**2
    assert acceleration.max() < 2.5 * window_peak
    jerk = np.linalg.norm(np.diff(path, 3, axis=0), axis=-1)
    assert jerk.max() < 2.5 * 0.19 * 61 / 24**3


def test_the_result_is_differentiable_in_the_move() -> None:
    def key_frame(s: float) -> np.ndarray:
        a = Adjustment(
            "left_hand", frame=1, move=np.array([0.05, 0.1, 0.05]) * (1 + s), ease_in=0, ease_out=0
        )
        return frames(moved(few, a))[1]

    few = transfer_motion(walking().frames(slice(14, 17)), human_body(), measure=False)
    h = 0.02
    V = {s: key_frame(s * h) for s in (-2, -1, 1, 2)}
    coarse, fine = (V[2] - V[-2]) / (4 * h), (V[1] - V[-1]) / (2 * h)
    assert np.abs(fine).max() > 0.1
    assert np.abs(coarse - fine).max() < 0.02 * np.abs(fine).max()


# ---- several


def test_keys_of_one_part_are_all_met() -> None:
    keys = [(8, (0.05, 0.1, 0.0)), (13, (0.0, 0.15, 0.08)), (20, (0.1, 0.05, 0.05))]
    result = moved(base(), *(move("left_hand", by, frame) for frame, by in keys))
    point = part_of(base(), "left_hand")
    step = point.points(frames(result)) - point.points(frames(base()))
    for frame, by in keys:
        assert_allclose(step[frame], by, rtol=0, atol=1e-6)


def test_order_does_not_matter_where_parts_do_not_touch() -> None:
    a, b = move("left_hand", (0, 0.1, 0.05)), move("right_foot", (0, 0.08, 0.02))
    assert_array_equal(frames(moved(base(), a, b)), frames(moved(base(), b, a)))
    c = move("chest", (0.03, 0, 0.03))
    place = part_of(base(), "right_hand").points(frames(base()))[KEY] + np.array([0, 0.05, 0.05])
    d = Adjustment("right_hand", frame=KEY, to=place, **EASE)
    both = moved(base(), d, c)
    # the hand finds its place although the chest that carries it moves
    assert_array_equal(frames(both), frames(moved(base(), c, d)))
    assert_allclose(part_of(base(), "right_hand").points(frames(both))[KEY], place, rtol=0, atol=1e-6)


def test_moves_of_one_frame_add_up() -> None:
    a, b = move("left_hand", (0, 0.1, 0)), move("left_hand", (0.05, 0, 0.05))
    assert_allclose(
        frames(moved(base(), a, b)),
        frames(moved(base(), move("left_hand", (0.05, 0.1, 0.05)))),
        rtol=0,
        atol=1e-6,
    )


def test_layers_are_undone_by_leaving_out_the_last() -> None:
    a, b = move("left_hand", (0, 0.1, 0)), move("left_hand", (0.05, 0, 0.05), KEY + 3)
    one = moved(base(), a)
    two = moved(one, b)
    assert two.base is base() and two.adjustments == (a, b)
    assert_array_equal(frames(two), frames(moved(base(), a, b)))
    assert two.base is not None
    assert_array_equal(frames(adjust(two.base, two.adjustments[:-1])), frames(one))
    assert_array_equal(frames(adjust(two.base, ())), frames(base()))


def test_transfer_takes_them_along(tmp_path: Path) -> None:
    a = move("left_hand", (0, 0.1, 0))
    result = transfer_motion(walking(), human_body(), adjustments=[a], scratch=tmp_path)
    assert_array_equal(frames(result), frames(moved(base(), a)))
    assert isinstance(result.clip.vertices.base, np.memmap) or isinstance(result.clip.vertices, np.memmap)
    assert result.report["adjustments"]["count"] == 1
    assert result.report["flipped_percent"] == 0
    assert result.report["seconds"]["adjustments"] > 0


# ---- other bodies


@pytest.mark.parametrize("unit", [0.01, 100.0])
def test_a_body_of_any_size(unit: float) -> None:
    body = human_body()
    mesh = body.mesh.with_vertices(unit * body.mesh.vertices)
    skeleton = scaled(clip_of(body.skeleton, {}, 1), unit).skeleton
    large = transfer_motion(walking(), SkinnedMesh(mesh, skeleton, body.weights), measure=False)
    by = np.array([0.05, 0.1, 0.1])
    a, b = moved(base(), move("left_hand", by)), moved(large, move("left_hand", unit * by))
    assert_allclose((frames(b) - frames(large)) / unit, frames(a) - frames(base()), rtol=0, atol=1e-4)


def test_a_body_moved_by_a_mesh_has_vertices_and_a_root() -> None:
    ball = sphere(2)
    V, F = ball.vertices * [0.3, 1.0, 0.3] + np.array([0, 1, 0]), ball.faces
    path = np.outer(np.arange(9), [0, 0, 0.1])
    source = MeshClip(V + path[:, None], Mesh(V, F), 10.0)
    some = np.arange(0, len(V), 5)
    result = transfer_motion(source, Mesh(V, F), Pairs("vertices", some, some), measure=False)
    top = int(V[:, 1].argmax())
    a = moved(result, Adjustment([top], frame=4, move=(0.1, 0.1, 0), ease_in=0.2, ease_out=0.2))
    step = frames(a) - frames(result)
    assert_allclose(step[4, top], [0.1, 0.1, 0], rtol=0, atol=1e-6)
    assert_array_equal(step[4, int(V[:, 1].argmin())], 0)
    assert_array_equal(step[[0, 1, 2, 6, 7, 8]], 0)
    b = moved(result, Adjustment("root", frame=4, move=(1, 0, 0), turn=(0, 90, 0), ease_in=0, ease_out=0))
    assert_allclose(np.ptp(frames(b)[4], axis=0), np.ptp(V, axis=0)[[2, 1, 0]], rtol=0, atol=1e-5)
    with pytest.raises(
        ValueError, match=r"adjustment 0: part 'head' needs a skeleton as source.*'root' or a list"
    ):
        moved(result, move("head", (0, 1, 0), 4))
    with pytest.raises(ValueError, match="adjustment 0: axes 'body' need a skeleton as source"):
        moved(result, move("root", (0, 1, 0), 4, axes="body"))
    with pytest.raises(ValueError, match="vertex 0 cannot be turned: no bone carries it"):
        moved(result, Adjustment([0], frame=4, turn=(0, 1, 0)))


# ---- what cannot be


def test_a_place_out_of_reach_is_reported_with_its_distance() -> None:
    point = part_of(base(), "left_hand")
    shoulder = part_of(base(), "left_upper_arm").points(frames(base()))[KEY]
    place = shoulder + np.array([0.0, 0.0, 3.0])
    result = moved(base(), Adjustment("left_hand", frame=KEY, to=place, **EASE))
    [unmet] = result.report["adjustments"]["unmet"]
    reached = point.points(frames(result))[KEY]
    assert unmet["distance_m"] == pytest.approx(np.linalg.norm(place - reached), abs=1e-6)
    assert (unmet["part"], unmet["frame"]) == ("left_hand", KEY)
    assert "'left_hand' at frame 15 misses its place by 2" in result.report["warnings"][-1]
    # as far as the arm goes, in the right direction, and no further
    arm = reached - shoulder
    assert arm[2] / np.linalg.norm(arm) > 0.99
    length = 2 * 0.26
    assert 0.8 * length < np.linalg.norm(arm) < 1.3 * length


def test_feet_that_cannot_be_kept_are_reported() -> None:
    result = moved(base(), move("hips", (0, 0.5, 0)))
    names = {entry["part"] for entry in result.report["adjustments"]["unmet"]}
    assert names == {"left_foot (kept)", "right_foot (kept)"}


def test_two_places_at_once_are_a_contradiction() -> None:
    a = Adjustment("left_hand", frame=KEY, to=(0, 1, 0), hold=0.3)
    b = Adjustment("left_hand", frame=KEY + 2, to=(0, 1.2, 0))
    with pytest.raises(
        ValueError, match=r"adjustments 0 and 2 contradict each other: 'left_hand' cannot be at .*frame 17"
    ):
        moved(base(), a, move("head", (0, 0, 0.01)), b)
    # another frame, or the same place, is none
    assert moved(base(), replace(a, to=(0.4, 0.8, 0.4)), replace(b, frame=KEY + 9)) is not None
    assert moved(base(), a, replace(b, to=a.to)) is not None


def test_places_that_exclude_each_other_are_reported() -> None:
    """Wrist and fingers of one hand are asked to be a metre apart: the last one gets its way."""
    hand = part_of(base(), "left_hand").points(frames(base()))[KEY]
    fingers = owned("left_hand")[-3:]
    result = moved(
        base(),
        Adjustment("left_hand", frame=KEY, to=hand + np.array([0, 0.1, 0.05]), **EASE),
        Adjustment(fingers, frame=KEY, to=hand + np.array([0.1, -0.1, 0.1]), **EASE),
    )
    assert [entry["part"] for entry in result.report["adjustments"]["unmet"]] == ["left_hand"]


@pytest.mark.parametrize(
    ("adjustment", "message"),
    [
        (
            move("left_paw", (0, 1, 0)),
            "adjustment 0: no part 'left_paw'; parts are root, hips, .*or a list of vert",
        ),
        (move("lefthand", (0, 1, 0)), "did you mean 'left_hand'"),
        (move([10**6], (0, 1, 0)), "adjustment 0: part names vertex 1000000; the target has vertices 0 to"),
        (move("head", (0, 1, 0), 30), "adjustment 0: .*frame 30 is not in the clip, whose last frame is 29"),
        (
            move("left_thigh", (0, 1, 0)),
            "'left_thigh' hangs on the hips and cannot move by itself; turn it, or move",
        ),
    ],
)
def test_what_does_not_exist_is_named_before_any_work(adjustment: Adjustment, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        transfer_motion(walking(), human_body(), adjustments=[adjustment], measure=False)


def test_a_part_on_two_limbs_is_refused() -> None:
    with pytest.raises(ValueError, match="vertices of a part must lie on one limb"):
        moved(base(), move([*owned("left_hand")[:2], *owned("right_foot")[:2]], (0, 0.1, 0)))


def test_a_result_that_kept_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="result must come from transfer_motion"):
        adjust(replace(base(), job=None), [move("head", (0, 0, 0.01))])
