"""`tempose transfer` is loading, the library's transfer, saving, and a report; what is wrong is one line."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import tempose
from tempose.clips import Mesh
from tempose.clips.resample import select_frames

Run = Callable[..., Any]

BVH = """HIERARCHY
ROOT low
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT high
  {
    OFFSET 0 1 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 1 0
    }
  }
}
MOTION
Frames: 6
Frame Time: 0.05
"""
RINGS, SIDES = 9, 8


def tube() -> Mesh:
    """Closed tube of 2 m along Y."""
    angle = np.arange(SIDES) * 2 * np.pi / SIDES
    circle = 0.2 * np.column_stack([np.sin(angle), np.zeros(SIDES), np.cos(angle)])
    V = np.concatenate(
        [np.add(circle, [0, y, 0]) for y in np.linspace(0, 2, RINGS)] + [[[0, 0, 0]], [[0, 2, 0]]]
    )
    k, after = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES
    bottom, top = np.full(SIDES, len(V) - 2), np.full(SIDES, len(V) - 1)
    faces = [
        np.column_stack([bottom, after, k]),
        np.column_stack([(RINGS - 1) * SIDES + k, (RINGS - 1) * SIDES + after, top]),
    ]
    for low in range(0, (RINGS - 1) * SIDES, SIDES):
        faces.append(np.column_stack([low + k, low + after, low + SIDES + after]))
        faces.append(np.column_stack([low + k, low + SIDES + after, low + SIDES + k]))
    return Mesh(V, np.concatenate(faces))


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a bending motion, a tube and pairs between them."""
    monkeypatch.chdir(tmp_path)
    rows = [f"{0.1 * t} 0 0 0 0 0 {9 * t} 0 0" for t in range(6)]
    Path("bend.bvh").write_text(BVH + "\n".join(rows) + "\n")
    mesh = tube()
    tempose.save("tube.obj", mesh)
    centre = mesh.vertices[mesh.faces].mean(axis=1)[:, 1]
    faces = {"low": np.flatnonzero(centre < 0.6), "high": np.flatnonzero(centre > 1.4)}
    pairs = [[joint, int(face)] for joint, chosen in faces.items() for face in chosen]
    Path("pairs.json").write_text(json.dumps({"kind": "joints", "pairs": pairs}))
    return tmp_path


WORDS = ["transfer", "bend.bvh", "tube.obj", "--pairs", "pairs.json", "-o", "out.npz", "--source-unit", "m"]


def test_result_is_that_of_the_library(run: Run, job: Path) -> None:
    ran = run(*WORDS, "--source-rest", 0, "--no-contacts")
    assert ran.code == 0, ran.err
    motion = tempose.formats.load_skeleton_clip("bend.bvh", unit="m")
    expected = tempose.transfer.transfer_motion(
        motion,
        tempose.formats.load_mesh("tube.obj"),
        tempose.transfer.load_pairs("pairs.json"),
        source_rest=motion,
        rest_frame=0,
        contacts=False,
    ).clip
    result = tempose.formats.load_clip("out.npz")
    assert_allclose(result.vertices, expected.vertices, atol=1e-6)
    assert_array_equal(result.faces, expected.faces)
    assert result.fps == expected.fps == 20
    tip = result.vertices[:, 2 * SIDES - 1] - result.vertices[:, 0]
    bent = result.vertices[5, -1] - result.vertices[5, 4 * SIDES]
    assert abs(np.degrees(np.arctan2(-bent[0], bent[1]))) > 20, "the upper half must follow the joint"
    assert np.isfinite(tip).all()


def test_trimming_keeps_the_reference(run: Run, job: Path) -> None:
    assert run(*WORDS, "--source-rest", 0, "--no-contacts").code == 0
    whole = tempose.formats.load_clip("out.npz")
    assert run(*WORDS, "--source-rest", 0, "--no-contacts", "--start", 2, "--stop", 6, "--step", 2).code == 0
    part, kept = tempose.formats.load_clip("out.npz"), select_frames(whole, 2, 6, 2)
    offset = part.vertices[0].mean(axis=0) - kept.vertices[0].mean(axis=0)
    assert_allclose(part.vertices[0] - offset, kept.vertices[0], atol=1e-5)
    assert part.fps == kept.fps


