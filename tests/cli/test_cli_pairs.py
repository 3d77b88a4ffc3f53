"""`tempose pairs` finds, shows and writes what `tempose transfer --pairs` takes."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import tempose
from tempose.cli.pairs import _towards_us
from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.rotations import rotate
from tempose.samples.skeletons import human_skeleton
from tempose.transfer import Pairs, mark_colors
from tempose.transfer.bodies.facing import yaw
from tempose.transfer.pairing.found_pairs import Found

Run = Callable[..., Any]

WALK = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0.9 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
%s}
MOTION
Frames: 3
Frame Time: 0.05
"""
CHAINS = (
    (("Spine", (0, 0.15, 0)), ("Neck", (0, 0.4, 0)), ("Head", (0, 0.1, 0), (0, 0.2, 0))),
    (("LeftArm", (0.2, 0.5, 0)), ("LeftForeArm", (0.3, 0, 0)), ("LeftHand", (0.25, 0, 0), (0.15, 0, 0))),
    (("RightArm", (-0.2, 0.5, 0)), ("RightForeArm", (-0.3, 0, 0)), ("RightHand", (-0.2, 0, 0), (-0.1, 0, 0))),
    (("LeftUpLeg", (0.1, 0, 0)), ("LeftLeg", (0, -0.42, 0)), ("LeftFoot", (0, -0.4, 0), (0, -0.05, 0.2))),
    (("RightUpLeg", (-0.1, 0, 0)), ("RightLeg", (0, -0.42, 0)), ("RightFoot", (0, -0.4, 0), (0, -0.05, 0.2))),
)  # fmt: skip


def chain(joints: tuple[Any, ...]) -> str:
    """BVH text of one limb, each joint within the one before."""
    name, offset, *end = joints[0]
    inner = chain(joints[1:]) if len(joints) > 1 else ""
    tip = f"End Site\n{{\nOFFSET {end[0][0]} {end[0][1]} {end[0][2]}\n}}\n" if end else ""
    place = " ".join(map(str, offset))
    return f"JOINT {name}\n{{\nOFFSET {place}\nCHANNELS 3 Zrotation Xrotation Yrotation\n{inner}{tip}}}\n"


@pytest.fixture(scope="module")
def body() -> SkinnedMesh:
    """A box round every bone of a human."""
    import trimesh

    skeleton = human_skeleton()
    from tempose.kinematics import rest_transforms

    places = rest_transforms(skeleton)[1]
    V, F, owners = [], [], []
    for j in range(skeleton.n_joints):
        children = [k for k, p in enumerate(skeleton.parents) if p == j]
        end = places[children[0]] if children else places[j] + np.nan_to_num(skeleton.tips[j])
        box = trimesh.creation.box(extents=(0.1, 0.1, max(float(np.linalg.norm(end - places[j])), 0.1)))
        box = box.subdivide().subdivide()
        turn = trimesh.geometry.align_vectors([0, 0, 1], end - places[j])[:3, :3]
        F.append(np.array(box.faces) + sum(map(len, V)))
        V.append(box.vertices @ turn.T + (places[j] + end) / 2)
        owners.append(np.full(len(box.vertices), j))
    owner = np.concatenate(owners)
    mesh = Mesh(np.concatenate(V), np.concatenate(F), name="boxes")
    return SkinnedMesh(mesh, skeleton, np.eye(skeleton.n_joints)[owner])


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, body: SkinnedMesh) -> Path:
    """A folder with a motion; the target's skin is handed over beside the file system."""
    monkeypatch.chdir(tmp_path)
    text = WALK % "".join(chain(limb) for limb in CHAINS)
    rows = [f"0 0.9 {0.1 * t} " + " ".join(["0 0 0"] * 16) for t in range(3)]
    Path("walk.bvh").write_text(text + "\n".join(rows) + "\n")
    tempose.save("boxes.npz", body.mesh)
    loaded = tempose.formats.load_mesh("boxes.npz")
    for module in ("pairs", "transfer"):
        monkeypatch.setattr(f"tempose.cli.{module}.load_target", lambda *_, **__: replace(body, mesh=loaded))
    return tmp_path


def test_what_it_writes_moves_the_target_as_without_a_file(run: Run, job: Path) -> None:
    ran = run("pairs", "walk.bvh", "boxes.npz", "-o", "pairs.json", "--preview", "marks.png")
    assert ran.code == 0, ran.err
    assert "left_forearm" in ran.out and "wrote pairs.json" in ran.err and "skin weights" in ran.err
    assert run("transfer", "walk.bvh", "boxes.npz", "-o", "a.npz").code == 0
    assert run("transfer", "walk.bvh", "boxes.npz", "--pairs", "pairs.json", "-o", "b.npz").code == 0
    assert Path("a.npz").read_bytes() == Path("b.npz").read_bytes()
    picture = np.asarray(Image.open("marks.png"), dtype=float)
    spread = picture.max(axis=2) - picture.min(axis=2)
    assert (spread > 60).mean() > 0.01, "marks must be coloured"


def test_json_counts_the_faces_of_every_joint(run: Run, job: Path) -> None:
    ran = run("pairs", "walk.bvh", "boxes.npz", "-o", "pairs.json", "--json")
    found = json.loads(ran.out)
    pairs = tempose.transfer.load_pairs("pairs.json")
    for name, row in found["joints"].items():
        assert row["faces"] == list(pairs.source).count(name)
    assert found["joints"]["LeftForeArm"]["part"] == "left_forearm"
    assert len(found["joints"]) == 16 and found["warnings"] == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "pairs.txt"], "expected a name that ends in .json"),
        (["--preview", "marks.gif"], "expected a name that ends in .png"),
        (["-o", "none/pairs.json"], "no such folder"),
        (["--weights", "skin.json"], "expected a name that ends in .mhw"),
        (["--mapping", "none.json"], "none.json"),
    ],
)
def test_wrong_options(run: Run, job: Path, words: list[str], said: str) -> None:
    ran = run("pairs", "walk.bvh", "boxes.npz", *words)
    assert ran.code == 2 and said in ran.err.splitlines()[-1], ran.err
    assert sorted(p.name for p in job.iterdir()) == ["boxes.npz", "walk.bvh"]


