"""Every defect planted in a clean mesh is counted once, and nothing else is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tempose.geometry.defects import Defects, find_defects

V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32)
CLEAN = Defects(1, 0, 0, 0, 0, 0)


def test_closed_tetrahedron_has_none() -> None:
    assert find_defects(V, F) == CLEAN


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("seed", range(3))
def test_unit_and_numbering_do_not_matter(unit: float, seed: int) -> None:
    order = np.random.default_rng(seed).permutation(4)
    moved = np.zeros_like(V)
    moved[order] = V
    assert find_defects(unit * moved + 7.0, order[F].astype(np.int32)) == CLEAN


def test_hole() -> None:
    assert find_defects(V, F[1:]) == replace(CLEAN, boundary_edges=3)


def test_two_pieces_and_a_loose_vertex() -> None:
    two = np.concatenate([V, V + 5, [[9.0, 9, 9]]])
    assert find_defects(two, np.concatenate([F, F + 4])) == replace(CLEAN, pieces=2, loose_vertices=1)


def test_repeated_face_makes_its_edges_nonmanifold() -> None:
    again = np.concatenate([F, F[:1, ::-1]])
    assert find_defects(V, again) == replace(CLEAN, duplicate_faces=1, nonmanifold_edges=3)


def test_flat_and_collapsed_faces() -> None:
    flat = V.copy()
    flat[3] = [0.5, 0, 0]
    assert find_defects(flat, F).degenerate_faces == 1
    collapsed = F.copy()
    collapsed[0] = [1, 1, 2]
    assert find_defects(V, collapsed).degenerate_faces == 1


def test_mesh_without_faces() -> None:
    assert find_defects(V, np.zeros((0, 3), np.int32)) == Defects(0, 0, 0, 0, 0, 4)
