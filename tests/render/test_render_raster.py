"""The z-buffer agrees with exact geometry: coverage, depth and weights."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial import Delaunay

from tempose.render.camera import Camera
from tempose.render.normals import corner_normals
from tempose.render.raster import rasterise
from tempose.render.surface import screen, trace


def cross(a, b):
    return int(a[0] * b[1] - a[1] * b[0])


def twin(P, F, width, height):
    """Slow twin: strict half planes in exact integers; samples on an edge are left undecided (-2)."""
    Q = np.floor(P[:, :2] * 256 + 0.5).astype(np.int64)
    face, near = np.full((height, width), -1), np.full((height, width), -np.inf)
    for f, (a, b, c) in enumerate(F):
        area = cross(Q[b] - Q[a], Q[c] - Q[a])
        for j in range(height):
            for i in range(width):
                s = np.array([256 * i + 128, 256 * j + 128])
                e = [cross(Q[v] - Q[u], s - Q[u]) for u, v in ((b, c), (c, a), (a, b))]
                if area == 0 or min(k * np.sign(area) for k in e) < 0:
                    continue
                if 0 in e:
                    face[j, i] = -2
                    continue
                w = np.float32(sum(k * P[v, 2] for k, v in zip(e, (a, b, c))) / area)
                if face[j, i] != -2 and w > near[j, i]:
                    face[j, i], near[j, i] = f, w
    return face, near


def test_agrees_with_the_slow_twin(rng):
    P = rng.uniform(-4, 20, (30, 3))
    F = rng.integers(0, 30, (25, 3))
    face, near = rasterise(P, F, 16, 13)
    expected, expected_near = twin(P, F, 16, 13)
    sure = expected != -2
    assert sure.mean() > 0.9
    assert_array_equal(face[sure], expected[sure])
    seen = sure & (expected >= 0)
    assert_allclose(near[seen], expected_near[seen], rtol=1e-5)


def test_triangles_that_share_edges_leave_no_crack_and_no_overlap(rng):
    # Points on a lattice of half pixels put many edges and corners exactly on samples.
    inner = rng.integers(0, 65, (120, 2)) / 2
    points = np.unique(np.concatenate([inner, [[0, 0], [32, 0], [0, 32], [32, 32]]]), axis=0)
    F = Delaunay(points).simplices
    P = np.column_stack([points, np.ones(len(points))])
    hits = sum((rasterise(P, F[f : f + 1], 32, 32)[0] >= 0).astype(int) for f in range(len(F)))
    assert_array_equal(hits, np.ones((32, 32)))


def test_winding_does_not_matter(rng):
    P, F = rng.uniform(0, 20, (12, 3)), rng.integers(0, 12, (9, 3))
    for one, other in zip(rasterise(P, F, 20, 20), rasterise(P, F[:, ::-1], 20, 20)):
        assert_array_equal(one, other)


def test_the_nearer_triangle_wins_in_either_order():
    P = np.array([[0, 0, 1], [20, 0, 1], [0, 20, 1], [0, 0, 2], [20, 0, 2], [0, 20, 2.0]])
    far_first, near_first = np.array([[0, 1, 2], [3, 4, 5]]), np.array([[3, 4, 5], [0, 1, 2]])
    assert set(np.unique(rasterise(P, far_first, 10, 10)[0])) == {1}
    assert set(np.unique(rasterise(P, near_first, 10, 10)[0])) == {0}


def test_crossing_triangles_meet_where_their_planes_do():
    # Nearness x against nearness 10: they change over at x = 10.
    P = np.array([[0, 0, 0], [40, 0, 40], [0, 40, 0], [0, 0, 10], [40, 0, 10], [0, 40, 10.0]])
    face, _ = rasterise(P, np.array([[0, 1, 2], [3, 4, 5]]), 20, 15)
    assert_array_equal(face, np.tile(np.where(np.arange(20) + 0.5 > 10, 0, 1), (15, 1)))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e300, -1e9])
def test_faces_of_hidden_or_far_vertices_are_left_out(bad):
    P = np.array([[0, 0, 1], [10, 0, 1], [0, 10, 1], [bad, 5, 1]])
    assert (rasterise(P, np.array([[0, 1, 3]]), 8, 8)[0] == -1).all()
    assert (rasterise(P, np.array([[0, 1, 2], [0, 1, 3]]), 8, 8)[0] == 0).any()


def test_degenerate_triangles_cover_nothing():
    P = np.array([[0.5, 0.5, 1], [8.5, 8.5, 1], [4.5, 4.5, 1]])
    for F in ([[0, 1, 2]], [[0, 0, 1]], [[2, 2, 2]]):
        assert (rasterise(P, np.array(F), 9, 9)[0] == -1).all()


def test_an_empty_mesh_gives_an_empty_picture():
    face, near = rasterise(np.zeros((0, 3)), np.zeros((0, 3), np.int32), 5, 4)
    assert face.shape == near.shape == (4, 5)
    assert (face == -1).all()


@pytest.mark.parametrize("fov", [0.0, 0.8])
def test_samples_lie_on_their_triangle_and_on_their_line_of_sight(rng, fov):
    V, F = rng.normal(size=(12, 3)), rng.integers(0, 12, (10, 3))
    F = F[[len(set(f)) == 3 for f in F.tolist()]]
    camera, size, s = Camera.fit(V, 0.5, 0.3, fov), (48, 40), 2
    (samples,) = trace(V, F, corner_normals(V, F), camera, size, s)
    X = camera.project(samples.position, size)
    # Snapping moves a corner by up to 1/512 of a sample; slivers magnify it.
    off = np.abs(X[:, :2] - [[p % 48 + 0.5, p // 48 + 0.5] for p in samples.pixel])
    assert (off < 0.25 + 0.05).all()
    assert_allclose(samples.depth, X[:, 2], rtol=1e-9)
    assert_allclose(samples.weights.sum(axis=1), 1.0)
    assert_allclose(np.linalg.norm(samples.view, axis=1), 1.0)
    inside = samples.weights.min(axis=1) > 0.01
    P = screen(V, camera, (96, 80))
    near = rasterise(P, F, 96, 80)[1]
    expected = near.reshape(40, 2, 48, 2).transpose(0, 2, 1, 3).ravel()
    expected = expected[expected > -np.inf]
    assert_allclose((-samples.depth if fov == 0 else 1 / samples.depth)[inside], expected[inside], rtol=2e-3)


def test_light_starts_outside_the_curved_surface_that_a_coarse_mesh_stands_for():
    # Between tangent planes of a sphere: as far outside as the chord is inside, to leading order.
    ball = trimesh.creation.icosphere(subdivisions=2)
    V, F = np.asarray(ball.vertices), np.asarray(ball.faces)
    (samples,) = trace(V, F, corner_normals(V, F), Camera.fit(V, 0.3, 0.2), (80, 80), 1)
    sag = 1 - np.linalg.norm(samples.position, axis=1)
    rise = np.linalg.norm(samples.smooth_position, axis=1) - 1
    assert_allclose(rise, sag, atol=0.2 * sag.max())
    # Flat parts stay where they are.
    box = trimesh.creation.box()
    V, F = np.asarray(box.vertices), np.asarray(box.faces)
    (samples,) = trace(V, F, corner_normals(V, F, 0.1), Camera.fit(V, 0.3, 0.2), (40, 40), 1)
    assert_allclose(samples.smooth_position, samples.position, atol=1e-12)
