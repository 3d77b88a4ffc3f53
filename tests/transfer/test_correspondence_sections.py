"""Plane sections are exact polylines, each connected, and only the one that is asked for."""

from __future__ import annotations

import numpy as np
import pytest
from correspondence_shapes import capsule, cylinder, face_near, merged
from numpy.testing import assert_allclose
from transfer_zoo import ZOO

from tempose.transfer import Sections
from tempose.transfer.correspondence.section import Loop, loop_centre


def brute_force(V: np.ndarray, F: np.ndarray, point: np.ndarray, normal: np.ndarray) -> dict[int, np.ndarray]:
    """Segment of every crossed face, by looking at its three edges one after another."""
    found = {}
    for f, corners in enumerate(F):
        h = [(V[v] - point) @ normal / np.linalg.norm(normal) for v in corners]
        ends = []
        for i, j in ((0, 1), (1, 2), (2, 0)):
            if (h[i] >= 0) != (h[j] >= 0):
                s = h[i] / (h[i] - h[j])
                ends.append(V[corners[i]] + s * (V[corners[j]] - V[corners[i]]))
        if ends:
            found[f] = np.array(ends)
    return found


@pytest.mark.parametrize("name", ZOO)
def test_every_crossed_face_has_its_segment(name: str, rng: np.random.Generator) -> None:
    mesh = ZOO[name]()
    point, normal = mesh.vertices.mean(axis=0) + 0.01 * rng.normal(size=3), rng.normal(size=3)
    expected = brute_force(mesh.vertices, mesh.faces, point, normal)
    loops = Sections(mesh.vertices, mesh.faces).cut(point, normal)
    assert sorted(f for loop in loops for f in loop.faces) == sorted(expected)
    for loop in loops:
        for a, b, f in zip(loop.points[:-1], loop.points[1:], loop.faces):
            there = expected[int(f)]
            straight = np.abs(there - [a, b]).max()
            turned = np.abs(there - [b, a]).max()
            assert min(straight, turned) < 1e-12 * mesh.diagonal


@pytest.mark.parametrize("y", [0.55, 0.5])
def test_the_section_of_a_cylinder_is_its_polygon(y: float) -> None:
    mesh = cylinder()
    (loop,) = Sections(mesh.vertices, mesh.faces).cut(np.array([3.0, y, 1.0]), np.array([0, 5.0, 0]))
    assert loop.closed and len(loop.faces) == 48
    assert_allclose(loop.length, 24 * 2 * 0.25 * np.sin(np.pi / 24), rtol=1e-12)
    assert_allclose(loop.points[:, 1], y, atol=1e-12)
    assert_allclose(loop_centre(loop, np.array([0, 1.0, 0])), [0, y, 0], atol=1e-12)


def test_the_centre_is_that_of_the_area() -> None:
    # an L: the mean of its corners lies elsewhere
    P = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [0, 2], [0, 0]], dtype=float)
    loop = Loop(np.column_stack([P[:, 0], np.zeros(7), P[:, 1]]), np.arange(6), True)
    centre = loop_centre(loop, np.array([0, 1.0, 0]))
    assert_allclose(centre, [(3 * 1.5 + 0.5) / 4, 0, (3 * 0.5 + 1.5) / 4], atol=1e-12)


def test_only_the_loop_of_the_picked_leg() -> None:
    left, right = cylinder(), cylinder()
    both = merged(left, right.with_vertices(right.vertices + np.array([0.6, 0, 0])))
    sections = Sections(both.vertices, both.faces)
    face = face_near(both, [0.6, 0.85, 0.25])
    point = both.vertices[both.faces[face]].mean(axis=0)
    assert len(sections.cut(point, np.array([0, 1.0, 0]))) == 2
    (loop,) = sections.cut(point, np.array([0, 1.0, 0]), face)
    assert face in loop.faces and (loop.points[:, 0] > 0.3).all()


def test_a_hole_leaves_the_outline_open() -> None:
    mesh = cylinder()
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    F = mesh.faces[centres[:, 2] < 0.2]
    (loop,) = Sections(mesh.vertices, F).cut(np.array([0, 1.03, 0]), np.array([0, 1.0, 0]))
    assert not loop.closed and len(loop.points) == len(loop.faces) + 1
    assert loop.points[[0, -1], 2].min() > 0.15


def test_a_texture_seam_is_no_hole() -> None:
    mesh = capsule()
    corners = mesh.vertices[mesh.faces].reshape(-1, 3)
    F = np.arange(len(corners)).reshape(-1, 3)
    (loop,) = Sections(corners, F).cut(np.array([0, 1.03, 0]), np.array([0, 1.0, 0.1]))
    assert loop.closed


def test_a_plane_beside_the_mesh_cuts_nothing() -> None:
    mesh = cylinder()
    sections = Sections(mesh.vertices, mesh.faces)
    assert sections.cut(np.array([0, 9.0, 0]), np.array([0, 1.0, 0])) == []
    assert sections.cut(np.array([0, 1.03, 0]), np.array([0, 1.0, 0]), through=0) == []
