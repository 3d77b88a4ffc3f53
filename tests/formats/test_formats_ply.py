"""PLY and OFF: all encodings agree with one another and with trimesh; headers are not trusted."""

from __future__ import annotations

import struct
import tracemalloc

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, MeshClip
from tempose.formats import FormatError, load, load_clip, load_mesh, ply, save

VERTICES = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0.25]]
POLYGONS = [[0, 1, 2, 3], [3, 2, 4], [0, 3, 4], [0, 1, 2, 4, 3]]
TRIANGLES = [[0, 1, 2], [0, 2, 3], [3, 2, 4], [0, 3, 4], [0, 1, 2], [0, 2, 4], [0, 4, 3]]


def mixed(**extra) -> Mesh:
    return Mesh(VERTICES, TRIANGLES, polygons=[4, 3, 3, 5], name="house", **extra)


def handmade(order: str, polygons: list[list[int]] = POLYGONS, extra: bool = False) -> bytes:
    """PLY written by hand: float positions with a colour between them, faces with a flag after the list."""
    kind = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = (
        f"ply\nformat {kind} 1.0\ncomment made by hand\nelement vertex 5\nproperty float x\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float y\nproperty double z\n"
        f"element face {len(polygons)}\nproperty list uchar int vertex_index\nproperty short flag\n"
        + ("element edge 1\nproperty int a\nproperty int b\n" if extra else "")
        + "end_header\n"
    ).encode()
    rows = [(x, 255, 0, 51, y, z) for x, y, z in VERTICES]
    if order == "":
        body = "".join(" ".join(map(str, row)) + "\n" for row in rows)
        body += "".join(" ".join(map(str, [len(p), *p, -7])) + "\n" for p in polygons)
        return head + (body + "0 1\n" * extra).encode()
    data = b"".join(struct.pack(order + "fBBBfd", *row) for row in rows)
    data += b"".join(struct.pack(f"{order}B{len(p)}ih", len(p), *p, -7) for p in polygons)
    return head + data + struct.pack(order + "ii", 0, 1) * extra


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("extra", [False, True])
def test_every_encoding_gives_the_same_mesh(tmp_path, order, extra):
    (tmp_path / "x.ply").write_bytes(handmade(order, extra=extra))
    mesh = load_mesh(tmp_path / "x.ply")
    assert_array_equal(mesh.vertices, VERTICES)
    assert_array_equal(mesh.faces, TRIANGLES)
    assert_array_equal(mesh.polygons, [4, 3, 3, 5])
    assert_array_equal(mesh.colors, np.tile([1, 0, 0.2], (5, 1)))
    assert mesh.source.format == "ply" and mesh.source.guessed == ("up", "unit")


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_rows_of_equal_length_take_the_fast_way_to_the_same_result(tmp_path, order):
    (tmp_path / "x.ply").write_bytes(handmade(order, TRIANGLES))
    mesh = load_mesh(tmp_path / "x.ply")
    assert_array_equal(mesh.faces, TRIANGLES)
    assert mesh.polygons is None


@pytest.mark.parametrize("text", [False, True])
def test_trimesh_reads_what_we_write_and_we_what_it_writes(tmp_path, text, rng):
    sphere = trimesh.creation.icosphere(subdivisions=1)
    V = sphere.vertices + 1e-3 * rng.standard_normal(sphere.vertices.shape)
    made = Mesh(V, sphere.faces, name="ball")
    (tmp_path / "ours.ply").write_bytes(ply.encoder(made, text=text)(made.vertices))
    theirs = trimesh.load(tmp_path / "ours.ply", process=False)
    assert_array_equal(theirs.vertices, V)
    assert_array_equal(theirs.faces, made.faces)
    encoding = "ascii" if text else "binary"
    (tmp_path / "theirs.ply").write_bytes(theirs.export(file_type="ply", encoding=encoding))
    back = load_mesh(tmp_path / "theirs.ply", unit="m")
    assert_allclose(back.vertices, V, atol=1e-7)
    assert_array_equal(back.faces, made.faces)


