"""Distances through a solid: true in the open, round corners, and a fixed point of the update."""

from __future__ import annotations

import numpy as np
from capsule_people import joined, sphere
from numpy.testing import assert_allclose, assert_array_equal

from tempose.embedding._marching import march
from tempose.embedding.cells import Cells, make_cells
from tempose.embedding.solid import Solid, make_solid


def block(inside: np.ndarray, spacing: float = 1.0) -> Solid:
    inside = np.pad(inside, 1)
    walls = np.zeros((3, *inside.shape), dtype=bool)
    return Solid(inside, np.zeros(3), spacing, inside.astype(float), walls)


def cells_of(solid: Solid) -> Cells:
    cells = make_cells(solid, None)
    assert cells is not None
    return cells


def test_distances_in_a_box_are_straight(rng: np.random.Generator) -> None:
    cells = cells_of(block(np.ones((24, 20, 16), dtype=bool), 0.25))
    seed = int(rng.integers(len(cells.grid)))
    D = cells.distances(seed)
    true = np.linalg.norm(cells.points - cells.points[seed], axis=1)
    far = true > 1.5
    # of first order: too long by up to 8 % along diagonals, never too short
    assert (D[far] >= true[far] * (1 - 1e-9)).all() and (D[far] <= 1.08 * true[far]).all()
    assert_allclose(D[~far & (true <= 0.75)], true[~far & (true <= 0.75)])


def test_distances_go_round_a_corner() -> None:
    inside = np.ones((40, 40, 9), dtype=bool)
    inside[:28, 12:] = False
    cells = cells_of(block(inside))
    ends = [[1, 1, 5], [40, 40, 5]]
    start, end = (int(np.flatnonzero((cells.grid == p).all(axis=1))[0]) for p in ends)
    corner = np.array([28.5, 12.5, 5])
    true = sum(np.linalg.norm(np.array(p) - corner) for p in ends)
    assert_allclose(cells.distances(start)[end], true, rtol=0.03)
    assert_allclose(cells.distances(end)[start], cells.distances(start)[end], rtol=1e-2)


def slow_update(D: np.ndarray, beside: np.ndarray) -> np.ndarray:
    """Solve each cell for its neighbours by trying every number of axes."""
    out = np.full(len(D), np.inf)
    near = np.where(beside >= 0, D[beside], np.inf).reshape(-1, 3, 2).min(axis=2)
    for i, values in enumerate(np.sort(near, axis=1)):
        for k in (1, 2, 3):
            a = values[:k]
            if not np.isfinite(a).all():
                break
            square = a.sum() ** 2 - k * ((a**2).sum() - 1)
            t = (a.sum() + np.sqrt(max(square, 0.0))) / k
            if k == 3 or t <= values[k]:
                out[i] = t
                break
            out[i] = t
    return out


def test_every_cell_solves_the_eikonal_equation(rng: np.random.Generator) -> None:
    cells = cells_of(make_solid(*sphere(2), cells=14))
    seeds = rng.choice(len(cells.grid), 3, replace=False)
    D = march(cells.neighbours, seeds, np.zeros(3))
    expected = slow_update(D, cells.neighbours)
    expected[seeds] = 0
    assert_allclose(D, expected, atol=1e-9)


def test_what_is_not_joined_is_infinitely_far() -> None:
    inside = np.ones((7, 3, 3), dtype=bool)
    inside[3] = False
    cells = cells_of(block(inside))
    D = cells.distances(0)
    assert_array_equal(np.isinf(D), cells.grid[:, 0] > 4)


def test_walls_keep_touching_bodies_apart() -> None:
    V, F = sphere(3)
    V2, F2 = joined([(V, F), (V * [1, 0.5, 0.5] + [1.95, 0, 0], F)])
    solid = make_solid(V2, F2, cells=60)
    walled, open_ = make_cells(solid, solid.walls), make_cells(solid, None)
    assert open_ is not None and walled is None
    alone = make_solid(V, F, cells=60)
    one = make_cells(alone, alone.walls)
    assert one is not None and len(one.grid) == alone.inside.sum()
