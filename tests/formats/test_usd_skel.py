"""USD comes back as it was written, and files of others give the frames that their makers baked."""

from __future__ import annotations

import numpy as np
import pytest
from moving_skins import odd_skin, sheet, wild_motion
from numpy.testing import assert_allclose, assert_array_equal

from tempose import formats
from tempose.clips import MeshClip, SkeletonClip, SkinnedMesh
from tempose.formats.usd_stage import identifier
from tempose.kinematics import linear_blend_skinning, rest_transforms

pxr = pytest.importorskip("pxr")


def posed(skin: SkinnedMesh, motion: SkeletonClip) -> np.ndarray:
    return linear_blend_skinning(skin, motion.rotations, motion.root_position, motion.skeleton)


@pytest.mark.parametrize("suffix", [".usda", ".usdc", ".usd"])
@pytest.mark.parametrize(("up", "unit", "size"), [("y", 1.0, 1.0), ("z", 0.01, 1e3), ("z", 1.0, 1e-3)])
def test_skin_and_motion_come_back(tmp_path, suffix, up, unit, size):
    skin = odd_skin(size, influences=6)
    motion = wild_motion(skin.skeleton)
    file = tmp_path / f"a{suffix}"
    formats.save_skin(file, skin, motion, up=up, unit=unit)
    back, moves = formats.load_skin(file), formats.load_skeleton_clip(file)
    assert back.skeleton.names == moves.skeleton.names == skin.skeleton.names
    assert_array_equal(back.skeleton.parents, skin.skeleton.parents)
    assert_allclose(rest_transforms(back.skeleton)[1], rest_transforms(skin.skeleton)[1], atol=1e-6 * size)
    assert_allclose(back.weights, skin.weights, atol=1e-7)
    assert_allclose(back.mesh.vertices, skin.mesh.vertices, atol=1e-6 * size)
    assert_allclose(posed(back, moves), posed(skin, motion), atol=5e-6 * size)
    assert moves.fps == motion.fps and moves.source.up == up and moves.source.unit == unit
    clip = formats.load_clip(file)
    assert_allclose(clip.vertices, posed(skin, motion), atol=5e-6 * size)
    assert_allclose(clip.rest, skin.mesh.vertices, atol=1e-6 * size)


def test_what_is_bound_to_nothing_stays(tmp_path):
    skin = odd_skin(loose=5)
    motion = wild_motion(skin.skeleton)
    formats.save_skin(tmp_path / "a.usda", skin, motion)
    assert_allclose(formats.load_clip(tmp_path / "a.usda").vertices, posed(skin, motion), atol=5e-6)


@pytest.mark.parametrize(
    ("blending", "token"), [("linear", "classicLinear"), ("dual-quaternion", "dualQuaternion")]
)
def test_way_of_blending_is_stated(tmp_path, blending, token):
    from pxr import Usd, UsdSkel

    formats.save_skin(tmp_path / "a.usda", odd_skin(), blending=blending)
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    methods = [UsdSkel.BindingAPI(prim).GetSkinningMethodAttr().Get() for prim in stage.Traverse()]
    assert token in methods


@pytest.mark.parametrize("up", ["y", "z"])
def test_mesh_clip_comes_back_with_quads_seams_and_groups(tmp_path, up, rng):
    mesh = sheet()
    V = (mesh.vertices + rng.normal(size=(7, len(mesh.vertices), 3))).astype(np.float32)
    formats.save(tmp_path / "a.usda", MeshClip(V, mesh, 29.97), up=up, unit="cm")
    back = formats.load(tmp_path / "a.usda")
    assert isinstance(back, MeshClip)
    assert_allclose(back.vertices, V, atol=2e-6)
    assert_allclose(back.rest, mesh.vertices, atol=1e-6)
    assert_array_equal(back.faces, mesh.faces)
    assert_array_equal(back.mesh.polygons, mesh.polygons)
    assert_allclose(back.mesh.uv[back.mesh.uv_faces], mesh.uv[mesh.uv_faces], atol=1e-7)
    assert back.mesh.groups.keys() == mesh.groups.keys() and back.name == mesh.name
    assert_array_equal(back.mesh.groups["left side"], mesh.groups["left side"])
    assert abs(back.fps - 29.97) < 1e-9


def test_still_mesh_stays_still(tmp_path):
    formats.save(tmp_path / "a.usdc", sheet())
    back = formats.load(tmp_path / "a.usdc")
    assert not isinstance(back, MeshClip)
    assert_allclose(back.vertices, sheet().vertices, atol=1e-6)
    assert_array_equal(formats.load_mesh(tmp_path / "a.usdc").faces, sheet().faces)


def test_rate_is_that_of_the_samples(tmp_path, rng):
    from pxr import Usd, UsdGeom

    mesh = sheet()
    formats.save(
        tmp_path / "a.usda", MeshClip(np.tile(mesh.vertices, (5, 1, 1)).astype(np.float32), mesh, 24)
    )
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    points = next(UsdGeom.Mesh(p).GetPointsAttr() for p in stage.Traverse() if p.IsA(UsdGeom.Mesh))
    for t in (1, 3):
        points.ClearAtTime(t)
    stage.GetRootLayer().Export(str(tmp_path / "b.usda"))
    every_second = formats.load_clip(tmp_path / "b.usda")
    assert every_second.fps == 12 and every_second.n_frames == 3
    assert formats.load_clip(tmp_path / "b.usda", fps=24).n_frames == 5


