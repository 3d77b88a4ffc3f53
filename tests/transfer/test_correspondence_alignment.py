"""Rough alignment: a known similarity comes back exactly, a reflection never."""

from __future__ import annotations

import numpy as np
import pytest
from correspondence_shapes import renumbered
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import human_body, t_body
from transfer_zoo import sphere, wxyz

from tempose.clips import Mesh
from tempose.rotations import angle_between, to_matrix
from tempose.transfer import Alignment, align_meshes, align_points
from tempose.transfer.correspondence import turned
from tempose.transfer.correspondence.closest import make_cloud, spread_points
from tempose.transfer.correspondence.front import feet_front
from tempose.transfer.correspondence.similarity import fit_similarity


@pytest.mark.parametrize("scale", [0.01])
def test_a_random_similarity_is_recovered_exactly(scale: float, rng: np.random.Generator) -> None:
    mesh = sphere(3)
    R, shift = Rotation.random(rng=rng), rng.normal(size=3)
    goal = mesh.with_vertices(scale * mesh.vertices @ R.as_matrix().T + shift)
    found = align_meshes(renumbered(mesh, rng)[0], goal)
    assert found.residual < 1e-12 and found.ambiguity < 0.1 and found.warnings == ()
    assert_allclose(found.scale, scale, rtol=1e-12)
    assert angle_between(found.rotation, wxyz(R)) < 1e-7
    assert_allclose(found.apply(mesh.vertices), goal.vertices, atol=1e-12 * goal.diagonal)


@pytest.mark.slow
def test_a_mirror_image_is_not_reflected_back() -> None:
    mesh = sphere(3)
    mirror = mesh.with_vertices(mesh.vertices * [-1, 1, 1])
    found = align_meshes(mesh, mirror)
    assert_allclose(np.linalg.det(to_matrix(found.rotation)), 1, atol=1e-12)
    assert found.residual > 1e-3


@pytest.mark.parametrize("degrees", [170])
@pytest.mark.slow
def test_bodies_in_other_poses_come_to_face_alike(degrees: float) -> None:
    body, other = human_body().mesh, t_body().mesh
    turn = Rotation.from_euler("y", degrees, degrees=True)
    found = align_meshes(body.with_vertices(100 * body.vertices @ turn.as_matrix().T + 7), other)
    assert angle_between(found.rotation, wxyz(turn.inv())) < np.radians(12)
    assert_allclose(found.scale, 0.01, rtol=0.1)


def test_a_lying_body_is_stood_up() -> None:
    body = human_body().mesh
    found = align_meshes(body.with_vertices(body.vertices[:, [0, 2, 1]] * [1, -1, 1]), t_body().mesh)
    assert_allclose(to_matrix(found.rotation) @ [0, 0, 1], [0, 1, 0], atol=0.25)
    assert to_matrix(found.rotation)[0, 0] > 0.9


def test_upright_turns_about_the_vertical_only(rng: np.random.Generator) -> None:
    mesh = sphere(3)
    tilted = mesh.with_vertices(mesh.vertices @ Rotation.random(rng=rng).as_matrix().T)
    found = align_meshes(mesh, tilted, upright=True)
    assert_allclose(to_matrix(found.rotation) @ [0, 1, 0], [0, 1, 0], atol=1e-12)


def test_what_looks_alike_turned_is_said_to(rng: np.random.Generator) -> None:
    # an ellipsoid fits itself in four ways
    mesh = sphere(3)
    V = mesh.vertices / np.linalg.norm(mesh.vertices, axis=1, keepdims=True) * [1.0, 2.0, 0.6]
    found = align_meshes(mesh.with_vertices(V), mesh.with_vertices(2 * V))
    assert found.other is not None
    assert "fits almost as well" in found.warnings[0]


def test_points_give_the_least_squares_similarity(rng: np.random.Generator) -> None:
    P, R, shift = rng.normal(size=(9, 3)), Rotation.random(rng=rng), rng.normal(size=3)
    found = align_points(P, 2.5 * R.apply(P) + shift)
    assert_allclose(found.apply(P), 2.5 * R.apply(P) + shift, atol=1e-12)
    assert found.residual < 1e-12
    Q = P + 0.1 * rng.normal(size=P.shape)
    best = align_points(P, Q)
    assert_allclose(
        to_matrix(best.rotation), Rotation.align_vectors(Q - Q.mean(0), P - P.mean(0))[0].as_matrix()
    )
    back = align_points(Q, P)
    assert_allclose(back.apply(best.apply(P)), P, atol=1e-12)


