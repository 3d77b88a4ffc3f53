"""Pictures of signals show what is there: places, strains, bad transitions, crowding, errors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip
from tempose.render import LIGHT
from tempose.render.drawing import Inset, Stroke, Words
from tempose.signals import SignalModel
from tempose.signals.pictures import (
    bad_transitions,
    draw_errors,
    draw_pose_grid,
    draw_pose_plane,
    draw_retiming,
    draw_scree,
    plot_signals,
    pose_grid,
    thumbnails,
)
from tempose.signals.pictures.clipping import clipped
from tempose.signals.pictures.crowding import Crowd
from tempose.signals.pictures.pose_grid import poses_at
from tempose.signals.pictures.region import check_region, curve_points, used_region
from tempose.signals.pictures.trust import make_trust
from tempose.signals.pictures.views import telling_view

pytest.importorskip("PIL")

T = 18


def moving(unit: float = 1.0) -> MeshClip:
    """An octahedron on a closed path of two shapes."""
    V = np.concatenate([np.eye(3), -np.eye(3)]) * [1.0, 1.5, 0.8]
    F = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    t = 2 * np.pi * np.arange(T) / T
    frames = np.stack([V * [1 + 0.2 * np.cos(a), 1 + 0.2 * np.sin(a), 1 + 0.05 * np.sin(2 * a)] for a in t])
    return MeshClip((unit * frames).astype(np.float32), Mesh(unit * frames[0], np.array(F)), 30.0)


@pytest.fixture(scope="module")
def model() -> SignalModel:
    return SignalModel(k=T + 2, l=T, m=T - 1).fit(moving())


def of_kind(drawing: object, kind: type) -> list:
    return [shape for shape in drawing.shapes if isinstance(shape, kind)]  # type: ignore[attr-defined]


def test_every_frame_and_control_is_in_the_plane(model: SignalModel) -> None:
    drawing = draw_pose_plane(model.signals_, thumbnails=0)
    discs = of_kind(drawing, Stroke)
    dots = np.array(
        [s.points[0] for s in discs if len(s.points) == 1 and s.points[0][1] < drawing.height - 60]
    )
    assert len(np.unique(dots.round(3), axis=0)) == T, "frames and their sites share their places"
    squares = [s for s in discs if len(s.points) == 5]
    assert len(squares) == len(model.signals_.time.curve.controls) + 1, "one more in the legend"
    words = {w.text for w in of_kind(drawing, Words)}
    assert {"0", str(T - 1), "frame", "site", "control point"} <= words


def test_an_edit_shows_what_was_before(model: SignalModel) -> None:
    assert "before edits" not in {
        w.text for w in of_kind(draw_pose_plane(model.signals_, thumbnails=0), Words)
    }
    edited = model.edited([{"op": "move", "control": 6, "by": [0.2, 0.1]}])
    drawing = draw_pose_plane(edited.signals_, thumbnails=0)
    assert "before edits" in {w.text for w in of_kind(drawing, Words)}
    assert any(s.dash for s in of_kind(drawing, Stroke))


def test_bad_transitions_wear_a_ring_each(model: SignalModel) -> None:
    drawing = draw_pose_plane(model.signals_, bad=[2, 9], thumbnails=0)
    assert {"2-3", "9-10", "bad transition"} <= {w.text for w in of_kind(drawing, Words)}
    assert len([s for s in of_kind(drawing, Stroke) if s.dash and len(s.points) == 49]) == 3


def test_a_pose_surface_bent_between_frames_is_a_bad_transition(model: SignalModel) -> None:
    assert bad_transitions(model.signals_) == []
    g, i = model.signals_.pose, 5
    assert model.signals_.path is not None
    at = model.signals_.time(np.array([i + 0.5]))[0]

    class Bent:
        sites = g.sites

        def __call__(self, p: np.ndarray, origin: np.ndarray | None = None) -> np.ndarray:
            bump = np.exp(-np.square(p - at).sum(-1, keepdims=True) / 0.02)
            return g(p, origin) + 5 * bump

    bent = replace(model.signals_, pose=Bent())  # type: ignore[arg-type]
    assert i in bad_transitions(bent)


def test_thumbnails_keep_clear_of_one_another(model: SignalModel) -> None:
    insets = of_kind(draw_pose_plane(model.signals_, thumbnails=6), Inset)
    assert len(insets) >= 3
    for i, a in enumerate(insets):
        for b in insets[:i]:
            apart = np.abs(np.subtract(a.at, b.at)) >= np.array(a.size) - 1e-6
            assert apart.any()


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_strain_is_zero_on_the_clip_and_does_not_know_the_unit(unit: float) -> None:
    model = SignalModel(k=T + 2, l=T, m=T - 1).fit(moving(unit))
    trust = make_trust(model.signals_)
    V = model.sample(dtype=np.float64)
    for v in V[::4]:
        assert trust.strain(v) < 1e-6
    assert trust.strain(2 * V.max(axis=0)) > 0.1
    grown = V[0] * 1.5
    longest = trust.longest
    edges = V[0][trust.edges[:, 0]] - V[0][trust.edges[:, 1]]
    beyond = np.maximum(np.log(1.5 * np.linalg.norm(edges, axis=1)) - longest, 0)
    weight = np.exp(0.5 * (longest + trust.shortest))
    assert trust.strain(grown) == pytest.approx(np.sqrt((weight * beyond**2).sum() / weight.sum()), rel=1e-6)


def test_poses_far_from_the_curve_are_fainter(model: SignalModel) -> None:
    trust = make_trust(model.signals_)
    places = curve_points(model.signals_)[1][[0]] * np.array([[1.0], [1.5], [3.0], [6.0]])
    strengths = [trust.strength(p, v) for p, v in zip(places, poses_at(model.signals_, places))]
    assert strengths[0] > 0.99 and (np.diff(strengths) < 0).all()
    assert strengths[-1] >= 0.16


def test_poses_of_the_plane_are_those_of_the_model(model: SignalModel) -> None:
    P = np.random.default_rng(3).normal(size=(5, 2))
    assert_allclose(poses_at(model.signals_, P), model.pose_at(P, dtype=np.float64), atol=1e-12)


def test_the_plane_reaches_to_controls_outside_the_curve(model: SignalModel) -> None:
    s = model.signals_
    x0, _, x1, y1 = used_region(s, margin=0.0)
    side = x1 - x0
    controls = s.time.curve.controls.copy()
    controls[1] = (x1 + 0.4 * side, y1)
    moved = replace(s, time=replace(s.time, curve=s.time.curve.with_controls(controls)))
    seen = used_region(moved, controls=True)
    assert seen[0] < controls[:, 0].min() and seen[2] > controls[:, 0].max()
    assert used_region(moved)[2] < seen[2]
    controls[1] = (x1 + 9 * side, y1)
    far = replace(s, time=replace(s.time, unedited=s.time.curve, curve=s.time.curve.with_controls(controls)))
    assert used_region(far, controls=True)[2] < controls[1, 0]


def test_a_smaller_region_is_shown_finer(model: SignalModel, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(thumbnails, "FINE", 1)
    x0, y0, x1, y1 = used_region(model.signals_)
    near = (x0, y0, 0.5 * (x0 + x1), 0.5 * (y0 + y1))
    for region in (None, near):
        assert len(of_kind(draw_pose_grid(model.signals_, region, columns=2), Inset)) in (2, 4)
    picture = pose_grid(model, near, columns=2, scale=0.25)
    assert picture.dtype == np.uint8 and picture.shape[2] == 3
    with pytest.raises(ValueError, match="2 to 60"):
        pose_grid(model, columns=1)


@pytest.mark.parametrize("region", [(0, 0, 1), (0, 0, 0, 1), (0, 1, 1, 0), (0, 0, np.nan, 1)])
def test_an_empty_region_is_refused(region: tuple) -> None:
    with pytest.raises(ValueError, match="region must"):
        check_region(region)
    assert check_region((0, 1, 2, 3)) == (0.0, 1.0, 2.0, 3.0)


def test_the_view_shows_the_motion() -> None:
    rng = np.random.default_rng(0)
    V = np.tile(rng.normal(size=(30, 3)), (5, 1, 1))
    along = np.arange(5.0)[:, None, None] * rng.normal(size=(30, 1))
    sideways, forward = V + along * [1.0, 0, 0], V + along * [0, 0, 1.0]
    assert abs(telling_view(sideways)[0]) < 0.5, "what moves along x is seen from the front"
    assert abs(telling_view(forward)[0] - np.pi / 2) < 0.5


def test_words_settle_where_nothing_is() -> None:
    crowd = Crowd(np.array([[50.0, 43.0]]), (0, 0, 100, 100))
    first = crowd.settle(np.array([50.0, 50.0]), (8, 4), (2.0,))
    assert first is not None and not (np.abs(first - [50, 43]) < [8, 4]).all(), "a point is in the way"
    taken = [crowd.settle(np.array([50.0, 50.0]), (8, 4), (2.0, 6.0, 20.0)) for _ in range(40)]
    assert any(at is None for at in taken), "at last there is no room"
    for k, (a, b, c, d) in enumerate(crowd.boxes):
        assert a >= 0 and b >= 0 and c <= 100 and d <= 100
        for e, f, g, h in crowd.boxes[:k]:
            assert c < e or g < a or d < f or h < b


def test_charts_hold_the_numbers(model: SignalModel) -> None:
    drawing = draw_errors({"shape": np.full(T, 0.25), "played": np.linspace(0, 1, T)}, 0.5)
    line = [s for s in of_kind(drawing, Stroke) if len(s.points) == T and s.color == LIGHT.accent]
    assert len(line) == 1 and np.allclose(np.diff(line[0].points, 2, axis=0), 0, atol=1e-9)
    assert {"tolerance 0.5", "shape", "played"} <= {w.text for w in of_kind(drawing, Words)}
    scree = draw_scree(10.0 ** -np.arange(5), 2)
    curve = next(s for s in of_kind(scree, Stroke) if len(s.points) == 5 and s.color == LIGHT.accent)
    assert np.allclose(np.diff(curve.points, 2, axis=0), 0, atol=1e-9), "powers of ten lie on a line"
    assert "m = 2" in {w.text for w in of_kind(scree, Words)}


def test_normal_speed_lies_on_the_dashed_line(model: SignalModel) -> None:
    drawing = draw_retiming(model.signals_)
    dashed, played = [s for s in of_kind(drawing, Stroke) if len(s.points) > 100]
    assert dashed.dash and not played.dash
    assert_allclose(dashed.points, played.points[: len(dashed.points)], atol=1e-6)


def test_the_errors_of_frames_are_those_of_the_budget(model: SignalModel) -> None:
    clip = moving()
    fitted = SignalModel(k=8, l=7, m=2).fit(clip)
    report = fitted.report_
    rows, budget = report["frame_errors"], report["budget"]
    square = {name: float(np.square(row).mean()) for name, row in rows.items()}
    assert square["h"] == pytest.approx(budget["h"] ** 2)
    assert square["hg"] == pytest.approx(budget["h"] ** 2 + budget["g"] ** 2)
    assert square["hgf"] == pytest.approx(budget["whole"] ** 2)
    assert square["played"] == pytest.approx(report["errors"]["rms_percent"] ** 2)
    assert report["scree"][2] == pytest.approx(budget["h"])
    assert report["scree"][0] > report["scree"][1] > report["scree"][2] and report["scree"][-1] == 0


def test_all_pictures_of_a_model(model: SignalModel, tmp_path: Path) -> None:
    written = plot_signals(model, tmp_path / "new", formats=("svg",), grid=False)
    assert {p.name for p in written} == {"pose-plane.svg", "frame-errors.svg", "scree.svg"}
    slow = model.edited([{"op": "speed", "from": 3, "to": 9, "factor": 0.5}])
    names = {p.name for p in plot_signals(slow, tmp_path / "new", formats=("svg",), grid=False)}
    assert names == {"pose-plane.svg", "scree.svg", "retiming.svg"}
    with pytest.raises(ValueError, match="formats"):
        plot_signals(model, tmp_path, formats=("pdf",))
    with pytest.raises(FileNotFoundError):
        plot_signals(model, tmp_path / "no" / "folder", grid=False)


def test_lines_are_cut_at_the_edge() -> None:
    box = (0.0, 0.0, 10.0, 10.0)
    line = np.array([[-5, 5], [5, 5], [5, 20], [20, 20], [20, -20], [5, -5], [5, 5.0]])
    parts = clipped(line, box)
    assert_allclose(parts, [[[0, 5], [5, 5]], [[5, 5], [5, 10]], [[5, 0], [5, 5]]])
    (through,) = clipped(np.array([[-10, -10], [20, 20.0]]), box)
    assert_allclose(through, [[0, 0], [10, 10]])
    (out,) = clipped(np.array([[5, 4], [20, 16.0]]), box)
    assert_allclose(out, [[5, 4], [10, 8]])
