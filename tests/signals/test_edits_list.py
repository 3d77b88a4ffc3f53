"""Edit lists: what they may hold, what they say when they hold something else, undo."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from edit_clips import bending, played, signals_of, tube
from model_clips import swinging
from numpy.testing import assert_allclose, assert_array_equal

from tempose.formats import save
from tempose.signals.edits import OPERATIONS, apply_edits, load_edits, move_control, pin_frames, set_fps
from tempose.signals.replace_shape import locate

BASE = signals_of(swinging(40), k=16, l=20)

EVERY = [
    {"op": "move", "control": 6, "by": [0.1, 0.0]},
    {"op": "place", "control": 3, "at": [0.1, 0.2]},
    {"op": "insert_control", "at": 12},
    {"op": "loop", "from": 4, "to": 17, "times": 3},
    {"op": "cut", "from": 50, "to": 55},
    {"op": "keep", "from": 1, "to": 58},
    {"op": "paste", "from": 3, "to": 9, "at": 20},
    {"op": "reverse", "from": 10, "to": 20},
    {"op": "blend", "from": 30, "to": 12, "frames": 5},
    {"op": "insert_curve", "at": 7, "points": [[0, 0], [0.2, 0.1]], "frames": 10},
    {"op": "retime", "keys": [[0, 0], [20, 30], [40, 40]]},
    {"op": "speed", "from": 5, "to": 20, "factor": 0.5, "ease": 1},
    {"op": "retime", "times": [0.0, 0.5, 0.6, 1.4]},
    {"op": "fps", "value": 60},
    {"op": "pin", "frame": 3, "at": [0.0, 0.0]},
    {"op": "pin", "frame": 6, "at": [0.1, 0.0]},
]


def test_a_list_of_every_edit_plays() -> None:
    edited = apply_edits(BASE, EVERY)
    assert np.isfinite(played(edited)).all()
    named = {entry["op"] for entry in EVERY}
    assert set(OPERATIONS) - named == {"close_loop", "repair", "add_pose", "replace_shape"}


def test_undo_is_leaving_out_the_last_entry() -> None:
    before = played(BASE)
    results = [played(apply_edits(BASE, EVERY[:i])) for i in range(5)]
    for i, expected in enumerate(results):
        assert_array_equal(played(apply_edits(BASE, EVERY[:i])), expected)
    assert_array_equal(results[0], before)


def test_a_list_does_what_the_functions_do() -> None:
    edited = apply_edits(BASE, [EVERY[0], {"op": "fps", "value": 48}])
    assert_array_equal(played(edited), played(set_fps(move_control(BASE, 6, [0.1, 0.0]), 48)))


def test_pins_that_follow_one_another_hold_together() -> None:
    edited = apply_edits(BASE, EVERY[14:16])
    assert_array_equal(
        edited.time.curve.controls, pin_frames(BASE, {3: [0, 0], 6: [0.1, 0]}).time.curve.controls
    )
    assert_allclose(edited.time(np.array([3.0, 6.0])), [[0, 0], [0.1, 0]], atol=1e-9)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (
            {"op": "move", "control": 40, "by": [0, 0]},
            r"operation 1 \(move\): control must be from 0 to 15, got",
        ),
        ({"op": "mov"}, "operation 1: unknown op 'mov'; known are move, place"),
        ({"op": "move", "control": 1, "bye": [0, 0]}, r"\(move\): unknown key 'bye'; known are control, by"),
        ({"op": "move", "control": 1}, r"\(move\): needs the key 'by'; its keys are control, by"),
        ({"op": "move", "control": 1.5, "by": [0, 0]}, "control must be a whole number, got 1.5"),
        ({"op": "move", "control": "1", "by": [0, 0]}, "control must be a number, got '1'"),
        ({"op": "move", "control": 1, "by": [0]}, r"by must be two numbers, \[x, y\], got \[0\]"),
        ({"op": "cut", "from": 5, "to": 300}, r"\(cut\): to must be a frame from 0 to 39, got 300"),
        ({"op": "loop", "from": 5, "to": 9, "times": 0}, "times must be 1 or more, got 0"),
        ({"op": "retime"}, "either times or keys"),
        ({"op": "retime", "times": "fast"}, "times must be a list of numbers"),
        ({"op": "insert_curve", "at": 3, "points": [], "frames": 4}, "points must be a list of pairs"),
        ({"op": "fps", "value": True}, "value must be a number, got True"),
        ({"op": "repair", "from": 3}, "unknown key 'from'"),
        ({"op": "add_pose", "file": 3, "at": [0, 0]}, "file must be a text"),
        ({"op": "add_pose", "file": "no.obj", "at": [0, 0]}, r"\(add_pose\): .*no\.obj"),
        ({"op": "replace_shape", "source": [], "target": ["a"]}, "source must be a list of file names"),
        ({"op": "loop", "from": 5, "to": 9, "times": 10**9}, "times = 1e.09 would make 4e.09 frames"),
        ({"op": "close_loop", "from": 5, "to": 19, "insert": 1e9}, "insert = 1e.09 would make"),
        ({"op": "blend", "from": 5, "to": 9, "frames": 1e9}, "frames = 1e.09 would make"),
        ({"op": "insert_curve", "at": 5, "points": [[0, 0]], "frames": 1e9}, "frames = 1e.09 would make"),
        ({"op": "fps", "value": 1e9}, "value = 1e.09 would make"),
        ({"op": "speed", "from": 5, "to": 9, "factor": 1e-9}, "factor = 1e-09 would make"),
        ({"op": "retime", "keys": [[0, 0], [1e9, 20]]}, "last frame of keys = 1e.09 would make"),
        ({"op": "move", "control": 10**400, "by": [0, 0]}, "control must be a finite number"),
        ({"op": "move", "control": 3, "by": [10**400, 0]}, "by must be an array of numbers"),
        ({"op": "move", "control": 3, "by": [1e308, 0]}, "by puts control 3 at .* go up to"),
        ({"op": "place", "control": 3, "at": [1e308, 0]}, "at puts control 3 at .* go up to"),
        ({"control": 3}, 'operation 1 must be a table with a key "op"'),
        ("move", 'operation 1 must be a table with a key "op"'),
    ],
)
def test_an_edit_that_cannot_be_says_which_and_why(entry: object, message: str, tmp_path: Path) -> None:
    before = played(BASE)
    with pytest.raises(ValueError, match=message):
        apply_edits(BASE, [EVERY[0], entry], tmp_path)  # type: ignore[list-item]
    assert_array_equal(played(BASE), before)


@pytest.mark.parametrize("suffix", ["json", "toml"])
def test_lists_are_read_from_files(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"edit.{suffix}"
    toml = '[[operations]]\nop = "move"\ncontrol = 6\nby = [0.1, 0.0]\n'
    path.write_text(json.dumps({"operations": EVERY[:1]}) if suffix == "json" else toml)
    assert load_edits(path) == EVERY[:1]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.json", "{", "a.json: expected JSON"),
        ("a.toml", "x = ", "a.toml: expected TOML"),
        ("a.json", "[]", "a.json: expected a table"),
        ("a.json", '{"operation": []}', 'expected {"operations"'),
        ("a.json", '{"operations": {}}', 'expected {"operations"'),
        ("a.json", '{"operations": [{"op": "mov"}]}', "a.json: operation 0: unknown op 'mov'"),
        ("a.json", "[" * 100000, "a.json: "),
    ],
)
def test_files_that_are_no_lists_are_refused(name: str, text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=message):
        load_edits(tmp_path / name)


def test_poses_that_are_not_beside_the_list_are_read_from_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, lists = tmp_path / "here", tmp_path / "lists"
    here.mkdir()
    lists.mkdir()
    monkeypatch.chdir(here)
    assert locate("a.obj", lists) == lists / "a.obj"
    for name in ("a.obj", "b.0001.obj"):
        (here / name).touch()
        assert locate(name, lists) == Path(name)
    assert locate("b.####.obj", lists) == Path("b.####.obj")
    assert locate("b.%04d.obj", lists) == Path("b.%04d.obj")
    assert locate("b*.obj", lists) == Path("b*.obj")
    (lists / "a.obj").touch()
    assert locate("a.obj", lists) == lists / "a.obj"


def test_poses_are_read_from_the_folder_of_the_list(tmp_path: Path) -> None:
    clip = bending(12)
    signals = signals_of(clip)
    save(tmp_path / "new.obj", tube(bend=(0.2, 0.9)))
    for i, bends in enumerate([(0, 0), (0.5, 0), (0, 0.5), (0.5, 0.5), (-0.5, 0.5)]):
        save(tmp_path / f"thin{i}.obj", tube(bend=bends))
        save(tmp_path / f"thick{i}.obj", tube(bend=bends, thick=0.3, sides=9))
    notes: list[str] = []
    edited = apply_edits(
        signals,
        [
            {"op": "add_pose", "file": "new.obj", "at": [5.0, 5.0]},
            {
                "op": "replace_shape",
                "source": [f"thin{i}.obj" for i in range(5)],
                "target": [f"thick{i}.obj" for i in range(5)],
                "use": 4,
            },
        ],
        tmp_path,
        notes,
    )
    assert played(edited).shape == (12, 9 * 9 + 2, 3)
    assert notes[0] == "operation 0 (add_pose): the shape signal has 12 components, one of them new"
    assert notes[1].startswith("operation 1 (replace_shape): 4 of 5 pairs used")
