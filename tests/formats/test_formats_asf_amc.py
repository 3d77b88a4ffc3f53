"""ASF/AMC: the axis rule worked out by hand, and the same take against its BVH conversion."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.formats.asf_amc import read_amc
from tempose.formats.bvh import read_bvh
from tempose.formats.conventions import FormatError
from tempose.kinematics import forward_kinematics
from tempose.rotations import rotate, to_matrix

ASF = """# comment
:version 1.10
:name test
:units
  mass 1.0
  length 0.45
  angle deg
:documentation
  words: and more words
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 7 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name hip
    direction 0 -1 0
    length 2
    axis 0 0 20 XYZ
  end
  begin
    id 2
    name knee
    direction 0.6 -0.8 0
    length 5
    axis 10 20 30 XYZ
    dof rx rz
    limits (-10.0 170.0)
           (-70.0 70.0)
  end
:hierarchy
  begin
    root hip
    hip knee
  end
"""
AMC = """#!OML:ASF somewhere
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 0 0 0
knee 0 0
2
root 4 5 6 10 20 30
knee 40 50
"""


@pytest.fixture
def write(tmp_path):
    def put(asf=ASF, amc=AMC):
        (tmp_path / "07.asf").write_text(asf)
        path = tmp_path / "07_02.amc"
        path.write_text(amc)
        return path

    return put


def world(clip):
    return forward_kinematics(clip.skeleton, clip.rotations, clip.root_position)


def test_bones_turn_about_their_own_axes(write):
    clip = read_amc(write(), unit=1.0, up="y")
    C = Rotation.from_euler("xyz", [10, 20, 30], degrees=True)
    M = Rotation.from_euler("xz", [40, 50], degrees=True)
    R_root = Rotation.from_euler("xyz", [10, 20, 30], degrees=True)
    knee = (C * M * C.inv()).as_matrix()
    assert_allclose(to_matrix(clip.rotations[1]), [R_root.as_matrix(), np.eye(3), knee], atol=1e-12)
    assert clip.skeleton.names == ("root", "hip", "knee")
    assert_allclose(clip.skeleton.offsets, [[0, 7, 0], [0, 0, 0], [0, -2, 0]])
    assert_allclose(clip.skeleton.tips[2], [3, -4, 0])
    assert np.isnan(clip.skeleton.tips[:2]).all()
    positions = world(clip)[1]
    assert_allclose(positions[1, 2] - positions[1, 0], R_root.apply([0, -2, 0]), atol=1e-12)
    assert_allclose(positions[1, 0], [4, 5, 6])
    assert_allclose(clip.rotations[0], np.tile([1.0, 0, 0, 0], (3, 1)), atol=1e-15)


def test_unit_follows_from_the_length_stated_and_the_rate_is_guessed(write):
    clip = read_amc(write())
    assert_allclose(clip.source.unit, 0.0254 / 0.45)
    assert_allclose(clip.root_position[0], np.array([1, 2, 3]) * 0.0254 / 0.45)
    assert (clip.fps, clip.source.fps, clip.source.guessed) == (120.0, None, ("up", "fps"))
    assert read_amc(write(), fps=60, up="y").source.guessed == ()


@pytest.mark.parametrize("where", ["asf", "amc"])
def test_radians_give_the_same_motion(write, where):
    def scaled(line):
        name, *values = line.split()
        head = values[:3] if name == "root" else []
        return " ".join([name, *head, *(repr(float(np.radians(float(v)))) for v in values[len(head) :])])

    amc = "\n".join(scaled(line) if line[:4] in ("root", "knee") else line for line in AMC.splitlines())
    asf = ASF
    if where == "asf":
        asf = ASF.replace("angle deg", "angle rad").replace("0 0 20", "0 0 .3490658503988659")
        asf = asf.replace("10 20 30", " ".join(repr(float(np.radians(v))) for v in (10, 20, 30)))
    amc = amc.replace(":DEGREES\n", "" if where == "asf" else ":RADIANS\n")
    expected = read_amc(write()).rotations
    assert_allclose(read_amc(write(asf, amc)).rotations, expected, atol=1e-12)


def test_skeleton_is_found_beside_the_motion(write, tmp_path):
    path = write()
    (tmp_path / "08.asf").write_text("nonsense")
    assert read_amc(path).n_frames == 2
    other = path.rename(tmp_path / "walk.amc")
    with pytest.raises(FormatError, match=r"expected walk.asf beside it, found 07.asf, 08.asf; pass asf"):
        read_amc(other)
    assert read_amc(other, asf=tmp_path / "07.asf").n_frames == 2
    (tmp_path / "08.asf").unlink()
    assert read_amc(other).n_frames == 2
    (tmp_path / "07.asf").unlink()
    with pytest.raises(FormatError, match=r"found no .asf file at all"):
        read_amc(other)
    with pytest.raises(FormatError, match=r"gone.amc: no such file"):
        read_amc(tmp_path / "gone.amc")


def test_skeleton_alone_is_refused_with_advice(write):
    with pytest.raises(
        FormatError, match=r"07\.asf: an \.asf file is a skeleton without motion; give the \.amc"
    ):
        read_amc(write().with_name("07.asf"))


def test_bones_without_motion_are_noted(write):
    clip = read_amc(write(amc=AMC.replace("knee 0 0\n", "").replace("knee 40 50\n", "")))
    assert clip.source.notes == ("Bones without motion: knee.",)
    assert_allclose(clip.rotations[1, 2], [1, 0, 0, 0], atol=1e-15)


@pytest.mark.parametrize(("old", "new", "message"), [
    ("knee 40 50", "elbow 40 50", r"amc, line 9: expected a bone of 07.asf, found 'elbow'"),
    ("knee 40 50", "knee 40", r"amc, line 9: expected 2 values for 'knee', found '40'"),
    ("knee 40 50", "knee 40 x", r"amc, line 9: expected 2 values for 'knee', found '40 x'"),
    ("knee 40 50", "knee 40 nan", r"amc, line 7: expected finite numbers here, found nan for 'knee'"),
    ("knee 40 50", "knee 40 1e300", r"amc, line 7: expected finite numbers .* found 1e\+300 for 'knee'"),
    ("knee 40 50", "", r"amc, line 7: expected 2 bones in this frame, found 1, 'knee' is missing"),
    ("knee 40 50", "root 1 2 3 4 5 6", r"amc, line 9: expected each bone once a frame, found 'root' again"),
    ("1\nroot", "root", r"amc, line 4: expected a frame number, found 'root 1 2 3 0 0 0'"),
    (AMC[AMC.index("1\n") :], "", r"amc: expected frames, found none in 3 lines"),
    (AMC, "", r"amc: expected an Acclaim motion \(AMC\), found an empty file"),
])  # fmt: skip
def test_faults_of_the_motion_are_named(write, old, new, message):
    assert old in AMC
    with pytest.raises(FormatError, match=message):
        read_amc(write(amc=AMC.replace(old, new)))


@pytest.mark.parametrize(("old", "new", "message"), [
    (ASF, "words", r"asf: expected a section :bonedata, found no section at all"),
    (":hierarchy", ":hier", r"asf: expected a section :hierarchy, found :version, :name"),
    ("direction 0 -1 0", "direction 0 -1", r"asf, line 19: expected 3 numbers, found '0 -1'"),
    ("length 2", "length inf", r"asf, line 20: expected 1 number, found 'inf'"),
    ("0 0 20 XYZ", "0 0 20 XYY", r"asf, line 21: expected an axis order such as XYZ, found 'xyy'"),
    ("dof rx rz", "dof rx rx", r"asf, line 29: expected distinct degrees of freedom"),
    ("dof rx rz", "dof rx rw", r"asf, line 29: expected distinct degrees of freedom"),
    ("  end\n  begin", "  begin", r"asf, line 22: expected end, found 'begin'"),
    ("  end\n:hier", ":hier", r"asf, line 23: expected an end to this bone"),
    ("name knee", "name hip", r"asf, line 16: expected a name of its own, found 'hip'"),
    ("hip knee\n", "", r"asf: expected every bone under root in :hierarchy, found 'knee' outside"),
    ("root hip", "root hip foot", r"asf, line 35: expected a bone of :bonedata, found 'foot'"),
    ("hip knee", "hip knee root", r"asf, line 36: expected one parent a bone, found a second of 'root'"),
    ("hip knee", "knee knee", r"asf: expected every bone under root in :hierarchy, found 'knee' outside"),
    ("length 0.45", "length zero", r"asf, line 6: expected 1 number, found 'zero'"),
])  # fmt: skip
def test_faults_of_the_skeleton_are_named(write, old, new, message):
    assert old in ASF
    with pytest.raises(FormatError, match=message):
        read_amc(write(asf=ASF.replace(old, new)))


PAIRS = {
    "root": "Hips", "lfemur": "LeftUpLeg", "ltibia": "LeftLeg", "lfoot": "LeftFoot", "ltoes": "LeftToeBase",
    "rfemur": "RightUpLeg", "rtibia": "RightLeg", "rfoot": "RightFoot", "rtoes": "RightToeBase",
    "upperback": "Spine", "thorax": "Spine1",
}  # fmt: skip
ABOVE_THORAX = {
    "lhumerus": "LeftArm", "lradius": "LeftForeArm", "lwrist": "LeftHand", "rhumerus": "RightArm",
    "rradius": "RightForeArm", "rwrist": "RightHand", "upperneck": "Neck1", "head": "Head",
}  # fmt: skip


@pytest.mark.real
def test_the_same_take_in_amc_and_bvh_agrees(data_folder):
    folder = data_folder("mocap-cmu")
    amc, bvh = read_amc(folder / "01_01.amc"), read_bvh(folder / "01_01.bvh")
    assert (amc.n_frames, bvh.n_frames) == (2751, 2752)
    turns, points = world(amc)
    expected = world(bvh)[1][1:]
    # the converter let the bones above the chest start where the thorax starts, not where it ends
    a, b = amc.skeleton.index, bvh.skeleton.index
    thorax = rotate(turns[:, a("thorax")], amc.skeleton.offsets[a("lowerneck")])
    for name, other in PAIRS.items():
        assert_allclose(points[:, a(name)], expected[:, b(other)], atol=2e-5)
    for name, other in ABOVE_THORAX.items():
        assert_allclose(points[:, a(name)] - thorax, expected[:, b(other)], atol=2e-5)