@pytest.mark.parametrize("text", [False, True])
@pytest.mark.parametrize("uv", ["vertex", "corner", None])
@pytest.mark.parametrize("bytes_", [True, False])
def test_round_trip_is_exact(tmp_path, rng, text, uv, bytes_):
    extra = {"groups": {"wall": np.array([0, 1]), "roof top": np.array([2, 3]), "all": np.arange(4)}}
    extra["colors"] = rng.integers(0, 256, (5, 3)) / 255 if bytes_ else rng.random((5, 3))
    if uv == "vertex":
        extra["uv"] = rng.random((5, 2))
    if uv == "corner":
        extra |= {"uv": rng.random((15, 2)), "uv_faces": np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [7, 8, 9],
                  [10, 11, 12], [10, 12, 13], [10, 13, 14]])}  # fmt: skip
    made = mixed(**extra)
    (tmp_path / "x.ply").write_bytes(ply.encoder(made, text=text)(made.vertices))
    back = load_mesh(tmp_path / "x.ply", unit="m")
    for key in ("vertices", "faces", "polygons", "colors"):
        assert_array_equal(getattr(back, key), getattr(made, key))
    assert back.name == "house"
    assert {k: v.tolist() for k, v in back.groups.items()} == {k: v.tolist() for k, v in made.groups.items()}
    if uv == "vertex":
        assert_array_equal(back.uv, made.uv)
    if uv == "corner":
        assert_array_equal(back.uv[back.uv_faces], made.uv[made.uv_faces])


def test_long_polygons_get_a_longer_count(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    V = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    disc = Mesh(V, [[0, k, k + 1] for k in range(1, 299)], polygons=[300])
    save(tmp_path / "disc.ply", disc)
    assert_array_equal(load_mesh(tmp_path / "disc.ply").polygons, [300])
    assert_array_equal(load_mesh(tmp_path / "disc.ply").faces, disc.faces)


@pytest.mark.parametrize("change", ["faces", "order", "count"])
def test_frames_are_compared_by_what_they_mean(tmp_path, change):
    made = mixed()
    save(tmp_path / "a.####.ply", MeshClip(np.stack([made.vertices] * 2), made))
    other = tmp_path / "a.0001.ply"
    if change == "order":
        other.write_bytes(handmade(">"))
        assert_array_equal(load(tmp_path).vertices[1], load(tmp_path).vertices[0])
        return
    if change == "faces":
        save(other, Mesh(VERTICES, TRIANGLES[::-1]))
        message = r"a\.0001\.ply: expected the faces of .*a\.0000\.ply"
    else:
        save(other, Mesh([*VERTICES, [0, 0, 1]], TRIANGLES))
        message = r"a\.0001\.ply: has 6 vertices, but .*a\.0000\.ply has 5"
    with pytest.raises(FormatError, match=message):
        load(tmp_path)


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("element", ["vertex 5", "face"])
@pytest.mark.parametrize("polygons", [POLYGONS, TRIANGLES])
def test_a_huge_header_is_refused_before_anything_is_allocated(tmp_path, order, element, polygons):
    stated = element if element == "vertex 5" else f"face {len(polygons)}"
    data = handmade(order, polygons).replace(stated.encode(), stated.split()[0].encode() + b" 99999999999")
    (tmp_path / "x.ply").write_bytes(data)
    tracemalloc.start()
    with pytest.raises(FormatError, match=r"expected 99999999999 rows .* end of the file in row \d"):
        load(tmp_path / "x.ply")
    assert tracemalloc.get_traced_memory()[1] < 10e6
    tracemalloc.stop()


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_every_cut_file_is_refused(tmp_path, order):
    data = handmade(order)
    for end in range(0, len(data) - (2 if order == "" else 0)):
        (tmp_path / "x.ply").write_bytes(data[:end])
        with pytest.raises(FormatError):
            load(tmp_path / "x.ply")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("format ascii 1.0", "format morse 1.0", "line 2: expected format"),
        ("property float x", "property floot x", "line 5: expected format"),
        ("property float x", "property float w", "expected vertices with x, y and z"),
        ("element vertex 5", "element vertex -5", "line 4"),
        ("vertex_index", "indices", "expected faces with vertex_indices"),
        ("format ascii 1.0\n", "", "expected a 'format' line"),
        ("element face 4", "element face 0", "expected faces"),
        ("3 3 2 4 -7", "2 3 2 -7", "3 or more corners, found 2"),
        ("3 3 2 4 -7", "3 3 2 5 -7", "from 0 below 5, found 5.0 in face 1"),
        ("3 3 2 4 -7", "3 3 2 nan -7", "from 0 below 5, found nan in face 1"),
        ("3 3 2 4 -7", "1.5 3 2 4 -7", "list length in row 1 of 'face', found 1.5"),
        ("3 3 2 4 -7", "3 3 2 4 x", "line 21: expected numbers, found '3 3 2 4 x'"),
        ("0.5 255", "nan 255", "finite positions.*vertex 4"),
    ],
)
def test_a_bad_file_names_itself_the_place_and_the_expectation(tmp_path, old, new, message):
    data = handmade("").decode()
    assert old in data
    (tmp_path / "x.ply").write_text(data.replace(old, new))
    with pytest.raises(FormatError, match=message) as caught:
        load(tmp_path / "x.ply")
    assert str(tmp_path / "x.ply") in str(caught.value)
    assert "\n" not in str(caught.value)