def test_two_joints_are_enough_upright() -> None:
    P = np.array([[0.1, 1, 0], [-0.1, 1, 0]])
    found = align_points(P, P[:, [2, 1, 0]] * [1, 1, -1], upright=True)
    assert_allclose(found.apply(P), P[:, [2, 1, 0]] * [1, 1, -1], atol=1e-12)
    with pytest.raises(ValueError, match="at least 3"):
        align_points(P, P)
    with pytest.raises(ValueError, match="one place"):
        align_points(np.zeros((3, 3)), np.eye(3))


def test_yaw_is_the_best_of_all_yaws(rng: np.random.Generator) -> None:
    P, Q = rng.normal(size=(2, 8, 3))
    scale, R, shift = fit_similarity(P, Q, np.ones(8), True)
    angles = np.linspace(0, 2 * np.pi, 721)

    def misfit(A: np.ndarray) -> float:
        return float(((scale * (P - P.mean(0)) @ A.T - (Q - Q.mean(0))) ** 2).sum())

    brute = min(misfit(Rotation.from_euler("y", a).as_matrix()) for a in angles)
    assert misfit(R) <= brute + 1e-12
    assert_allclose(scale * R @ P.mean(0) + shift, Q.mean(0), atol=1e-12)


def test_there_and_back(rng: np.random.Generator) -> None:
    P = rng.normal(size=(5, 3))
    there = Alignment(1.7, wxyz(Rotation.random(rng=rng)), rng.normal(size=3))
    assert_allclose(there.inverse().apply(there.apply(P)), P, atol=1e-12)
    half = wxyz(Rotation.from_euler("y", 180, degrees=True))
    again = turned(turned(there, half, P[0]), half, P[0])
    assert_allclose(again.apply(P), there.apply(P), atol=1e-12)
    assert_allclose(turned(there, half, there.apply(P[0])).apply(P[0]), there.apply(P[0]), atol=1e-12)


def test_feet_point_forward() -> None:
    body = human_body().mesh
    for degrees in (0, 90, 200):
        turn = Rotation.from_euler("y", degrees, degrees=True)
        front = feet_front(body.vertices @ turn.as_matrix().T, body.faces)
        assert front is not None
        assert front @ turn.apply([0, 0, 1]) > 0.95 * np.linalg.norm(front)
    ball = sphere(3)
    level = ball.with_vertices(ball.vertices * [1, 0, 1])
    assert feet_front(level.vertices, level.faces) is None


def test_clouds_are_dense_and_their_moments_exact(rng: np.random.Generator) -> None:
    box = Mesh(
        np.array(np.meshgrid([0, 2.0], [0, 3.0], [0, 5.0], indexing="ij")).reshape(3, -1).T,
        [[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6], [0, 2, 6],
         [0, 6, 4], [1, 5, 7], [1, 7, 3]],
    )  # fmt: skip
    cloud = make_cloud(box.vertices, box.faces)
    assert len(cloud.points) >= 4000
    assert_allclose(cloud.centre, [1, 1.5, 2.5], atol=1e-12)
    # over the faces of a box a x b x c: the mean of x^2 is a^2/4 on the two across, a^2/12 on the others
    a, b, c = 2.0, 3.0, 5.0
    areas = 2 * np.array([b * c, a * c, a * b])
    squares = np.array([a, b, c]) ** 2
    mean = sum(squares[k] * (areas[k] / 4 + (areas.sum() - areas[k]) / 12) for k in range(3)) / areas.sum()
    assert_allclose(cloud.size**2, mean, rtol=1e-12)


def test_spread_points_are_the_farthest_each_time(rng: np.random.Generator) -> None:
    P = rng.normal(size=(60, 3))
    chosen = spread_points(P, 8, np.zeros(3))
    for i in range(1, 8):
        gap = np.linalg.norm(P[:, None] - P[chosen[:i]], axis=2).min(axis=1)
        assert gap[chosen[i]] == gap.max()
    assert len(spread_points(P, 100, np.zeros(3))) == 60


def test_nothing_to_align_is_refused() -> None:
    mesh = sphere(1)
    with pytest.raises(ValueError, match="target must be a surface"):
        align_meshes(mesh, Mesh(np.zeros((3, 3)), [[0, 1, 2]]))
