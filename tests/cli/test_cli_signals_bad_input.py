"""What `tempose signals` cannot use is one line and exit code 2; nothing is half written, nothing lost."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tempose
from tempose.clips import Mesh, MeshClip
from tempose.models import load_model, save_model
from tempose.signals import SignalModel

Run = Callable[..., Any]


def octahedron() -> Mesh:
    V = np.concatenate([np.eye(3), -np.eye(3)]) * [1.0, 1.5, 0.8]
    F = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    return Mesh(V, np.array(F))


def clip_of(offsets: Any) -> MeshClip:
    mesh = octahedron()
    V = np.stack([mesh.vertices * (1 + 0.1 * np.array([a, b, 0.0])) for a, b in offsets])
    return MeshClip(V.astype(np.float32), Mesh(V[0], mesh.faces), 24.0)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    turn = np.linspace(0, 5, 8)
    tempose.save(folder / "clip.npz", clip_of(np.column_stack([np.sin(turn), np.cos(2 * turn)])))
    SignalModel().fit(tempose.load(folder / "clip.npz")).save(folder / "clip.tempose")
    return folder


@pytest.fixture
def job(tmp_path: Path, made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a clip of 8 frames, a model of it, and an empty folder for outputs."""
    monkeypatch.chdir(tmp_path)
    for path in made.iterdir():
        shutil.copy(path, tmp_path)
    (tmp_path / "out").mkdir()
    return tmp_path


def refused(run: Run, *words: object) -> str:
    """Run what must fail; the line that it says. Inputs stay, outputs do not appear."""
    inputs = {p: p.read_bytes() for p in Path().iterdir() if p.is_file()}
    ran = run(*words)
    assert ran.code == 2, (ran.code, ran.out, ran.err)
    assert list(Path("out").iterdir()) == []
    assert {p: p.read_bytes() for p in Path().iterdir() if p.is_file()} == inputs
    last = ran.err.splitlines()[-1]
    assert last.startswith("tempose: ") and "Traceback" not in ran.err
    assert sum(line.startswith("tempose: ") for line in ran.err.splitlines()) == 1
    assert "a defect of Tempose" not in last
    return last


FIT = ["signals", "fit", "clip.npz", "-o", "out/m.tempose", "--report", "out/r.json", "--plot", "out/plots"]


def test_one_frame(run: Run, job: Path) -> None:
    tempose.save("one.npz", clip_of([(0, 0)]))
    line = refused(run, "signals", "fit", "one.npz", "-o", "out/m.tempose")
    assert "one.npz" in line and "2 frames" in line


def test_two_frames_become_a_line(run: Run, job: Path) -> None:
    tempose.save("two.npz", clip_of([(0, 0), (1, 0)]))
    assert run("signals", "fit", "two.npz", "-o", "out/m.tempose").code == 0
    assert run("signals", "sample", "out/m.tempose", "-o", "out/two.npz", "--fps", 48).code == 0
    V = tempose.formats.load_clip("out/two.npz").vertices
    np.testing.assert_allclose(V[1], 0.5 * (V[0] + V[2]), atol=1e-6)


@pytest.mark.parametrize("offsets", [[(0, 0)] * 6, [(1, 0), (1, 0), (0, 1), (0, 1), (1, 0), (1, 0)]])
def test_still_and_repeated_frames_are_played_as_they_are(run: Run, job: Path, offsets: Any) -> None:
    clip = clip_of(offsets)
    tempose.save("still.npz", clip)
    ran = run("signals", "fit", "still.npz", "-o", "out/m.tempose", "--report", "out/r.json")
    assert ran.code == 0, ran.err
    assert run("signals", "sample", "out/m.tempose", "-o", "out/back.npz").code == 0
    back = tempose.formats.load_clip("out/back.npz").vertices
    np.testing.assert_allclose(back, clip.vertices, atol=5e-3 * clip.mesh.diagonal)


def test_nan(run: Run, job: Path) -> None:
    clip = clip_of([(0, 0), (1, 0), (0, 1)])
    V = clip.vertices.copy()
    V[1, 2, 0] = np.nan
    np.savez("nan.npz", vertices=V, faces=clip.faces, fps=24.0)
    assert "nan.npz" in refused(run, "signals", "fit", "nan.npz", "-o", "out/m.tempose")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-k", 3], "from 4 to T + 2"),
        (["-k", 11], "from 4 to 10"),
        (["-l", 2], "from 3 to T"),
        (["-l", 9], "from 3 to 8"),
        (["-m", -1], "from 0 to T - 1"),
        (["-m", 8], "from 0 to 7"),
        (["-k", 8, "-l", 8, "-m", 3, "--tolerance", 1], "not both"),
        (["--tolerance", 0], "positive"),
        (["--tolerance", -1], "positive"),
        (["--tolerance", "nan"], "positive"),
        (["--space", "sphere"], "gradient"),
        (["--between", "linear"], "path"),
        (["--layout", "circle"], "mds"),
        (["--period", "often"], "auto, none"),
        (["--period", "0.5"], "period"),
        (["--period", "9"], "below 7 frames"),
        (["--held-out", 1], "--held-out"),
        (["--held-out", -3], "--held-out"),
        (["--window", 3], "16"),
        (["--fix", "2"], "FRAME=X,Y"),
        (["--fix", "2=1"], "FRAME=X,Y"),
        (["--fix", "2=a,b"], "FRAME=X,Y"),
        (["--fix", "2=1,nan"], "finite"),
        (["--fix", "8=0,0"], "0 to 7"),
        (["--fix", "2=0,0", "--fix", "2=1,1"], "twice"),
        (["--start", 9], "start"),
        (["--stop", 1], "2 frames"),
        (["--examples", "nowhere*.obj"], "nowhere"),
        (["-k", "many"], "-k"),
    ],
)
def test_options_out_of_range_say_the_range(run: Run, job: Path, words: list[Any], says: str) -> None:
    assert says in refused(run, *FIT, *words)


