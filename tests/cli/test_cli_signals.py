"""`tempose signals` fits, edits and plays as the library does; a model on disk plays as one in memory."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import tempose
from tempose.clips import Mesh, MeshClip
from tempose.signals import SignalModel

Run = Callable[..., Any]
T, FPS = 16, 24.0


def octahedron() -> Mesh:
    V = np.concatenate([np.eye(3), -np.eye(3)]) * [1.0, 1.5, 0.8]
    F = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    return Mesh(V, np.array(F))


def swaying() -> MeshClip:
    """A body that bends and twists, each at its own pace."""
    mesh = octahedron()
    t = np.arange(T)[:, None] / T
    x, y, z = mesh.vertices.T
    V = np.stack(
        [x + 0.3 * np.sin(5 * t) * y, y + 0.1 * np.cos(3 * t) * x, z * (1 + 0.2 * np.sin(7 * t))], axis=2
    )
    return MeshClip(V.astype(np.float32), Mesh(V[0], mesh.faces), FPS)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    tempose.save(folder / "clip.npz", swaying())
    SignalModel().fit(tempose.load(folder / "clip.npz")).save(folder / "clip.tempose")
    edits = {"operations": [{"op": "move", "control": 3, "by": [0.02, 0.01]}, {"op": "fps", "value": 12}]}
    (folder / "edit.json").write_text(json.dumps(edits))
    return folder


@pytest.fixture
def job(tmp_path: Path, made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a clip, a model of it and a list of edits."""
    monkeypatch.chdir(tmp_path)
    for path in made.iterdir():
        shutil.copy(path, tmp_path)
    return tmp_path


def test_fit_is_that_of_the_library(run: Run, job: Path) -> None:
    ran = run(
        "signals", "fit", "clip.npz", "-o", "m.tempose", "-k", 10, "-l", 9, "-m", 3, "--fix", "2=0.1,-0.2"
    )
    assert ran.code == 0, ran.err
    expected = SignalModel(k=10, l=9, m=3).fit(tempose.load("clip.npz"), {2: (0.1, -0.2)})
    found = SignalModel.load("m.tempose")
    assert_array_equal(found.sample(), expected.sample())
    assert_allclose(found.positions_[2], [0.1, -0.2], atol=1e-12)
    assert "10 of at most 18" in ran.out and "wrote m.tempose" in ran.err


def test_frames_are_chosen_before_the_fit(run: Run, job: Path) -> None:
    assert (
        run("signals", "fit", "clip.npz", "-o", "m.tempose", "--start", 2, "--stop", 12, "--step", 2).code
        == 0
    )
    model = SignalModel.load("m.tempose")
    assert (model.signals_.n_frames, model.signals_.fps) == (5, FPS / 2)


def test_report_holds_what_every_report_holds(run: Run, job: Path) -> None:
    ran = run(
        "signals", "fit", "clip.npz", "-o", "m.tempose", "--tolerance", 0.2, "--report", "r.json", "--json"
    )
    assert ran.code == 0, ran.err
    report = json.loads(Path("r.json").read_text())
    assert json.loads(ran.out) == report
    assert report["command"] == "signals fit" and report["version"] == tempose.__version__
    assert report["options"]["tolerance"] == 0.2 and report["options"]["space"] == "vertex"
    measures = {"rms", "rms_percent", "p99_percent", "max_percent", "e_rms", "kg"}
    assert set(report["errors"]) == measures
    assert set(report["baselines"]) == {"linear", "cubic"}
    assert set(report["heldout"]) == {"ours", "linear", "cubic"}
    for row in (*report["baselines"].values(), *report["heldout"].values()):
        assert set(row) == measures
    stages = {name: value for name, value in report["seconds"].items() if name != "total"}
    assert {"load", "layout", "pose", "time"} <= set(stages)
    assert sum(stages.values()) <= report["seconds"]["total"] + 1e-9
    assert report["errors"]["rms_percent"] <= 0.2


def test_left_out_frames_are_the_odd_ones(run: Run, job: Path) -> None:
    assert (
        run("signals", "fit", "clip.npz", "-o", "m.tempose", "--report", "r.json", "--held-out", 2).code == 0
    )
    V = tempose.load("clip.npz").vertices.astype(np.float64)
    middle = 0.5 * (V[0:13:2] + V[2:15:2]) - V[1:14:2]
    rms = np.sqrt(np.square(middle).sum(axis=2).mean())
    found = json.loads(Path("r.json").read_text())["heldout"]["linear"]
    assert found["rms"] == pytest.approx(rms, rel=1e-6)


def test_a_period_given_counts_fewer_of_the_frames_kept(run: Run, job: Path) -> None:
    for period in (6, 13):
        ran = run(
            *("signals", "fit", "clip.npz", "-o", "m.tempose", "--report", "r.json", "--period", period),
            *("--held-out", 4),
        )
        assert ran.code == 0, ran.err
        assert json.loads(Path("r.json").read_text())["heldout"]["ours"]["rms"] > 0


def test_examples_span_the_shape(run: Run, job: Path) -> None:
    clip = tempose.load("clip.npz")
    for i in (0, 5, 10):
        tempose.save(f"pose{i}.obj", Mesh(clip.vertices[i].astype(float), clip.faces))
    assert run("signals", "fit", "clip.npz", "-o", "m.tempose", "--examples", "pose*.obj").code == 0
    assert SignalModel.load("m.tempose").report_["m"] == 2


