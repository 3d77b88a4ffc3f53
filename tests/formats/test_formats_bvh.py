"""BVH: poses worked out by hand, and real files of makers who mean different things."""

import time

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.formats._motion_clip import rate_from_period
from tempose.formats.bvh import read_bvh
from tempose.formats.conventions import FormatError
from tempose.kinematics import forward_kinematics
from tempose.rotations import to_matrix

ARM = """HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Arm
  {
    OFFSET 2 0 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    JOINT Hand
    {
      OFFSET 0 1 0
      CHANNELS 1 Xrotation
      End Site
      {
        OFFSET 0 0 0.5
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: .0083333
0 0 0 0 0 0 0 0 0 0
4 5 6 10 20 30 40 50 60 70
"""


@pytest.fixture
def write(tmp_path):
    def put(text, name="a.bvh"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return put


def world_positions(clip):
    return forward_kinematics(clip.skeleton, clip.rotations, clip.root_position)[1]


def test_channels_compose_in_the_order_of_the_file(write):
    clip = read_bvh(write(ARM), up="y", unit=1.0)
    R_hips = Rotation.from_euler("ZXY", [10, 20, 30], degrees=True).as_matrix()
    R_arm = Rotation.from_euler("YZX", [40, 50, 60], degrees=True).as_matrix()
    R_hand = Rotation.from_euler("X", 70, degrees=True).as_matrix()
    assert_allclose(to_matrix(clip.rotations[1]), [R_hips, R_arm, R_hand], atol=1e-12)
    hand = [4, 5, 6] + R_hips @ [2, 0, 0] + R_hips @ R_arm @ [0, 1, 0]
    assert_allclose(world_positions(clip)[1, 2], hand, atol=1e-12)


def test_zero_channels_are_the_identity_and_the_root_goes_where_they_say(write):
    clip = read_bvh(write(ARM), up="y", unit=1.0)
    assert_allclose(clip.rotations[0], np.tile([1.0, 0, 0, 0], (3, 1)))
    assert_allclose(world_positions(clip)[0], [[0, 0, 0], [2, 0, 0], [2, 1, 0]])
    assert_allclose(clip.skeleton.offsets, [[1, 2, 3], [2, 0, 0], [0, 1, 0]])
    assert_allclose(clip.skeleton.tips[2], [0, 0, 0.5])
    assert np.isnan(clip.skeleton.tips[:2]).all()
    assert clip.skeleton.parents.tolist() == [-1, 0, 1]
    assert (clip.fps, clip.name, clip.source.guessed) == (120.0, "a", ())


def test_root_without_position_channels_stays_at_its_offset(write):
    text = ARM.replace("CHANNELS 6 Xposition Yposition Zposition", "CHANNELS 3").replace("\n0 0 0 0", "\n0")
    clip = read_bvh(write(text.replace("\n4 5 6", "\n")), up="y", unit=1.0)
    assert_allclose(clip.root_position, [[1, 2, 3], [1, 2, 3]])


@pytest.mark.parametrize("unit", [0.01, 1.0, 2.54])
def test_z_up_turns_every_point_and_keeps_rest_the_identity(write, unit):
    turn = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]) * unit
    plain = read_bvh(write(ARM), up="y", unit=1.0)
    clip = read_bvh(write(ARM), up="z", unit=unit)
    assert_allclose(world_positions(clip), world_positions(plain) @ turn.T, atol=1e-12)
    assert_allclose(clip.skeleton.tips[2], turn @ [0, 0, 0.5])
    assert_allclose(clip.rotations[0], np.tile([1.0, 0, 0, 0], (3, 1)), atol=1e-15)


@pytest.mark.parametrize(("text", "expected"), [
    (".0083333", 120), ("0.0333333", 30), ("0.041667", 24), ("0.033", 30), ("0.0166667", 60), ("0.008", 125),
    ("0.0333667", 30000 / 1001), ("0.02", 50), ("1.0", 1), ("4e-2", 25), ("0.0142857142857", 70),
])  # fmt: skip
def test_rate_is_the_one_that_was_rounded(text, expected):
    assert rate_from_period(text) == expected


