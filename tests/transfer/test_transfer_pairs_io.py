"""Lists of pairs on disk: written and read back, hand-written, foreign, broken."""

from __future__ import annotations

import json
import string
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tempose.transfer import Pairs, load_pairs, save_pairs

KNOWN = "kind, source, target, pairs, part, joints, ends, how, comment"


@pytest.fixture
def write(tmp_path: Path):
    def write_(text: str | bytes, name: str = "pairs.json") -> Path:
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write_


def same(a: Pairs, b: Pairs) -> None:
    assert a.kind == b.kind and a.parts == b.parts and list(a.joints) == list(b.joints)
    assert a.how == b.how and a.comment == b.comment
    assert_array_equal(a.source, b.source)
    assert_array_equal(a.target, b.target)
    for places, others in ((a.joints, b.joints), (a.ends, b.ends)):
        assert list(places) == list(others)
        for name in places:
            assert_allclose(places[name], others[name], rtol=0, atol=0)


@pytest.mark.parametrize(
    "pairs",
    [
        Pairs("vertices", [4, 0, 9], [1, 2, 3]),
        Pairs("faces", [4, 0, 9], [1, 2, 3], ("leg", "ear", 'Öhr, "left"\n')),
        Pairs("joints", ("Hips", "mixamorig:Hips", 'a "b"'), [7, 8, 2**31 - 1]),
        Pairs("faces", [4, 0], [1, 2], how=("picked", "mirror"), comment='left knee was hard\nsee "notes"'),
        Pairs("joints", ("a", "b"), [0, 1], ("p", "q"), {"a": [0.1, 1 / 3, -1e-17]}, {"b": [1, 2, 3]}),
    ],
)
def test_what_is_saved_is_loaded(pairs: Pairs, tmp_path: Path) -> None:
    path = tmp_path / "pairs.json"
    save_pairs(path, pairs, source="walk.bvh", target="scan.obj")
    loaded = load_pairs(path)
    same(pairs, loaded)
    assert loaded.origin == str(path) and loaded.files == ("walk.bvh", "scan.obj")
    again = tmp_path / "again.JSON"
    save_pairs(again, loaded)
    assert again.read_bytes() == path.read_bytes()
    # a person can edit it: one pair a line, the files named
    table = json.loads(path.read_text(encoding="utf-8"))
    assert table["source"] == "walk.bvh" and table["target"] == "scan.obj"
    assert path.read_text(encoding="utf-8").count("\n  [") == len(pairs)