def test_sampling_at_twice_the_rate(run: Run, job: Path) -> None:
    assert run("signals", "sample", "clip.tempose", "-o", "out.npz", "--fps", 2 * FPS).code == 0
    out = tempose.formats.load_clip("out.npz")
    assert (out.n_frames, out.fps) == (2 * (T - 1) + 1, 2 * FPS)
    model = SignalModel.load("clip.tempose")
    assert_allclose(out.vertices, model(np.arange(2 * T - 1) / (2 * FPS)), atol=1e-6)
    assert_allclose(out.vertices[::2], model.sample(), atol=1e-6)


def test_sampling_at_moments_of_a_file(run: Run, job: Path) -> None:
    Path("times.txt").write_text("0\n# slow here\n0.01  # seconds\n\n0.015\n0.3\n")
    assert run("signals", "sample", "clip.tempose", "-o", "out.npz", "--times", "times.txt").code == 0
    out = tempose.formats.load_clip("out.npz")
    assert_allclose(
        out.vertices, SignalModel.load("clip.tempose")(np.array([0, 0.01, 0.015, 0.3])), atol=1e-6
    )


def test_moments_outside_the_clip_are_told(run: Run, job: Path) -> None:
    Path("times.txt").write_text("-1\n0.1\n9\n")
    ran = run("signals", "sample", "clip.tempose", "-o", "out.npz", "--times", "times.txt")
    assert ran.code == 0 and "2 of 3 times lie outside" in ran.err


def test_edit_is_that_of_the_library(run: Run, job: Path) -> None:
    before = Path("clip.tempose").read_bytes()
    ran = run("signals", "edit", "clip.tempose", "edit.json", "-o", "two.tempose", "--report", "r.json")
    assert ran.code == 0, ran.err
    expected = SignalModel.load("clip.tempose").edited(
        json.loads(Path("edit.json").read_text())["operations"]
    )
    assert_array_equal(SignalModel.load("two.tempose").sample(), expected.sample())
    assert Path("clip.tempose").read_bytes() == before
    report = json.loads(Path("r.json").read_text())
    assert (report["frames"], report["fps"], report["operations"]) == (8, 12.0, 2)


def test_a_model_may_be_replaced_by_its_edit(run: Run, job: Path) -> None:
    assert run("signals", "edit", "clip.tempose", "edit.json", "-o", "clip.tempose").code == 0
    assert SignalModel.load("clip.tempose").signals_.fps == 12


def test_operations_are_listed(run: Run) -> None:
    from tempose.signals.edits import OPERATIONS

    ran = run("signals", "edit", "--list")
    assert ran.code == 0 and all(name in ran.out for name in OPERATIONS)


def test_design_makes_a_model(run: Run, job: Path) -> None:
    clip = tempose.load("clip.npz")
    for i in range(3):
        tempose.save(f"{i}.obj", Mesh(clip.vertices[5 * i].astype(float), clip.faces))
    design = {
        "poses": ["0.obj", "1.obj", "2.obj"],
        "places": [[0, 0], [1, 0], [0, 1]],
        "curve": [[0, 0], [0.5, 0], [1, 0], [0, 1]],
        "fps": 10,
        "seconds": 1,
        "space": "vertex",
    }
    Path("design.json").write_text(json.dumps(design))
    ran = run("signals", "design", "design.json", "-o", "d.tempose")
    assert ran.code == 0, ran.err
    assert run("signals", "sample", "d.tempose", "-o", "d.npz").code == 0
    made = tempose.formats.load_clip("d.npz")
    assert made.n_frames == 11
    assert_allclose(made.vertices[0], clip.vertices[0], atol=1e-5)
    assert_allclose(made.vertices[-1], clip.vertices[10], atol=1e-5)


@pytest.mark.slow
def test_plots_and_grid(run: Run, job: Path) -> None:
    pytest.importorskip("PIL")
    assert (
        run("signals", "edit", "clip.tempose", "edit.json", "-o", "two.tempose", "--plot", "pictures").code
        == 0
    )
    names = {path.name for path in Path("pictures").iterdir()}
    assert {"pose-plane.png", "pose-plane.svg", "pose-grid.png", "scree.png"} <= names
    assert (
        run("signals", "grid", "clip.tempose", "-o", "grid.png", "--columns", 3, "--view", "front").code == 0
    )
    assert Path("grid.png").read_bytes()[:4] == b"\x89PNG"


def test_placement_is_advised_for_a_body_that_travels(run: Run, job: Path) -> None:
    clip = tempose.load("clip.npz")
    along = np.arange(T)[:, None, None] * np.array([0.0, 0.0, 0.4], np.float32)
    tempose.save("walk.npz", MeshClip(clip.vertices + along, clip.mesh, FPS))
    for name, options, advised in (
        ("walk.npz", (), True),
        ("walk.npz", ("--placement",), False),
        ("clip.npz", (), False),
    ):
        ran = run("signals", "fit", name, "-o", "w.tempose", *options)
        assert ran.code == 0 and ("--placement" in ran.err) == advised


def test_loops_of_a_clip_and_of_its_model(run: Run, job: Path) -> None:
    clip = tempose.load("clip.npz")
    twice = np.concatenate([clip.vertices, clip.vertices, clip.vertices])
    tempose.save("twice.npz", MeshClip(twice, clip.mesh, FPS))
    assert run("signals", "fit", "twice.npz", "-o", "twice.tempose", "--tolerance", 0.01).code == 0
    for name in ("twice.npz", "twice.tempose"):
        ran = run("signals", "loops", name, "--json")
        assert ran.code == 0, ran.err
        found = json.loads(ran.out)
        best = found["loops"][0]
        assert (best["frames"] % T, best["to"] - best["from"], best["grade"]) == (0, best["frames"], "exact")
    assert '{"op": "close_loop", "from": ' in run("signals", "loops", "twice.tempose").err
