"""`tempose rig`: what it writes is what the library finds; what it cannot use is one line and exit code 2."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tube_rig import NAMES, tube_clip, tube_mesh, tube_motion, tube_skin

import tempose
from tempose.clips import Mesh, MeshClip
from tempose.formats import save_skin
from tempose.kinematics import linear_blend_skinning
from tempose.rigging import Rig, fit_rig

Run = Callable[..., Any]


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a clip and its skin, and an empty folder for outputs."""
    monkeypatch.chdir(tmp_path)
    tempose.save("clip.npz", tube_clip())
    save_skin("skin.glb", tube_skin(), tube_motion(2))
    (tmp_path / "out").mkdir()
    return tmp_path


def refused(run: Run, *words: object) -> str:
    """Run what must fail; the line that it says. Outputs do not appear."""
    ran = run(*words)
    assert ran.code == 2, (ran.code, ran.out, ran.err)
    assert not Path("out").is_dir() or list(Path("out").iterdir()) == []
    last = ran.err.splitlines()[-1]
    assert last.startswith("tempose: ") and "Traceback" not in ran.err
    assert "a defect of Tempose" not in last
    return last


FIT = ("rig", "fit", "clip.npz", "-o", "out/r.tempose", "--skeleton")


def test_a_fit_is_that_of_the_library(run: Run, job: Path) -> None:
    ran = run(*FIT, "skin.glb", "--report", "out/r.json")
    assert ran.code == 0, ran.err
    rig = Rig.load("out/r.tempose")
    ours = fit_rig(tempose.formats.load_clip("clip.npz"), tempose.formats.load_skin("skin.glb"))
    assert rig.skin.skeleton.names == NAMES
    assert_allclose(rig.vertices(), ours.vertices(), atol=1e-4)
    report = json.loads(Path("out/r.json").read_text())
    assert report["command"] == "rig fit" and report["options"]["skeleton"] == "skin.glb"
    assert report["errors"]["rms_percent"] == pytest.approx(ours.report["errors"]["rms_percent"], rel=1e-3)
    assert report["seconds"]["total"] > 0 and "warnings" in report
    assert f"{report['errors']['rms_percent']:.3g} %" in ran.out


def test_a_rig_is_a_skeleton_for_the_next_fit(run: Run, job: Path) -> None:
    assert run(*FIT, "skin.glb").code == 0
    assert run("rig", "fit", "clip.npz", "-o", "out/2.tempose", "--skeleton", "out/r.tempose").code == 0
    assert_allclose(Rig.load("out/2.tempose").vertices(), Rig.load("out/r.tempose").vertices(), atol=1e-4)


@pytest.mark.slow
def test_pictures_and_json(run: Run, job: Path) -> None:
    ran = run(*FIT, "skin.glb", "--plot", "out/plots", "--json", "--stop", 4)
    assert ran.code == 0, ran.err
    assert json.loads(ran.out)["options"]["stop"] == 4
    found = {path.name for path in Path("out/plots").iterdir()}
    assert found == {"skeleton.png", "weights.png", "frames.png", "frame-errors.png", "frame-errors.svg"}


@pytest.mark.parametrize("suffix", [".bvh", ".glb", ".usda"])
def test_a_rig_leaves_as_a_file_and_comes_back(run: Run, job: Path, suffix: str) -> None:
    if suffix == ".usda":
        pytest.importorskip("pxr")
    assert run(*FIT, "skin.glb").code == 0
    ran = run("rig", "export", "out/r.tempose", "-o", f"out/r{suffix}")
    assert ran.code == 0, ran.err
    rig = Rig.load("out/r.tempose")
    back = tempose.formats.load_skeleton_clip(f"out/r{suffix}")
    skeleton = replace(back.skeleton)
    assert skeleton.names[:3] == NAMES and back.n_frames == 30
    if suffix != ".bvh":
        skin = tempose.formats.load_skin(f"out/r{suffix}")
        V = linear_blend_skinning(skin, back.rotations, back.root_position, back.skeleton)
        assert_allclose(V, rig.vertices(), atol=1e-5)


def test_a_still_mesh_takes_a_skeleton(run: Run, job: Path) -> None:
    tempose.save("still.obj", tube_mesh())
    ran = run("rig", "fit", "still.obj", "--skeleton", "skin.glb", "-o", "out/still.tempose")
    assert ran.code == 0, ran.err
    assert Rig.load("out/still.tempose").motion.n_frames == 1


def test_a_bvh_brings_its_joints(run: Run, job: Path) -> None:
    tempose.save("joints.bvh", tube_motion(3))
    ran = run(*FIT, "joints.bvh")
    assert ran.code == 0, ran.err
    assert Rig.load("out/r.tempose").skin.skeleton.n_joints >= 3


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--skeleton", "dog"), "human, auto or a file"),
        (("--skeleton", "none.bvh"), "none.bvh"),
        (("--bones", 4), "--bones is for --skeleton auto"),
        (("--skeleton", "auto", "--bones", 1), "2 or more"),
        (("--frame", -1), "--frame"),
        (("--frame", 99, "--skeleton", "skin.glb"), "99"),
        (("--blending", "cubic"), "linear, dual-quaternion"),
        (("--report", "nowhere/r.json"), "nowhere"),
        (("--start", 40), "40"),
    ],
)
def test_options_out_of_range(run: Run, job: Path, words: tuple, says: str) -> None:
    assert says in refused(run, "rig", "fit", "clip.npz", "-o", "out/r.tempose", *words)


@pytest.mark.parametrize("name", ["out/r.glb", "out/r.bvh", "out/r.png", "out", "nowhere/r.tempose"])
def test_places_that_are_no_rig(run: Run, job: Path, name: str) -> None:
    assert name.split("/")[0] in refused(run, "rig", "fit", "clip.npz", "-o", name, "--skeleton", "skin.glb")