def test_saving_leaves_nothing_half_written(tmp_path: Path, monkeypatch) -> None:
    path = tmp_path / "pairs.json"
    path.write_text("old")

    def full(self: Path, *args: object, **options: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(OSError, match="No space"):
        save_pairs(path, Pairs("faces", [0], [0]))
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_toml_says_the_same_as_json(write) -> None:
    table = {
        "kind": "joints",
        "source": "a.bvh",
        "pairs": [["Hips", 3], ["Head", 4]],
        "part": ["hips", "head"],
        "joints": {"Hips": [0.0, 1.0, 2.5]},
    }
    toml = (
        'kind = "joints"\nsource = "a.bvh"\npairs = [["Hips", 3], ["Head", 4]]\npart = ["hips", "head"]\n'
        "[joints]\nHips = [0.0, 1.0, 2.5]\n"
    )
    same(load_pairs(write(json.dumps(table))), load_pairs(write(toml, "pairs.toml")))


@pytest.mark.parametrize(
    "text",
    ["3\n1, 2\n3, 4\n5, 6\n", "3\r\n1,2\r\n3,4\r\n5,6", "  3 \n\n1 2\n\n 3\t4 \n5 ,6\n\n"],
)
def test_cons_lists(text: str, write) -> None:
    pairs = load_pairs(write(text, "a.cons"))
    assert pairs.kind == "vertices"
    assert_array_equal(pairs.source, [1, 3, 5])
    assert_array_equal(pairs.target, [2, 4, 6])


@pytest.mark.parametrize(
    "text",
    [
        "markers:\n  - 12:30\n  - 1:59\n  - 0:7\n",
        'markers: ["12:30", "1:59", "0:7"]\n',
        "- 12:30\n- 1:59\n- 0:7\n",
        "# comment\nmarkers:\n- 12, 30\n- 1 59\n- ' 0 : 7'\n",
    ],
)
@pytest.mark.parametrize("name", ["m.yml", "m.yaml", "m.YML"])
def test_yaml_markers_are_not_read_in_base_60(text: str, name: str, write) -> None:
    pairs = load_pairs(write(text, name))
    assert_array_equal(pairs.source, [12, 1, 0])
    assert_array_equal(pairs.target, [30, 59, 7])


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.json", "", "line 1 is not JSON"),
        ("a.json", '{"kind": "faces",\n "pairs": [[0, 1]}', "line 2 is not JSON"),
        ("a.json", "[1, 2]", f"expected an object with the keys {KNOWN}, found list"),
        ("a.json", '{"kind": "faces", "pair": [[0, 1]]}', f"unknown key 'pair'; known are {KNOWN}"),
        ("a.json", '{"pairs": [[0, 1]]}', "kind must be one of joints, faces, vertices, found None"),
        ("a.json", '{"kind": ["faces"], "pairs": [[0, 1]]}', "kind must be one of"),
        ("a.json", '{"kind": "faces"}', "pairs must be a list of"),
        ("a.json", '{"kind": "faces", "pairs": []}', "pairs must be a list of"),
        ("a.json", '{"kind": "faces", "pairs": {"0": 1}}', "pairs must be a list of"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1], [2]]}', r"pair 1 must be \[index, index\] from 0"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1.0]]}', "pair 0 must be"),
        ("a.json", '{"kind": "faces", "pairs": [[0, true]]}', "pair 0 must be"),
        ("a.json", '{"kind": "faces", "pairs": [[true, 0]]}', "pair 0 must be"),
        ("a.json", '{"kind": "faces", "pairs": [["0", 1]]}', "pair 0 must be"),
        ("a.json", '{"kind": "faces", "pairs": [[0, -1]]}', "pair 0 must be"),
        ("a.json", '{"kind": "faces", "pairs": [[-2, 1]]}', "pair 0 must be"),
        ("a.json", '{"kind": "joints", "pairs": [[3, 1]]}', r"pair 0 must be \[joint name, face index\]"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1]], "part": ["a", "b"]}', "part must name every one"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1]], "part": "a"}', "part must be a list of names"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1]], "part": 3}', "part must be a list of names"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1]], "joints": [1]}', "joints must"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1]], "joints": {"a": "x"}}', r"joints\['a'\] must"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 1]], "ends": {"a": [1, 2, NaN]}}', "must be finite"),
        ("a.json", '{"kind": "faces", "pairs": [[0, 99999999999999999999999]]}', "indices|integers|index"),
        ("a.json", '{"kind": "faces", "pairs": [[4294967296, 1]]}', "indices"),
        ("a.json", "[" * 100_000, "nested too deep"),
        ("a.toml", "kind = ", "not TOML"),
        ("a.toml", "a = " + "[" * 100_000, "nested too deep|not TOML"),
        ("a.toml", 'kind = "faces"\npairs = [[0, 1979-05-27]]', "pair 0 must be"),
        ("a.cons", "", "line 1 must hold the number of pairs"),
        ("a.cons", "1, 2\n3, 4\n", "line 1 must hold the number of pairs"),
        ("a.cons", "2\n1, 2\n", "line 1 announces 2 pairs, found 1"),
        ("a.cons", "1\n1, 2\n3, 4\n", "line 1 announces 1 pairs, found 2"),
        ("a.cons", "2\n\n1, 2\n3\n", "line 4 must be 'source, target' from 0, found '3'"),
        ("a.cons", "1\n1, 2, 3\n", "line 2 must be"),
        ("a.cons", "1\n-1, 2\n", "line 2 must be"),
        ("a.cons", "1\n1, 2.5\n", "line 2 must be"),
        ("a.cons", "1\nv12, w13\n", "line 2 must be"),
        (
            "a.cons",
            "1\n1, 99999999999999999999999\n",
            "index 99999999999999999999999 is larger than any mesh",
        ),
        ("a.cons", "0\n", "at least one|none"),
        ("a.yml", "", "expected a list under 'markers', found none"),
        ("a.yml", "markers: 3\n", "expected a list under 'markers'"),
        ("a.yml", "other:\n- 1:2\n", "expected a list under 'markers'"),
        ("a.yml", "markers: [\n", "not YAML"),
        ("a.yml", "markers:\n- 1:2:3\n", "marker 0 must be 'source:target' from 0, found '1:2:3'"),
        ("a.yml", "markers:\n- 1:2\n- -1:3\n", "marker 1 must be"),
        ("a.yml", "markers:\n- 1:2\n- {3: 4}\n", "marker 1 must be"),
        ("a.yml", "markers:\n- 1:99999999999999999999999\n", "is larger than any mesh"),
        ("a.yml", "markers: " + "[" * 950, "nested too deep"),
        (
            "a.txt",
            "1, 2\n",
            r"pairs are read from .cons, .json, .toml, .yaml, .yml or .mhw files, got '.txt'",
        ),
        ("pairs", "1, 2\n", "pairs are read from"),
    ],
)
def test_what_is_no_list_of_pairs_is_refused_with_its_place(
    name: str, text: str, message: str, write
) -> None:
    path = write(text, name)
    with pytest.raises(ValueError, match=message) as caught:
        load_pairs(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value) and len(str(caught.value)) < len(str(path)) + 400