def test_pins_of_different_poses_at_one_place_are_told_with_what_they_cost(run: Run, job: Path) -> None:
    """Not an error: two moments of a loop may be meant to meet."""
    ran = run(*FIT[:5], "--fix", "1=0.5,0.5", "--fix", "4=0.5,0.5")
    assert ran.code == 0 and "one place" in ran.err and "%" in ran.err


def test_pins_on_one_line(run: Run, job: Path) -> None:
    """All frames on one line leave no plane."""
    pins = [word for i in range(8) for word in ("--fix", f"{i}={i},{2 * i}")]
    assert "line" in refused(run, *FIT, *pins)


def test_example_of_another_mesh(run: Run, job: Path) -> None:
    tempose.save("other.obj", Mesh(np.eye(3), np.array([[0, 1, 2]])))
    assert "other.obj" in refused(run, *FIT, "--examples", "other.obj")


@pytest.mark.parametrize("name", ["missing/m.tempose", "out/m.glb", "out"])
def test_places_where_no_model_can_go(run: Run, job: Path, name: str) -> None:
    assert name.split("/")[0] in refused(run, "signals", "fit", "clip.npz", "-o", name)


def test_folders_of_reports_and_pictures_are_checked_first(run: Run, job: Path) -> None:
    words = ("signals", "fit", "clip.npz", "-o", "out/m.tempose")
    assert "missing" in refused(run, *words, "--report", "missing/r.json")
    assert "missing" in refused(run, *words, "--plot", "missing/plots")


def test_still_mesh_and_missing_clip(run: Run, job: Path) -> None:
    tempose.save("still.obj", octahedron())
    assert "still.obj" in refused(run, "signals", "fit", "still.obj", "-o", "out/m.tempose")
    assert "nothing.npz" in refused(run, "signals", "fit", "nothing.npz", "-o", "out/m.tempose")


