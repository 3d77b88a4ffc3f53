"""Clips from scratch: the curve shows each pose at its place."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from edit_clips import played, tube
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tempose.formats import save
from tempose.signals import Signals
from tempose.signals.design import design, load_design
from tempose.signals.edits import move_control
from tempose.typing import FloatArray

POSES = [tube(bend=b) for b in [(0, 0), (0.9, 0), (0, 0.9), (-0.9, 0.3), (0.5, -0.8)]]
PLACES = np.array([[0.0, 0], [1, 0], [0, 1], [-1, 0.2], [0.4, -0.9]])
CURVE = [[0, 0], [0.5, 0.3], [0.8, 0.9], [-0.5, 0.6], [-1, 0.2]]


def centred(V: FloatArray) -> FloatArray:
    return V - V.mean(axis=-2, keepdims=True)


def shown_at(signals: Signals, at: FloatArray) -> FloatArray:
    return signals.shape.vertices(signals.pose(np.asarray(at, dtype=float)))


@pytest.mark.parametrize("space", ["vertex", "gradient"])
@settings(max_examples=8)
@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=5, max_size=5, unique=True))
def test_poses_are_shown_at_their_places(space: str, places: list[tuple[int, int]]) -> None:
    signals = design(POSES, places, CURVE, space=space)
    V = shown_at(signals, np.array(places))
    wanted = np.array([m.vertices for m in POSES])
    assert_allclose(centred(V), centred(wanted), atol=1e-6)


def test_the_clip_begins_and_ends_where_the_curve_does() -> None:
    signals = design(POSES, PLACES, CURVE, fps=24, seconds=1.5, space="vertex")
    assert signals.n_frames == 37
    assert_allclose(signals.duration, 1.5)
    assert_allclose(played(signals)[0], POSES[0].vertices, atol=1e-9)
    assert_allclose(played(signals)[-1], POSES[3].vertices, atol=1e-9)


def test_a_closed_curve_comes_back_smoothly() -> None:
    signals = design(POSES, PLACES, CURVE, fps=30, seconds=2, space="vertex", closed=True)
    first, last = signals.time.curve.domain
    for order in range(3):
        assert_allclose(
            signals.time.curve(first, derivative=order),
            signals.time.curve(last, derivative=order),
            atol=1e-12,
        )
    assert_allclose(played(signals)[0], played(signals)[-1], atol=1e-12)


def test_the_pace_and_the_knots_are_even() -> None:
    signals = design(POSES, PLACES, CURVE, fps=20, seconds=2)
    assert_allclose(np.diff(signals.time.curve.knots[3:-3]), 1.0)
    assert_allclose(np.diff(signals.time.pace(np.arange(41.0))), 2 / 40)


def test_a_straight_way_between_two_poses_mixes_them() -> None:
    signals = design(
        POSES[:2],
        [[0, 0], [1, 0]],
        [[0, 0], [1 / 3, 0], [2 / 3, 0], [1, 0]],
        fps=10,
        seconds=1,
        space="vertex",
    )
    a, b = POSES[0].vertices, POSES[1].vertices
    s = np.linspace(0, 1, 11)[:, None, None]
    assert_allclose(played(signals), (1 - s) * a + s * b, atol=1e-9)


def test_turning_the_plane_changes_nothing() -> None:
    R = np.array([[0.6, -0.8], [0.8, 0.6]])
    a = design(POSES, PLACES, CURVE, space="vertex")
    b = design(POSES, 7 * PLACES @ R.T + 3, 7 * np.array(CURVE) @ R.T + 3, space="vertex")
    assert_allclose(played(a), played(b), atol=1e-9)


def test_aligned_poses_stand_in_one_place() -> None:
    moved = [m.with_vertices(m.vertices + np.array([i, 0, 0])) for i, m in enumerate(POSES)]
    V = played(design(moved, PLACES, CURVE, space="vertex", align=True))
    assert np.ptp(V.mean(axis=1), axis=0).max() < 1e-6
    assert np.ptp(played(design(moved, PLACES, CURVE, space="vertex")).mean(axis=1), axis=0).max() > 1


def test_a_design_can_be_edited() -> None:
    signals = design(POSES, PLACES, CURVE * 2, space="vertex")
    moved = move_control(signals, 1, [0.2, 0.2])
    same = (played(moved) == played(signals)).all(axis=(1, 2))
    assert same[40:].all() and not same[10]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"poses": POSES[:1]}, "poses must hold two or more, got 1"),
        ({"poses": []}, "got none"),
        ({"poses": [*POSES[:4], tube(sides=7)]}, r"poses\[4\] has other faces"),
        ({"places": PLACES[:4]}, "one place for each of the 5 poses, got 4"),
        ({"places": PLACES[[0, 1, 2, 3, 1]]}, "those of poses 1 and 4"),
        ({"places": [[0, 0, 0]] * 5}, r"places must have shape"),
        ({"curve": CURVE[:3]}, "4 or more control points, got 3"),
        ({"curve": CURVE[:2], "closed": True}, "3 or more control points, got 2"),
        ({"fps": 0}, "fps must be positive"),
        ({"seconds": -1}, "seconds must be positive"),
        ({"space": "no"}, "space must be one of"),
    ],
)
def test_designs_that_cannot_be_are_refused(change: dict[str, object], message: str) -> None:
    arguments = {"poses": POSES, "places": PLACES, "curve": CURVE, **change}
    with pytest.raises(ValueError, match=message):
        design(**arguments)  # type: ignore[arg-type]


def written(folder: Path, **change: object) -> Path:
    for i, mesh in enumerate(POSES):
        save(folder / f"{i}.obj", mesh)
    table = {
        "poses": [f"{i}.obj" for i in range(5)],
        "places": PLACES.tolist(),
        "curve": CURVE,
        "fps": 24,
        "seconds": 1,
        "space": "vertex",
        **change,
    }
    path = folder / "design.json"
    path.write_text(json.dumps({k: v for k, v in table.items() if v is not None}))
    return path


def test_a_design_is_read_from_a_file(tmp_path: Path) -> None:
    signals = load_design(written(tmp_path))
    direct = design(POSES, PLACES, CURVE, fps=24, seconds=1, space="vertex")
    assert_allclose(played(signals), played(direct), atol=1e-6)
    toml = tmp_path / "design.toml"
    toml.write_text(
        'poses = ["0.obj", "1.obj"]\nplaces = [[0, 0], [1, 0]]\ncurve = [[0, 0], [0, 1], [1, 1], [1, 0]]\n'
    )
    assert load_design(toml).n_frames == 61


def test_a_folder_or_glob_of_poses_will_do(tmp_path: Path) -> None:
    path = written(tmp_path, poses="*.obj")
    assert_array_equal(load_design(path).n_frames, 25)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"place": []}, "design.json: unknown key 'place'; known are poses, places, curve"),
        ({"curve": None}, "design.json: needs the key 'curve'"),
        ({"closed": 1}, "closed must be true or false"),
        ({"poses": ["0.obj", "9.obj"]}, r"design.json: .*9\.obj"),
        ({"fps": "24"}, "fps must be a number"),
    ],
)
def test_files_that_are_no_designs_are_refused(
    change: dict[str, object], message: str, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match=message):
        load_design(written(tmp_path, **change))