def test_a_moving_mesh_has_no_joints_to_find(run: Run, job: Path) -> None:
    ran = run("pairs", "boxes.npz", "boxes.npz")
    assert ran.code == 2 and "moving mesh" in ran.err.splitlines()[-1]


def test_a_source_without_a_body_is_refused(run: Run, job: Path) -> None:
    text = Path("walk.bvh").read_text()
    for name in ("LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm"):
        text = text.replace(name, "x" + name[::-1].lower())
    Path("odd.bvh").write_text(text)
    ran = run("pairs", "odd.bvh", "boxes.npz", "--embed")
    assert ran.code == 2 and "name them with a mapping" in ran.err.splitlines()[-1]


def test_doubt_is_told(run: Run, job: Path, monkeypatch: pytest.MonkeyPatch, body: SkinnedMesh) -> None:
    from tempose.transfer.pairing import matching

    facts = {
        "embedding": {"penalty": 1.3, "confidence": 0.37, "doubtful": True, "reasons": ["x"], "up": "+y"}
    }

    def find(source: Skeleton, target: SkinnedMesh, mapping: Any, embed: bool) -> Found:
        assert embed
        return Found(tempose.transfer.pairs_from_skin(source, target, mapping), ("looks odd",), facts)

    monkeypatch.setattr(matching, "find_pairs", find)
    ran = run("pairs", "walk.bvh", "boxes.npz", "--embed")
    assert ran.code == 0 and "note: looks odd" in ran.err and "confidence 0.37" in ran.err
    found = json.loads(run("pairs", "walk.bvh", "boxes.npz", "--embed", "--json").out)
    assert found["embedding"] == facts["embedding"] and found["warnings"] == ["looks odd"]


def test_neighbouring_joints_differ_in_colour(body: SkinnedMesh) -> None:
    pairs = tempose.transfer.pairs_from_skin(human_skeleton(), body)
    colors = mark_colors(pairs, len(body.mesh.faces))
    first = {name: i for i, name in reversed(list(enumerate(pairs.source)))}
    shown = [colors[pairs.target[i]] for i in sorted(first.values())]
    for a, b in pairwise(shown):
        assert np.abs(a - b).max() > 0.3
    unmarked = np.setdiff1d(np.arange(len(colors)), pairs.target)
    assert np.ptp(colors[unmarked], axis=0).max(initial=0) == 0


@pytest.mark.parametrize("command", [pytest.param("pairs", marks=pytest.mark.slow), "transfer"])
def test_what_is_no_human_leaves_one_line_and_no_file(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    import trimesh

    monkeypatch.chdir(tmp_path)
    text = WALK % "".join(chain(limb) for limb in CHAINS)
    Path("walk.bvh").write_text(text + "\n".join(["0 0.9 0 " + " ".join(["0 0 0"] * 16)] * 3) + "\n")
    post = trimesh.creation.cylinder(radius=0.15, height=1.6, sections=12)
    tempose.save("post.ply", Mesh(post.vertices[:, [0, 2, 1]], post.faces[:, ::-1]))
    out = "out.json" if command == "pairs" else "out.npz"
    ran = run(command, "walk.bvh", "post.ply", "-o", out)
    assert ran.code == 2 and "Traceback" not in ran.err
    last = ran.err.splitlines()[-1]
    assert "does not look human" in last and "penalty" in last and "--pairs" in last
    assert sorted(p.name for p in tmp_path.iterdir()) == ["post.ply", "walk.bvh"]


def test_contradicting_options_are_refused(run: Run, job: Path) -> None:
    ran = run("pairs", "walk.bvh", "boxes.npz", "--embed", "--weights", "skin.mhw")
    assert ran.code == 2 and "leave one of --embed and --weights out" in ran.err.splitlines()[-1]
    ran = run("transfer", "walk.bvh", "boxes.npz", "--embed", "--pairs", "pairs.json", "-o", "out.npz")
    assert ran.code == 2 and "leave one of --embed and --pairs out" in ran.err.splitlines()[-1]


@pytest.mark.parametrize("degrees", [0.0, 90.0, 217.0])
def test_the_preview_shows_the_body_from_its_own_front(degrees: float) -> None:
    V = np.random.default_rng(3).normal(size=(12, 3))
    V[:6, 0] += 5.0
    V[6:, 0] -= 5.0
    V[6:] = V[:6] * [-1.0, 1.0, 1.0]
    W = rotate(yaw(np.radians(degrees)), V)
    F = np.arange(12).reshape(4, 3)
    parts = ("left_hand", "left_foot", "right_hand", "right_foot")
    pairs = Pairs("joints", parts, np.arange(4), parts, joints={"left_hand": W[0]}, ends={"left_hand": W[1]})
    turned = Mesh(W, F)
    shown, bones = _towards_us(turned, pairs)
    np.testing.assert_allclose(shown.vertices, V, atol=1e-12)
    np.testing.assert_allclose(
        np.linalg.norm(bones[0, 1] - bones[0, 0]), np.linalg.norm(V[1] - V[0]), rtol=1e-12
    )
    np.testing.assert_allclose(bones[0], V[:2], atol=1e-12)