OFF = (
    "OFF # house\n5 4 0\n\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 2 .25\n"
    "4 0 1 2 3 255 0 0\n3 3 2 4\n3 0 3 4\n5 0 1 2 4 3\n"
)


def test_off_comes_and_goes(tmp_path):
    (tmp_path / "x.off").write_text(OFF)
    mesh = load_mesh(tmp_path / "x.off")
    assert_array_equal(mesh.vertices, VERTICES)
    assert_array_equal(mesh.faces, TRIANGLES)
    save(tmp_path / "y.off", mesh)
    back = load_mesh(tmp_path / "y.off")
    assert_array_equal(back.vertices, VERTICES)
    assert_array_equal(back.polygons, [4, 3, 3, 5])
    save(tmp_path / "z.off", Mesh(VERTICES, TRIANGLES))
    theirs = trimesh.load(tmp_path / "z.off", process=False)
    assert_array_equal(theirs.vertices, VERTICES)
    assert_array_equal(theirs.faces, TRIANGLES)


def test_off_with_colours(tmp_path):
    (tmp_path / "x.off").write_text(
        "COFF\n3 1 0\n0 0 0 255 0 51 255\n1 0 0 0 0 0 0\n0 1 0 0 0 0 0\n3 0 1 2\n"
    )
    assert_array_equal(load_mesh(tmp_path / "x.off").colors, [[1, 0, 0.2], [0, 0, 0], [0, 0, 0]])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("OFF", "ON", "expected an OFF mesh"),
        (
            "5 4 0",
            "5 4000000000 0",
            "expected 5 vertices and 4000000000 faces as its header says, found 9 rows",
        ),
        ("5 4 0", "nan 4 0", "expected counts"),
        ("5 4 0", "5 0 0", "expected counts"),
        ("1 1 0", "1 inf 0", "finite positions.*vertex 2"),
        ("1 1 0", "1 1", "3 numbers in vertex 2"),
        ("3 3 2 4", "3 3 2", "corners in face 1"),
        ("3 3 2 4", "2 3 2", "corners in face 1"),
        ("3 3 2 4", "3 3 2 9", "below 5, found 9 in face 1"),
        ("3 3 2 4", "3 3 2 y", "expected numbers after 'OFF', found 'y'"),
    ],
)
def test_a_bad_off_names_the_place(tmp_path, old, new, message):
    (tmp_path / "x.off").write_text(OFF.replace(old, new))
    with pytest.raises(FormatError, match=message):
        load(tmp_path / "x.off")


@pytest.mark.real
@pytest.mark.parametrize("suffix", ["ply", "npz"])
def test_two_formats_of_one_clip_agree(data_folder, tmp_path, suffix):
    clip = load_clip(data_folder("horse-gallop"))
    clip = MeshClip(clip.vertices[:6], clip.mesh, 24, clip.source)
    name = "gallop.####.ply" if suffix == "ply" else "gallop.npz"
    save(tmp_path / name, clip)
    back = load_clip(tmp_path / name, fps=24)
    assert_array_equal(back.vertices, clip.vertices)
    assert_array_equal(back.faces, clip.faces)
