"""Numpy archives: exact both ways, never unpickled, sizes in headers not trusted."""

from __future__ import annotations

import io
import pickle
import tracemalloc
import zipfile

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tempose.clips import Mesh, MeshClip, Source
from tempose.formats import FormatError, load, load_clip, load_mesh, save

V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.5]])
F = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32)


def moving(rng, T: int = 5, **extra) -> MeshClip:
    frames = (V + 0.1 * rng.standard_normal((T, 4, 3))).astype(np.float32)
    return MeshClip(
        frames, Mesh(V, F, name="tet", **extra), fps=23.976, source=Source(up="z", unit=0.01, fps=120)
    )


def test_round_trip_is_exact_and_guesses_nothing(tmp_path, rng):
    extra = {"uv": rng.random((6, 2)), "uv_faces": rng.integers(0, 6, (4, 3)), "colors": rng.random((4, 3))}
    clip = moving(rng, **extra, groups={"a/b c": np.array([0, 3]), "ü": np.array([1])})
    save(tmp_path / "x.npz", clip)
    back = load(tmp_path / "x.npz")
    assert isinstance(back, MeshClip)
    assert_array_equal(back.vertices, clip.vertices)
    assert_array_equal(back.rest, clip.rest)
    assert_array_equal(back.faces, F)
    for key, value in extra.items():
        assert_array_equal(getattr(back.mesh, key), value)
    assert {k: v.tolist() for k, v in back.mesh.groups.items()} == {"a/b c": [0, 3], "ü": [1]}
    assert (back.fps, back.name) == (23.976, "tet")
    assert (back.source.up, back.source.unit, back.source.fps, back.source.guessed) == ("z", 0.01, 120, ())


def test_arrays_lie_in_the_axes_and_unit_of_the_source(tmp_path, rng):
    clip = moving(rng)
    save(tmp_path / "x.npz", clip)
    with np.load(tmp_path / "x.npz", allow_pickle=False) as arrays:
        assert_array_equal(arrays["faces"], F)
        x, y, z = clip.vertices.astype(np.float64).transpose(2, 0, 1) * 100
        np.testing.assert_allclose(arrays["vertices"], np.stack([x, -z, y], axis=2), rtol=1e-12)
    save(tmp_path / "x.npz", clip, up="y", unit="m")
    with np.load(tmp_path / "x.npz", allow_pickle=False) as arrays:
        assert_array_equal(arrays["vertices"], clip.vertices)
        assert arrays["vertices"].dtype == np.float32


def test_a_foreign_archive_needs_vertices_and_faces_only(tmp_path):
    np.savez(tmp_path / "x.npz", vertices=np.stack([V, V]) * 100, faces=F)
    clip = load(tmp_path / "x.npz")
    assert clip.source.guessed == ("up", "unit", "fps") and clip.source.unit == 0.01 and clip.fps == 30
    clip = load(tmp_path / "x.npz", fps=60, up="z", unit="mm")
    assert clip.source.guessed == () and clip.source.unit == 0.001 and clip.fps == 60
    np.savez_compressed(tmp_path / "y.npz", vertices=V, faces=F)
    assert isinstance(load(tmp_path / "y.npz"), Mesh)
    assert load_clip(tmp_path / "y.npz").n_frames == 1


def test_arrays_of_other_names_are_left_alone(tmp_path):
    objects = np.array([Bomb()], dtype=object)
    np.savez(tmp_path / "x.npz", vertices=V, faces=F, meta=objects)
    assert_array_equal(load_mesh(tmp_path / "x.npz").faces, F)


def test_the_same_clip_gives_the_same_bytes(tmp_path, rng):
    clip = moving(rng)
    save(tmp_path / "a.npz", clip)
    save(tmp_path / "b.npz", clip)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_fortran_order_and_integers_are_read(tmp_path):
    frames = np.stack([V, 2 * V, 3 * V])
    np.savez(
        tmp_path / "x.npz", vertices=np.asfortranarray(frames), faces=np.asfortranarray(F.astype(np.uint64))
    )
    assert_array_equal(load(tmp_path / "x.npz", unit="m").vertices, frames)
    assert_array_equal(load(tmp_path / "x.npz", unit="m").faces, F)