def test_duplicate_names_get_a_suffix(write):
    clip = read_bvh(write(ARM.replace("JOINT Hand", "JOINT Arm")), up="y", unit=1.0)
    assert clip.skeleton.names == ("Hips", "Arm", "Arm_2")
    assert clip.source.notes == ("A second joint 'Arm' is called 'Arm_2'.",)


MOVING = """HIERARCHY
ROOT Reference
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Hips
  {
    OFFSET 0 9 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    JOINT Leg
    {
      OFFSET 0 -4 0
      CHANNELS 4 Yposition Zrotation Xrotation Yrotation
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 1 0 0 0  0 9 0 0 0 0   -4 0 0 0
0 0 2 0 0 90 1 8 0 0 0 0   -5 0 0 90
"""


def test_reference_root_is_folded_exactly_into_hips_that_travel(write):
    clip = read_bvh(write(MOVING), up="y", unit=1.0)
    assert clip.skeleton.names == ("Hips", "Leg")
    assert_allclose(clip.root_position, [[0, 9, 1], [0, 8, 1]], atol=1e-12)
    turn = Rotation.from_euler("Y", 90, degrees=True).as_matrix()
    assert_allclose(to_matrix(clip.rotations[1]), [turn, turn], atol=1e-12)
    assert_allclose(clip.skeleton.offsets, [[0, 9, 0], [0, -4.5, 0]])
    assert clip.source.notes[0] == "Root 'Reference' is folded into its child 'Hips', which travels."
    assert clip.source.notes[1].endswith("largest deviation 0.5 units at 'Leg'.")


def test_more_rows_than_stated_is_a_note_and_fewer_an_error(write):
    more = read_bvh(write(ARM.replace("Frames: 2", "Frames: 1")), up="y", unit=1.0)
    assert more.n_frames == 1
    assert more.source.notes == ("The header says 1 frames, the file has 2: the rest is left out.",)
    with pytest.raises(
        FormatError, match=r"a.bvh, line 25: expected 99999999999 frames .* found 2; .* cut short"
    ):
        read_bvh(write(ARM.replace("Frames: 2", "Frames: 99999999999")))


@pytest.mark.parametrize(("old", "new", "message"), [
    ("HIERARCHY", "HIERARCHIE", r"line 1: a BVH file starts with HIERARCHY, found 'HIERARCHIE'"),
    ("60 70", "60", r"line 25: expected 10 values \(one a channel\), found 9"),
    ("60 70", "60 x", r"line 25: expected a number as value 10, found 'x'"),
    ("60 70", "60 nan", r"line 25: expected a number as value 10, found 'nan'"),
    ("60 70", "60 1e300", r"line 25: expected a number as value 10, found '1e300'"),
    ("Frames: 2", "Frames: 0", r"line 22: expected 'Frames:' and a count above 0, found '0'"),
    ("Frames: 2", "Frames: -2", r"line 22: expected 'Frames:' and a count above 0, found '-2'"),
    ("Frames: 2\n", "", r"expected 'Frames:' and a count above 0, found 'nothing'"),
    ("Time: .0083333", "Time: 0", r"expected a 'Frame Time:' above 0, found 0; pass fps"),
    ("Time: .0083333", "Time: soon", r"line 23: expected 'Frame Time:' and seconds, found 'soon'"),
    ("OFFSET 2 0 0", "OFFSET 2 0", r"line 8: expected OFFSET and three numbers, found 'OFFSET 2 0'"),
    ("OFFSET 2 0 0", "OFFSET 2 0 nan", r"line 8: expected OFFSET and three numbers"),
    ("CHANNELS 3", "CHANNELS 4", r"line 9: expected CHANNELS 3, found 'CHANNELS 4'"),
    ("CHANNELS 1 Xrotation", "CHANNELS 1 Wrotation", r"line 13: expected distinct channels such as"),
    ("}\nMOTION", "MOTION", r"expected a closing brace, found the end of the hierarchy"),
    ("}\nMOTION", "}\n}\nMOTION", r"line 21: found a closing brace that nothing opened"),
    ("}\nMOTION", "}\nROOT b\n{\n}\nMOTION", r"line 21: expected one ROOT, found a second"),
    (ARM[ARM.index("MOTION") :], "", r"expected a line MOTION after the hierarchy"),
    ("  JOINT Arm\n  {", "  JOINT Arm\n", r"line 8: expected \{, found 'OFFSET'"),
    ("Yrotation Zrotation Xrotation", "Yrotation Yrotation Xrotation", r"line 9: expected distinct channels"),
])  # fmt: skip
def test_faults_are_named_with_their_line(write, old, new, message):
    assert old in ARM
    with pytest.raises(FormatError, match=r"a\.bvh.*" + message):
        read_bvh(write(ARM.replace(old, new)))