def test_report_holds_what_was_asked_and_what_was_found(run: Run, job: Path) -> None:
    ran = run(*WORDS, "--report", "report.json", "--save-pairs", "used.json", "--json")
    assert ran.code == 0, ran.err
    report = json.loads(Path("report.json").read_text())
    assert report == json.loads(ran.out)
    assert (report["command"], report["version"]) == ("transfer", tempose.__version__)
    assert report["inputs"] == {"source": "bend.bvh", "target": "tube.obj", "out": "out.npz"}
    assert report["options"]["pairs"] == "pairs.json" and report["options"]["contacts"] is True
    assert {"load", "frames", "save", "total"} <= set(report["seconds"])
    assert report["seconds"]["total"] >= sum(v for k, v in report["seconds"].items() if k != "total") - 1e-3
    assert {"errors", "baselines", "heldout", "warnings", "edge_ratio", "flipped_percent", "volume"} <= set(
        report
    )
    assert tempose.transfer.load_pairs("used.json").source == tempose.transfer.load_pairs("pairs.json").source


def test_table_for_people(run: Run, job: Path) -> None:
    ran = run(*WORDS)
    assert "edge lengths" in ran.out and "seconds" in ran.out and "wrote out.npz" in ran.err


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        ({"kind": "joints", "pairs": [["low", 0], ["high", 99999]]}, "99999"),
        ({"kind": "joints", "pairs": [["low", 0], ["high", 0]]}, "a second time"),
        ({"kind": "joints", "pairs": [["low", 0]]}, "too few"),
        ({"kind": "joints", "pairs": [["low", 0], ["wing", 1]]}, "wing"),
        ({"kind": "joints", "pairs": [["low", 0], ["high", 1]], "colour": 1}, "colour"),
        ({"kind": "faces", "pairs": [[0, 0], [1, 1], [2, 2]]}, "expected a mesh"),
        ("[", "pairs.json"),
    ],
)
def test_wrong_pairs(run: Run, job: Path, pairs: Any, said: str) -> None:
    Path("pairs.json").write_text(pairs if isinstance(pairs, str) else json.dumps(pairs))
    ran = run(*WORDS)
    assert ran.code == 2 and said in ran.err.splitlines()[-1], ran.err
    assert sorted(os.listdir()) == ["bend.bvh", "pairs.json", "tube.obj"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--source-rest", "6"], "--source-rest must be a file or a frame from 0 to 5, got 6"),
        (["--source-rest", "none.bvh"], "none.bvh: no such file"),
        (["--start", "6"], "start must be a frame from 0 to 5, got 6"),
        (["-o", "out.xyz"], "out.xyz: cannot write '.xyz'"),
        (["-o", "no/where.npz"], "no such folder"),
        (["--group", "head"], "no group named 'head'"),
        (["--mapping", "pairs.json"], "pairs.json: expected one table"),
        (["--mapping", "tube.obj"], "tube.obj: expected JSON or TOML"),
        (["--pairs", "none.json"], "none.json"),
        (["--pairs", "none.mhw"], "none.mhw"),
        (["--volume", "-1"], "Invalid value for '--volume'"),
    ],
)
def test_wrong_options(run: Run, job: Path, words: list[str], said: str) -> None:
    ran = run(*WORDS, *words)
    assert ran.code == 2 and said in ran.err.splitlines()[-1], ran.err
    assert sorted(os.listdir()) == ["bend.bvh", "pairs.json", "tube.obj"]


def test_target_without_skin_needs_pairs(run: Run, job: Path) -> None:
    ran = run("transfer", "bend.bvh", "tube.obj", "-o", "out.npz")
    assert ran.code == 2 and "give a pairs file" in ran.err.splitlines()[-1]


@pytest.mark.parametrize(
    "content",
    ["v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"],
)
def test_target_without_volume(run: Run, job: Path, content: str) -> None:
    Path("tube.obj").write_text(content)
    ran = run(*WORDS)
    assert ran.code == 2 and "target must" in ran.err.splitlines()[-1]