def bad_models(folder: Path) -> dict[str, str]:
    """Files that are no model, and a word that the message must hold."""
    whole = (folder / "clip.tempose").read_bytes()
    Path("short.tempose").write_bytes(whole[: len(whole) // 2])
    Path("empty.tempose").write_bytes(b"")
    Path("text.tempose").write_text("hello")
    save_model("other.tempose", "rig", {"a": np.zeros(3)}, {})
    save_model("bare.tempose", "signals", {"a": np.zeros(3)}, {})
    arrays, header = load_model(folder / "clip.tempose", "signals")
    options = {key: header[key] for key in ("options", "report", "edits", "tree")}
    emptied = {"signals.shape.space.0": np.zeros(0)}
    spoilt = {"signals.pose.weights": np.full_like(arrays["signals.pose.weights"], np.nan)}
    save_model("emptied.tempose", "signals", arrays | emptied, options)
    save_model("spoilt.tempose", "signals", arrays | spoilt, options)
    newer = whole.replace(b'\\"format_version\\": 1', b'\\"format_version\\": 9')
    assert newer != whole
    Path("newer.tempose").write_bytes(newer)
    return {
        "short": "short",
        "empty": "empty",
        "text": "text",
        "other": "rig",
        "bare": "bare",
        "emptied": "do not fit together",
        "spoilt": "must be finite",
        "newer": "newer",
    }


@pytest.mark.parametrize(
    "kind", ["short", "empty", "text", "other", "bare", "emptied", "spoilt", "newer", "missing"]
)
def test_files_that_are_no_model(run: Run, job: Path, kind: str) -> None:
    says = bad_models(job).get(kind, "missing")
    Path("edit.json").write_text('{"operations": []}')
    file = f"{kind}.tempose"
    for words in (
        ("sample", file, "-o", "out/a.npz"),
        ("edit", file, "edit.json", "-o", "out/m.tempose"),
        ("plot", file, "-o", "out/plots"),
    ):
        line = refused(run, "signals", *words)
        assert file in line and says in line


EDITS = {
    "a control that is not there": ([{"op": "move", "control": 99, "by": [1, 0]}], "99"),
    "a negative control": ([{"op": "move", "control": -1, "by": [1, 0]}], "-1"),
    "an unknown operation": ([{"op": "dance"}], "move"),
    "an unknown key": ([{"op": "fps", "value": 12, "speed": 2}], "speed"),
    "a missing key": ([{"op": "move", "control": 1}], "by"),
    "a wrong kind": ([{"op": "move", "control": "one", "by": [1, 0]}], "control"),
    "a frame after the end": ([{"op": "cut", "from": 3, "to": 40}], "cut"),
    "frames in the wrong order": ([{"op": "loop", "from": 5, "to": 2, "times": 2}], "loop"),
    "a loop of no times": ([{"op": "loop", "from": 2, "to": 5, "times": 0}], "times"),
    "a rate of nothing": ([{"op": "fps", "value": 0}], "fps"),
    "a missing pose": ([{"op": "add_pose", "file": "nowhere.obj", "at": [0, 0]}], "nowhere.obj"),
    "missing shapes": ([{"op": "replace_shape", "source": ["no.obj"], "target": ["no2.obj"]}], "no.obj"),
    "times as words": ([{"op": "retime", "times": ["now"]}], "times"),
}


@pytest.mark.parametrize("kind", EDITS)
def test_edits_that_cannot_be_done(run: Run, job: Path, kind: str) -> None:
    operations, says = EDITS[kind]
    Path("edit.json").write_text(json.dumps({"operations": [{"op": "fps", "value": 30}, *operations]}))
    line = refused(
        run, "signals", "edit", "clip.tempose", "edit.json", "-o", "out/m.tempose", "--plot", "out/p"
    )
    assert "edit.json" in line and says in line and "operation 1" in line


@pytest.mark.parametrize("text", ["", "{", "[]", '{"operations": 3}', '{"operations": [3]}', '{"ops": []}'])
def test_edit_lists_that_are_none(run: Run, job: Path, text: str) -> None:
    Path("edit.json").write_text(text)
    line = refused(run, "signals", "edit", "clip.tempose", "edit.json", "-o", "out/m.tempose")
    assert "edit.json" in line


def test_missing_edit_list(run: Run, job: Path) -> None:
    assert "no.json" in refused(run, "signals", "edit", "clip.tempose", "no.json", "-o", "out/m.tempose")


@pytest.mark.parametrize(
    ("text", "says"),
    [("0\nnow\n", "line 2"), ("0 1\n", "line 1"), ("nan\n", "finite"), ("", "no line"), ("# 1", "no")],
)
def test_times_that_are_none(run: Run, job: Path, text: str, says: str) -> None:
    Path("times.txt").write_text(text)
    line = refused(run, "signals", "sample", "clip.tempose", "-o", "out/a.npz", "--times", "times.txt")
    assert "times.txt" in line and says in line


@pytest.mark.parametrize("fps", ["1e300", "1e13", "2e7"])
def test_rates_that_nothing_can_hold(run: Run, job: Path, fps: str, monkeypatch: pytest.MonkeyPatch) -> None:
    usage = shutil.disk_usage(".")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=1 << 28))
    line = refused(run, "signals", "sample", "clip.tempose", "-o", "out/a.npz", "--fps", fps)
    assert "GB" in line and ("fps" in line or "fewer frames" in line)


def test_bytes_as_times(run: Run, job: Path) -> None:
    Path("times.txt").write_bytes(bytes(range(128, 256)))
    assert "text" in refused(
        run, "signals", "sample", "clip.tempose", "-o", "out/a.npz", "--times", "times.txt"
    )


@pytest.mark.parametrize(
    "words",
    [
        ["-o", "out/a.npz", "--fps", 0],
        ["-o", "out/a.npz", "--fps", -5],
        ["-o", "out/a.npz", "--fps", "nan"],
        ["-o", "out/a.xyz"],
        ["-o", "missing/a.npz"],
        ["-o", "out/a.npz", "--times", "nowhere.txt"],
        ["-o", "out/a.npz", "--tolerance", 1],
    ],
)
def test_samples_that_cannot_be_made(run: Run, job: Path, words: list[Any]) -> None:
    refused(run, "signals", "sample", "clip.tempose", *words)


@pytest.mark.parametrize(
    "words",
    [
        ["-o", "out/g.png", "--region", "0,0,1"],
        ["-o", "out/g.png", "--region", "1,0,0,1"],
        ["-o", "out/g.png", "--columns", 1],
        ["-o", "out/g.png", "--view", "nowhere"],
        ["-o", "out/g.jpg"],
        ["-o", "missing/g.png"],
    ],
)
def test_grids_that_cannot_be_drawn(run: Run, job: Path, words: list[Any]) -> None:
    refused(run, "signals", "grid", "clip.tempose", *words)


@pytest.mark.parametrize(
    "text", ["{", "{}", '{"poses": ["no.obj", "no2.obj"], "places": [[0,0],[1,1]], "curve": []}']
)
def test_designs_that_cannot_be_made(run: Run, job: Path, text: str) -> None:
    Path("design.json").write_text(text)
    assert "design.json" in refused(run, "signals", "design", "design.json", "-o", "out/m.tempose")
