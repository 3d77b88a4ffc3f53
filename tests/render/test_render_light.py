"""Light in closed form: open planes, walls, shadows, the floor."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.render.camera import Camera, axes_towards
from tempose.render.floor import floor_points, floor_shadow, grid_spacing
from tempose.render.gather import gather
from tempose.render.lights import BOUNCE, KEY, SKY, Quality, light_directions, make_lights

UP = np.array([[0.0, 1.0, 0.0]])
OVERHEAD = np.array([0.0, 1.0, 0.0])
FINE = Quality(samples=1, key=16, sky=400, resolution=256)


def square(side=1.0, height=0.0):
    V = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1.0]]) * side / 2 + [0, height, 0]
    return V, np.array([[0, 2, 1], [0, 3, 2]])


def nothing(quality=FINE, key=OVERHEAD):
    return make_lights(np.zeros((0, 3)), np.zeros((0, 3), np.int32), key, quality)


def test_directions_are_unit_and_each_kind_lights_an_open_plane_with_one():
    directions, weights, kind = light_directions(OVERHEAD, FINE)
    assert_allclose(np.linalg.norm(directions, axis=1), 1.0)
    assert_allclose(weights[kind == KEY].sum(), 1.0)
    assert_allclose((weights * directions[:, 1])[kind == SKY].sum(), 1.0)
    assert_allclose((weights * directions[:, 1])[kind == BOUNCE].sum(), -1.0)
    assert (directions[kind == SKY, 1] > 0).all()


def test_an_open_point_facing_up_or_down_receives_one():
    assert_allclose(gather(np.zeros((1, 3)), UP, nothing()), [[1, 1, 0]], atol=1e-9)
    assert_allclose(gather(np.zeros((1, 3)), -UP, nothing()), [[0, 0, 1]], atol=1e-9)


@pytest.mark.parametrize("tilt", [0.3, np.pi / 4, np.pi / 2, 2.5])
@pytest.mark.parametrize("azimuth", [0.0, 1.1])
def test_the_sky_lights_a_tilted_plane_by_its_view_factor(tilt, azimuth):
    n = [[np.sin(tilt) * np.cos(azimuth), np.cos(tilt), np.sin(tilt) * np.sin(azimuth)]]
    _, sky, ground = gather(np.zeros((1, 3)), np.array(n), nothing())[0]
    assert_allclose(sky, (1 + np.cos(tilt)) / 2, atol=0.01)
    assert_allclose(ground, (1 - np.cos(tilt)) / 2, atol=0.02)


def test_a_wall_takes_away_half_of_the_sky():
    V = np.array([[-500, -1, 0], [500, -1, 0], [500, 500, 0], [-500, 500, 0.0]])
    lights = make_lights(V, np.array([[0, 1, 2], [0, 2, 3]]), OVERHEAD, FINE)
    assert_allclose(gather(np.array([[0.0, 0.0, 1e-6]]), UP, lights)[0, 1], 0.5, atol=0.02)


def test_a_disc_above_takes_away_its_view_factor():
    # A disc of radius r at height h hides r^2 / (r^2 + h^2) of the light of the sky.
    angle = np.linspace(0, 2 * np.pi, 65)[:-1]
    V = np.concatenate([[[0, 1.0, 0]], np.stack([np.cos(angle), np.ones(64), np.sin(angle)], axis=1)])
    k = np.arange(64)
    F = np.column_stack([np.zeros(64, int), 1 + (k + 1) % 64, 1 + k])
    lights = make_lights(V, F, OVERHEAD, FINE)
    key, sky, _ = gather(np.zeros((1, 3)), UP, lights)[0]
    assert key == 0
    assert_allclose(sky, 0.5, atol=0.02)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_shadow_falls_where_the_key_light_throws_it(unit):
    key = np.array([1.0, 1.0, 0.0]) / np.sqrt(2)
    V, F = square(0.5, height=1.0)
    # A map of 32 pixels: half of one would move the shadow by 0.01. Points are raised by an offset.
    lights = make_lights(unit * V, F, key, Quality(1, 1, 6, 32))
    raised = 1.6 * lights.texel / unit
    x = np.linspace(-1.5, -0.5, 1001) + raised
    spot = np.column_stack([unit * x, np.zeros_like(x), np.zeros_like(x)])
    dark = 1 - gather(spot, np.repeat(UP, len(x), axis=0), lights)[:, 0]
    place = (x * dark).sum() / dark.sum() - raised
    assert_allclose(place, -1.0, atol=0.004)
    assert_allclose(dark.sum() * 0.001, 0.5, atol=0.03)


def test_a_lit_surface_does_not_shade_itself():
    V, F = square(2.0)
    lights = make_lights(V, F, np.array([0.8, 0.6, 0.0]), FINE)
    points = np.column_stack([np.linspace(-0.9, 0.9, 50), np.zeros(50), np.linspace(-0.7, 0.8, 50)])
    assert_allclose(gather(points, np.repeat(UP, 50, axis=0), lights)[:, :2], 1.0, atol=1e-9)


def test_the_far_side_of_a_surface_is_dark():
    V, F = square(200.0)
    below = gather(np.zeros((1, 3)), -UP, make_lights(V, F, OVERHEAD, FINE))[0]
    assert_allclose(below, [0, 0, 1], atol=0.01)
    just_under = gather(np.array([[0.0, -30.0, 0.0]]), UP, make_lights(V, F, OVERHEAD, FINE))[0]
    assert just_under[0] == 0 and just_under[1] < 0.12


def test_floor_shadow_by_strides_agrees_with_every_pixel():
    V, F = square(1.0, height=0.3)
    lights = make_lights(V, F, np.array([0.5, 0.8, 0.33]), Quality(1, 16, 60, 128))
    camera, size = Camera.fit([[-1, 0, -1], [1, 1, 1]], 0.4, 0.6), (60, 50)
    spot, depth, _, _ = floor_points(camera, size, 0.0, (1.0, 0.2))
    wanted = np.isfinite(depth)
    full, fast = (floor_shadow(spot, 0.0, lights, wanted, size, stride) for stride in (1, 3))
    assert full.max() > 0.8
    assert_allclose(fast, full, atol=0.04)
    changed = fast != full
    assert changed.mean() > 0.3
    assert np.abs(fast - full)[changed].mean() < 0.0015
    slow = gather(np.insert(spot[wanted], 1, 0.0, axis=1), np.repeat(UP, wanted.sum(), axis=0), lights)
    offset_free = 1 - 0.6 * slow[:, 0] - 0.4 * slow[:, 1]
    assert np.abs(offset_free - full[wanted]).mean() < 0.01


@pytest.mark.parametrize(("extent", "spacing"), [(1.8, (1, 0.2)), (0.03, (0.01, 0.002)), (400, (100, 20))])
def test_grid_lines_stand_at_metres_or_powers_of_ten(extent, spacing):
    assert_allclose(grid_spacing(extent), spacing)


def test_grid_lines_cover_the_pixels_of_whole_metres():
    camera, size = Camera.fit([[-0.7, 0, -0.7], [0.7, 0, 0.7]], 0.0, np.pi / 2, 0.0), (101, 101)
    strong = floor_points(camera, size, 0.0, (1.0, 0.2))[3].reshape(101, 101)
    assert_allclose(strong[50], 1.0)
    assert_allclose(strong[:, 50], 1.0)
    assert strong[20, 20] == 0
    # One pixel wide: each row away from the other line holds one pixel of ink.
    assert_allclose(strong[20].sum(), 1.0, atol=1e-9)


@pytest.mark.parametrize("numbers", [(0, 1, 6, 64), (1, 0, 6, 64), (1, 1, 2, 64), (1, 1, 6, 8)])
def test_a_quality_without_light_is_refused(numbers):
    with pytest.raises(ValueError, match="a quality needs at least"):
        Quality(*numbers)


@pytest.mark.parametrize("roll", [0.0, 0.6, -1.3])
def test_grid_lines_are_one_pixel_wide_under_any_camera(roll):
    # Coverage falls to nothing at one pixel from the line: distance over the local size of a pixel.
    c, t = np.cos(roll), np.sin(roll)
    axes = np.array([[c, t, 0], [-t, c, 0], [0, 0, 1]]) @ axes_towards(0.4, 0.7)
    camera = Camera(3 * axes[2] + np.array([0.1, 0, 0.2]), axes, 0.5)
    size = (90, 70)
    spot, depth, _, strong = floor_points(camera, size, 0.0, (1.0, 0.2))
    assert np.isfinite(depth).all()
    grid = spot.reshape(70, 90, 2)
    expected = np.zeros((70, 90))
    for c in range(2):
        pixel = np.hypot(*np.gradient(grid[..., c]))
        line = np.clip(1 - np.abs(grid[..., c] - np.round(grid[..., c])) / pixel, 0, 1)
        expected = np.maximum(expected, line * np.clip((0.25 - pixel) / 0.2, 0, 1))
    assert expected.max() > 0.9
    assert_allclose(strong.reshape(70, 90)[1:-1, 1:-1], expected[1:-1, 1:-1], atol=0.02)
