"""What a command writes is what the library call gives; what fails leaves nothing behind."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import tempose
from tempose.cli import console, convert
from tempose.clips import MeshClip
from tempose.clips.resample import resample, select_frames

Run = Callable[..., Any]


def test_info_says_what_the_library_says(run: Run, frames: Path, clip: MeshClip) -> None:
    ran = run("info", frames, "--json")
    facts = json.loads(ran.out)
    assert (ran.code, ran.err) == (0, "")
    assert (facts["kind"], facts["frames"], facts["fps"]) == ("mesh clip", 5, 30.0)
    assert (facts["vertices"], facts["triangles"], facts["pieces"]) == (4, 4, 1)
    assert facts["problems"] == {} and facts["guessed"] == ["up", "unit", "fps"]
    assert_allclose(facts["height_metres"], clip.mesh.height, rtol=1e-6)
    table = run("info", frames)
    assert "none found" in table.out and "tetra" not in table.err


def test_info_names_problems(run: Run, tmp_path: Path) -> None:
    (tmp_path / "open.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\nf 1 3 2\n")
    facts = json.loads(run("info", tmp_path / "open.obj", "--json").out)
    assert facts["problems"] == {"duplicate_faces": 1, "loose_vertices": 1}
    assert "1 faces that are there twice, 1 vertices without a face" in run("info", tmp_path / "open.obj").out


def test_convert_is_load_and_save(run: Run, frames: Path, clip: MeshClip, tmp_path: Path) -> None:
    out = tmp_path / "out.npz"
    ran = run("convert", frames, out)
    assert (ran.code, ran.out) == (0, "")
    assert ran.err.count("\n") == 2 and "wrote" in ran.err
    loaded = tempose.load(out)
    assert isinstance(loaded, MeshClip)
    assert_array_equal(loaded.vertices, clip.vertices)
    assert_array_equal(loaded.faces, clip.faces)
    assert loaded.fps == clip.fps


def test_convert_frames_and_rate(run: Run, frames: Path, clip: MeshClip, tmp_path: Path) -> None:
    stated, out = tmp_path / "stated.npz", tmp_path / "out.npz"
    assert run("convert", frames, stated, "--fps", 24).code == 0
    assert_array_equal(tempose.load(stated).vertices, clip.vertices)
    assert tempose.load(stated).fps == 24

    assert run("convert", stated, out, "--fps", 48, "--start", 1).code == 0
    expected = resample(select_frames(tempose.load(stated), 1), 48)
    assert_array_equal(tempose.load(out).vertices, expected.vertices)
    assert expected.n_frames == 7

    assert run("convert", stated, out, "--step", 2, "--stop", 4).code == 0
    assert_array_equal(tempose.load(out).vertices, clip.vertices[[0, 2]])
    assert tempose.load(out).fps == 12


def test_rate_stated_with_a_step_is_that_of_the_output(run: Run, frames: Path, tmp_path: Path) -> None:
    assert run("convert", frames, tmp_path / "out.npz", "--fps", 24, "--step", 2).code == 0
    loaded = tempose.load(tmp_path / "out.npz")
    assert (loaded.n_frames, loaded.fps) == (3, 24)


def test_convert_states_input_and_output_apart(
    run: Run, frames: Path, clip: MeshClip, tmp_path: Path
) -> None:
    out = tmp_path / "out.npz"
    assert run("convert", frames, out, "--from-unit", "cm", "--unit", "mm", "--up", "z").code == 0
    assert_allclose(tempose.load(out).vertices, clip.vertices * 0.01, rtol=1e-5, atol=1e-8)
    raw = np.load(out)["vertices"]
    assert_allclose(raw[..., 2], clip.vertices[..., 1] * 10, rtol=1e-5, atol=1e-5)
    assert_allclose(raw[..., 1], -clip.vertices[..., 2] * 10, rtol=1e-5, atol=1e-5)


def test_tolerance_makes_a_smaller_file_within_it(run: Run, tmp_path: Path, rng: np.random.Generator) -> None:
    V, t = rng.normal(size=(2, 200, 3)), np.linspace(0, 6, 40)[:, None, None]
    mesh = tempose.Mesh(V[0], np.arange(198)[:, None] + np.arange(3))
    tempose.save(tmp_path / "clip.npz", MeshClip(V[0] + np.sin(t) * V[1], mesh, 30))
    sizes: list[int] = []
    for words in ([], ["--tolerance", 0.01]):
        out = tmp_path / f"{len(sizes)}.glb"
        assert run("convert", tmp_path / "clip.npz", out, *words).code == 0
        errors = json.loads(run("compare", tmp_path / "clip.npz", out, "--json").out)
        assert errors["max_percent"] <= (0.01 if words else 1e-4)
        sizes.append(out.stat().st_size)
    assert sizes[1] < 0.2 * sizes[0]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--start", "5"], "start must be a frame from 0 to 4, got 5"),
        (["--stop", "9"], "at most 5, got 9"),
        (["--step", "0"], "step must be at least 1, got 0"),
        (["--fps", "-1"], "fps must be positive"),
        (["--up", "w"], "up must be"),
        (["--unit", "furlong"], "unit must be"),
        (["--group", "wing"], "wing"),
        (["--from-fps", "0"], "fps must be positive"),
        (["--tolerance", "0.1"], "--tolerance is for .glb"),
    ],
)
def test_wrong_values_are_refused(
    run: Run, frames: Path, tmp_path: Path, words: list[str], said: str
) -> None:
    ran = run("convert", frames, tmp_path / "out.npz", *words)
    assert ran.code == 2 and said in ran.err.splitlines()[-1]
    assert sorted(os.listdir(tmp_path)) == ["frames"]


def test_frames_of_a_still_mesh_are_refused(run: Run, frames: Path, tmp_path: Path) -> None:
    ran = run("convert", frames / "0.obj", tmp_path / "out.npz", "--start", 1)
    assert ran.code == 2 and "is still" in ran.err.splitlines()[-1]


@pytest.mark.parametrize("out", ["out", "new/a.####.obj", "out.xyz", "no/such/out.npz", "frames/0.obj/x.npz"])
def test_failed_writing_leaves_nothing(
    run: Run, frames: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out: str
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "write_bytes", full)
    ran = run("convert", "frames", out)
    assert ran.code == 2
    assert out.split("/")[0] in ran.err.splitlines()[-1]
    assert os.listdir() == ["frames"]


@pytest.mark.skipif(os.name == "nt", reason="no limit on the size of files")
@pytest.mark.parametrize("out", ["out.npz", "out.npy", "out.glb", "out", "a.####.obj"])
def test_full_disk_is_one_line_and_leaves_nothing(tmp_path: Path, rng: np.random.Generator, out: str) -> None:
    V = rng.normal(size=(60, 300, 3))
    mesh = tempose.Mesh(V[0], np.arange(298)[:, None] + np.arange(3))
    tempose.save(tmp_path / "clip.npz", MeshClip(V, mesh, 30))
    code = (
        "import resource, sys; from tempose.cli import main; "
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)); sys.exit(main())"
    )
    line = [sys.executable, "-B", "-c", code, "convert", "clip.npz", out]
    ran = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 2, ran.stderr
    assert ran.stderr.splitlines()[-1].startswith(f"tempose: {out}: "), ran.stderr
    assert "Traceback" not in ran.stderr and os.listdir(tmp_path) == ["clip.npz"]


def test_read_only_folder(run: Run, frames: Path, tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o500)
    if os.access(closed, os.W_OK):
        pytest.skip("this user may write anywhere")
    ran = run("convert", frames, closed / "out.npz")
    assert ran.code == 2 and "Permission denied" in ran.err and os.listdir(closed) == []


def test_ctrl_c_while_writing_leaves_the_old_file(
    run: Run, frames: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    @contextmanager
    def interrupting() -> Generator[Any, None, None]:
        def show(done: int, total: int, stage: str) -> None:
            if done == 3:
                raise KeyboardInterrupt

        yield show

    out = tmp_path / "out"
    assert run("convert", frames, out, "--stop", 2).code == 0
    before = {p.name: p.read_bytes() for p in out.iterdir()}
    monkeypatch.setattr(convert, "progress_bar", interrupting)
    ran = run("convert", frames, out)
    assert ran.code == 130
    assert ran.err.splitlines()[-1] == "tempose: interrupted; nothing was written under its final name"
    assert {p.name: p.read_bytes() for p in out.iterdir()} == before
    assert sorted(os.listdir(tmp_path)) == ["frames", "out"]


def test_compare_prints_the_errors(run: Run, frames: Path, clip: MeshClip, tmp_path: Path) -> None:
    other = tmp_path / "other.npz"
    moved = MeshClip(clip.vertices + np.float32([0, 0.01, 0]), clip.mesh, clip.fps)
    tempose.save(other, moved)
    ran = run("compare", frames, other, "--json")
    errors = json.loads(ran.out)
    expected = tempose.metrics.compare(clip.vertices, moved.vertices, clip.mesh.diagonal).as_dict()
    assert errors == pytest.approx({**expected, "frames": 5, "vertices": 4}, rel=1e-5)
    assert list(errors)[:6] == ["rms", "rms_percent", "p99_percent", "max_percent", "e_rms", "kg"]
    assert all(key in run("compare", frames, other).out for key in errors)
    zero = json.loads(run("compare", frames, frames, "--json").out)
    assert [zero[key] for key in expected] == [0] * 6


def test_compare_of_other_sizes_names_both(run: Run, frames: Path, tmp_path: Path) -> None:
    run("convert", frames, tmp_path / "short.npz", "--stop", 3)
    ran = run("compare", frames, tmp_path / "short.npz")
    assert ran.code == 2
    assert "has 3 frames of 4 vertices" in ran.err and "5 frames of 4 vertices" in ran.err.splitlines()[-1]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "out.bmp"], "pictures are written as .png, .gif or .mp4"),
        (["-o", "out.gif", "--view", "front", "--view", "top"], "a film has one view, got 2"),
        (["-o", "out.png", "--view", "inside"], "a view must be"),
        (["-o", "out.png", "--frames", "0"], "Invalid value for '--frames'"),
        (["-o", "out.png", "--theme", "pink"], "pink"),
    ],
)
def test_wrong_render_options(
    run: Run, frames: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: list[str], said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    ran = run("render", "frames", *words)
    assert ran.code == 2 and said in ran.err.splitlines()[-1]
    assert os.listdir() == ["frames"]


@pytest.mark.parametrize("name", ["out.png", "out.gif"])
def test_render_writes_the_picture_of_the_library(run: Run, frames: Path, tmp_path: Path, name: str) -> None:
    pytest.importorskip("PIL")
    options: dict[str, Any] = {"frames": 2, "cell": 40} if name == "out.png" else {"size": (40, 40)}
    ran = run("render", frames, "-o", tmp_path / name, "--frames", 2, "--size", 40)
    assert ran.code == 0 and ran.out == ""
    tempose.render.render([tempose.load(str(frames))], tmp_path / f"library{name}", **options)
    assert (tmp_path / name).read_bytes() == (tmp_path / f"library{name}").read_bytes()


@pytest.mark.skipif(os.name == "nt", reason="no limit on the size of files")
def test_film_on_a_full_disk_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("imageio_ffmpeg")
    code = (
        "import resource, sys, numpy as np; from tempose.render.video import save_mp4; "
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)); "
        "noise = np.random.default_rng(0).integers(0, 255, (9, 96, 96, 3)).astype(np.uint8); "
        "save_mp4(noise, sys.argv[1])"
    )
    line = [sys.executable, "-B", "-c", code, "film.mp4"]
    ran = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 1 and "film.mp4: the film could not be written whole" in ran.stderr, ran.stderr
    assert os.listdir(tmp_path) == []


def test_json_holds_no_nan() -> None:
    value = {"a": np.float64("nan"), "b": [np.inf, 1.5], "c": np.arange(2), "d": Path("x"), 1: None}
    assert console.plain(value) == {"a": None, "b": [None, 1.5], "c": [0, 1], "d": "x", "1": None}


def test_data_lists_and_finds(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TEMPOSE_DATA", str(tmp_path))
    names = [entry["name"] for entry in json.loads(run("data", "list", "--json").out)]
    assert names == list(tempose.datasets.dataset_names())
    folder = tmp_path / "mocap-cmu"
    folder.mkdir()
    for file in tempose.datasets.dataset("mocap-cmu").files:
        (folder / file.name).touch()
    assert run("data", "where", "mocap-cmu").out == f"{folder}\n"
    assert run("data", "fetch", "mocap-cmu").out == f"{folder}\n"
    here = {e["name"]: e["here"] for e in json.loads(run("data", "list", "--json").out)}
    assert here["mocap-cmu"]


def test_data_without_network_is_one_line(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from tempose.datasets import download, folders

    monkeypatch.delenv("TEMPOSE_DATA", raising=False)
    monkeypatch.setattr(folders.pooch, "os_cache", lambda project: tmp_path)
    fetch = download.fetch
    monkeypatch.setattr(
        tempose.datasets,
        "fetch",
        lambda name, progress: fetch(name, progress, host="http://127.0.0.1:9", timeout=2.0),
    )
    ran = run("data", "fetch", "mocap-cmu")
    assert ran.code == 2
    assert "no connection" in ran.line and str(tmp_path / "data" / "mocap-cmu") in ran.line
    assert run("data", "where", "mocap-cmu").line.endswith("or set TEMPOSE_DATA")
