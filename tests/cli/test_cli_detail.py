"""`tempose detail`: models are those of the library; what it cannot use is one line and exit code 2."""

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
from tempose.cli.detail_words import parse_strength, read_mask
from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip
from tempose.detail import DetailModel
from tempose.rigging import fit_rig
from tempose.rotations import from_rotation_vector, multiply

Run = Callable[..., Any]
THEIRS = ("Bip01", "Bip01_Spine", "Bip01_Head")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    clip = tube_clip()
    rig = fit_rig(clip, tube_skin())
    rig.save(folder / "rig.tempose")
    tempose.save(folder / "clip.npz", clip)
    DetailModel("gp", folds=0).fit(clip, rig).save(folder / "model.tempose")
    return folder


@pytest.fixture
def job(tmp_path: Path, made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a clip, a rig, a model and their motion, and an empty folder for outputs."""
    monkeypatch.chdir(tmp_path)
    for path in made.iterdir():
        (tmp_path / path.name).symlink_to(path)
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


FIT = ("detail", "fit", "clip.npz", "--rig", "rig.tempose", "-o", "out/m.tempose")
POSE = ("detail", "pose", "model.tempose")


def test_a_fit_is_that_of_the_library(run: Run, job: Path) -> None:
    ran = run(*FIT, "--learner", "gp", "--report", "out/r.json")
    assert ran.code == 0, ran.err
    ours = DetailModel("gp").fit(tempose.load("clip.npz"), tempose.rigging.Rig.load("rig.tempose"))
    assert_allclose(DetailModel.load("out/m.tempose").pose().vertices, ours.pose().vertices, atol=1e-5)
    report = json.loads(Path("out/r.json").read_text())
    assert report["command"] == "detail fit" and report["learner"] == "gp"
    assert report["errors"]["rms_percent"] < 0.3 * report["baselines"]["skin"]["rms_percent"]
    assert {"skin", "mean", "nearest", "ridge", "gp"} <= set(report["heldout"])
    assert "skin alone" in ran.out and "gp" in ran.out


@pytest.mark.slow
def test_pictures_of_a_fit(run: Run, job: Path) -> None:
    ran = run(*FIT, "--learner", "gp", "--plot", "out/plots", "--json")
    assert ran.code == 0, ran.err
    assert json.loads(ran.out)["learner"] == "gp"
    names = {path.name for path in Path("out/plots").iterdir()}
    assert {
        "latent-space.png",
        "heldout-errors.svg",
        "frame-errors.png",
        "frames.png",
        "variance.png",
    } <= names


def test_several_clips_are_learned_from(run: Run, job: Path) -> None:
    ran = run("detail", "fit", "clip.npz", *FIT[2:], "--learner", "mean", "--report", "out/r.json")
    assert ran.code == 0, ran.err
    assert json.loads(Path("out/r.json").read_text())["clips"] == 2


def test_a_coarse_model_is_smaller_and_still_better_than_the_skin(run: Run, job: Path) -> None:
    assert run(*FIT, "--learner", "gp", "--resolution", 50, "--report", "out/r.json").code == 0
    report = json.loads(Path("out/r.json").read_text())
    assert report["errors"]["rms_percent"] < 0.6 * report["baselines"]["skin"]["rms_percent"]
    whole, coarse = DetailModel.load("model.tempose"), DetailModel.load("out/m.tempose")
    assert coarse.coarse_ is not None
    assert coarse.coarse_.basis.modes.shape[1] == pytest.approx(0.5 * whole.detail_.modes.shape[1], abs=1)
    assert coarse.detail_.modes.shape[1] == whole.detail_.modes.shape[1]


def test_a_motion_goes_out_is_edited_and_detail_follows(run: Run, job: Path) -> None:
    assert run("rig", "export", "model.tempose", "-o", "out/m.bvh").code == 0
    assert run(*POSE, "out/m.bvh", "-o", "out/same.npz").code == 0
    model = DetailModel.load("model.tempose")
    before = tempose.load("out/same.npz")
    assert_allclose(before.vertices, model.pose().vertices, atol=2e-4)
    motion = tempose.formats.load_skeleton_clip("out/m.bvh")
    turned = np.array(motion.rotations)
    late = slice(20, 30)
    turned[late, 2] = multiply(from_rotation_vector(np.array([0.0, 0.0, 0.6])), turned[late, 2])
    tempose.save("out/edited.bvh", replace(motion, rotations=turned))
    assert run(*POSE, "out/edited.bvh", "-o", "out/edited.npz").code == 0
    after = tempose.load("out/edited.npz")
    moved = np.linalg.norm(after.vertices - before.vertices, axis=-1)
    assert moved[:19].max() < 1e-4
    assert moved[late, tube_mesh().vertices[:, 1] > 0.9].min() > 0.02


def test_a_rig_without_detail_is_posed_as_well(run: Run, job: Path) -> None:
    rig = tempose.Rig.load("rig.tempose")
    assert run("rig", "export", "rig.tempose", "-o", "out/m.bvh").code == 0
    assert run("detail", "pose", "rig.tempose", "out/m.bvh", "-o", "out/skin.npz").code == 0
    assert_allclose(tempose.load("out/skin.npz").vertices, rig.vertices(), atol=1e-5)
    Path("sizes.json").write_text('{"middle": 1.3}')
    sized = ("--proportions", "sizes.json", "-o", "out/long.npz")
    assert run("detail", "pose", "rig.tempose", *sized).code == 0
    longer = tempose.rigging.change_proportions(rig, {"middle": 1.3})
    assert_allclose(tempose.load("out/long.npz").vertices, longer.vertices(), atol=1e-5)


@pytest.mark.parametrize("words", [("--strength", "0.5"), ("--damp", "0.1"), ("--mask", "middle")])
def test_a_rig_has_no_detail_to_edit(run: Run, job: Path, words: tuple) -> None:
    line = refused(run, "detail", "pose", "rig.tempose", "-o", "out/x.npz", *words)
    assert words[0] in line and "without detail" in line


def test_without_a_motion_the_clip_comes_back(run: Run, job: Path) -> None:
    assert run(*POSE, "-o", "out/back.npz").code == 0
    error = tempose.metrics.compare(
        tempose.load("clip.npz").vertices, tempose.load("out/back.npz").vertices, 1.0
    )
    assert error.rms < 2e-3


def test_edits_of_detail_are_those_of_the_library(run: Run, job: Path) -> None:
    model = DetailModel.load("model.tempose")
    np.save("mask.npy", np.linspace(0, 1, len(tube_mesh().vertices)))
    Path("sizes.json").write_text('{"middle": 1.3}')
    ways: list[tuple[tuple, dict[str, Any]]] = [
        (("--strength", 0), {"strength": 0.0}),
        (("--strength", "middle=2", "--strength", "end=0"), {"strength": {"middle": 2.0, "end": 0.0}}),
        (("--damp", 0.2), {"damp": 0.2}),
        (("--mask", "middle,end"), {"mask": ["middle", "end"]}),
        (("--mask", "mask.npy"), {"mask": np.load("mask.npy")}),
        (("--proportions", "sizes.json"), {"proportions": {"middle": 1.3}}),
    ]
    plain = model.pose().vertices
    for i, (words, options) in enumerate(ways):
        ran = run(*POSE, "-o", f"out/{i}.npz", *words)
        assert ran.code == 0, ran.err
        V = tempose.load(f"out/{i}.npz").vertices
        assert_allclose(V, model.pose(**options).vertices, atol=1e-5)
        assert np.abs(V - plain).max() > 1e-4, words


def other_names(names: tuple[str, ...] = THEIRS) -> None:
    tempose.save("theirs.bvh", tube_motion(6, names))


def test_odd_names_need_a_mapping(run: Run, job: Path) -> None:
    other_names()
    line = refused(run, *POSE, "theirs.bvh", "-o", "out/x.npz")
    assert "--map" in line and "theirs.bvh" in line and any(name in line for name in NAMES)
    Path("map.json").write_text(json.dumps(dict(zip(THEIRS, NAMES))))
    ran = run(*POSE, "theirs.bvh", "-o", "out/x.npz", "--map", "map.json")
    assert ran.code == 0, ran.err
    assert tempose.load("out/x.npz").n_frames == 6


def test_a_mapping_that_names_nothing(run: Run, job: Path) -> None:
    other_names()
    for text in ('{"Bip01": "pelvis"}', '{"Nobody": "root"}', '{"Bip01": 3}', "[]", "{"):
        Path("map.json").write_text(text)
        refused(run, *POSE, "theirs.bvh", "-o", "out/x.npz", "--map", "map.json")


def test_a_bvh_of_another_skeleton(run: Run, job: Path) -> None:
    names = ("tail", "fin")
    skeleton = Skeleton(names, np.array([-1, 0]), np.array([[0.0, 0, 0], [0, 0, 1]]))
    turns = np.tile([1.0, 0, 0, 0], (4, 2, 1))
    tempose.save("fish.bvh", SkeletonClip(skeleton, turns, np.zeros((4, 3)), 25.0))
    line = refused(run, *POSE, "fish.bvh", "-o", "out/x.npz")
    assert "fish.bvh" in line and "tail" in line


def test_poses_far_from_what_was_learned_are_told_of(run: Run, job: Path) -> None:
    motion = tube_motion(30)
    turned = np.array(motion.rotations)
    turned[10:, 2] = from_rotation_vector(np.array([0.0, 0.0, 2.4]))
    tempose.save("far.bvh", replace(motion, rotations=turned))
    ran = run(*POSE, "far.bvh", "-o", "out/x.npz", "--report", "out/r.json")
    assert ran.code == 0 and "far from what was learned" in ran.err
    assert any("far" in text for text in json.loads(Path("out/r.json").read_text())["warnings"])


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--learner", "oracle"), "regional-gp"),
        (("--basis", "sideways"), "blended, root, world"),
        (("--resolution", 0), "percent"),
        (("--resolution", 120), "percent"),
        (("--resolution", 1), "8 vertices"),
        (("--stop", 1), "2 frames"),
        (("--report", "nowhere/r.json"), "nowhere"),
    ],
)
def test_options_of_fit_out_of_range(run: Run, job: Path, words: tuple, says: str) -> None:
    assert says in refused(run, *FIT, *words)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--strength", "much"), "--strength"),
        (("--strength", -1), "--strength"),
        (("--strength", "1", "--strength", "2"), "twice"),
        (("--strength", "knee=2"), "knee"),
        (("--damp", 0), "--damp"),
        (("--damp", "nan"), "--damp"),
        (("--mask", "knee"), "knee"),
        (("--mask", "none.npy"), "none.npy"),
        (("--proportions", "none.json"), "none.json"),
        (("--tolerance", 1), "--tolerance is for .glb"),
    ],
)
def test_options_of_pose_out_of_range(run: Run, job: Path, words: tuple, says: str) -> None:
    assert says in refused(run, *POSE, "-o", "out/x.npz", *words)


@pytest.mark.parametrize("text", ['{"knee": 2}', '{"middle": -1}', '{"middle": {"width": 2}}', "3"])
def test_proportions_that_mean_nothing(run: Run, job: Path, text: str) -> None:
    Path("sizes.json").write_text(text)
    refused(run, *POSE, "-o", "out/x.npz", "--proportions", "sizes.json")


def test_masks_of_another_length(run: Run, job: Path) -> None:
    np.save("mask.npy", np.ones(5))
    line = refused(run, *POSE, "-o", "out/x.npz", "--mask", "mask.npy")
    assert "5" in line and str(len(tube_mesh().vertices)) in line


def test_clips_of_another_mesh(run: Run, job: Path, clip: MeshClip) -> None:
    tempose.save("other.npz", clip)
    line = refused(run, "detail", "fit", "other.npz", *FIT[3:])
    assert "other.npz" in line and "vertices" in line


def test_a_clip_of_other_vertices_in_the_same_number(run: Run, job: Path) -> None:
    clip = tube_clip()
    order = np.random.default_rng(0).permutation(len(clip.rest))
    V = np.asarray(clip.vertices)[:, order]
    mesh = Mesh(V[0], np.argsort(order)[clip.mesh.faces])
    tempose.save("mixed.npz", MeshClip(V, mesh, 25.0))
    ran = run("detail", "fit", "mixed.npz", *FIT[3:], "--learner", "mean", "--report", "r.json")
    warnings = " ".join(json.loads(Path("r.json").read_text())["warnings"])
    assert ran.code == 0 and "other faces" in ran.err and "other faces" in warnings
    assert "skin alone is off by" in ran.err and "skin alone is off by" in warnings
    good = run(*FIT, "--learner", "mean")
    assert good.code == 0 and "other faces" not in good.err and "another mesh" not in good.err


def test_a_skin_that_is_the_clip_leaves_nothing_to_learn(run: Run, job: Path) -> None:
    Path("clip.npz").unlink()
    tempose.save("clip.npz", tempose.Rig.load("rig.tempose").clip())
    ran = run(*FIT, "--learner", "gp")
    assert ran.code == 0 and "next to nothing is left to learn" in ran.err


def test_what_is_not_human_is_told_where_skeletons_are_given(run: Run, job: Path) -> None:
    line = refused(run, "detail", "fit", "clip.npz", "-o", "out/m.tempose")
    assert "--skeleton" in line and "tempose rig fit" in line and "--rig" in line


def test_detail_needs_motion(run: Run, job: Path) -> None:
    tempose.save("still.obj", tube_mesh())
    assert "still" in refused(run, "detail", "fit", "still.obj", *FIT[3:])


def test_constant_frames_are_told_of(run: Run, job: Path) -> None:
    V = np.repeat(tube_mesh().vertices[None], 20, axis=0).astype(np.float32)
    tempose.save("still.npz", MeshClip(V, tube_mesh(), 25.0))
    ran = run("detail", "fit", "still.npz", *FIT[3:])
    assert ran.code == 0 and "same" in ran.err


@pytest.mark.parametrize("learner", ["gplvm", "gplvm-paper"])
def test_fewer_frames_than_latent_dimensions(run: Run, job: Path, learner: str) -> None:
    ran = run(*FIT, "--learner", learner, "--stop", 4)
    assert ran.code in (0, 2) and "Traceback" not in ran.err
    assert "frames" in ran.err.split("mesh clip")[-1]


@pytest.mark.parametrize("words", [("none.tempose",), ("out",), ("clip.npz",)])
def test_what_is_no_model(run: Run, job: Path, words: tuple) -> None:
    assert words[0] in refused(run, "detail", "pose", *words, "-o", "out/x.npz")


def test_places_that_are_no_clip(run: Run, job: Path) -> None:
    assert ".fbx" in refused(run, *POSE, "-o", "out/x.fbx")
    assert "nowhere" in refused(run, *POSE, "-o", "nowhere/x.npz")
    assert ".tempose" in refused(run, "detail", "fit", "clip.npz", "--rig", "rig.tempose", "-o", "out/m.glb")


def test_words_are_read_as_they_are_written(tmp_path: Path) -> None:
    assert parse_strength(None) == 1.0 and parse_strength(["0.5"]) == 0.5
    assert parse_strength(["a=1", "b = c=2"]) == {"a": 1.0, "b = c": 2.0}
    assert read_mask(None) is None and read_mask("a, b") == ["a", "b"]
    path = tmp_path / "mask.json"
    path.write_text("[0, 0.5, 1]")
    assert_allclose(read_mask(str(path)), [0, 0.5, 1])
    for text in ("[0, 2]", "[[1]]", "{}", "[null]", '["a"]'):
        path.write_text(text)
        with pytest.raises(ValueError, match="each vertex"):
            read_mask(str(path))