@pytest.mark.real
@pytest.mark.parametrize("name", ["human-male.glb", "base.obj"])
def test_walk_onto_a_human_without_a_click(
    run: Run, tmp_path: Path, data_folder: Callable[[str], Path], name: str
) -> None:
    walk = data_folder("mocap-cmu") / "cmu_12_01_walk.bvh"
    words: list[Any] = [data_folder("rigged-gltf") / name]
    if name == "base.obj":
        human = data_folder("makehuman-base")
        words = [human / name, "--group", "body", "--pairs", human / "default_weights.mhw"]
    out = tmp_path / "out.npz"
    ran = run("transfer", walk, *words, "-o", out, "--step", 40, "--json")
    report = json.loads(ran.out)
    assert ran.code == 0 and tempose.formats.load_clip(out).n_frames in (13, 14)
    assert report["bone_direction_deg"]["mean"] < 6 and report["flipped_percent"] < 0.05


@pytest.mark.parametrize("out", ["out.npz", "out.glb", "out.####.ply", "out.npy", "out"])
def test_a_long_clip_goes_by_way_of_the_disk_and_comes_out_the_same(
    run: Run, job: Path, monkeypatch: pytest.MonkeyPatch, out: str
) -> None:
    def files() -> dict[str, bytes]:
        return {str(p): p.read_bytes() for p in Path().rglob("*") if p.is_file() and "out" in str(p)}

    words = [out if word == "out.npz" else word for word in WORDS]
    assert run(*words).code == 0
    short = files()
    assert short
    monkeypatch.setattr("tempose.cli.transfer_frames.IN_MEMORY", 0)
    assert run(*words).code == 0
    assert files() == short
    assert not list(Path().rglob(".*")), "nothing is left of the frames"


def test_an_interrupted_long_clip_leaves_nothing(
    run: Run, job: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempose.cli.transfer_frames.IN_MEMORY", 0)
    before = sorted(os.listdir())

    def full(*_: Any, **__: Any) -> None:
        assert any(name.startswith(".out.npz.") for name in os.listdir())
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempose, "save", full)
    ran = run(*WORDS)
    assert ran.code == 2 and "out.npz: No space left" in ran.err
    monkeypatch.setattr(tempose, "save", lambda *_, **__: (_ for _ in ()).throw(KeyboardInterrupt()))
    assert run(*WORDS).code == 130
    assert sorted(os.listdir()) == before


def test_adjustments_are_layered_on_the_result(run: Run, job: Path) -> None:
    words = [*WORDS, "--source-rest", 0, "--no-contacts"]
    assert run(*words).code == 0
    before = tempose.formats.load_clip("out.npz")
    changes = [{"part": "root", "frame": 2, "move": [0.5, 0, 0], "ease_in": 0.1, "ease_out": 0.1}]
    Path("changes.json").write_text(json.dumps({"adjustments": changes}))
    ran = run(*words, "--adjust", "changes.json", "--report", "report.json")
    assert ran.code == 0, ran.err
    assert "1, 3 frames changed" in ran.out
    step = np.asarray(tempose.formats.load_clip("out.npz").vertices) - before.vertices
    assert_allclose(step[2], np.tile([0.5, 0, 0], (len(step[2]), 1)), atol=1e-6)
    assert_array_equal(step[[0, 4, 5]], 0)
    report = json.loads(Path("report.json").read_text())
    assert report["adjustments"]["unmet"] == [] and report["options"]["adjust"] == "changes.json"


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (
            {"part": "root", "frame": 9, "move": [1, 0, 0]},
            "frame 9 is not in the clip, whose last frame is 5",
        ),
        (
            {"part": "paw", "frame": 0, "move": [1, 0, 0]},
            "adjustment 0: no part 'paw'; parts are root, low, high",
        ),
        (
            {"part": "root", "frame": 0},
            "changes.json: adjustment 0: an adjustment needs move, to, turn",
        ),
    ],
)
def test_wrong_adjustments(run: Run, job: Path, entry: Any, said: str) -> None:
    Path("changes.json").write_text(json.dumps({"adjustments": [entry]}))
    ran = run(*WORDS, "--adjust", "changes.json")
    assert ran.code == 2 and said in ran.err.splitlines()[-1]
    assert not Path("out.npz").exists()


def test_measures_can_be_left_out(run: Run, job: Path) -> None:
    assert run(*WORDS).code == 0
    measured = Path("out.npz").read_bytes()
    ran = run(*WORDS, "--no-measure", "--json")
    assert ran.code == 0 and Path("out.npz").read_bytes() == measured
    report = json.loads(ran.out)
    assert "edge_ratio" not in report and "measures" not in report["seconds"]
    assert run(*WORDS, "--no-measure").code == 0