def test_a_yaml_bomb_is_refused_at_once(write) -> None:
    levels = [f"l{i}: &l{i} [{', '.join(['*l' + str(i - 1)] * 9)}]" for i in range(1, 30)]
    with pytest.raises(ValueError, match="marker 0 must be"):
        load_pairs(write("l0: &l0 [lol]\n" + "\n".join(levels) + "\nmarkers: [*l29]\n", "bomb.yml"))


def test_a_mark_before_the_text_as_windows_writes_it(write) -> None:
    pairs = load_pairs(write(b"\xef\xbb\xbf" + b'{"kind": "faces", "pairs": [[0, 1]]}'))
    assert_array_equal(pairs.target, [1])
    assert_array_equal(load_pairs(write(b"\xef\xbb\xbf1\n4, 5\n", "a.cons")).target, [5])


def test_binary_files_folders_and_missing_files(write, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="expected a text file of pairs, found binary data"):
        load_pairs(write(bytes(range(256))))
    with pytest.raises(OSError):
        load_pairs(tmp_path)
    with pytest.raises(FileNotFoundError):
        load_pairs(tmp_path / "none.json")


GOOD = {
    ".json": '{"kind": "joints", "source": "", "target": "", "part": ["a", "b"],\n'
    ' "joints": {"Hips": [0.0, 1.0, 2.0]}, "pairs": [["Hips", 3], ["Head", 14]]}',
    ".toml": 'kind = "faces"\npairs = [[0, 3], [2, 14]]\npart = ["a", "b"]\n[ends]\nHips = [0.0, 1.0, 2.0]\n',
    ".cons": "3\n0, 3\n1, 14\n2, 15\n",
    ".yml": "markers:\n  - 0:3\n  - 1:14\n  - '2 15'\n",
}


@st.composite
def mutated(draw: st.DrawFn) -> tuple[str, str]:
    """A good file with some of its characters replaced, doubled or cut out."""
    suffix = draw(st.sampled_from(sorted(GOOD)))
    text = GOOD[suffix]
    alphabet = st.sampled_from(string.printable + "\x00é\u2028\ufeff" + "[]{}:,\"'&*!|>-%@`")
    for _ in range(draw(st.integers(1, 6))):
        at = draw(st.integers(0, len(text)))
        cut = draw(st.integers(0, 6))
        text = text[:at] + draw(st.text(alphabet, max_size=5)) + text[at + cut :]
    return suffix, text


def message_of(path: Path) -> str:
    """What loading a list says: nothing where it could be read. Any other error is a failure."""
    try:
        pairs = load_pairs(path)
    except (ValueError, OSError) as error:
        return str(error)
    assert len(pairs.source) == len(pairs.target) > 0
    return ""


@settings(max_examples=100)
@given(mutated())
def test_damaged_lists_are_read_or_refused(tmp_path_factory, case: tuple[str, str]) -> None:
    suffix, text = case
    path = tmp_path_factory.getbasetemp() / ("fuzz" + suffix)
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    assert message_of(path).startswith(str(path)) or not message_of(path)


@settings(max_examples=30)
@given(st.sampled_from(sorted(GOOD)), st.one_of(st.text(), st.binary()))
def test_any_text_at_all_is_read_or_refused(tmp_path_factory, suffix: str, text: str | bytes) -> None:
    path = tmp_path_factory.getbasetemp() / ("any" + suffix)
    path.write_bytes(text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text)
    assert message_of(path).startswith(str(path)) or not message_of(path)


@settings(max_examples=30)
@given(
    st.lists(st.tuples(st.text(max_size=8), st.integers(0, 2**31 - 1)), min_size=1, max_size=8),
    st.booleans(),
)
def test_any_pairs_come_back(tmp_path_factory, rows: list[tuple[str, int]], named: bool) -> None:
    source = tuple(name.encode("utf-8", "replace").decode() for name, _ in rows)
    pairs = Pairs("joints", source, [t for _, t in rows], source if named else ())
    path = tmp_path_factory.getbasetemp() / "round.json"
    save_pairs(path, pairs)
    same(load_pairs(path), pairs)
