"""The camera projects as the closed form says, and `fit` touches the border it promises."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.render.camera import Camera, axes_towards, box_corners
from tempose.render.floor import floor_points
from tempose.render.views import NAMED_VIEWS, view_named


@pytest.mark.parametrize("azimuth", [0.0, 0.7, -2.5])
@pytest.mark.parametrize("elevation", [0.0, 0.4, np.pi / 2])
def test_axes_are_a_rotation_whose_last_row_points_at_the_viewer(azimuth, elevation):
    A = axes_towards(azimuth, elevation)
    assert_allclose(A @ A.T, np.eye(3), atol=1e-12)
    assert_allclose(np.linalg.det(A), 1.0)
    up = np.array([0.0, 1.0, 0.0])
    assert_allclose(A[2] @ up, np.sin(elevation), atol=1e-12)
    assert_allclose(A[0] @ up, 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("view", "towards_viewer"),
    [
        ("front", [0, 0, 1]),
        ("back", [0, 0, -1]),
        ("left", [1, 0, 0]),
        ("right", [-1, 0, 0]),
        ("top", [0, 1, 0]),
    ],
)
def test_named_views_look_at_the_side_they_name(view, towards_viewer):
    assert_allclose(axes_towards(*view_named(view))[2], towards_viewer, atol=1e-12)


def test_the_left_hand_of_a_person_is_on_the_right_of_a_front_picture():
    camera = Camera.fit([[-1, -1, -1], [1, 1, 1]], *NAMED_VIEWS["front"])
    x_left, x_right = camera.project([[0.5, 0, 0], [-0.5, 0, 0]], (100, 100))[:, 0]
    assert x_left > 50 > x_right


def test_perspective_projection_is_the_closed_form(rng):
    fov, size = 0.9, (320, 200)
    camera = Camera([0.0, 0.0, 5.0], np.eye(3), fov)
    P = rng.uniform(-1, 1, (50, 3))
    focal = size[1] / 2 / np.tan(fov / 2)
    depth = 5 - P[:, 2]
    expected = np.column_stack([160 + focal * P[:, 0] / depth, 100 - focal * P[:, 1] / depth, depth])
    assert_allclose(camera.project(P, size), expected, rtol=1e-12)


def test_parallel_projection_does_not_depend_on_depth(rng):
    camera = Camera.fit(rng.normal(size=(20, 3)), 0.4, 0.3, fov=0)
    P = rng.normal(size=(30, 3))
    moved = P + rng.normal(size=(30, 1)) * camera.axes[2]
    assert_allclose(camera.project(P, (80, 60))[:, :2], camera.project(moved, (80, 60))[:, :2], atol=1e-9)


@pytest.mark.parametrize("fov", [0.0, 0.3, 1.2])
@pytest.mark.parametrize("aspect", [0.5, 1.0, 2.0])
def test_fit_holds_every_point_and_touches_the_border(rng, fov, aspect):
    P = rng.normal(size=(200, 3)) * [1.0, 2.0, 0.5]
    width, height, margin = int(200 * aspect), 200, 0.1
    X = Camera.fit(P, 0.6, 0.2, fov, aspect=aspect, margin=margin).project(P, (width, height))
    assert (X[:, 2] > 0).all()
    reach = np.abs(X[:, :2] - [width / 2, height / 2]) / [width / 2, height / 2]
    assert_allclose(reach.max(), 1 - margin, atol=1e-9)
    if fov == 0:
        assert_allclose(X[:, :2].max(axis=0) + X[:, :2].min(axis=0), [width, height], atol=1e-9)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_fit_scales_with_the_scene(rng, unit):
    P = rng.normal(size=(40, 3))
    one, other = Camera.fit(P, 0.3, 0.2), Camera.fit(unit * P, 0.3, 0.2)
    assert_allclose(other.position, unit * one.position, rtol=1e-9)
    assert_allclose(one.project(P, (64, 64))[:, :2], other.project(unit * P, (64, 64))[:, :2], rtol=1e-9)


def test_a_moved_camera_sees_a_moved_scene_unchanged(rng):
    P, offset = rng.normal(size=(20, 3)), np.array([3.0, -1.0, 2.0])
    camera = Camera.fit(P, 1.0, 0.5)
    assert_allclose(
        camera.moved(offset).project(P + offset, (50, 40)), camera.project(P, (50, 40)), rtol=1e-9
    )


def test_two_points_stand_for_the_eight_corners_of_their_box():
    corners = box_corners(np.array([[0.0, 1.0, 2.0], [3.0, 5.0, 7.0]]))
    assert corners.shape == (8, 3)
    assert len(np.unique(corners, axis=0)) == 8
    assert_allclose(corners.mean(axis=0), [1.5, 3.0, 4.5])


@pytest.mark.parametrize("fov", [0.0, 0.6])
def test_floor_points_invert_the_projection(fov):
    camera = Camera.fit([[-1, 0, -1], [1, 2, 1]], 0.5, 0.6, fov)
    size, level = (40, 30), 0.25
    spot, depth, _, _ = floor_points(camera, size, level, (1.0, 0.2))
    seen = np.isfinite(depth)
    assert seen.any()
    points = np.column_stack([spot[seen, 0], np.full(seen.sum(), level), spot[seen, 1]])
    i, j = np.meshgrid(np.arange(40), np.arange(30))
    centres = np.column_stack([i.ravel() + 0.5, j.ravel() + 0.5])[seen]
    X = camera.project(points, size)
    assert_allclose(X[:, :2], centres, atol=1e-6)
    assert_allclose(X[:, 2], depth[seen], rtol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"position": [0, 0]}, r"position must have shape \(3,\), got \(2,\)"),
        ({"axes": np.diag([1.0, 1.0, -1.0])}, "right-handed"),
        ({"axes": 2 * np.eye(3)}, "orthonormal"),
        ({"fov": 4.0}, "fov must be an angle in radians"),
        ({"half_height": 0.0}, "half_height must be a positive number of metres"),
    ],
)
def test_impossible_cameras_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        Camera(**({"position": np.zeros(3), "axes": np.eye(3)} | arguments))


def test_nothing_to_look_at_is_refused():
    with pytest.raises(ValueError, match="at least one point"):
        Camera.fit(np.zeros((0, 3)))
    with pytest.raises(ValueError, match="front, left, side"):
        view_named("below")
