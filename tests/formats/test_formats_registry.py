"""One table: every ending finds its reader, every wrong path is one clear line."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import MarkerClip, Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh, Source
from tempose.formats import (
    FORMATS,
    FormatError,
    describe,
    load,
    load_clip,
    load_mesh,
    load_skeleton_clip,
    load_skin,
    save,
)  # fmt: skip
from tempose.formats._frames import natural_key, split_counter

V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
TETRAHEDRON = Mesh(V, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], name="tet", groups={"base": [0]})


def test_natural_order_counts():
    names = ["a10", "a2", "a1", "b1", "a2b", "a", "a02"]
    assert sorted(names, key=natural_key) == ["a", "a1", "a02", "a2", "a2b", "a10", "b1"]


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("run.####.obj", ("run.", 4, ".obj")),
        ("run_%05d.ply", ("run_", 5, ".ply")),
        ("run_%d.ply", ("run_", 0, ".ply")),
        ("take#1.##.obj", ("take#1.", 2, ".obj")),
        ("run.0001.obj", None),
    ],
)
def test_counters_of_patterns(name, parts):
    assert split_counter(name) == parts


def test_progress_is_told_and_may_cancel(tmp_path):
    clip = MeshClip(np.stack([V, V, V]), TETRAHEDRON)
    seen: list[tuple[int, int]] = []
    save(tmp_path / "out", clip, progress=lambda done, total, stage: seen.append((done, total)))
    assert seen == [(0, 3), (1, 3), (2, 3), (3, 3)]
    seen.clear()
    load(tmp_path / "out", progress=lambda done, total, stage: seen.append((done, total)))
    assert seen == [(0, 3), (1, 3), (2, 3), (3, 3)]

    def cancel(done: int, total: int, stage: str) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        save(tmp_path / "other", clip, progress=cancel)
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("function", [load, load_mesh, load_clip, load_skeleton_clip, load_skin])
def test_wrong_paths_are_one_line_that_names_them(tmp_path, function):
    (tmp_path / "x.docx").write_text("x")
    (tmp_path / "noending").write_text("x")
    (tmp_path / "folder").mkdir()
    (tmp_path / "dir.obj").mkdir()
    (tmp_path / "dir.npz").mkdir()
    for name, message in [
        ("nix.obj", "no such file"),
        ("x.docx", r"unknown kind of file '\.docx'; known are \.obj"),
        ("noending", "no ending"),
        ("folder", "."),
        ("dir.obj", "."),
        ("dir.npz", "."),
        ("no/such/place.npz", "no such file"),
    ]:
        with pytest.raises(FormatError, match=message) as caught:
            function(tmp_path / name)
        assert name in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["folder", "*.obj", "a.####.obj", "a.%04d.obj", "no/*.obj", "no/a.##.obj"])
def test_patterns_without_frames_say_so(tmp_path, name):
    (tmp_path / "folder").mkdir()
    with pytest.raises(FormatError, match="found none") as caught:
        load(tmp_path / name)
    assert name in str(caught.value)


def test_brackets_in_folder_names_are_no_wildcards(tmp_path):
    folder = tmp_path / "take [2]"
    folder.mkdir()
    save(folder / "a1.obj", TETRAHEDRON)
    save(folder / "a2.obj", TETRAHEDRON)
    for name in ("*.obj", "a?.obj", "a#.obj", ""):
        assert load(folder / name).n_frames == 2


def test_an_ending_slash_makes_a_folder(tmp_path):
    save(f"{tmp_path}/run.v2/", MeshClip(np.stack([V, V]), TETRAHEDRON))
    assert load(tmp_path / "run.v2").n_frames == 2


def test_folders_of_several_kinds_ask_for_a_glob(tmp_path):
    save(tmp_path / "a.obj", TETRAHEDRON)
    save(tmp_path / "a.ply", TETRAHEDRON)
    with pytest.raises(FormatError, match=r"found \.obj, \.ply; name them with a glob"):
        load(tmp_path)
    assert load(tmp_path / "*.ply").n_frames == 1


@pytest.mark.parametrize("suffix", ["obj", "ply", "off", "npz"])
def test_axis_unit_and_rate_are_those_stated_else_guessed(tmp_path, suffix):
    path = tmp_path / f"x.{suffix}"
    if suffix == "npz":
        np.savez(path, vertices=V * 170, faces=TETRAHEDRON.faces)
    else:
        save(path, TETRAHEDRON.with_vertices(V * 170))
    mesh = load_mesh(path)
    assert (mesh.source.up, mesh.source.unit, mesh.source.guessed) == ("y", 0.01, ("up", "unit"))
    assert_allclose(mesh.height, 1.7)
    assert mesh.source.path == str(path) and mesh.source.format == suffix
    stated = load_mesh(path, up="z", unit="in")
    assert (stated.source.up, stated.source.unit, stated.source.guessed) == ("z", 0.0254, ())
    assert_allclose(stated.vertices, (V * 170 * 0.0254)[:, [0, 2, 1]] * [1, 1, -1])
    flat = V * [170, 0, 1.7]
    save(tmp_path / "flat.obj", TETRAHEDRON.with_vertices(flat))
    assert load_mesh(tmp_path / "flat.obj", up="z").source.unit == 1.0
    assert load_mesh(tmp_path / "flat.obj", up="x").source.unit == 0.01
    assert_array_equal(load_mesh(path, unit=2.5).vertices, V * 170 * 2.5)
    clip = load_clip(path, fps=25)
    assert clip.fps == 25 and clip.n_frames == 1


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"unit": "furlong"}, "unit must be one of mm"),
        ({"unit": 0}, "unit must be"),
        ({"unit": float("nan")}, "unit must be"),
        ({"up": "Y"}, "up must be x, y or z, got 'Y'"),
        ({"fps": -1}, "fps must be positive"),
        ({"fps": float("nan")}, "fps must be positive"),
    ],
)
def test_wrong_statements_are_refused(tmp_path, wrong, message):
    save(tmp_path / "x.obj", TETRAHEDRON)
    with pytest.raises(ValueError, match=message):
        load(tmp_path / "x.obj", **wrong)


@pytest.mark.parametrize("suffix", ["obj", "npz"])
def test_group_keeps_its_faces(tmp_path, suffix):
    save(tmp_path / f"x.{suffix}", TETRAHEDRON)
    part = load_mesh(tmp_path / f"x.{suffix}", group="base")
    assert_array_equal(part.faces, [[0, 2, 1]])
    assert_array_equal(part.vertices, V[:3])
    clip = load_clip(tmp_path / f"x.{suffix}", group="base")
    assert_array_equal(clip.vertices[0], V[:3])
    with pytest.raises(FormatError, match=rf"x\.{suffix}: no group named 'bass' .*closest: base"):
        load(tmp_path / f"x.{suffix}", group="bass")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("x.fbx", r"cannot write \.fbx; known are \.obj"),
        ("x", "cannot write a mesh to a name without ending"),
        ("x.bvh", r"cannot write \.bvh; known"),
    ],
)
def test_endings_that_cannot_be_written(tmp_path, name, message):
    with pytest.raises(FormatError, match=message):
        save(tmp_path / name, TETRAHEDRON)
    assert list(tmp_path.iterdir()) == []


def test_a_clip_does_not_fit_one_obj(tmp_path):
    with pytest.raises(FormatError, match=r"the clip has 2; write to x\.####\.obj"):
        save(tmp_path / "x.obj", MeshClip(np.stack([V, V]), TETRAHEDRON))
    save(tmp_path / "x.obj", MeshClip(V[None] + 1, TETRAHEDRON))
    assert_array_equal(load_mesh(tmp_path / "x.obj").vertices, V + 1)


def test_a_missing_folder_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="gone"):
        save(tmp_path / "gone" / "x.obj", TETRAHEDRON)


def test_import_is_quick_and_pulls_no_reader():
    code = (
        "import sys, tempose.formats as f; "
        "late = {'numba', 'trimesh', 'pygltflib', 'tempose.formats.glb', 'tempose.formats.bvh'}; "
        "bad = late & set(sys.modules); "
        "sys.exit(str(bad) if bad else 0)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_every_row_of_the_table_can_do_something():
    for suffix, row in FORMATS.items():
        assert suffix.startswith(".") and row.reads
        assert set(row.reads) <= {"mesh", "clip", "skeleton", "skin"}


def test_descriptions_are_one_line_with_what_matters():
    frames = np.stack([V, V + 0.2])
    source = Source(format="obj", guessed=("unit", "fps"), notes=("2 of the frames 1 to 5 are missing",))
    text = describe(MeshClip(frames, TETRAHEDRON, 24, source))
    for piece in ("4 vertices", "2 frames at 24 fps", "moving", "1 m tall", "from obj", "y up", "unit m"):
        assert piece in text
    assert "guessed: unit, fps" in text and "state fps" in text and "2 of the frames" in text
    assert "still" in describe(MeshClip(frames[[0, 0]], TETRAHEDRON))
    assert "note" not in describe(TETRAHEDRON)
    assert "0.001 m tall is unusual" in describe(TETRAHEDRON.with_vertices(V / 1000))
    assert "170 m tall is unusual" in describe(TETRAHEDRON.with_vertices(V * 170))


def test_descriptions_of_skeletons_skins_and_markers():
    skeleton = Skeleton(("hips", "head"), np.array([-1, 0]), np.array([[0, 1, 0], [0, 0.7, 0.0]]))
    still = np.tile([1.0, 0, 0, 0], (3, 2, 1))
    path = np.zeros((3, 3))
    clip = SkeletonClip(skeleton, still, path, 120, "walk", Source(format="bvh", unit=0.01))
    assert describe(clip) == (
        "skeleton clip walk: 2 joints, 3 frames at 120 fps (0.02 s, still), 0.7 m tall, "
        "from bvh, y up, unit cm"
    )
    assert "moving" in describe(SkeletonClip(skeleton, still, np.add(path, [[0], [1], [2]])))
    skin = SkinnedMesh(TETRAHEDRON, skeleton, np.tile([0.5, 0.5], (4, 1)))
    assert describe(skin).startswith("skinned mesh tet: 4 vertices, 4 triangles, 1 groups, 2 joints, still")
    markers = MarkerClip(("a", "b"), np.array([[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [np.nan] * 3]]))
    assert "2 markers, 2 frames at 30 fps (0.03 s, still), 1 m tall" in describe(markers)


@pytest.mark.real
def test_gltf_bvh_amc_and_makehuman_go_through_the_same_door(data_folder):
    gltf, cmu, human = (data_folder(name) for name in ("rigged-gltf", "mocap-cmu", "makehuman-base"))
    assert isinstance(load(gltf / "CesiumMan.glb"), MeshClip)
    assert isinstance(load_mesh(gltf / "CesiumMan.glb"), Mesh)
    assert isinstance(load(gltf / "human-male.glb"), Mesh)
    assert load_clip(gltf / "human-male.glb").n_frames == 1
    assert load_skeleton_clip(gltf / "CesiumMan.glb").skeleton.n_joints == 19
    assert isinstance(load_skin(gltf / "CesiumMan.glb"), SkinnedMesh)
    assert load(cmu / "cmu_12_01_walk.bvh").n_frames == 524
    assert load(cmu / "02_03.amc").n_frames == 173
    with pytest.raises(FormatError, match="skeleton without motion"):
        load(cmu / "02.asf")
    with pytest.raises(FormatError, match="no surface"):
        load_mesh(cmu / "02_03.amc")
    with pytest.raises(FormatError, match=r"expected a skeleton's motion \(.glb"):
        load_skeleton_clip(human / "base.obj")
    with pytest.raises(ValueError, match="mesh="):
        load_skin(human / "default_weights.mhw")
    body = load_mesh(human / "base.obj", group="body")
    assert load_skin(human / "default_weights.mhw", mesh=body).weights.shape == (13380, 163)


def test_glb_goes_through_save_and_load(tmp_path):
    clip = MeshClip(np.stack([V, V + 0.25, V + 0.5]), TETRAHEDRON, 24, Source(up="z", unit=0.01))
    seen: list[int] = []
    save(tmp_path / "x.glb", clip, progress=lambda done, total, stage: seen.append(done))
    back = load(tmp_path / "x.glb")
    assert_allclose(back.vertices, clip.vertices, atol=1e-6)
    assert_array_equal(back.faces, TETRAHEDRON.faces)
    assert back.fps == 24 and seen
    with pytest.raises(ValueError, match="up"):
        save(tmp_path / "y.glb", clip, up="z")
    assert [p.name for p in tmp_path.iterdir()] == ["x.glb"]
