"""What is written to BVH moves as it did, whatever bases the joints had."""

from __future__ import annotations

import numpy as np
import pytest
from moving_skins import odd_skeleton, wild_motion
from numpy.testing import assert_allclose

from tempose import formats
from tempose.clips import Skeleton, SkeletonClip, Source
from tempose.formats.bvh_write import continuous_angles, write_bvh, zero_at_rest
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.rotations import angle_between, conjugate, from_euler_degrees, multiply


def joints_by_name(clip: SkeletonClip, names: tuple[str, ...]) -> np.ndarray:
    places = forward_kinematics(clip.skeleton, clip.rotations, clip.root_position)[1]
    return places[:, [clip.skeleton.index(name) for name in names]]


def plain(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(name.replace(" ", "_") for name in names)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize(("up", "unit"), [("y", 1.0), ("z", 0.01), ("x", 0.0254)])
def test_joints_stand_where_they_stood_and_turn_as_they_turned(tmp_path, size, up, unit):
    clip = wild_motion(odd_skeleton(size))
    write_bvh(tmp_path / "a.bvh", clip, up=up, unit=unit)
    back = formats.load(tmp_path / "a.bvh", up=up, unit=unit)
    names = clip.skeleton.names
    there = joints_by_name(clip, names)
    assert_allclose(joints_by_name(back, plain(names)), there, atol=1e-7 * np.ptp(there))
    order = [back.skeleton.index(name) for name in plain(names)]
    turns = [
        multiply(forward_kinematics(c.skeleton, c.rotations, c.root_position)[0], conjugate(rest))
        for c, rest in ((clip, rest_transforms(clip.skeleton)[0]), (back, np.array([1.0, 0, 0, 0])))
    ]
    assert angle_between(turns[1][:, order], turns[0]).max() < 1e-7
    assert back.fps == clip.fps and back.n_frames == clip.n_frames


def test_zero_channels_are_the_rest_pose(tmp_path):
    clip = wild_motion(odd_skeleton())
    write_bvh(tmp_path / "a.bvh", clip)
    back = formats.load(tmp_path / "a.bvh", up="y", unit=1.0)
    here, there = rest_transforms(back.skeleton)[1], rest_transforms(clip.skeleton)[1]
    order = [back.skeleton.index(name) for name in plain(clip.skeleton.names)]
    assert_allclose((here - here[0])[order], there - there[0], atol=1e-8)


def test_root_has_no_offset_as_programs_differ_on_whether_to_add_it(tmp_path):
    write_bvh(tmp_path / "a.bvh", wild_motion(odd_skeleton()))
    lines = (tmp_path / "a.bvh").read_text().split("\n")
    assert lines[1:4] == ["ROOT root", "{", "\tOFFSET 0 0 0"]
    assert lines[4].split() == [
        "CHANNELS",
        "6",
        *(f"{a}position" for a in "XYZ"),
        *(f"{a}rotation" for a in "ZXY"),
    ]


def test_tips_come_back_and_unknown_ones_stay_unknown(tmp_path):
    clip = wild_motion(odd_skeleton())
    write_bvh(tmp_path / "a.bvh", clip)
    back = formats.load(tmp_path / "a.bvh", up="y", unit=1.0).skeleton
    rest = rest_transforms(clip.skeleton)[0][5]
    from tempose.rotations import rotate

    assert_allclose(back.tips[back.index("tail")], rotate(rest, clip.skeleton.tips[5]), atol=1e-8)
    assert np.isnan(back.tips[back.index("7th")]).all()


def test_frame_rates_that_have_no_finite_decimals_come_back(tmp_path):
    for fps in (23.976, 24.0, 29.97, 30.0, 60.0, 120.0, 1000 / 3):
        clip = wild_motion(odd_skeleton(), frames=2, fps=fps)
        write_bvh(tmp_path / "a.bvh", clip)
        assert abs(formats.load(tmp_path / "a.bvh").fps / fps - 1) < 1e-5


def test_a_still_clip_of_one_joint_comes_back(tmp_path):
    clip = SkeletonClip(
        Skeleton(("only",), np.array([-1]), np.zeros((1, 3))), np.eye(4)[None, :1], [[1, 2, 3]]
    )
    formats.save(tmp_path / "a.bvh", clip)
    back = formats.load(tmp_path / "a.bvh", unit=1.0)
    assert_allclose(back.root_position, clip.root_position)
    assert "nan" not in (tmp_path / "a.bvh").read_text()


def test_axes_and_unit_of_the_source_are_kept(tmp_path):
    clip = wild_motion(odd_skeleton())
    kept = SkeletonClip(
        clip.skeleton, clip.rotations, clip.root_position, 25.0, source=Source(up="z", unit=0.01)
    )
    formats.save(tmp_path / "a.bvh", kept)
    formats.save(tmp_path / "b.bvh", clip, up="z", unit="cm")
    assert (tmp_path / "a.bvh").read_text() == (tmp_path / "b.bvh").read_text()


def test_angles_do_not_jump_although_the_turn_passes_right_angles():
    turn = np.linspace(0, 900, 100)
    angles = np.stack([turn, 0.7 * turn, -1.3 * turn], axis=1)
    wrapped = (angles + 180) % 360 - 180
    even = np.arange(100) % 2 == 0
    wrapped[even] = np.stack([wrapped[even, 0] + 180, 180 - wrapped[even, 1], wrapped[even, 2] + 180], axis=1)
    wrapped[0] = angles[0]
    result = continuous_angles(wrapped)
    assert_allclose(result, angles, atol=1e-9)
    assert angle_between(from_euler_degrees(result, "zxy"), from_euler_degrees(angles, "zxy")).max() < 1e-12


def test_bases_of_the_world_at_rest_leave_the_motion_alone():
    clip = wild_motion(odd_skeleton())
    skeleton, rotations = zero_at_rest(clip.skeleton, clip.rotations)
    here = forward_kinematics(skeleton, rotations, clip.root_position)[1]
    there = forward_kinematics(clip.skeleton, clip.rotations, clip.root_position)[1]
    assert_allclose(here, there, atol=1e-12)
    assert_allclose(rest_transforms(skeleton)[1], rest_transforms(clip.skeleton)[1], atol=1e-12)


def test_no_frames_and_other_endings_are_refused(tmp_path):
    clip = wild_motion(odd_skeleton())
    with pytest.raises(ValueError, match="at least one frame"):
        formats.save(tmp_path / "a.bvh", clip.frames(slice(0, 0)))
    with pytest.raises(formats.FormatError, match=r"goes into \.bvh"):
        formats.save(tmp_path / "a.obj", clip)
    assert not list(tmp_path.iterdir())


@pytest.mark.real
def test_captures_come_back(tmp_path, data_folder):
    for name in ("mocap-cmu/cmu_12_01_walk.bvh", "mocap-bandai-namco/dataset-1_bow_normal_001.bvh"):
        folder, file = name.split("/")
        clip = formats.load(data_folder(folder) / file)
        formats.save(tmp_path / "a.bvh", clip)
        back = formats.load(tmp_path / "a.bvh", up=clip.source.up, unit=clip.source.unit)
        there = joints_by_name(clip, clip.skeleton.names)
        off = joints_by_name(back, plain(clip.skeleton.names)) - there
        assert np.abs(off).max() < 1e-6


def test_names_that_become_alike_get_numbers(tmp_path):
    names = ("root", "left arm", "left_arm", "left{arm")
    skeleton = Skeleton(names, np.array([-1, 0, 0, 0]), np.eye(4, 3))
    write_bvh(
        tmp_path / "a.bvh", SkeletonClip(skeleton, np.tile([1.0, 0, 0, 0], (1, 4, 1)), np.zeros((1, 3)))
    )
    back = formats.load(tmp_path / "a.bvh")
    assert back.skeleton.names == ("root", "left_arm", "left_arm_2", "left_arm_3")
    assert back.source.notes == ()