def test_a_motion_is_no_body(run: Run, job: Path) -> None:
    tempose.save("walk.bvh", tube_motion(4))
    line = refused(run, "rig", "fit", "walk.bvh", "-o", "out/r.tempose")
    assert "walk.bvh" in line and "--skeleton" in line


def test_bones_need_motion(run: Run, job: Path) -> None:
    tempose.save("still.obj", tube_mesh())
    line = refused(run, "rig", "fit", "still.obj", "-o", "out/r.tempose", "--skeleton", "auto")
    assert "still.obj" in line and "2 frames" in line


@pytest.mark.slow
def test_what_is_no_person_is_doubted(run: Run, job: Path) -> None:
    """A tube has no limbs: an error, or a warning with a measure, and the way out."""
    ran = run("rig", "fit", "clip.npz", "-o", "out/r.tempose", "--report", "out/r.json")
    assert ran.code in (0, 2)
    assert "--skeleton auto" in ran.err or "'auto'" in ran.err
    assert any(c.isdigit() for c in ran.err)


def test_a_skeleton_far_outside(run: Run, job: Path) -> None:
    motion = tube_motion(2)
    far = replace(motion.skeleton, offsets=np.array([[0, 0, 0], [3.0, 0, 0], [0, 0, 5.0]]))
    tempose.save("far.bvh", replace(motion, skeleton=far))
    ran = run(*FIT, "far.bvh")
    assert ran.code in (0, 2)
    assert "outside" in ran.err or "inside" in ran.err


def broken(mesh: Mesh, kind: str) -> Mesh:
    F = mesh.faces
    if kind == "open":
        return replace(mesh, faces=F[:-30])
    if kind == "inside out":
        return replace(mesh, faces=F[:, ::-1])
    n = len(mesh.vertices)
    beside = mesh.vertices + np.array([2.0, 0, 0])
    return Mesh(np.concatenate([mesh.vertices, beside]), np.concatenate([F, F + n]))


@pytest.mark.parametrize("kind", ["open", "in pieces", "inside out"])
def test_bodies_in_a_bad_state_are_told_of(run: Run, job: Path, kind: str) -> None:
    tempose.save("bad.obj", broken(tube_mesh(), kind))
    tempose.save("joints.bvh", tube_motion(1))
    ran = run("rig", "fit", "bad.obj", "--skeleton", "joints.bvh", "-o", "out/r.tempose")
    assert ran.code in (0, 2), ran.err
    words = {"open": "open", "in pieces": "piece", "inside out": "inside out"}
    assert words[kind] in ran.err, ran.err


def test_constant_frames_are_told_of(run: Run, job: Path) -> None:
    V = np.repeat(tube_mesh().vertices[None], 5, axis=0).astype(np.float32)
    tempose.save("still.npz", MeshClip(V, tube_mesh(), 25.0))
    ran = run("rig", "fit", "still.npz", "--skeleton", "skin.glb", "-o", "out/r.tempose")
    assert ran.code == 0 and "same" in ran.err


@pytest.mark.parametrize("content", [b"", b"no model", b"\x10\0\0\0\0\0\0\0{}"])
def test_broken_rigs(run: Run, job: Path, content: bytes) -> None:
    Path("bad.tempose").write_bytes(content)
    assert "bad.tempose" in refused(run, "rig", "export", "bad.tempose", "-o", "out/r.bvh")


def test_exports_that_cannot_be(run: Run, job: Path) -> None:
    assert run(*FIT, "skin.glb").code == 0
    Path("out/r.tempose").rename("r.tempose")
    assert ".fbx" in refused(run, "rig", "export", "r.tempose", "-o", "out/r.fbx")
    assert "nowhere" in refused(run, "rig", "export", "r.tempose", "-o", "nowhere/r.bvh")
    assert "none.tempose" in refused(run, "rig", "export", "none.tempose", "-o", "out/r.bvh")


def test_a_model_of_another_kind(run: Run, job: Path) -> None:
    tempose.SignalModel().fit(tempose.load("clip.npz")).save("signals.tempose")
    line = refused(run, "rig", "export", "signals.tempose", "-o", "out/r.bvh")
    assert "signals" in line and "rig" in line


def test_a_skin_on_the_wrong_vertices_is_told_of(run: Run, job: Path) -> None:
    clip = tube_clip()
    order = np.random.default_rng(0).permutation(len(clip.rest))
    V = np.asarray(clip.vertices)[:, order]
    tempose.save("mixed.npz", MeshClip(V, replace(clip.mesh, vertices=V[0]), 25.0))
    ran = run("rig", "fit", "mixed.npz", "--skeleton", "skin.glb", "-o", "out/r.tempose")
    assert ran.code == 0 and "skin alone is off by" in ran.err and "another mesh" in ran.err
    good = run(*FIT, "skin.glb")
    assert good.code == 0 and "another mesh" not in good.err


def test_bones_of_a_clip_that_only_slides(run: Run, job: Path) -> None:
    V = tube_mesh().vertices + np.arange(8)[:, None, None] * np.array([0.1, 0, 0])
    tempose.save("slide.npz", MeshClip(V.astype(np.float32), tube_mesh(), 25.0))
    line = refused(run, "rig", "fit", "slide.npz", "-o", "out/r.tempose", "--skeleton", "auto", "--bones", 6)
    assert "one rigid body" in line and "bones=1" not in line


def test_bones_of_two_frames_are_doubted(run: Run, job: Path) -> None:
    tempose.save("two.npz", tube_clip(2))
    ran = run("rig", "fit", "two.npz", "-o", "out/r.tempose", "--skeleton", "auto", "--bones", 2)
    assert ran.code == 0 and "only 2 frames" in ran.err
