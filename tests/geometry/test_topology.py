"""Neighbours found by sorting and sparse products are those a loop over the faces finds."""

from __future__ import annotations

from collections import Counter, deque

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_array_equal

from tempose.geometry import (
    boundary_edges,
    edge_list,
    face_components,
    k_rings,
    vertex_adjacency,
    vertex_components,
    weld,
)


@pytest.fixture(scope="module")
def sphere() -> np.ndarray:
    return np.array(trimesh.creation.icosphere(subdivisions=2).faces, dtype=np.int32)


@pytest.fixture
def soup(rng: np.random.Generator) -> np.ndarray:
    """Random faces: non-manifold, duplicated, some naming a vertex twice, some vertices unused."""
    return rng.integers(0, 40, size=(60, 3)).astype(np.int32)


def directed(F: np.ndarray) -> list[tuple[int, int]]:
    return [(int(f[k]), int(f[(k + 1) % 3])) for f in F for k in range(3)]


def neighbours(F: np.ndarray, n: int) -> list[set[int]]:
    around: list[set[int]] = [set() for _ in range(n)]
    for a, b in directed(F):
        around[a] |= {b} - {a}
        around[b] |= {a} - {b}
    return around


def test_edges_are_those_of_the_faces_each_once_sorted(sphere, soup) -> None:
    for F in (sphere, soup, soup[:1]):
        expected = sorted({(min(a, b), max(a, b)) for a, b in directed(F) if a != b})
        assert_array_equal(edge_list(F), expected)
        assert edge_list(F).dtype == F.dtype


def test_euler_formula(sphere) -> None:
    assert 162 - len(edge_list(sphere)) + len(sphere) == 2


def test_the_boundary_is_what_one_face_has_in_its_direction(sphere, soup) -> None:
    assert len(boundary_edges(sphere)) == 0
    assert_array_equal(boundary_edges(sphere[:1]), [(a, b) for a, b in directed(sphere[:1])])
    for F in (sphere[30:], soup):
        uses = Counter((min(a, b), max(a, b)) for a, b in directed(F))
        expected = {(a, b) for a, b in directed(F) if uses[min(a, b), max(a, b)] == 1 and a != b}
        found = boundary_edges(F)
        assert len(found) == len(expected) and {(int(a), int(b)) for a, b in found} == expected


def test_a_hole_is_bounded_against_the_faces_that_left_it(sphere) -> None:
    hole, rest = sphere[:1], sphere[1:]
    assert {(int(b), int(a)) for a, b in boundary_edges(rest)} == set(directed(hole))


def test_adjacency_is_symmetric_zero_one_without_diagonal(sphere, soup) -> None:
    for F, n in ((sphere, 162), (soup, 45)):
        A = vertex_adjacency(F, n).toarray()
        around = neighbours(F, n)
        expected = [[int(j in around[i]) for j in range(n)] for i in range(n)]
        assert_array_equal(A, expected)


def components(F: np.ndarray, n: int) -> list[int]:
    around, labels, count = neighbours(F, n), [-1] * n, 0
    for start in range(n):
        if labels[start] < 0:
            stack = [start]
            while stack:
                v = stack.pop()
                if labels[v] < 0:
                    labels[v] = count
                    stack += list(around[v])
            count += 1
    return labels


def assert_same_partition(a, b) -> None:
    pairs = set(zip(map(int, a), map(int, b)))
    assert len(pairs) == len({x for x, _ in pairs}) == len({y for _, y in pairs})


def test_components_are_those_of_a_flood(soup) -> None:
    sparse = np.concatenate([soup[:8], soup[40:44] + 40])
    count, labels = vertex_components(sparse, 90)
    slow = components(sparse, 90)
    assert count == max(slow) + 1 == labels.max() + 1
    assert_same_partition(labels, slow)
    count, of_face = face_components(sparse, 90)
    assert_same_partition(of_face, [slow[f[0]] for f in sparse])
    assert sorted(set(of_face.tolist())) == list(range(count))


def test_lone_vertices_are_components_but_have_no_face(sphere) -> None:
    assert vertex_components(sphere, 165)[0] == 4
    assert face_components(sphere, 165)[0] == 1
    two = np.concatenate([sphere, sphere + 165])
    assert vertex_components(two, 327)[0] == 5
    count, of_face = face_components(two, 327)
    assert count == 2
    assert_array_equal(of_face, np.repeat([0, 1], len(sphere)))


def test_no_face_at_all() -> None:
    none = np.zeros((0, 3), dtype=np.int32)
    assert edge_list(none).shape == boundary_edges(none).shape == (0, 2)
    assert vertex_adjacency(none, 4).nnz == 0
    assert vertex_components(none, 4)[0] == 4
    assert face_components(none, 4)[0] == 0


@pytest.mark.parametrize("k", [0, 1, 2, 3, 20])
def test_rings_are_those_of_a_breadth_first_search(sphere, soup, k: int) -> None:
    for F, n in ((sphere, 162), (soup, 45)):
        around, seeds = neighbours(F, n), np.array([0, 17, n - 1, 17])
        rings = k_rings(F, n, seeds, k)
        assert len(rings) == 4
        for seed, ring in zip(seeds, rings):
            distance, queue = {int(seed): 0}, deque([int(seed)])
            while queue:
                v = queue.popleft()
                for w in around[v]:
                    if w not in distance and distance[v] < k:
                        distance[w] = distance[v] + 1
                        queue.append(w)
            assert_array_equal(ring, sorted(distance))


def test_no_seed_has_no_ring(sphere) -> None:
    assert k_rings(sphere, 162, np.zeros(0, dtype=int), 2) == []


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_weld_finds_equal_positions_in_first_seen_order(rng, dtype) -> None:
    spots = rng.normal(size=(20, 3)).astype(dtype)
    V = spots[np.concatenate([rng.permutation(20), rng.integers(0, 20, size=50)])]
    first, inverse = weld(V)
    assert_array_equal(V[first][inverse], V)
    assert len(first) == 20
    assert (np.diff(first) > 0).all()
    for v in range(len(V)):
        assert first[inverse[v]] == next(i for i in range(len(V)) if (V[i] == V[v]).all())


def test_weld_takes_minus_zero_for_zero_and_nearby_for_different() -> None:
    V = np.array([[0.0, 1, 2], [-0.0, 1, 2], [5e-324, 1, 2], [0, 1, 2 + 1e-15]])
    first, inverse = weld(V)
    assert_array_equal(first, [0, 2, 3])
    assert_array_equal(inverse, [0, 0, 1, 2])


def test_weld_of_nothing_and_of_all_one_spot() -> None:
    first, inverse = weld(np.zeros((0, 3)))
    assert len(first) == len(inverse) == 0
    first, inverse = weld(np.ones((5, 3)))
    assert_array_equal(first, [0])
    assert_array_equal(inverse, np.zeros(5))