@pytest.mark.parametrize("content", [b"", b"\x00\xff\x00garbage", b"HIERARCHY", b"HIERARCHY\nMOTION\n"])
def test_what_is_no_bvh_is_refused(write, content):
    with pytest.raises(FormatError, match=r"a\.bvh"):
        read_bvh(write(content))


def test_bad_options_are_refused(write):
    with pytest.raises(ValueError, match="up must be"):
        read_bvh(write(ARM), up="w")
    with pytest.raises(ValueError, match="fps must be positive"):
        read_bvh(write(ARM), fps=0.0)


@pytest.mark.real
@pytest.mark.parametrize(("folder", "name", "T", "J", "fps", "up", "unit", "height"), [
    ("mocap-cmu", "cmu_12_01_walk.bvh", 524, 31, 120, "y", 0.0254 / 0.45, (1.2, 1.7)),
    ("mocap-bandai-namco", "dataset-1_run_normal_001.bvh", 24, 21, 30, "y", 0.01, (1.2, 1.5)),
    ("makehuman-base", "walk1.bvh", 14, 75, 24, "z", 0.1, (1.4, 1.8)),
    ("makehuman-base", "tpose.bvh", 1, 173, 24, "z", 0.1, (1.4, 1.8)),
    ("makehuman-base", "benchmark.bvh", 1, 163, 24, "z", 0.1, (1.0, 1.8)),
])  # fmt: skip
def test_real_files_stand_upright_in_metres(data_folder, folder, name, T, J, fps, up, unit, height):
    clip = read_bvh(data_folder(folder) / name)
    assert (clip.n_frames, clip.skeleton.n_joints, clip.fps) == (T, J, fps)
    assert (clip.source.up, clip.source.unit, clip.source.guessed) == (up, unit, ("up", "unit"))
    extent = np.median(np.ptp(world_positions(clip)[..., 1], axis=1))
    assert height[0] < extent < height[1]


@pytest.mark.real
def test_bandai_hips_travel_and_its_bones_keep_their_length(data_folder):
    clip = read_bvh(data_folder("mocap-bandai-namco") / "dataset-1_run_normal_001.bvh")
    assert clip.skeleton.names[:2] == ("Hips", "Spine")
    assert len(clip.source.notes) == 1 and "joint_Root" in clip.source.notes[0]
    travel = np.ptp(clip.root_position, axis=0)
    assert 1.9 < travel[2] < 2.1 and travel[0] < 0.05
    feet = world_positions(clip)[:, clip.skeleton.index("Toes_L"), 1]
    assert 0.0 < feet.min() < 0.05


@pytest.mark.real
def test_a_long_take_reads_fast(data_folder):
    path = data_folder("mocap-cmu") / "01_01.bvh"
    seconds = []
    for _ in range(3):
        start = time.perf_counter()
        clip = read_bvh(path)
        seconds.append(time.perf_counter() - start)
    assert clip.rotations.shape == (2752, 31, 4)
    assert min(seconds) < 0.6
