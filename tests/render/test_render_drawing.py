"""Drawings cover every pixel once and by as much as they should; SVG holds the same shapes."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.render.dashes import dashed
from tempose.render.drawing import Drawing, Inset, Patch, Stroke, Words, save_drawing
from tempose.render.drawing_raster import drawing_picture
from tempose.render.drawing_svg import drawing_svg
from tempose.render.graph import Graph, text_width
from tempose.render.themes import DARK, LIGHT

pytest.importorskip("PIL")


def ink(drawing: Drawing, scale: float = 1.0) -> float:
    """How much black there is on white, in pixels of the drawing."""
    return float((255 - drawing_picture(drawing, scale)[..., 0].astype(float)).sum() / 255 / scale**2)


@pytest.mark.parametrize("scale", [1.0, 2.0, 3.0])
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.8, np.pi / 2])
def test_a_line_covers_its_area(scale: float, angle: float) -> None:
    d = 30 * np.array([np.cos(angle), np.sin(angle)])
    drawing = Drawing(80, 80)
    drawing.add(Stroke(40 + np.array([-d, d]), "#000000", 4.0))
    assert ink(drawing, scale) == pytest.approx(60 * 4 + np.pi * 4, rel=0.01)


def test_a_line_of_many_points_is_the_same_line() -> None:
    ends = np.array([[10.3, 12.1], [70.9, 61.2]])
    fine = np.stack([np.linspace(a, b, 500) for a, b in ends.T], axis=1)
    one, many = Drawing(80, 80), Drawing(80, 80)
    one.add(Stroke(ends, "#000000", 3.0))
    many.add(Stroke(fine, "#000000", 3.0))
    assert np.abs(drawing_picture(one).astype(int) - drawing_picture(many)).max() <= 1


def test_opacity_is_not_doubled_where_a_line_crosses_itself() -> None:
    drawing = Drawing(40, 40)
    cross = np.array([[5, 5], [35, 35], [35, 5], [5, 35]], dtype=float)
    drawing.add(Stroke(cross, "#000000", 6.0, opacity=0.5))
    assert int(drawing_picture(drawing, 1.0).min()) == pytest.approx(127, abs=1)


def test_discs_and_patches_cover_their_areas() -> None:
    drawing = Drawing(60, 60)
    drawing.disc((30, 30), 12.0, "#000000")
    assert ink(drawing) == pytest.approx(np.pi * 144, rel=0.005)
    for turn in (slice(None), slice(None, None, -1)):
        drawing = Drawing(60, 60)
        drawing.add(Patch(np.array([[10, 10], [40.5, 10], [40.5, 30.25], [10, 30.25]])[turn]))
        assert ink(drawing) == pytest.approx(30.5 * 20.25, rel=0.005)


def test_half_transparent_patch() -> None:
    drawing = Drawing(20, 20)
    drawing.add(Patch(np.array([[-5, -5], [25, -5], [25, 25], [-5, 25]]), "#ff0000", 0.5))
    assert_allclose(drawing_picture(drawing, 1.0)[10, 10], [255, 127, 127], atol=1)


def test_colours_run_along_a_line() -> None:
    drawing = Drawing(101, 21)
    drawing.add(Stroke(np.array([[0.5, 10.5], [100.5, 10.5]]), np.array([[1, 0, 0], [0, 0, 1.0]]), 5.0))
    row = drawing_picture(drawing, 1.0)[10].astype(float) / 255
    assert_allclose(row[5:95, 0], 1 - np.arange(5, 95) / 100, atol=0.01)
    assert_allclose(row[5:95, 2], np.arange(5, 95) / 100, atol=0.01)


def test_dashes_add_up() -> None:
    points = np.array([[0, 0], [3, 4], [3, 4], [3, 14.0]])
    pieces = dashed(points, points, (2, 1))
    lengths = [float(np.linalg.norm(np.diff(p, axis=0), axis=1).sum()) for p, _ in pieces]
    assert_allclose(lengths, [2, 2, 2, 2, 2], atol=1e-12)
    for p, v in pieces:
        assert_allclose(p, v)
    assert_allclose(pieces[1][0][[0, -1]], [[1.8, 2.4], [3, 4]])
    ((whole, _),) = dashed(points, points, ())
    assert_allclose(whole, points[[0, 1, 3]])


def test_an_inset_keeps_its_colours_and_lets_the_background_through() -> None:
    picture = np.zeros((8, 8, 4), np.uint8)
    picture[:, :4] = [200, 100, 50, 255]
    picture[:, 4:6] = [200, 100, 50, 128]
    drawing = Drawing(20, 20, "#ffffff")
    drawing.add(Inset(picture, (10, 10), (8, 8)))
    seen = drawing_picture(drawing, 1.0)
    assert_allclose(seen[10, 7], [200, 100, 50])
    assert_allclose(seen[10, 10], np.array([200, 100, 50]) * 128 / 255 + 255 * 127 / 255, atol=1)
    assert_allclose(seen[10, 13], 255)
    drawing = Drawing(20, 20, "#000000")
    drawing.add(Inset(picture, (10, 10), (4, 4)))
    assert drawing_picture(drawing, 1.0)[10, 8].tolist() == [200, 100, 50]


def test_insets_and_lines_beyond_the_edge_are_cut() -> None:
    drawing = Drawing(20, 20)
    drawing.add(Inset(np.full((8, 8, 4), 255, np.uint8), (-2, 19), (8, 8)))
    drawing.add(Inset(np.full((8, 8, 4), 255, np.uint8), (-50, 190), (8, 8)))
    drawing.add(Stroke(np.array([[-50, -50], [-30, 90.0]]), "#000000"))
    drawing.add(Stroke(np.array([[-50, 10], [90, 10.0]]), "#000000"))
    assert ink(drawing) == pytest.approx(20 * 1.5, rel=0.02)


def test_svg_is_xml_with_everything_in_it() -> None:
    drawing = Drawing(50, 40, "#fafafa")
    drawing.add(Stroke(np.array([[0, 0], [9, 9.0]]), "#123456", 2.0, (3, 4)))
    drawing.add(Stroke(np.array([[0, 0], [9, 9], [5, 2.0]]), np.eye(3), 2.0))
    drawing.disc((3, 4), 2.0, "#00ff00")
    drawing.box((8, 8), 3.0, "#000000", "#ffffff")
    drawing.add(Words('1 < 2 & "three"', (5, 5), halo="#ffffff"))
    drawing.add(Inset(np.full((4, 4, 4), 9, np.uint8), (10, 10), (4, 4)))
    root = ElementTree.fromstring(drawing_svg(drawing))
    tags = [element.tag.split("}")[1] for element in root.iter()]
    counts = {tag: tags.count(tag) for tag in set(tags)}
    assert counts == {
        "svg": 1,
        "rect": 1,
        "polyline": 3,
        "g": 1,
        "circle": 1,
        "polygon": 2,
        "text": 1,
        "image": 1,
    }
    assert next(e.text for e in root.iter() if e.tag.endswith("text")) == '1 < 2 & "three"'


def test_saving_by_ending(tmp_path: Path) -> None:
    drawing = Drawing(10, 8)
    save_drawing(drawing, tmp_path / "a.png", 3.0)
    save_drawing(drawing, tmp_path / "a.svg")
    from PIL import Image

    with Image.open(tmp_path / "a.png") as image:
        assert image.size == (30, 24)
    with pytest.raises(ValueError, match=r"\.png or \.svg"):
        save_drawing(drawing, tmp_path / "a.pdf")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.png", "a.svg"]


@pytest.mark.parametrize("tone", [LIGHT, DARK])
def test_places_of_numbers(tone: object) -> None:
    graph = Graph(Drawing(200, 100), LIGHT, (20, 10, 180, 90), (0, 8), (1, 100), log=True)
    assert_allclose(graph.place(0, 1), [20, 90])
    assert_allclose(graph.place(8, 100), [180, 10])
    assert_allclose(graph.place(4, 10), [100, 50])
    flat = Graph(Drawing(200, 100), LIGHT, (20, 10, 180, 90), (0, 8), (-1, 1))
    assert_allclose(flat.place(np.array([0, 4]), np.array([0, 1])), [[20, 50], [100, 10]])


def test_curves_break_where_values_are_missing() -> None:
    graph = Graph(Drawing(200, 100), LIGHT, (0, 0, 200, 100), (0, 4), (0, 1))
    graph.line(np.arange(5), np.array([0, 1, np.nan, 1, 5]), "#000000")
    assert [len(shape.points) for shape in graph.drawing.shapes] == [2, 2]  # type: ignore[union-attr]
    assert graph.drawing.shapes[1].points[1, 1] == 0  # type: ignore[union-attr]


def test_text_widths_are_near_the_truth() -> None:
    from tempose.render.text import font_of

    for text in ("control point", "rms error, % of the diagonal", "0.767 s", "17-18"):
        assert text_width(text, 24) == pytest.approx(font_of(24).getlength(text), rel=0.15)
