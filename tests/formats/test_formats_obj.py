"""OBJ: every notation gives the same mesh, and what is written reads back exactly."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from tempose.clips import Mesh, MeshClip, Source
from tempose.formats import UNITS, FormatError, load, load_clip, load_mesh, save
from tempose.formats._number_kernel import read_floats
from tempose.formats._numbers import NumberError, parse_floats, split_lines, tokens_per_line
from tempose.formats._place import inside, outside

CUBE_CORNERS = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def write(folder: Path, text: str | bytes, name: str = "x.obj") -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def cube(**extra) -> Mesh:
    faces = [f for a, b, c, d in QUADS for f in ([a, b, c], [a, c, d])]
    return Mesh(np.array(CUBE_CORNERS, float), faces, polygons=np.full(6, 4), name="cube", **extra)


def assert_same_mesh(a: Mesh, b: Mesh) -> None:
    assert_array_equal(a.vertices, b.vertices)
    assert_array_equal(a.faces, b.faces)
    for key in ("uv", "uv_faces", "colors", "polygons"):
        x, y = getattr(a, key), getattr(b, key)
        assert (x is None) == (y is None), key
        if x is not None:
            assert_array_equal(x, y)
    assert dict.fromkeys(a.groups) == dict.fromkeys(b.groups)
    for name in a.groups:
        assert_array_equal(a.groups[name], b.groups[name])
    assert a.name == b.name


VERTICES = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
TEXTURE = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
NORMAL = "vn 0 0 1\n"


@pytest.mark.parametrize(
    ("face", "uv"),
    [
        ("f 1 2 3 4", None),
        ("f 1//1 2//1 3//1 4//1", None),
        ("f 1/4 2/3 3/2 4/1", [3, 2, 1, 0]),
        ("f 1/4/1 2/3/1 3/2/1 4/1/1", [3, 2, 1, 0]),
        ("f -4 -3 -2 -1", None),
        ("f -4/-1/-1 -3/-2/-1 -2/-3/-1 -1/-4/-1", [3, 2, 1, 0]),
        ("f 1/4 2/3/1 3/2 4/1/1", [3, 2, 1, 0]),
        ("f 1 2//1 3 4//1", None),
        ("f 1/ 2/ 3/ 4/", None),
        ("  f\t1/4  2/3  3/2\t4/1  \r", [3, 2, 1, 0]),
        ("f 1/4 2/3 \\\n 3/2 4/1", [3, 2, 1, 0]),
        ("f 1/4 2/3 3/2 4/1 # a comment 5/5", [3, 2, 1, 0]),
    ],
)
def test_every_notation_of_a_corner_gives_the_same_quad(tmp_path, face, uv):
    mesh = load_mesh(write(tmp_path, VERTICES + TEXTURE + NORMAL + face + "\n"))
    assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3]])
    assert_array_equal(mesh.polygons, [4])
    if uv is None:
        assert mesh.uv is None and mesh.uv_faces is None
    else:
        assert_array_equal(mesh.uv_faces, [[uv[0], uv[1], uv[2]], [uv[0], uv[2], uv[3]]])
        assert_array_equal(mesh.uv, [[0, 0], [1, 0], [1, 1], [0, 1]])


def test_negative_indices_count_back_from_their_own_line(tmp_path):
    text = VERTICES + "f -4 -3 -2\nv 5 5 5\nf -1 -2 -3\nf 1 2 5\n"
    assert_array_equal(load_mesh(write(tmp_path, text)).faces, [[0, 1, 2], [4, 3, 2], [0, 1, 4]])


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("last", [True, False])
def test_line_ends_do_not_matter(tmp_path, end, last):
    text = "# head\n" + VERTICES + "\n   \ng a\nf 1 2 3\nf 1 3 4"
    mesh = load_mesh(write(tmp_path, text.replace("\n", end) + end * last))
    assert_array_equal(mesh.faces, [[0, 1, 2], [0, 2, 3]])
    assert_array_equal(mesh.groups["a"], [0, 1])


def test_corners_without_texture_get_one_coordinate_of_their_own(tmp_path):
    mesh = load_mesh(write(tmp_path, VERTICES + TEXTURE + "f 1/2 2/3 3/4\nf 1 3 4\n"))
    assert_array_equal(mesh.uv_faces, [[1, 2, 3], [4, 4, 4]])
    assert_array_equal(mesh.uv[4], [0, 0])
    assert any("texture" in note for note in mesh.source.notes)


def test_colours_weights_and_mixed_rows(tmp_path):
    faces = "f 1 2 3\n"
    coloured = load_mesh(write(tmp_path, "v 0 0 0 1 0 .5\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n" + faces))
    assert_array_equal(coloured.colors, [[1, 0, 0.5], [0, 1, 0], [0, 0, 1]])
    weighted = load_mesh(write(tmp_path, "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\n" + faces))
    assert weighted.colors is None
    assert_array_equal(weighted.vertices, coloured.vertices)
    mixed = load_mesh(write(tmp_path, "v 0 0 0 1 0 .5\nv 1 0 0\nv 0 1 0 1\n" + faces))
    assert mixed.colors is None
    assert_array_equal(mixed.vertices, coloured.vertices)


def test_groups_may_overlap_end_and_come_back(tmp_path):
    text = VERTICES + "f 1 2 3\ng a b\nf 1 2 3 4\ng b\nf 1 2 4\ng\nf 2 3 4\ng a\nf 1 3 4\ng empty\n"
    groups = load_mesh(write(tmp_path, text)).groups
    assert {k: v.tolist() for k, v in groups.items()} == {"a": [1, 2, 5], "b": [1, 2, 3]}


def test_objects_and_materials_are_groups_only_without_groups(tmp_path):
    body = "o left arm\nusemtl skin\nf 1 2 3\no head\nf 1 3 4\n"
    groups = load_mesh(write(tmp_path, VERTICES + body)).groups
    assert {k: v.tolist() for k, v in groups.items()} == {"left arm": [0], "head": [1], "skin": [0, 1]}
    assert list(load_mesh(write(tmp_path, VERTICES + "g only\n" + body)).groups) == ["only"]


@pytest.mark.parametrize("unit", ["m", "dm", "in", 0.37])
@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_round_trip_is_exact_in_any_unit_and_axis(tmp_path, rng, unit, up):
    extra = {"colors": rng.random((8, 3)), "uv": rng.random((5, 2)), "uv_faces": rng.integers(0, 5, (12, 3))}
    extra["uv_faces"][1::2, 0] = extra["uv_faces"][::2, 0]
    extra["uv_faces"][1::2, 1] = extra["uv_faces"][::2, 2]
    made = cube(**extra, groups={"a": np.arange(4), "b": np.array([2, 3, 8, 9])})
    save(tmp_path / "made.obj", made.with_vertices(rng.standard_normal((8, 3))), up=up, unit=unit)
    first = load_mesh(tmp_path / "made.obj", up=up, unit=unit)
    save(tmp_path / "again.obj", first)
    assert_same_mesh(load_mesh(tmp_path / "again.obj", up=up, unit=unit), first)
    save(tmp_path / "again.npz", first)
    assert_same_mesh(load_mesh(tmp_path / "again.npz"), first)
    assert first.source.guessed == ()


def decimals(rng, n: int) -> list[str]:
    """Decimal numbers of every length, some of them next to the middle between two doubles."""
    a = 10.0 ** rng.integers(-9, 9, n) * rng.standard_normal(n)
    words = [f"{x:.{d}{kind}}" for x, d, kind in zip(a, rng.integers(0, 22, n), rng.choice(list("efg"), n))]
    x = rng.uniform(0.5, 4, n)
    middle = [(Fraction(p) + Fraction(q)) / 2 for p, q in zip(x.tolist(), np.nextafter(x, 9).tolist())]
    words += [f"{m.numerator * 10**18 // m.denominator}e-18" for m in middle]
    words += [str(m.numerator // (m.denominator >> 40)) + f"e{k % 40 - 30}" for k, m in enumerate(middle)]
    words += [str(2**53 + k) for k in range(9)] + [f"{2**52 + k}.5" for k in range(9)]
    odd = ["0", "-0", "+1.5", ".5", "5.", "1E5", "1e-400", "123456789012345678901234567890.5", "9" * 18]
    return words + odd


@pytest.mark.parametrize("unit", [*UNITS.values(), 0.37, 3.0])
@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_what_came_from_a_file_goes_back_to_the_same_numbers(rng, unit, up):
    V = inside(rng.standard_normal((20_000, 3)), Source(up=up, unit=unit), "x")
    assert_array_equal(inside(outside(V, up, unit), Source(up=up, unit=unit), "x"), V)


def test_a_polygon_is_in_a_group_if_its_first_triangle_is(tmp_path):
    save(tmp_path / "x.obj", cube(groups={"first": [0, 2, 3], "second": [1, 5]}))
    groups = load_mesh(tmp_path / "x.obj").groups
    assert {k: v.tolist() for k, v in groups.items()} == {"first": [0, 1, 2, 3]}


@pytest.mark.parametrize("reader", [parse_floats, read_floats])
def test_numbers_are_those_of_python_to_the_last_bit(reader, rng):
    words = decimals(rng, 4000)
    assert_array_equal(reader(" ".join(words).encode()), [float(word) for word in words])
    assert np.signbit(reader(b"-0 -0.0e5 0\n")).tolist() == [True, True, False]
    assert reader(b" \n ").shape == (0,)


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False).map(repr), min_size=1, max_size=12))
def test_numbers_of_any_size_are_those_of_python(words):
    for reader in (parse_floats, read_floats):
        assert_array_equal(reader("\n".join(words).encode()), [float(word) for word in words])


@given(st.text(alphabet="ab \t\r\n", max_size=60))
def test_words_and_lines_are_those_of_python(text):
    data = split_lines(text.encode()).data
    lines = data.split(b"\n")[:-1]
    assert tokens_per_line(data).tolist() == [len(line.split()) for line in lines]


@pytest.mark.parametrize("word", ["1,5", "0x10", "1e", "--1", "1-2", "v", "1.2.3"])
def test_words_that_are_no_numbers_are_refused(word):
    with pytest.raises(NumberError):
        parse_floats(f"1 2 {word} 3".encode())
    assert read_floats(f"1 2 {word} 3".encode()) is None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty file"),
        ("\n\n", "empty file"),
        ("hello\nworld\n", "no vertices"),
        (VERTICES, "no faces"),
        ("v 0 0\n" + VERTICES + "f 1 2 3\n", "line 1: expected vertex"),
        (VERTICES + "v 0 nan 0\nf 1 2 3\n", "line 5: expected vertex"),
        (VERTICES + "v 0 1e999 0\nf 1 2 3\n", "line 5: expected vertex"),
        (VERTICES + "v 0 abc 0\nf 1 2 3\n", "line 5: expected vertex.*'v 0 abc 0'"),
        (VERTICES + "f 1 2\n", "line 5: expected a face of 3"),
        (VERTICES + "f 1 2 5\n", "line 5: refers to vertex 5, the file has 4"),
        (VERTICES + "f 1 2 -5\n", "line 5: refers to vertex -5"),
        (VERTICES + "f 0 1 2\n", "line 5: expected corners"),
        (VERTICES + "f 1 2 x\n", "line 5: expected corners.*'x'"),
        (VERTICES + "f 1/1 2/1 3/1\n", "line 5: refers to texture vertex 1, the file has 0"),
        (VERTICES + "f 1/1/1/1 2 3\n", "line 5: expected corners"),
        (VERTICES + "f 1 2 99999999999999999999\n", "line 5"),
        (VERTICES + "v 1e35 0 0\nf 1 2 3\n", "below 1e30"),
        (b"\x89PNG\r\n\x1a\n\0\0\0", "a PNG picture"),
        (b"glTF\x02\0\0\0", "a binary glTF"),
        (b"v 0 0 0\n\0\0", "binary data"),
        (b"ply\nformat ascii 1.0\n", "a PLY mesh"),
    ],
)
def test_a_bad_file_names_itself_the_place_and_the_expectation(tmp_path, text, message):
    path = write(tmp_path, text)
    with pytest.raises(FormatError, match=message) as caught:
        load(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def frames_of(rng, T: int = 12) -> MeshClip:
    base = cube(groups={"top": np.arange(2)})
    vertices = (base.vertices + rng.standard_normal((T, 8, 3)).cumsum(axis=0)).astype(np.float32)
    return MeshClip(vertices, base.with_vertices(vertices[0]), fps=24)


@pytest.mark.parametrize("suffix", ["obj", "ply", "off"])
@pytest.mark.parametrize("unit", ["m", "cm"])
def test_a_clip_of_frames_comes_back_exactly_in_natural_order(tmp_path, rng, suffix, unit):
    clip = frames_of(rng)
    save(tmp_path / f"run.#.{suffix}", clip, unit=unit, up="z")
    assert sorted(p.name for p in tmp_path.iterdir())[1] == f"run.1.{suffix}"  # then 10, as text sorts
    for path in (f"run.#.{suffix}", f"run.%d.{suffix}", f"run.*.{suffix}", ""):
        back = load_clip(tmp_path / path, unit=unit, up="z", fps=24)
        assert_array_equal(back.vertices, clip.vertices)
        assert_array_equal(back.faces, clip.faces)
        assert_array_equal(back.mesh.polygons, clip.mesh.polygons)
        assert back.fps == 24 and back.source.guessed == ()
    assert_array_equal(load_mesh(tmp_path, unit=unit, up="z").vertices, back.rest)


def test_a_folder_of_frames_replaces_frames_only(tmp_path, rng):
    clip = frames_of(rng)
    save(tmp_path / "out", clip)
    save(tmp_path / "out", MeshClip(clip.vertices[:3], clip.mesh))
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [f"frame_000{t}.obj" for t in range(3)]
    (tmp_path / "out" / "diary.txt").write_text("mine")
    with pytest.raises(FormatError, match=r"diary\.txt"):
        save(tmp_path / "out", clip)
    save(tmp_path / "out" / "frame_####.obj", clip)
    assert len(list((tmp_path / "out").iterdir())) == 13
    save(tmp_path / "out" / "frame_####.obj", MeshClip(clip.vertices[:2], clip.mesh))
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "diary.txt", "frame_0000.obj", "frame_0001.obj",
    ]  # fmt: skip


@pytest.mark.parametrize("target", ["out", "out/a.####.obj", "a.####.obj", "a.####.ply", "a.obj", "a.npz"])
def test_a_writer_that_fails_leaves_nothing(tmp_path, rng, monkeypatch, target):
    clip = frames_of(rng)
    thing = clip if "#" in target or target in ("out", "a.npz") else clip.mesh
    real, calls = Path.write_bytes, []

    def full_disk(self, data):
        calls.append(self)
        if len(calls) == 4 or thing is clip.mesh:
            raise OSError(28, "No space left on device")
        return real(self, data)

    def full_archive(stream, array, **options):
        stream.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full_disk)
    monkeypatch.setattr(np.lib.format, "write_array", full_archive)
    with pytest.raises(OSError, match="No space"):
        save(tmp_path / target, thing)
    assert list(tmp_path.iterdir()) == []


def test_frames_of_other_topology_name_both_files(tmp_path):
    write(tmp_path, VERTICES + "f 1 2 3\n", "a1.obj")
    write(tmp_path, VERTICES + "v 1 1 1\nf 1 2 3\n", "a2.obj")
    with pytest.raises(FormatError, match=r"a2\.obj: has 5 vertices, but .*a1\.obj has 4"):
        load(tmp_path)
    write(tmp_path, VERTICES + "f 1 2 3\nf 1 3 4\n", "a2.obj")
    with pytest.raises(FormatError, match=r"a2\.obj: has 2 faces, but .*a1\.obj has 1"):
        load(tmp_path)
    write(tmp_path, VERTICES + "f 1 2 4\n", "a2.obj")
    with pytest.raises(FormatError, match=r"a2\.obj: expected the faces of .*a1\.obj"):
        load(tmp_path)


def test_frames_may_write_equal_faces_in_other_words(tmp_path):
    write(tmp_path, VERTICES + "f 1 2 3\n", "a1.obj")
    write(tmp_path, NORMAL + "f 1//1 2//1 -2//1\n" + VERTICES.replace("1", "2"), "a2.obj")
    with pytest.raises(FormatError, match="line 2: refers to vertex -2"):
        load(tmp_path)
    write(tmp_path, NORMAL + VERTICES.replace("1", "2") + "f 1//1 2//1 -2//1\n", "a2.obj")
    assert_array_equal(load(tmp_path).vertices[1], 2 * load(tmp_path).vertices[0])


def test_gaps_in_the_numbers_are_noted(tmp_path):
    for k in (1, 2, 5):
        write(tmp_path, VERTICES + "f 1 2 3\n", f"f_{k:03d}.obj")
    source = load(tmp_path).source
    assert source.notes == ("2 of the frames 1 to 5 are missing",)
    assert source.guessed == ("up", "unit", "fps")


def test_hidden_files_of_a_folder_are_no_frames(tmp_path):
    write(tmp_path, VERTICES + "f 1 2 3\n", "a1.obj")
    write(tmp_path, b"\0\5\x16\7", "._a1.obj")
    assert load(tmp_path).n_frames == 1


@pytest.mark.real
def test_makehuman_body_is_the_first_13380_vertices(data_folder):
    path = data_folder("makehuman-base") / "base.obj"
    whole, body = load_mesh(path), load_mesh(path, group="body")
    assert (len(whole.vertices), len(whole.polygons)) == (19158, 18486)
    assert_array_equal(body.vertices, whole.vertices[:13380])
    assert_array_equal(body.faces, whole.faces[:26756])
    assert len(body.polygons) == 13378
    assert body.source.unit == 0.1 and 1.6 < body.height < 1.7
    assert_array_equal(body.uv[body.uv_faces], whole.uv[whole.uv_faces[:26756]])
    with pytest.raises(FormatError, match="closest: body") as caught:
        load_mesh(path, group="bodi")
    assert len(str(caught.value)) < 300


@pytest.mark.real
def test_makehuman_round_trip_is_exact(data_folder, tmp_path):
    whole = load_mesh(data_folder("makehuman-base") / "base.obj")
    save(tmp_path / "base.obj", whole)
    assert_same_mesh(load_mesh(tmp_path / "base.obj"), whole)


@pytest.mark.real
def test_gallop_equals_its_frames_and_python(data_folder):
    folder = data_folder("horse-gallop")
    clip = load(folder)
    assert clip.vertices.shape == (48, 8431, 3) and clip.faces.shape == (16843, 3)
    lines = (folder / "0031.obj").read_text().splitlines()
    V = [[float(word) for word in line.split()[1:]] for line in lines if line.startswith("v ")]
    F = [[int(word) - 1 for word in line.split()[1:]] for line in lines if line.startswith("f ")]
    assert_array_equal(clip.vertices[30], np.array(V, np.float32))
    assert_array_equal(clip.faces, F)
    assert_array_equal(load_mesh(folder / "0031.obj").vertices, V)
