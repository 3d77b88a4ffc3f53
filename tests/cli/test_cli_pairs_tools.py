"""`tempose pairs --check` and `--mirror` on a list between two meshes."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import tempose
from tempose.clips import Mesh
from tempose.transfer import Pairs, load_pairs, save_pairs

Run = Callable[..., Any]


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two eggs, the second larger, and pairs on the left of them."""
    monkeypatch.chdir(tmp_path)
    ball = trimesh.creation.icosphere(subdivisions=3)
    V = np.array(ball.vertices)
    V = V * [0.6, 1.5, 1.0] * (1 + 0.2 * V[:, [1]] + 0.15 * V[:, [2]] * (1 - V[:, [1]]))
    tempose.save("egg.npz", Mesh(V, np.array(ball.faces)))
    tempose.save("large.npz", Mesh(1.5 * V, np.array(ball.faces)))
    left = np.flatnonzero(V[ball.faces][:, :, 0].min(axis=1) > 0.1)[::6]
    save_pairs("left.json", Pairs("faces", left, left, comment="my own"))
    return tmp_path


def test_the_other_side_is_added_and_kept(run: Run, job: Path) -> None:
    ran = run("pairs", "egg.npz", "large.npz", "--mirror", "left.json", "-o", "both.json", "--json")
    assert ran.code == 0, ran.err
    before, both = load_pairs("left.json"), load_pairs("both.json")
    found = json.loads(ran.out)
    assert found["mirrored"] == len(before) == len(both) - len(before)
    assert found["findings"] == [] and found["pairs"] == len(both)
    assert both.how == ("picked",) * len(before) + ("mirror",) * len(before)
    assert both.comment == "my own" and both.files == ("egg.npz", "large.npz")
    np.testing.assert_array_equal(both.source, both.target)
    again = run("pairs", "egg.npz", "large.npz", "--check", "both.json")
    assert again.code == 0 and "nothing to say about" in again.err


def test_a_wrong_pair_is_told(run: Run, job: Path) -> None:
    run("pairs", "egg.npz", "large.npz", "--mirror", "left.json", "-o", "both.json")
    both = load_pairs("both.json")
    source = np.array(both.source)
    source[[2, -3]] = source[[-3, 2]]
    save_pairs("crossed.json", replace(both, source=source))
    ran = run("pairs", "egg.npz", "large.npz", "--check", "crossed.json")
    assert ran.code == 0 and "pair 2 lies" in ran.out.replace("\n", " ")


def test_a_mirror_image_ends_with_one(run: Run, job: Path) -> None:
    run("pairs", "egg.npz", "large.npz", "--mirror", "left.json", "-o", "both.json")
    both = load_pairs("both.json")
    k = len(both) // 2
    tempose.save("crooked.npz", bent("large.npz"))
    tempose.save("bow.npz", bent("egg.npz"))
    save_pairs("turned.json", replace(both, source=np.r_[both.source[k:], both.source[:k]]))
    ran = run("pairs", "bow.npz", "crooked.npz", "--check", "turned.json", "--json")
    assert ran.code == 1
    assert json.loads(ran.out)["findings"][0]["kind"] == "sides"


def bent(path: str) -> Mesh:
    mesh = tempose.formats.load_mesh(path)
    V = mesh.vertices
    return mesh.with_vertices(V + np.array([0.4, 0, 0]) * V[:, [1]] ** 2 / mesh.height)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--check", "left.json", "--mirror", "left.json"], "not both"),
        (["--check", "left.json", "-o", "x.json"], "writes nothing"),
        (["--check", "none.json"], "none.json"),
    ],
)
def test_bad_words(run: Run, job: Path, words: list[str], message: str) -> None:
    ran = run("pairs", "egg.npz", "large.npz", *words)
    assert ran.code == 2 and message in ran.err and len(ran.err.strip().splitlines()) == 1
