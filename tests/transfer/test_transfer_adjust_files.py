"""Adjustments: what they may say, and that files keep them."""

from __future__ import annotations

import json
import string
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.transfer import Adjustment, load_adjustments, save_adjustments

MANY = (
    Adjustment("left_hand", frame=40, move=(0, 0.25, 0)),
    Adjustment("right_foot", time=1.5, to=[0.1, 0, 2], hold=0.5, ease_in=0, ease_out=1, follow=True),
    Adjustment([5, 3, 5, 9], frame=0, turn=(0, 20, 0), axes="part"),
    Adjustment(np.array([7]), frame=3, move=np.array([1, 2, 3]), turn=(0.6, 0, 0.8, 0), axes="body"),
)

seconds = st.floats(0, 10, allow_nan=False)
vectors = st.tuples(*[st.floats(-5, 5, allow_nan=False)] * 3)


@pytest.mark.parametrize("adjustments", [(), MANY[:1], MANY])
def test_a_file_keeps_everything(adjustments: tuple[Adjustment, ...], tmp_path: Path) -> None:
    save_adjustments(tmp_path / "a.json", adjustments)
    assert load_adjustments(tmp_path / "a.json") == adjustments


@given(
    part=st.text(string.ascii_letters + "_:. ", min_size=1) | st.lists(st.integers(0, 10**6), min_size=1),
    frame=st.integers(0, 10**6),
    move=vectors,
    turn=st.none() | vectors,
    eases=st.tuples(seconds, seconds, seconds),
    axes=st.sampled_from(["world", "body", "part"]),
    follow=st.sampled_from([None, True, False]),
    swivel=st.none() | st.floats(-180, 180),
)
def test_records_are_read_back(
    part: Any,
    frame: int,
    move: Any,
    turn: Any,
    eases: Any,
    axes: str,
    follow: bool | None,
    swivel: float | None,
) -> None:
    a, b, c = eases
    a = Adjustment(part, frame, None, move, None, turn, axes, a, b, c, follow, swivel)
    assert Adjustment.from_record(json.loads(json.dumps(a.record()))) == a


def test_toml_will_do(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_text('[[adjustments]]\npart = "head"\ntime = 2\nturn = [0, 20, 0]\n')
    assert load_adjustments(path) == (Adjustment("head", time=2.0, turn=(0, 20, 0)),)


def test_turns_are_rotations() -> None:
    turn = Adjustment("head", frame=0, turn=(0, 20, 0)).rotation
    assert turn is not None
    expected = Rotation.from_euler("y", 20, degrees=True).as_quat(scalar_first=True)
    assert_allclose(turn, expected, rtol=0, atol=1e-15)
    quaternion = Adjustment("head", frame=0, turn=(0.6, 0, 0.8, 0)).rotation
    assert quaternion is not None
    assert_allclose(quaternion, [0.6, 0, 0.8, 0], rtol=0, atol=1e-15)
    assert MANY[0].rotation is None


def test_times_become_the_nearest_frame() -> None:
    assert Adjustment("head", time=1.02, turn=(0, 1, 0)).key(100, 30.0) == 31
    assert Adjustment("head", frame=99, turn=(0, 1, 0)).key(100, 30.0) == 99
    with pytest.raises(
        ValueError, match=r"adjustment of 'head': time 4 s \(frame 120\) is not in the clip, whose last"
    ):
        Adjustment("head", time=4, turn=(0, 1, 0)).key(100, 30.0)
    with pytest.raises(ValueError, match="adjustment of 2 vertices: frame 100 is not in the clip"):
        Adjustment([4, 5], frame=100, move=(0, 1, 0)).key(100, 30.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"frame": 1, "move": [0, 0, 1]}, "needs a part"),
        (
            {"part": "", "frame": 1, "move": [0, 0, 1]},
            "part must be a name or a list of vertices from 0, got ''",
        ),
        ({"part": [], "frame": 1, "move": [0, 0, 1]}, "part must be a name or a list of vertices"),
        ({"part": [-1], "frame": 1, "move": [0, 0, 1]}, "part must be a name or a list of vertices"),
        ({"part": [1.5], "frame": 1, "move": [0, 0, 1]}, "part must be a name or a list of vertices"),
        ({"part": 7, "frame": 1, "move": [0, 0, 1]}, "part must be a name or a list of vertices"),
        ({"part": "head", "move": [0, 0, 1]}, "needs either frame or time"),
        ({"part": "head", "frame": 1, "time": 1, "move": [0, 0, 1]}, "needs either frame or time"),
        ({"part": "head", "frame": -1, "move": [0, 0, 1]}, "frame must be a whole number from 0, got -1"),
        ({"part": "head", "frame": 1.5, "move": [0, 0, 1]}, "frame must be a whole number from 0, got 1.5"),
        ({"part": "head", "frame": True, "move": [0, 0, 1]}, "frame must be a whole number"),
        ({"part": "head", "time": -1, "move": [0, 0, 1]}, "time must be seconds, 0 or more, got -1"),
        ({"part": "head", "frame": 1, "move": [0, 0, 1], "hold": "long"}, "hold must be seconds"),
        ({"part": "head", "frame": 1, "move": [0, 0, 1], "ease_in": float("inf")}, "ease_in must be seconds"),
        (
            {"part": "head", "frame": 1, "move": [0, 0, 1], "ease_out": float("nan")},
            "ease_out must be seconds",
        ),
        ({"part": "head", "frame": 1}, "needs move, to, turn or swivel"),
        (
            {"part": "head", "frame": 1, "move": [0, 0, 1], "to": [0, 0, 1]},
            "move and to contradict each other",
        ),
        ({"part": "head", "frame": 1, "move": [0, 1]}, r"move must have shape \(3,\), got \(2,\)"),
        ({"part": "head", "frame": 1, "to": [0, 1, None]}, "to must be finite"),
        ({"part": "head", "frame": 1, "turn": [0, 1]}, r"turn must have shape \(3,\), got \(2,\)"),
        (
            {"part": "head", "frame": 1, "turn": [1, 1, 0, 0]},
            "turn must be a unit quaternion wxyz, got length 1.41",
        ),
        (
            {"part": "head", "frame": 1, "move": [0, 0, 1], "axes": "hips"},
            "axes must be one of world, body, part",
        ),
        ({"part": "head", "frame": 1, "move": [0, 0, 1], "follow": 1}, "follow must be true or false, got 1"),
        (
            {"part": "head", "frame": 1, "moves": [0, 0, 1]},
            "unknown key 'moves'; known are .*did you mean 'move'",
        ),
        ("head", "expected a table such as"),
    ],
)
def test_nonsense_is_named_with_its_file_and_entry(given: Any, message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(json.dumps({"adjustments": [MANY[0].record(), given]}))
    with pytest.raises(ValueError, match=message) as caught:
        load_adjustments(path)
    assert str(caught.value).startswith(f"{path}: adjustment 1: ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"adjustments": {}}', '{"adjustments": [], "more": 1}', "{", "\x00", "[" * 10**5],
)
def test_other_files_are_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"a\.json: "):
        load_adjustments(path)


def test_binary_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"a\.json: expected JSON"):
        load_adjustments(path)
