"""Pictures of scenes whose answer is known: silhouettes, colours, symmetry, order."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.render import DARK, LIGHT, Camera, render_frame
from tempose.render.colors import to_linear, to_srgb
from tempose.render.frame import key_direction
from tempose.render.paint import BOUNCE, KEY, SHEEN, SKY
from tempose.render.subject import polygon_edges
from tempose.render.themes import rgb, theme_named

BALL = trimesh.creation.icosphere(subdivisions=4)
WHITE = {"colors": "#ffffff", "lit": False, "show_back": False, "theme": "dark"}


def bytes_of(code):
    return np.round(rgb(code) * 255).astype(int)


def coverage(picture, code="#ffffff", background=DARK.view):
    back, ink = to_linear(rgb(background)), to_linear(rgb(code))
    return ((to_linear(picture / 255) - back) / (ink - back)).mean(axis=2)


def square(z=0.0, side=2.0):
    V = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0.0]]) * side / 2 + [0, 0, z]
    return V, np.array([[0, 1, 2], [0, 2, 3]])


def mean_difference(a, b):
    return np.abs(a.astype(int) - b.astype(int)).mean()


@pytest.mark.parametrize(("fov", "distance"), [(0.0, 5.0), (0.5, 5.0), (1.2, 2.2)])
def test_a_sphere_has_the_silhouette_of_its_projection(fov, distance):
    camera = Camera([0, 0, distance], np.eye(3), fov, half_height=1.4)
    cover = coverage(render_frame(BALL.vertices, BALL.faces, camera, size=(160, 160), **WHITE))
    focal = camera.pixels_per_metre((160, 160))
    radius = focal if fov == 0 else focal / np.sqrt(distance**2 - 1)
    assert_allclose(cover.sum(), np.pi * radius**2, rtol=5e-3)
    ys, xs = np.mgrid[:160, :160] + 0.5
    assert_allclose([(cover * c).sum() / cover.sum() for c in (xs, ys)], [80, 80], atol=0.05)


def test_a_sphere_off_the_axis_stands_where_it_is_projected():
    camera = Camera([0, 0, 8], np.eye(3), 0.0, half_height=4.0)
    V = BALL.vertices + np.array([1.5, -2.0, 0.7])
    cover = coverage(render_frame(V, BALL.faces, camera, size=(200, 100), **WHITE))
    ys, xs = np.mgrid[:100, :200] + 0.5
    centre = [(cover * c).sum() / cover.sum() for c in (xs, ys)]
    assert_allclose(centre, camera.project([[1.5, -2.0, 0.7]], (200, 100))[0, :2], atol=0.05)


def test_the_nearer_square_hides_the_farther_one():
    (A, F), (B, _) = square(0.0), square(1.0, side=1.0)
    camera = Camera([0, 0, 6], np.eye(3), 0.5)
    colors = np.repeat([[1, 0, 0], [0, 1, 0.0]], 2, axis=0)
    options = {"size": (61, 61), "lit": False, "quality": "draft"}
    one = render_frame(np.r_[A, B], np.r_[F, F + 4], camera, face_colors=colors, **options)
    other = render_frame(np.r_[B, A], np.r_[F, F + 4], camera, face_colors=colors[::-1], **options)
    assert_array_equal(one, other)
    assert_array_equal(one[30, 30], [0, 255, 0])
    assert_array_equal(one[30, 16], [255, 0, 0])


def test_a_vertex_colour_is_mixed_as_light_and_in_perspective():
    V = np.array([[-1, -1, 0], [1, -1, -3], [0, 1, 1.0]])
    camera, size = Camera([0.1, 0, 6], np.eye(3), 0.6), (301, 301)
    colors = np.eye(3)
    picture = render_frame(V, [[0, 1, 2]], camera, size=size, colors=colors, lit=False, show_back=False)
    for weights in ([1 / 3, 1 / 3, 1 / 3], [0.6, 0.3, 0.1], [0.15, 0.25, 0.6]):
        x, y, _ = camera.project(np.array([weights]) @ V, size)[0]
        expected = to_srgb(np.array(weights) @ to_linear(colors)) * 255
        assert_allclose(picture[int(y), int(x)], expected, atol=3)


def test_flat_colours_come_out_exactly():
    V, F = square()
    camera = Camera([0, 0, 3], np.eye(3), 0.5)
    picture = render_frame(V, F, camera, size=(21, 21), colors="#3f46b8", lit=False)
    assert_array_equal(picture[10, 10], bytes_of("#3f46b8"))
    picture = render_frame(V, F, camera, size=(21, 21), colors=np.array([10, 200, 77], np.uint8), lit=False)
    assert_array_equal(picture[10, 10], [10, 200, 77])


@pytest.mark.parametrize("theme", [LIGHT, DARK])
def test_back_faces_wear_the_warning_colour(theme):
    V, F = square()
    camera = Camera([0, 0, 3], np.eye(3), 0.5)
    options = {"size": (21, 21), "theme": theme.name}
    inside_out = render_frame(V, F[:, ::-1], camera, lit=False, **options)
    assert_array_equal(inside_out[10, 10], bytes_of(theme.back))
    assert_array_equal(render_frame(V, F, camera, lit=False, **options)[10, 10], bytes_of(theme.mesh))
    red, green, _ = render_frame(V, F[:, ::-1], camera, **options)[10, 10].astype(int)
    assert red > 1.5 * green


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (1, 1, 0)])
@pytest.mark.parametrize("angle", [-0.9, -0.4, 0.0, 0.5, 0.9])
def test_light_follows_the_normal(axis, angle):
    # Nothing is in the way: key light by its cosine, sky and ground by their view factors.
    V, F = square(side=1.0)
    camera = Camera([0, 0, 6], np.eye(3), 0.3)
    R = trimesh.transformations.rotation_matrix(angle, axis)[:3, :3]
    picture = render_frame(V @ R.T, F, camera, size=(41, 41), theme="dark", quality="best")
    n, d = R[:, 2], key_direction(camera)
    half = (d + camera.axes[2]) / np.linalg.norm(d + camera.axes[2])
    diffuse = KEY * max(n @ d, 0) + SKY * (1 + n[1]) / 2 + BOUNCE * (1 - n[1]) / 2
    light = to_linear(rgb(DARK.mesh)) * diffuse + (n @ d > 0) * SHEEN * max(n @ half, 0) ** 24
    # Near the terminator part of the key light's cone is below the horizon of the square.
    assert_allclose(picture[20, 20], to_srgb(light) * 255, atol=2 if n @ d > 0.1 else 4)


def test_the_back_of_a_surface_is_lit_like_its_front():
    V, F = square()
    R = trimesh.transformations.rotation_matrix(0.5, [1, 0.3, 0])[:3, :3]
    camera = Camera([0, 0, 6], np.eye(3), 0.3)
    one, other = (render_frame(V @ R.T, G, camera, size=(31, 31), show_back=False) for G in (F, F[:, ::-1]))
    assert_array_equal(one, other)


def test_the_key_light_comes_from_the_upper_left_of_any_view():
    for azimuth, elevation in ((0.0, 0.0), (2.0, 0.5), (-1.0, -0.6), (0.3, np.pi / 2)):
        camera = Camera.fit(BALL.vertices, azimuth, elevation)
        d = key_direction(camera)
        assert_allclose(np.linalg.norm(d), 1.0)
        assert d @ camera.axes[0] < -0.3
        assert d[1] > 0.3


def test_a_sphere_is_smooth_and_a_crease_shows_its_faces():
    ball = trimesh.creation.icosphere(subdivisions=1)
    camera = Camera.fit(ball.vertices, 0.3, 0.2)
    smooth, flat = (
        render_frame(ball.vertices, ball.faces, camera, size=(80, 80), crease=crease, quality="draft")
        for crease in (None, 0.01)
    )
    inside = np.s_[20:60, 20:60]
    # Flat faces: most neighbours are equal in shade, and some jump.
    steps = [np.abs(np.diff(p[inside][..., 1].astype(int), axis=1)) for p in (smooth, flat)]
    assert steps[1].max() > 2 * steps[0].max()


def test_a_mirrored_scene_gives_a_mirrored_picture(rng):
    V, F = BALL.vertices * [1, 1.5, 0.7] + 0.1 * BALL.vertices**2, BALL.faces
    colors = (V - V.min(axis=0)) / np.ptp(V, axis=0)
    options = {"size": (120, 100), "colors": colors, "lit": False}
    one = render_frame(V, F, Camera.fit(V, 0.7, 0.3), **options)
    M = V * [-1, 1, 1]
    other = render_frame(M, F[:, ::-1], Camera.fit(M, -0.7, 0.3), **options)
    assert mean_difference(one, other[:, ::-1]) < 0.2


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_a_picture_does_not_depend_on_the_unit(unit):
    V, F = BALL.vertices * [1, 1.5, 0.7], BALL.faces
    one = render_frame(V, F, Camera.fit(V, 0.5, 0.2), size=(60, 60))
    other = render_frame(unit * V, F, Camera.fit(unit * V, 0.5, 0.2), size=(60, 60))
    assert mean_difference(one, other) < 0.02


def test_moving_scene_and_camera_together_changes_nothing():
    V, F, offset = BALL.vertices * [1, 1.5, 0.7], BALL.faces, np.array([3.0, 0.0, -2.0])
    camera = Camera.fit(V, 0.5, 0.2)
    one = render_frame(V, F, camera, size=(80, 80), ground=-1.5)
    other = render_frame(V + offset, F, camera.moved(offset), size=(80, 80), ground=-1.5)
    assert mean_difference(one, other) < 0.05


def test_turning_scene_and_camera_together_hardly_changes_anything():
    V, F = BALL.vertices * [1, 1.5, 0.7], BALL.faces
    R = trimesh.transformations.rotation_matrix(1.0, [0, 1, 0])[:3, :3]
    one = render_frame(V, F, Camera.fit(V, 0.5, 0.2), size=(80, 80))
    other = render_frame(V @ R.T, F, Camera.fit(V @ R.T, 1.5, 0.2), size=(80, 80))
    assert mean_difference(one, other) < 1.0


def test_the_same_input_gives_the_same_bytes():
    camera = Camera.fit(BALL.vertices, 0.5, 0.2)
    pictures = [render_frame(BALL.vertices, BALL.faces, camera, size=(50, 50), ground=-1.0) for _ in range(2)]
    assert_array_equal(*pictures)


def test_more_samples_converge_to_the_same_picture():
    camera = Camera.fit(BALL.vertices, 0.5, 0.2)
    draft, good, best = (
        coverage(render_frame(BALL.vertices, BALL.faces, camera, size=(40, 40), quality=q, **WHITE))
        for q in ("draft", "good", "best")
    )
    assert np.abs(good - best).sum() < 0.5 * np.abs(draft - best).sum()


def test_bands_join_without_a_seam(monkeypatch):
    camera = Camera.fit(BALL.vertices, 0.5, 0.2)
    whole = render_frame(BALL.vertices, BALL.faces, camera, size=(64, 64), wire=True)
    monkeypatch.setattr("tempose.render.surface._BAND", 64 * 4 * 5)
    assert_array_equal(render_frame(BALL.vertices, BALL.faces, camera, size=(64, 64), wire=True), whole)


def test_a_model_on_the_floor_darkens_it():
    camera = Camera.fit([[-2, -1, -2], [2, 1, 2]], 0.0, 0.6)
    options = {"size": (120, 120), "ground": -1.0, "theme": "light"}
    standing = render_frame(BALL.vertices, BALL.faces, camera, **options).astype(int)
    away = render_frame(BALL.vertices + np.array([0, 50, 0]), BALL.faces, camera, **options).astype(int)
    x, y, _ = camera.project([[0.55, -1.0, 0.55]], (120, 120))[0]
    assert standing[int(y), int(x)].sum() < away[int(y), int(x)].sum() - 60


def test_what_has_sunk_into_the_floor_shines_through():
    V, F = square()
    flat = V @ trimesh.transformations.rotation_matrix(-np.pi / 2, [1, 0, 0])[:3, :3].T
    camera = Camera.fit([[-2, -1, -2], [2, 1, 2]], 0.0, 1.2)
    options = {"size": (61, 61), "theme": "light", "colors": "#203040", "lit": False}
    x, y = camera.project([[0.13, -0.1, 0.11]], (61, 61))[0, :2].astype(int)
    above, below, alone = (
        render_frame(flat + np.array([0, lift, 0]), F, camera, ground=ground, **options)[y, x]
        for lift, ground in ((0, -0.2), (0, 0.1), (50, 0.1))
    )
    assert_array_equal(above, bytes_of("#203040"))
    mixed = 0.4 * to_linear(rgb("#203040")) + 0.6 * to_linear(rgb(LIGHT.floor))
    assert_allclose(below, to_srgb(mixed) * 255, atol=12)
    assert (above < below).all() and (below < alone).all()


def test_a_point_is_drawn_in_its_colour_and_fainter_behind_the_surface():
    V, F = square()
    camera, size = Camera([0, 0, 6], np.eye(3), 0.6), (101, 101)
    at = np.array([[0.3, 0.4, 0.5], [-0.5, -0.2, -0.5], [np.nan] * 3])
    picture = render_frame(
        V, F, camera, size=size, lit=False, points=at, point_colors="#ff0000", theme="dark"
    )
    (x, y), (u, v) = camera.project(at[:2], size)[:, :2].astype(int)
    assert_array_equal(picture[y, x], [255, 0, 0])
    mixed = to_srgb(0.45 * to_linear(rgb("#ff0000")) + 0.55 * to_linear(rgb(DARK.mesh))) * 255
    assert_allclose(picture[v, u], mixed, atol=1)


def test_a_segment_covers_its_length_times_its_width():
    camera = Camera([0, 0, 5], np.eye(3), 0.0, half_height=1.0)
    lines = [[[-0.5, -0.3, 0], [0.5, 0.4, 0]]]
    picture = render_frame(
        np.zeros((0, 3)), np.zeros((0, 3), int), camera, size=(200, 200), lines=lines, line_width=6.0,
        line_colors="#ffffff", theme="dark",
    )  # fmt: skip
    length = np.hypot(100, 70)
    assert_allclose(coverage(picture).sum(), 6 * length + np.pi * 9, rtol=0.02)


def test_edges_are_drawn_where_triangles_end():
    V, F = square()
    camera = Camera([0, 0, 5], np.eye(3), 0.0, half_height=1.2)
    plain, wired = (render_frame(V, F, camera, size=(121, 121), lit=False, wire=w) for w in (False, True))
    changed = (plain != wired).any(axis=2)
    on_diagonal = np.eye(121, dtype=bool)[::-1]
    assert changed[on_diagonal][12:-12].all()
    assert not changed[60, 75:95].any()
    assert not changed[30:45, 45].any()


def test_only_the_edges_asked_for_are_drawn():
    V, F = square()
    camera = Camera([0, 0, 5], np.eye(3), 0.0, half_height=1.2)
    options = {"size": (121, 121), "lit": False}
    plain, quad = (
        render_frame(V, F, camera, wire=w, **options) for w in (False, polygon_edges(np.array([4])))
    )
    changed = (plain != quad).any(axis=2)
    assert not changed[30:90, 30:90].any()
    assert changed[60, 10] and changed[60, 110] and changed[10, 60] and changed[110, 60]
    with pytest.raises(ValueError, match=r"wire must be True, False or of shape \(2, 3\), got \(4, 3\)"):
        render_frame(V, F, camera, wire=np.ones((4, 3), bool), **options)


def test_a_chequerboard_alternates_along_uv():
    V, F = square()
    camera = Camera([0, 0, 5], np.eye(3), 0.0, half_height=1.0)
    uv = (V[:, :2] + 1) / 2
    picture = render_frame(V, F, camera, size=(80, 80), lit=False, uv=uv, checker=4)[:, :, 0]
    cells = picture[10::20, 10::20].astype(int)
    expected = np.indices((4, 4)).sum(axis=0) % 2
    assert len(np.unique(cells[expected == 0])) == len(np.unique(cells[expected == 1])) == 1
    assert cells[0, 0] != cells[0, 1]
    twice = render_frame(V, F, camera, size=(80, 80), lit=False, uv=uv, uv_faces=F, checker=4)[:, :, 0]
    assert_array_equal(twice, picture)


def test_an_empty_mesh_shows_the_background():
    camera = Camera.fit([[-1, 0, -1], [1, 2, 1]], 0.0, 0.0)
    picture = render_frame(np.zeros((0, 3)), np.zeros((0, 3), int), camera, size=(20, 10))
    assert picture.shape == (10, 20, 3)
    assert_array_equal(np.unique(picture.reshape(-1, 3), axis=0), [bytes_of(LIGHT.view)])
    assert render_frame(np.zeros((0, 3)), np.zeros((0, 3), int), camera, size=(20, 10), ground=0.0).shape


def test_degenerate_triangles_and_lone_vertices_do_no_harm():
    V, F = square()
    camera = Camera([0, 0, 5], np.eye(3), 0.5)
    more = np.r_[V, [[50, 0, 0], [0.2, 0.2, 0.2]]]
    with_slivers = np.r_[F, [[0, 0, 1], [5, 5, 5], [0, 2, 2]]]
    one, other = (
        render_frame(*mesh, camera, size=(40, 40), crease=0.5) for mesh in ((V, F), (more, with_slivers))
    )
    assert_array_equal(one, other)


def test_what_is_behind_the_eye_is_not_drawn():
    V, F = square()
    camera = Camera([0, 0, -3], np.eye(3), 0.5)
    assert coverage(render_frame(V, F, camera, size=(20, 20), **WHITE)).max() < 1e-3


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"V": [[0, 0, np.nan], [1, 0, 0], [0, 1, 0]]}, "V must be finite, got nan"),
        ({"V": [[0, 0], [1, 0], [0, 1]]}, r"V must have shape \(n, 3\)"),
        ({"F": [[0, 1, 3]]}, "F must hold indices from 0 and below 3, got 3"),
        ({"size": (0, 10)}, "size must be width and height"),
        ({"theme": "blue"}, "theme must be 'light' or 'dark', got 'blue'"),
        ({"quality": "worst"}, "quality must be one of draft, good, best"),
        ({"colors": np.ones((2, 3))}, r"colors must have shape \(3, 3\)"),
        ({"colors": 2 * np.ones((3, 3))}, "colors must lie from 0 to 1"),
        ({"colors": "red"}, "'#rrggbb'"),
        ({"face_colors": np.ones((3, 3))}, r"face_colors must have shape \(1, 3\)"),
        ({"checker": 8}, "checker needs uv"),
        ({"lines": np.zeros((2, 3))}, r"lines must have shape \(k, 2, 3\)"),
        ({"points": np.zeros((2, 2))}, r"points must have shape \(p, 3\)"),
        ({"ground": np.nan}, "ground must be a height"),
    ],
)
def test_wrong_arguments_are_named(change, message):
    right = {"V": np.eye(3), "F": [[0, 1, 2]], "camera": Camera.fit(np.eye(3)), "size": (8, 8)}
    assert render_frame(**right).shape == (8, 8, 3)
    with pytest.raises(ValueError, match=message):
        render_frame(**(right | change))


def test_themes_are_found_by_name_or_given():
    assert theme_named("dark") is DARK
    assert theme_named(LIGHT) is LIGHT
