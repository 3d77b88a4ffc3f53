"""Reports are whole, safe and self-contained; charts draw their numbers."""

from __future__ import annotations

import base64
import re
from html.parser import HTMLParser
from io import BytesIO
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tempose.render import Cell, Chart, Figure, Numbers, Paragraph, Section, Table, html_report, line_chart
from tempose.render.chart_scale import nice_ticks
from tempose.render.report import report_text

VOID = {"meta", "img", "source"}


class Page(HTMLParser):
    """Collects tags and text; complains about tags that do not match."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.words = [], [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] != "style":
            self.words.append(data)


def paths(svg):
    """Points of each curve, a list for each stroke of the pen."""
    root = ElementTree.fromstring(svg)
    curves = [e.get("d") for e in root.iter() if e.tag.endswith("path")]
    return [
        [np.array(re.findall(r"[ML]([-\d.]+) ([-\d.]+)", "M" + s), float) for s in (d or "").split("M")[1:]]
        for d in curves
    ]


def full_report(words="plain"):
    picture = np.arange(5 * 4 * 3, dtype=np.uint8).reshape(5, 4, 3)
    return [
        Section(
            words, [words, Paragraph(words + "\n\n" + words), Numbers({words: Cell(words, "error"), "n": 3})]
        ),
        Section(
            "two", [Table([words, "x"], [[words, 1.23456], [None, Cell(2, "good")], [True, np.nan]], words)]
        ),
        Section(
            "three", [Figure(picture, words, dark=255 - picture), Chart(line_chart({words: [1, 2]}), words)]
        ),
    ]


def test_a_report_needs_nothing_but_itself(tmp_path):
    html_report("Title", full_report(), tmp_path / "r.html", subtitle="sub")
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "http" not in text and "<script" not in text and "@import" not in text
    for tag, attributes in Page(text).tags:
        for name in ("src", "href", "srcset"):
            assert (attributes.get(name) or "data:").startswith(("data:", "#")), tag


@given(st.text(alphabet="<>&\"'/ abö\n", max_size=20))
def test_any_words_are_escaped(words):
    page = Page(report_text(words, full_report(words), subtitle=words))
    assert not any(tag in ("a", "b", "ab") and "href" not in a for tag, a in page.tags)
    squeezed = re.sub(r"\s+", "", words)
    assert squeezed in re.sub(r"\s+", "", "".join(page.words))


def test_pictures_are_embedded_without_loss(tmp_path, rng):
    picture = rng.integers(0, 256, (6, 9, 3), dtype=np.uint8)
    Image.fromarray(picture).save(tmp_path / "p.png")
    for source in (picture, tmp_path / "p.png"):
        text = report_text("t", [Section("s", [Figure(source, "c")])])
        data = re.search(r'src="data:image/png;base64,([^"]+)"', text)
        assert data is not None
        assert_array_equal(np.asarray(Image.open(BytesIO(base64.b64decode(data[1])))), picture)
    (tmp_path / "f.mp4").write_bytes(b"film")
    text = report_text("t", [Section("s", [Figure(tmp_path / "f.mp4", "c")])])
    assert f'src="data:video/mp4;base64,{base64.b64encode(b"film").decode()}"' in text


def test_tables_show_values_and_judgements_by_sign_as_well_as_colour():
    words = "".join(Page(report_text("t", full_report())).words)
    assert "1.235" in words and "✓ 2" in words and "–" in words and "yes" in words and "✗ plain" in words


@pytest.mark.parametrize(
    ("block", "message"),
    [
        (Table(["a", "b"], [[1]]), r"each row must have 2 values, got 1: \[1\]"),
        (Table(["a"], [[Cell(1, "fine")]]), "state must be one of"),
        (Figure("clip.abc"), "only .png, .jpg, .gif, .mp4 files"),
        (Figure(np.zeros((3, 3))), r"Figure.source must be uint8 \(height, width, 3\)"),
        (3, "a section holds text, Paragraph"),
    ],
)
def test_wrong_blocks_are_named_and_leave_no_file(tmp_path, block, message):
    with pytest.raises(ValueError, match=message):
        html_report("t", [Section("s", [block])], tmp_path / "r.html")
    assert not list(tmp_path.iterdir())


def test_curves_pass_through_their_numbers():
    x, y = np.array([0.0, 1.0, 4.0]), np.array([0.0, 10.0, 5.0])
    ((points,),) = paths(line_chart({"y": y}, x, size=(400, 200), y_range=(0, 10)))
    assert_allclose(np.diff(points[:, 0]) / np.diff(points[:, 0]).sum(), np.diff(x) / 4, atol=1e-3)
    fractions = (points[0, 1] - points[:, 1]) / (points[0, 1] - points[1, 1])
    assert_allclose(fractions, y / 10, atol=1e-3)
    assert points[1, 1] < points[0, 1]


def test_missing_values_are_gaps():
    ((a, b),) = paths(line_chart({"y": [1.0, 2.0, np.nan, 3.0, 4.0, 5.0]}))
    assert len(a) == 2 and len(b) == 3
    (empty,) = paths(line_chart({"y": [np.nan, np.nan]}))
    assert empty == []


def test_peaks_survive_thinning(rng):
    y = rng.normal(size=200_000)
    y[123_456], y[17] = 50.0, -50.0
    svg = line_chart({"y": y}, size=(500, 200))
    assert len(svg) < 60_000
    ((points,),) = paths(svg)
    ((ends,),) = paths(line_chart({"y": [-50.0, 50.0]}, size=(500, 200)))
    assert_allclose([points[:, 1].max(), points[:, 1].min()], ends[:, 1], atol=0.2)


def test_several_curves_differ_in_dash_and_are_named():
    svg = line_chart({"a<b": [1, 2], "c": [2, 1]}, title="T & U", limits={"limit": 1.5}, standalone=True)
    root = ElementTree.fromstring(svg)
    styles = [e.get("style") for e in root.iter() if e.tag.endswith("path")]
    assert len(set(styles)) == 2 and any("dasharray" in (s or "") for s in styles)
    words = {e.text for e in root.iter() if e.tag.endswith("text")}
    assert {"a<b", "c", "T & U", "limit"} <= words


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), st.integers(2, 9))
def test_ticks_are_round_evenly_spaced_and_inside(low, width, count):
    ticks = np.array(nice_ticks(low, low + width, count))
    assert ((ticks >= low - 1e-6 * width) & (ticks <= low + width + 1e-6 * width)).all()
    assert 1 <= len(ticks) <= 2 * count + 2
    if len(ticks) > 2:
        step = np.diff(ticks)
        assert_allclose(step, step[0], rtol=1e-3)
        powers = np.log10(step[0] / np.array([1.0, 2.0, 5.0]))
        assert np.abs(powers - np.round(powers)).min() < 1e-3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"series": {"a": [1, 2], "b": [1]}}, "series and x must have one length"),
        ({"series": {"a": [1, 2]}, "x": [0, 0]}, "x must be finite and ascending"),
        ({"series": {"a": [1, 2]}, "y_range": (1, 1)}, "y_range must go from low to high"),
    ],
)
def test_wrong_series_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        line_chart(**arguments)


def test_charts_of_nothing_and_of_one_point_are_whole():
    for svg in (
        line_chart({}),
        line_chart({"a": []}),
        line_chart({"a": [3.0]}),
        line_chart({"a": [2.0, 2.0]}),
    ):
        ElementTree.fromstring(svg)
