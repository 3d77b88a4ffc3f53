"""What is inside: winding numbers agree with solid angles, holes and gaps are closed."""

from __future__ import annotations

import numpy as np
import pytest
from capsule_people import joined, sphere
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.embedding.solid import make_solid, winding_numbers


def solid_angles(V: np.ndarray, F: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Winding numbers by van Oosterom and Strackee's formula."""
    a, b, c = (V[F[:, i]][None] - points[:, None] for i in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    top = (a * np.cross(b, c)).sum(axis=2)
    dot = lambda x, y: (x * y).sum(axis=2)  # noqa: E731
    bottom = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    return np.arctan2(top, bottom).sum(axis=1) / (2 * np.pi)


def nodes(shape: tuple[int, int, int]) -> np.ndarray:
    return np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3)


def overlapping() -> tuple[np.ndarray, np.ndarray]:
    V, F = sphere(1)
    return joined([(V + np.array([0.4, 0, 0]), F), (V - [0.4, 0, 0], F), (0.2 * V + [0, 1.4, 0], F[:, ::-1])])


def test_winding_numbers_are_those_of_solid_angles(rng: np.random.Generator) -> None:
    V, F = overlapping()
    V = 4.3 * V @ Rotation.random(rng=rng).as_matrix().T + [9.02, 8.97, 9.06]
    shape = (19, 18, 20)
    winding, _ = winding_numbers(V, F, shape)
    expected = solid_angles(V, F, nodes(shape).astype(float)).reshape(shape)
    assert_allclose(winding, expected, atol=1e-3)
    assert_array_equal(np.unique(np.round(winding)), [-1, 0, 1, 2])


@pytest.mark.parametrize("seed", range(4))
def test_no_line_slips_between_triangles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    # corners on the very lines: coordinates are whole numbers
    V, F = sphere(1)
    V = np.round(6 * V) + 8.0
    shape = (17, 17, 17)
    winding, _ = winding_numbers(V + 1e-12 * rng.normal(size=3), F, shape)
    assert_allclose(winding, np.round(winding), atol=1e-3)
    assert winding[0].max() < 1e-3


def test_walls_stand_where_neighbours_differ() -> None:
    V, F = sphere(2)
    shape = (17, 17, 17)
    winding, walls = winding_numbers(6.1 * V + 8.03, F, shape)
    inside = np.round(winding) == 1
    for axis in range(3):
        differ = np.diff(inside, axis=axis)
        assert_array_equal(np.delete(walls[axis], -1, axis=axis), differ)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_volume_and_depth_of_a_sphere(unit: float) -> None:
    V, F = sphere(4)
    solid = make_solid(unit * V, F, cells=60)
    assert_allclose(solid.inside.sum() * solid.spacing**3, 4 / 3 * np.pi * unit**3, rtol=0.02)
    assert_allclose(solid.depth_at(np.zeros(3)), unit, rtol=0.05)
    assert solid.depth_at(np.array([3.0 * unit, 0, 0])) == 0


def test_turning_inside_out_or_doubling_changes_nothing() -> None:
    V, F = sphere(3)
    one = make_solid(V, F, cells=40).inside
    assert_array_equal(make_solid(V, F[:, ::-1], cells=40).inside, one)
    assert_array_equal(make_solid(V, np.concatenate([F, F]), cells=40).inside, one)


def test_holes_hardly_change_the_inside() -> None:
    V, F = sphere(4)
    whole = make_solid(V, F, cells=50)
    away = np.linalg.norm(V[F].mean(axis=1) - np.array([1, 1, 1]) / np.sqrt(3), axis=1)
    holed = make_solid(V, F[away > 0.4], cells=50)
    near = whole.depth > 3 * whole.spacing
    assert (near & holed.inside).sum() > 0.97 * near.sum()
    assert holed.inside.sum() < 1.03 * whole.inside.sum()


def test_pieces_apart_are_bridged_and_specks_left_out() -> None:
    V, F = sphere(3)
    halves = joined([(V, F), (V + np.array([2.05, 0, 0]), F), (0.1 * V + [1.0, 3.0, 0], F)])
    solid = make_solid(*halves, cells=80)
    assert solid.bridged > 0
    assert 0 < solid.lost < 0.02
    assert solid.depth_at(np.array([1.025, 0, 0])) > 0
    assert solid.depth_at(np.array([1.0, 3.0, 0])) == 0


def test_meshes_without_inside_are_refused() -> None:
    V, F = sphere(1)
    with pytest.raises(ValueError, match="needs a mesh with extent, got 0 faces"):
        make_solid(V, F[:0])
    with pytest.raises(ValueError, match="encloses no volume"):
        make_solid(V * [1, 1, 0], F)