def test_npy_takes_faces_from_its_topology(tmp_path, rng):
    clip = moving(rng)
    save(tmp_path / "t.obj", clip.mesh, up="z", unit="cm")
    save(tmp_path / "x.npy", clip)
    with pytest.raises(FormatError, match="topology"):
        load(tmp_path / "x.npy")
    topology = load_mesh(tmp_path / "t.obj", up="z", unit="cm")
    back = load(tmp_path / "x.npy", topology=topology, fps=24)
    assert_array_equal(back.vertices, clip.vertices)
    assert_array_equal(back.rest, topology.vertices)
    assert back.source.guessed == () and back.fps == 24
    assert_array_equal(load(tmp_path / "x.npy", topology=tmp_path / "t.obj").faces, F)
    with pytest.raises(FormatError, match="has 4 vertices, the topology given has 3"):
        load(tmp_path / "x.npy", topology=Mesh(V[:3], F[:1]))


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"faces": F}, "expected arrays 'vertices' and 'faces', found 'faces'"),
        ({"vertices": V, "triangles": F}, "found 'vertices', 'triangles'"),
        ({"vertices": V[:, :2], "faces": F}, r"\(4, 2\)"),
        ({"vertices": np.zeros((0, 4, 3)), "faces": F}, "at least one frame"),
        ({"vertices": np.zeros((2, 0, 3)), "faces": F}, "at least one frame and vertex"),
        ({"vertices": V, "faces": F[:0]}, "expected faces"),
        ({"vertices": V, "faces": F + 1}, "below 4, got 4"),
        ({"vertices": V, "faces": F - 1}, "got -1"),
        ({"vertices": V, "faces": F[:, :2]}, r"faces must have shape \(m, 3\)"),
        ({"vertices": V, "faces": F.astype(float)}, "integers"),
        ({"vertices": V.astype(str), "faces": F}, "found <U"),
        ({"vertices": V + 1j, "faces": F}, "complex"),
        ({"vertices": np.where(V == 1.5, np.nan, V), "faces": F}, r"nan at index \(3, 2\)"),
        ({"vertices": V[None], "faces": F, "fps": 0.0}, "positive number as 'fps'"),
        ({"vertices": V[None], "faces": F, "fps": "fast"}, "positive number as 'fps'"),
        ({"vertices": V, "faces": F, "unit": [1.0, 2.0]}, "positive number as 'unit'"),
        ({"vertices": V, "faces": F, "up": "w"}, "up must be x, y or z"),
        ({"vertices": V[None], "faces": F, "rest": V[:3]}, "below 3"),
        ({"vertices": V[None, :3], "faces": F[:1], "rest": V}, r"shape \(T, 4, 3\)"),
    ],
)
def test_a_wrong_array_is_named(tmp_path, arrays, message):
    np.savez(tmp_path / "x.npz", **arrays)
    with pytest.raises(FormatError, match=message) as caught:
        load(tmp_path / "x.npz")
    assert str(tmp_path / "x.npz") in str(caught.value) and "\n" not in str(caught.value)


class Bomb:
    def __reduce__(self):
        return (pytest.fail, ("a pickle was loaded",))


def test_nothing_is_ever_unpickled(tmp_path):
    objects = np.array([Bomb()], dtype=object)
    np.savez(tmp_path / "x.npz", allow_pickle=True, vertices=objects, faces=F)
    np.save(tmp_path / "x.npy", objects, allow_pickle=True)
    (tmp_path / "y.npy").write_bytes(pickle.dumps(Bomb()))
    for name in ("x.npz", "x.npy", "y.npy"):
        with pytest.raises(FormatError, match=r"never unpickled|expected a numpy array"):
            load(tmp_path / name, topology=Mesh(V, F))


def member(shape: str, data: bytes) -> bytes:
    stream = io.BytesIO()
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    stream.write(b"\x93NUMPY\1\0" + len(header).to_bytes(2, "little") + header.encode() + data)
    return stream.getvalue()


@pytest.mark.parametrize(
    "shape", ["(9999999999, 3)", "(1, 9999999999, 3)", "(2, 3, 3)", "(-1, 3)", "(4, 3" + ", 1" * 40 + ")"]
)
@pytest.mark.parametrize("suffix", ["npz", "npy"])
def test_a_huge_header_is_refused_before_anything_is_allocated(tmp_path, shape, suffix):
    path = tmp_path / f"x.{suffix}"
    path.write_bytes(member(shape, V.tobytes()))
    if suffix == "npz":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("vertices.npy", member(shape, V.tobytes()))
            archive.writestr("faces.npy", member("(1, 3)", F[:2].tobytes()))
    tracemalloc.start()
    with pytest.raises(FormatError):
        load(path, topology=Mesh(V, F))
    assert tracemalloc.get_traced_memory()[1] < 10e6
    tracemalloc.stop()


@pytest.mark.parametrize("suffix", ["npz", "npy"])
def test_every_cut_file_is_refused(tmp_path, suffix, rng):
    save(tmp_path / f"whole.{suffix}", moving(rng))
    data = (tmp_path / f"whole.{suffix}").read_bytes()
    for end in [0, 1, 5, 9, 60, 130, *range(0, len(data) - 1, 97)]:
        (tmp_path / f"x.{suffix}").write_bytes(data[:end])
        with pytest.raises(FormatError):
            load(tmp_path / f"x.{suffix}", topology=Mesh(V, F))
