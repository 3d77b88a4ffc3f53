"""Weights that do not sum to one are normalised, and the mesh says so."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from glb_builder import Builder
from numpy.testing import assert_allclose

from tempose.formats import load_skin
from tempose.formats._skin_notes import weight_notes


def bound(path: Path, weights: list[list[float]]) -> Path:
    b = Builder()
    mesh = b.mesh()
    b.attribute(mesh, "JOINTS_0", [[0, 1, 0, 0]] * 3, "VEC4", "u1")
    b.attribute(mesh, "WEIGHTS_0", weights, "VEC4")
    b.node(name="root", children=[1])
    b.node(name="hips", translation=[0, 1, 0])
    b.node(mesh=mesh, skin=0)
    b.json["scenes"] = [{"nodes": [0, 2]}]
    inverse = np.tile(np.eye(4), (2, 1, 1))
    inverse[1, 1, 3] = -1
    b.json["skins"] = [
        {"joints": [0, 1], "inverseBindMatrices": b.accessor(inverse.transpose(0, 2, 1), "MAT4")}
    ]
    return b.save(path)


def test_rounding_is_not_worth_a_note() -> None:
    assert weight_notes(np.array([1.0, 0.999, 1.008, 0.0])) == ()
    assert weight_notes(np.zeros(0)) == ()


def test_the_furthest_off_is_named() -> None:
    (note,) = weight_notes(np.array([1.0, 0.5, 3.0, 0.0]))
    assert "2 of 4 vertices" in note and "summed to 3, at vertex 2" in note


def test_a_skin_of_a_file_says_what_was_done(tmp_path: Path) -> None:
    good = load_skin(bound(tmp_path / "good.glb", [[0.25, 0.75, 0, 0]] * 3))
    assert not any("weights" in note for note in good.mesh.source.notes)
    off = load_skin(bound(tmp_path / "off.glb", [[0.25, 0.75, 0, 0], [0.25, 0.25, 0, 0], [1, 0, 0, 0]]))
    assert_allclose(off.weights[1], [0.5, 0.5])
    (note,) = [note for note in off.mesh.source.notes if "weights" in note]
    assert "1 of 3 vertices" in note and "summed to 0.5, at vertex 1" in note


def test_vertices_without_weights_are_counted(tmp_path: Path) -> None:
    bare = load_skin(bound(tmp_path / "bare.glb", [[0.25, 0.75, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]]))
    assert_allclose(bare.weights[1:], [[1, 0], [1, 0]])
    (note,) = [note for note in bare.mesh.source.notes if "weights" in note]
    assert "2 of 3 vertices" in note and "first joint" in note
