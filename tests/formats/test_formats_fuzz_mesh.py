"""Damaged files: every mesh reader gives a valid object or one clear line, and never much memory."""

from __future__ import annotations

import functools
import re
import resource
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tempose.clips import Mesh, MeshClip
from tempose.clips.mesh_parts import keep_faces
from tempose.formats import FormatError, load, load_mesh, ply, save

KINDS = ["obj", "text.ply", "ply", "big.ply", "off", "npz", "npy"]
WORDS = [
    *(b"", b"-", b"/", b"//", b"1/1", b"#", b"\\\n", b"f", b"v", b"list", b"x" * 99, b"nan", b"inf"),
    *(b"0", b"-1", b"1", b"3", b"4", b"65536", b"2147483647", b"-2147483649", b"99999999999999999999"),
    *(b"1e308", b"1e-320", b"1e999"),
]
NUMBER = re.compile(rb"-?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?")


@functools.cache
def small_mesh(origin: str, root: Path | None) -> Mesh:
    if root is None:
        rng = np.random.default_rng(5)
        return Mesh(
            rng.random((9, 3)).round(3),
            [[0, 1, 2], [0, 2, 3], [3, 4, 5], [5, 6, 7], [5, 7, 8]],
            uv=rng.random((4, 2)).round(3),
            uv_faces=[[0, 1, 2], [0, 2, 3], [1, 2, 3], [3, 2, 1], [3, 1, 0]],
            colors=rng.integers(0, 256, (9, 3)) / 255,
            groups={"left arm": [0, 1], "all": np.arange(5)},
            polygons=[4, 3, 4],
            name="made",
        )
    whole = load_mesh(root / origin)
    return keep_faces(whole, np.arange(len(whole.faces)) < 40)[0]


@functools.cache
def seed(kind: str, origin: str, root: Path | None = None) -> bytes:
    """Bytes of a small intact file of one kind, made from the head of a real mesh."""
    mesh = small_mesh(origin, root)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"x.{kind}"
        if kind in ("npz", "npy"):
            save(path, MeshClip(np.stack([mesh.vertices] * 2), mesh, source=mesh.source))
        elif kind == "text.ply":
            path.write_bytes(ply.encoder(mesh, text=True)(mesh.vertices))
        elif kind == "big.ply":
            path.write_bytes(big_endian(mesh))
        else:
            save(path, mesh)
        return path.read_bytes()


def big_endian(mesh: Mesh) -> bytes:
    head = (
        f"ply\nformat binary_big_endian 1.0\nelement vertex {len(mesh.vertices)}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(mesh.faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    rows = np.zeros(len(mesh.faces), [("n", "u1"), ("v", ">i4", (3,))])
    rows["n"], rows["v"] = 3, mesh.faces
    return head + mesh.vertices.astype(">f4").tobytes() + rows.tobytes()


@st.composite
def damage(draw: st.DrawFn) -> list[tuple[str, float, float, object]]:
    place = st.floats(0, 1, exclude_max=True)
    kinds = st.sampled_from(["flip", "cut", "drop", "twice", "word", "insert", "line"])
    payload = st.one_of(
        st.sampled_from(WORDS), st.binary(max_size=6), st.integers(-5, 2**40).map(lambda n: b"%d" % n)
    )
    return draw(st.lists(st.tuples(kinds, place, place, payload), min_size=1, max_size=5))


def apply(data: bytes, steps: list[tuple[str, float, float, bytes]]) -> bytes:
    for kind, a, b, payload in steps:
        i = int(a * len(data))
        j = min(len(data), i + int(b * 60))
        if kind == "flip" and data:
            data = data[:i] + bytes([data[i] ^ (1 + int(b * 255))]) + data[i + 1 :]
        elif kind == "cut":
            data = data[:i]
        elif kind == "drop":
            data = data[:i] + data[j:]
        elif kind == "twice":
            data = data[:j] + data[i:j] * (1 + int(b * 4)) + data[j:]
        elif kind == "insert":
            data = data[:i] + payload + data[i:]
        elif kind == "word":
            found = list(NUMBER.finditer(data))
            if found:
                spot = found[int(a * len(found))]
                data = data[: spot.start()] + payload + data[spot.end() :]
        elif kind == "line":
            lines = data.split(b"\n")
            lines[int(a * len(lines))], lines[int(b * len(lines))] = (
                lines[int(b * len(lines))],
                lines[int(a * len(lines))],
            )
            data = b"\n".join(lines)
    return data


def check(folder: Path, kind: str, data: bytes, topology: Mesh) -> None:
    path = folder / f"x.{kind}"
    path.write_bytes(data)
    loaded, message = load_or_message(path, topology)
    if loaded is None:
        assert str(path) in message
        assert "\n" not in message and len(message) < 600
        return
    mesh = loaded.mesh if isinstance(loaded, MeshClip) else loaded
    assert len(mesh.faces) and np.isfinite(loaded.vertices).all()
    assert mesh.faces.min() >= 0 and mesh.faces.max() < len(mesh.vertices)


def load_or_message(path: Path, topology: Mesh | None = None) -> tuple[Mesh | MeshClip | None, str]:
    try:
        return load(path, topology=topology), ""
    except FormatError as error:
        return None, str(error)


def peak_bytes() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def run(kind: str, origin: str, folder: Path, steps, root: Path | None = None) -> None:
    data, topology = seed(kind, origin, root), small_mesh(origin, root)
    before = peak_bytes()
    check(folder, kind, apply(data, steps), topology)
    assert peak_bytes() - before < 300e6


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("fuzz")


@pytest.mark.parametrize("kind", KINDS)
def test_intact_seeds_load(kind, folder):
    check(folder, kind, seed(kind, "made"), small_mesh("made", None))
    assert load(folder / f"x.{kind}", topology=small_mesh("made", None)).vertices.shape[-2:] == (9, 3)


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=100)
@given(steps=damage())
def test_a_damaged_file_is_read_or_refused(kind, folder, steps):
    run(kind, "made", folder, steps)


@pytest.mark.real
@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=40)
@given(steps=damage())
def test_a_damaged_real_file_is_read_or_refused(kind, folder, data_folder, steps):
    run(kind, "base.obj", folder, steps, data_folder("makehuman-base"))


@pytest.mark.real
@settings(max_examples=40)
@given(steps=damage())
def test_a_damaged_export_of_another_program_is_read_or_refused(folder, data_folder, steps):
    data = (data_folder("point-cache-pc2") / "max_cache_box_44.obj").read_bytes()
    check(folder, "obj", apply(data, steps), small_mesh("made", None))


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=40)
@given(data=st.binary(max_size=300))
def test_garbage_is_refused(kind, folder, data):
    head = {"obj": b"v ", "off": b"OFF ", "npz": b"PK\x03\x04", "npy": b"\x93NUMPY\1\0"}.get(kind, b"ply\n")
    for prefix in (b"", head):
        check(folder, kind, prefix + data, small_mesh("made", None))


@settings(max_examples=40)
@given(steps=damage(), kind=st.sampled_from(["obj", "ply", "off"]))
def test_a_damaged_frame_of_a_sequence_is_read_or_refused(folder, steps, kind):
    data = seed(kind, "made")
    frames = folder / f"frames_{kind}"
    frames.mkdir(exist_ok=True)
    (frames / f"0.{kind}").write_bytes(data)
    (frames / f"1.{kind}").write_bytes(apply(data, steps))
    clip, message = load_or_message(frames)
    if clip is None:
        assert str(frames) in message
    else:
        assert clip.vertices.shape == (2, 9, 3) and np.isfinite(clip.vertices).all()
