"""Sheets and films hold exactly the pictures of their frames."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, MeshClip
from tempose.render import Camera, contact_sheet, film, ramp_colors, render_frame, turntable
from tempose.render.follow import clip_cameras, frame_boxes, good_aspect, root_path
from tempose.render.layout import CAPTION, GAP, PAD, TITLE
from tempose.render.subject import floor_level, frame_choice, ground_level
from tempose.render.text import draw_text, text_size
from tempose.render.themes import LIGHT, rgb
from tempose.render.workers import in_order

BOX = trimesh.creation.box(extents=[0.4, 1.8, 0.3])
LOOK = {"quality": "draft", "workers": 1}


def walk(frames=9, distance=6.0, fps=10.0, height=0.9):
    path = np.linspace(0, distance, frames)[:, None, None] * np.array([0.0, 0.0, 1.0])
    V = np.asarray(BOX.vertices) + path + np.array([0, height, 0])
    return MeshClip(V.astype(np.float32), Mesh(V[0], BOX.faces, name="box"), fps)


def test_each_cell_of_a_sheet_is_the_picture_of_its_frame():
    clip, cell, views = walk(), (90, 64), ("front", "side")
    sheet = contact_sheet(clip, [0, 4, 8], views, cell=cell, names=[""], **LOOK)
    assert sheet.shape == (PAD + 2 * (64 + CAPTION + 10) + PAD - GAP, 3 * (90 + GAP) - GAP + 2 * PAD, 3)
    for row, view in enumerate(views):
        cameras = clip_cameras(clip, view, aspect=90 / 64, elevation=np.radians(9.0), roam=0.2)
        for column, t in enumerate([0, 4, 8]):
            y, x = PAD + row * (64 + CAPTION + 10), PAD + column * (90 + GAP)
            alone = render_frame(
                clip.vertices[t], clip.faces, cameras[t], size=cell, ground=0.0, quality="draft"
            )
            skip = CAPTION + 10 if column == 0 else 0  # The label of the row stands there.
            assert_array_equal(sheet[y + skip : y + 64, x : x + 90], alone[skip:])


def test_a_title_makes_room_and_scalars_bring_a_legend():
    plain = contact_sheet(walk(), 2, ("front",), cell=(200, 40), **LOOK)
    titled = contact_sheet(walk(), 2, ("front",), cell=(200, 40), title="walk", **LOOK)
    assert titled.shape[0] == plain.shape[0] + TITLE + 10
    assert_array_equal(titled[PAD + TITLE + 10 :], plain[PAD:])
    height = walk().vertices[..., 1]
    legend = contact_sheet(walk(), 2, ("front",), cell=(200, 40), scalars=height, scalar_label="m", **LOOK)
    assert legend.shape == titled.shape
    colors = {tuple(c) for c in legend[PAD + 9].tolist()}
    for code in ((0x7A, 0x8A, 0xA8), (0xFF, 0xD6, 0xC9)):
        assert min(np.abs(np.array(code) - c).max() for c in colors) <= 3


def test_scalars_become_the_colours_of_their_ramp():
    clip = walk(1)
    values = np.linspace(0, 1, len(BOX.vertices))
    one = contact_sheet(clip, 1, ("front",), cell=(50, 60), scalars=values, scalar_range=(0, 1), **LOOK)
    other = contact_sheet(clip, 1, ("front",), cell=(50, 60), colors=ramp_colors(values, 0, 1), **LOOK)
    assert_array_equal(one[-80:-10], other[-80:-10])


def test_several_clips_make_several_rows_with_overlays_of_their_own():
    clips = [walk(3), walk(5)]
    marks = [None, np.tile([[0.0, 2.2, 0.0]], (5, 1, 1)) + root_path(clips[1])[:, None]]
    sheet = contact_sheet(clips, 3, ("front",), cell=(40, 60), points=marks, point_colors="#ff0000", **LOOK)
    red = (sheet == [255, 0, 0]).all(axis=2)
    half = sheet.shape[0] // 2
    assert not red[:half].any()
    assert red[half:].any()


def test_a_mesh_is_a_clip_of_one_frame():
    mesh = Mesh(np.asarray(BOX.vertices), BOX.faces)
    one = contact_sheet(mesh, 5, ("front",), cell=(30, 40), **LOOK)
    other = contact_sheet(MeshClip(mesh.vertices[None], mesh), 1, ("front",), cell=(30, 40), **LOOK)
    assert_array_equal(one, other)


def test_workers_change_nothing_but_time():
    sheets = [contact_sheet(walk(), 3, cell=(30, 40), quality="draft", workers=w) for w in (1, 2)]
    assert_array_equal(*sheets)
    assert_array_equal(
        *[np.stack(list(film(walk(), size=(20, 20), quality="draft", workers=w))) for w in (1, 3)]
    )


def test_in_order_keeps_the_order_and_is_lazy():
    taken = []

    def items():
        for k in range(50):
            taken.append(k)
            yield k

    results = in_order(lambda k: k * k, items(), 3)
    assert next(results) == 0
    assert len(taken) < 10
    assert list(results) == [k * k for k in range(1, 50)]


def test_progress_counts_the_cells_and_can_stop_the_work():
    seen = []
    contact_sheet(walk(), 3, ("front", "top"), cell=(20, 20), progress=lambda *a: seen.append(a[:2]), **LOOK)
    assert seen == [(k, 6) for k in range(1, 7)]

    def stop(done, total, stage):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        contact_sheet(walk(), 3, cell=(20, 20), progress=stop, **LOOK)


def test_a_tracking_camera_goes_with_the_model_and_a_still_one_does_not():
    clip = walk()
    tracked = clip_cameras(clip, "side")
    for camera, shift in zip(tracked, root_path(clip)):
        assert_allclose(camera.position - tracked[0].position, shift, atol=1e-6)
    still = clip_cameras(clip, "side", track=False)
    assert len({id(c) for c in still}) == 1
    near = clip_cameras(walk(distance=0.5), "side")
    assert len({id(c) for c in near}) == 1


@pytest.mark.parametrize("track", [True, False])
@pytest.mark.parametrize("view", ["front", "three-quarter", 2.0, (1.0, 0.5), "top"])
def test_every_frame_lies_in_the_picture(track, view):
    clip = walk(distance=3.0)
    for t, camera in enumerate(clip_cameras(clip, view, aspect=0.7, track=track)):
        X = camera.project(clip.vertices[t], (70, 100))
        assert (X[:, :2] > 0).all() and (X[:, :2] < [70, 100]).all() and (X[:, 2] > 0).all()


def test_the_root_path_of_a_steady_walk_is_straight_and_level():
    path = root_path(walk(frames=41, distance=4.0), smooth=0.1)
    assert_allclose(path[5:-5, 2] - path[5, 2], np.arange(31) * 0.1, atol=1e-3)
    assert_allclose(path[:, :2], 0, atol=1e-6)


def test_boxes_and_aspect_of_a_clip():
    clip = walk(distance=0.0)
    assert_allclose(frame_boxes(clip)[3], [[-0.2, 0, -0.15], [0.2, 1.8, 0.15]], atol=1e-6)
    assert_allclose(good_aspect(clip, "front", 0.01, 9), 0.4 / 1.8, rtol=1e-5)
    assert_allclose(good_aspect(clip, "side", 0.01, 9), 0.3 / 1.8, rtol=1e-5)
    assert good_aspect(clip, "front", 0.5, 2) == 0.5


@pytest.mark.parametrize(("height", "level"), [(0.9, 0.0), (0.95, 0.0), (0.0, -0.9), (5.0, 4.1)])
def test_the_floor_is_at_zero_or_under_the_feet(height, level):
    clip = walk(height=height)
    assert_allclose(ground_level(clip), level, atol=1e-6)
    assert floor_level(clip, None) is None
    assert floor_level(clip, 0.3) == 0.3
    with pytest.raises(ValueError, match="'auto' or None"):
        floor_level(clip, "floor")


def test_frames_are_spread_from_the_first_to_the_last():
    assert frame_choice(3, 11) == [0, 5, 10]
    assert frame_choice(8, 2) == [0, 1]
    assert frame_choice([4, 1], 5) == [4, 1]
    assert frame_choice(1, 9) == [0]
    for bad in (0, [], [5], [-1]):
        with pytest.raises(ValueError, match="frames must be"):
            frame_choice(bad, 5)


def test_film_gives_the_pictures_of_the_frames():
    clip, camera = walk(4, 0.1), Camera.fit([[-1, 0, -1], [1, 2, 1]])
    shots = list(film(clip, camera, size=(24, 32), frames=[3, 1], ground=None, **LOOK))
    for shot, t in zip(shots, [3, 1]):
        alone = render_frame(clip.vertices[t], clip.faces, camera, size=(24, 32), quality="draft")
        assert_array_equal(shot, alone)


def test_captions_stand_in_the_lower_left_corner():
    plain, named = (
        np.stack(list(film(walk(2, 0.1), size=(160, 120), captions=c, **LOOK))) for c in (False, True)
    )
    _, ys, xs = np.nonzero((plain != named).any(axis=3))
    assert ys.min() > 90 and xs.min() >= 9 and xs.max() < 80


def test_the_diagonals_of_quads_are_not_drawn():
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    V = np.array([[x, y, z] for x in (0, 1) for y in (0.5, 1.5) for z in (0, 1)])
    F = np.array([[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)])
    options = {"cell": (80, 80), "ground": None, "wire": True, **LOOK}
    with_, without = (
        contact_sheet(Mesh(V, F, polygons=p), 1, ("front",), **options).astype(int)
        for p in (None, np.full(6, 4))
    )
    drawn = (np.abs(with_ - without).max(axis=2) > 20).sum()
    assert 30 < drawn < 300


def test_a_turntable_goes_once_round_at_one_distance():
    ball = trimesh.creation.icosphere(subdivisions=3)
    mesh = Mesh(np.asarray(ball.vertices), ball.faces)
    shots = np.stack(list(turntable(mesh, 4, size=(40, 40), ground=None, lit=False, **LOOK))).astype(int)
    # A sphere looks the same from everywhere.
    assert np.abs(shots - shots[0]).mean() < 2.0


def test_text_stays_in_its_box_and_has_its_colour():
    picture = np.full((40, 200, 3), 255, np.uint8)
    draw_text(picture, "Frame 12", (5, 5), 13, rgb(LIGHT.text))
    ys, xs = np.nonzero((picture != 255).any(axis=2))
    width, height = text_size("Frame 12", 13)
    assert 5 <= xs.min() and xs.max() <= 5 + width and 5 <= ys.min() and ys.max() <= 5 + height
    assert_allclose(picture.min(axis=(0, 1)), rgb(LIGHT.text) * 255, atol=30)


def test_clips_without_frames_and_wrong_arrays_are_refused():
    mesh = Mesh(np.asarray(BOX.vertices), BOX.faces)
    with pytest.raises(ValueError, match="no frames to show"):
        contact_sheet(MeshClip(np.zeros((0, 8, 3)), mesh))
    with pytest.raises(ValueError, match="scalars must have one entry for each of 9 frames"):
        contact_sheet(walk(), 2, scalars=np.zeros((4, 8)))
    with pytest.raises(ValueError, match="one array for each of the 2 clips, got 1"):
        contact_sheet([walk(), walk()], 2, points=[None])
    with pytest.raises(TypeError, match="a Mesh or a MeshClip is needed, got int"):
        contact_sheet([1], 2)
    with pytest.raises(ValueError, match="at least 1, got 0"):
        list(in_order(abs, [1], 0))


def test_a_clip_without_vertices_is_an_empty_stage():
    empty = MeshClip(np.zeros((2, 0, 3)), Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)))
    assert contact_sheet(empty, 2, ("front",), cell=(20, 20), **LOOK).shape[1] == 2 * 24 - 4 + 20