def test_left_handed_faces_and_moving_prims(tmp_path):
    (tmp_path / "a.usda").write_text(
        """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Y"
    timeCodesPerSecond = 10
)
def Xform "Up" {
    double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 1: (0, 2, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "Tile" {
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        uniform token orientation = "leftHanded"
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    }
    def Mesh "Hidden" {
        token visibility = "invisible"
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    }
}
"""
    )
    clip = formats.load_clip(tmp_path / "a.usda")
    assert_allclose(clip.vertices[1] - clip.vertices[0], np.tile([0, 2, 0], (4, 1)))
    assert_array_equal(clip.faces, [[0, 3, 2], [0, 2, 1]])
    assert clip.fps == 10


BROKEN = {
    "no scene": ("nonsense", "expected a USD scene"),
    "no mesh": ("#usda 1.0\n", "expected a mesh, found none"),
    "index": (
        '#usda 1.0\ndef Mesh "m" {\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 9]\n'
        "point3f[] points = [(0,0,0),(1,0,0),(0,1,0)]\n}\n",
        "expected indices below 3, found 9",
    ),
    "corners": (
        '#usda 1.0\ndef Mesh "m" {\nint[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2]\n'
        "point3f[] points = [(0,0,0),(1,0,0),(0,1,0)]\n}\n",
        "expected one index a corner",
    ),
    "points": (
        '#usda 1.0\ndef Mesh "m" {\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n'
        "point3f[] points.timeSamples = {0: [(0,0,0),(1,0,0),(0,1,0)], 1: [(0,0,0)]}\n}\n",
        "expected 3 points, found 1 at time code 1",
    ),
    "nan": (
        '#usda 1.0\ndef Mesh "m" {\nint[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n'
        "point3f[] points = [(0,0,0),(nan,0,0),(0,1,0)]\n}\n",
        "expected finite positions",
    ),
}


@pytest.mark.parametrize("what", BROKEN)
def test_broken_files_are_refused_in_one_line(tmp_path, what):
    text, message = BROKEN[what]
    (tmp_path / "a.usda").write_text(text)
    with pytest.raises(formats.FormatError, match=message) as caught:
        formats.load(tmp_path / "a.usda")
    assert str(tmp_path / "a.usda") in str(caught.value) and "\n" not in str(caught.value)


def test_no_skeleton_other_axes_and_missing_files_are_refused(tmp_path):
    formats.save(tmp_path / "a.usda", sheet())
    for reader in (formats.load_skin, formats.load_skeleton_clip):
        with pytest.raises(formats.FormatError, match="expected a skeleton"):
            reader(tmp_path / "a.usda")
    with pytest.raises(ValueError, match="Y or Z up"):
        formats.save(tmp_path / "b.usda", sheet(), up="x")
    with pytest.raises(formats.FormatError, match="no such file"):
        formats.load(tmp_path / "missing.usda")


def test_without_usd_core_the_error_says_what_to_install(tmp_path, monkeypatch):
    import sys

    formats.save(tmp_path / "a.usda", sheet())
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(formats.FormatError, match=r'pip install "tempose\[usd\]"'):
        formats.load(tmp_path / "a.usda")


def test_identifiers_are_what_a_path_may_hold():
    assert [identifier(name) for name in ("a b", "7up", "", "é.1")] == ["a_b", "_7up", "_", "__1"]


@pytest.mark.real
def test_baked_file_holds_what_its_skin_gives(data_folder):
    folder = data_folder("usd-skel")
    baked = formats.load_clip(folder / "lbs.baked.usda")
    assert_array_equal(formats.load_clip(folder / "lbs.usda").vertices, baked.vertices)
    skin, motion = formats.load_skin(folder / "lbs.usda"), formats.load_skeleton_clip(folder / "lbs.usda")
    assert_allclose(posed(skin, motion), baked.vertices, atol=1e-6 * skin.mesh.diagonal)
    assert baked.n_frames == 30 and baked.fps == 24


@pytest.mark.real
def test_seventy_joints_in_centimetres_z_up_stand(data_folder):
    file = data_folder("usd-skel") / "HIK_Export.usda"
    skin, motion, clip = formats.load_skin(file), formats.load_skeleton_clip(file), formats.load_clip(file)
    assert skin.skeleton.n_joints == 70 and clip.n_frames == motion.n_frames == 101
    # scales are half floats in the file
    assert_allclose(posed(skin, motion), clip.vertices, atol=1e-5 * skin.mesh.diagonal)
    assert 1.5 < np.ptp(clip.vertices[0, :, 1]) < 1.9


@pytest.mark.real
def test_blend_shapes_are_baked_as_their_makers_did(data_folder):
    folder = data_folder("usd-skel")
    ours, theirs = (formats.load_clip(folder / f"blendshapes{s}.usda") for s in ("", ".baked"))
    assert_array_equal(ours.vertices, theirs.vertices)


def test_joints_that_the_skeleton_lacks_are_refused(tmp_path):
    from pxr import Usd, UsdSkel

    formats.save_skin(tmp_path / "a.usda", odd_skin())
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    (mesh,) = (prim for prim in stage.Traverse() if prim.GetTypeName() == "Mesh")
    binding = UsdSkel.BindingAPI(mesh)
    joints = list(
        UsdSkel.Skeleton(stage.GetPrimAtPath(binding.GetSkeletonRel().GetTargets()[0])).GetJointsAttr().Get()
    )
    binding.CreateJointsAttr([*joints[:-1], "elsewhere"])
    stage.GetRootLayer().Save()
    with pytest.raises(formats.FormatError, match="expected joints of the skeleton, found 'elsewhere'"):
        formats.load_skin(tmp_path / "a.usda")
