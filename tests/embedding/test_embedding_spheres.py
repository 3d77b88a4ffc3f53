"""Packed spheres cover the medial surface, and necks between them become walls."""

from __future__ import annotations

import numpy as np
import pytest
from capsule_people import capsule, joined, person, sphere
from numpy.testing import assert_array_equal

from tempose.embedding.cells import Cells, make_cells
from tempose.embedding.pinch import pinch_walls, sphere_regions
from tempose.embedding.solid import make_solid
from tempose.embedding.spheres import _pack, medial_cells, pack_spheres


@pytest.fixture(scope="module")
def body() -> Cells:
    mesh, _ = person()
    cells = make_cells(make_solid(mesh.vertices, mesh.faces, cells=100), None)
    assert cells is not None
    return cells


def test_spheres_cover_the_medial_surface_without_holding_each_other(body: Cells) -> None:
    spheres = pack_spheres(body)
    medial = body.points[medial_cells(body)]
    away = np.linalg.norm(medial[:, None] - spheres.centres, axis=2)
    assert (away < spheres.radii + 1e-9).any(axis=1).all()
    between = np.linalg.norm(spheres.centres[:, None] - spheres.centres, axis=2)
    later, earlier = np.tril_indices(len(spheres.radii), -1)
    assert (np.diff(spheres.radii) <= 0).all()
    assert (between[later, earlier] >= spheres.radii[earlier]).all()


def test_packing_agrees_with_the_plain_loop(rng: np.random.Generator) -> None:
    points, radii = rng.random((200, 3)), np.sort(0.3 * rng.random(200))[::-1].copy()
    kept: list[int] = []
    for i in range(200):
        if all(((points[i] - points[j]) ** 2).sum() >= radii[j] ** 2 for j in kept):
            kept.append(i)
    assert_array_equal(np.flatnonzero(_pack(points, radii)), kept)


def cut_at_necks(cells: Cells) -> Cells | None:
    spheres = pack_spheres(cells)
    return make_cells(cells.solid, pinch_walls(cells, spheres, sphere_regions(cells, spheres), 0.5))


def test_a_narrow_contact_is_cut_and_a_straight_limb_is_not() -> None:
    V, F = sphere(3)
    solid = make_solid(*joined([(V, F), (V + np.array([1.93, 0, 0]), F)]), cells=80)
    cells = make_cells(solid, None)
    assert cells is not None and solid.bridged == 0
    assert cut_at_necks(cells) is None
    alone = make_solid(*capsule(np.zeros(3), np.array([0.3, 1.5, 0.2]), 0.2), cells=80)
    cells = make_cells(alone, None)
    assert cells is not None
    cut = cut_at_necks(cells)
    assert cut is not None and len(cut.grid) == len(cells.grid)


def test_every_cell_belongs_to_a_sphere_near_it(body: Cells) -> None:
    spheres = pack_spheres(body)
    owner = sphere_regions(body, spheres)
    assert_array_equal(owner[spheres.cells], np.arange(len(spheres.cells)))
