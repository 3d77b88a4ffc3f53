"""What is written to a GLB comes back, and other readers see the same."""

from __future__ import annotations

import json
import struct

import numpy as np
import pygltflib
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, MeshClip
from tempose.formats import glb
from tempose.formats.glb_normals import UnitNormals
from tempose.geometry import vertex_normals

EPS = 2.0**-23


def grid(n=4):
    """Quads over a bumpy sheet with a UV seam down the middle, one spare vertex and one spare coordinate."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    V = np.column_stack([x.ravel(), y.ravel(), np.sin(x.ravel() + 2 * y.ravel())]) / n
    index = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1).reshape(-1, 4)
    F = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    right = (quads[:, 0] >= index[n // 2, 0]).repeat(2)
    C = F + right[:, None] * len(V)
    uv = np.concatenate([V[:, :2], V[:, :2] * 0.5, [[0.25, 0.125]]])
    used = np.unique(C)
    keep = np.append(used, len(uv) - 1)
    return Mesh(
        np.vstack([V, [[9.0, 9, 9]]]),
        F,
        uv=uv[keep],
        uv_faces=np.searchsorted(keep, C),
        colors=np.linspace(0, 1, 3 * (len(V) + 1)).reshape(-1, 3),
        groups={"left": np.flatnonzero(~right), "odd": np.arange(1, len(F), 2), "none": np.arange(0)},
        polygons=np.full(len(quads), 4),
        name="sheet",
    )


def wave(mesh, T=9, fps=29.97, rng=None):
    t = np.arange(T)[:, None, None]
    V = mesh.vertices + 0.2 * np.sin(t + mesh.vertices[:, [1, 2, 0]]) + t * [0.1, 0, 0]
    return MeshClip(V.astype(np.float32), mesh, fps)


def same_topology(a: Mesh, b: Mesh):
    assert_array_equal(a.faces, b.faces)
    assert (a.uv is None) == (b.uv is None) and (a.uv_faces is None) == (b.uv_faces is None)
    if a.uv_faces is not None:
        assert_array_equal(a.uv_faces, b.uv_faces)
    assert a.groups.keys() == b.groups.keys()
    for name, faces in a.groups.items():
        assert_array_equal(faces, b.groups[name])
    assert a.name == b.name
    assert (a.polygons is None) == (b.polygons is None)
    if a.polygons is not None:
        assert_array_equal(a.polygons, b.polygons)


def test_still_mesh_with_seams_quads_groups_and_colours_comes_back(tmp_path):
    mesh = grid()
    written = glb.write(tmp_path / "a.glb", mesh)
    back = glb.read_mesh(tmp_path / "a.glb")
    assert_array_equal(back.vertices, mesh.vertices.astype(np.float32))
    assert_allclose(back.uv, mesh.uv, atol=EPS)
    assert_array_equal(back.colors, mesh.colors.astype(np.float32))
    same_topology(back, mesh)
    assert written.frames == written.targets == 0 and written.largest_percent < 1e-5
    assert written.bytes == (tmp_path / "a.glb").stat().st_size


@pytest.mark.parametrize("normals", [True, False])
def test_clip_comes_back_to_float32(tmp_path, normals):
    clip = wave(grid())
    written = glb.write(tmp_path / "a.glb", clip, normals=normals)
    back = glb.read_clip(tmp_path / "a.glb")
    assert_allclose(back.vertices, clip.vertices, atol=EPS * clip.mesh.diagonal)
    assert back.fps == clip.fps and back.n_frames == clip.n_frames and back.source.guessed == ()
    same_topology(back.mesh, clip.mesh)
    off = np.linalg.norm(back.vertices.astype(float) - clip.vertices, axis=2).max()
    assert_allclose(written.largest_percent, 100 * off / clip.mesh.diagonal, rtol=1e-6)


def test_frames_whose_offsets_are_float32_come_back_bit_for_bit(tmp_path):
    # on a common binary grid differences of float32 numbers are float32 numbers
    mesh = grid()
    mesh = mesh.with_vertices(np.round(mesh.vertices * 1024) / 1024)
    clip = MeshClip((np.round(wave(mesh).vertices * 1024) / 1024).astype(np.float32), mesh, 24)
    assert glb.write(tmp_path / "a.glb", clip).largest_percent == 0
    assert_array_equal(glb.read_clip(tmp_path / "a.glb").vertices, clip.vertices)


def test_equal_frames_share_a_target_and_rest_needs_none(tmp_path):
    mesh = grid()
    a, b = wave(mesh, 2).vertices
    rest = mesh.vertices.astype(np.float32)
    clip = MeshClip(np.stack([rest, a, b, a, rest, b]), mesh, 5)
    written = glb.write(tmp_path / "a.glb", clip)
    assert (written.frames, written.targets) == (6, 2)
    back = glb.read_clip(tmp_path / "a.glb")
    assert back.fps == 5
    assert_array_equal(back.vertices[[1, 2]], back.vertices[[3, 5]])
    assert_array_equal(back.vertices[[0, 4]], [rest, rest])


@pytest.mark.parametrize("T", [1, 3])
def test_clip_that_never_moves_keeps_its_frames(tmp_path, T):
    mesh = grid()
    clip = MeshClip(np.repeat(mesh.vertices[None], T, axis=0).astype(np.float32), mesh, 50)
    for tolerance in (None, 1.0):
        glb.write(tmp_path / "a.glb", clip, tolerance=tolerance)
        back = glb.read_clip(tmp_path / "a.glb")
        assert back.n_frames == T and back.fps == 50
        assert_array_equal(back.vertices, clip.vertices)


def test_reading_back_at_another_rate_interpolates_linearly(tmp_path):
    clip = wave(grid(), 5, 20)
    glb.write(tmp_path / "a.glb", clip)
    back = glb.read_clip(tmp_path / "a.glb", fps=40)
    assert_allclose(back.vertices[::2], clip.vertices, atol=1e-6)
    assert_allclose(back.vertices[1::2], (clip.vertices[1:] + clip.vertices[:-1]) / 2, atol=1e-6)
    assert back.fps == 40 and back.source.fps == 20


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("tolerance", [0.01, 1.0, 10.0])
def test_compact_basis_keeps_within_tolerance_and_says_by_how_much(tmp_path, unit, tolerance):
    mesh = grid()
    clip = wave(mesh, 40)
    mesh = mesh.with_vertices(mesh.vertices * unit)
    clip = MeshClip(clip.vertices * np.float32(unit), mesh, 30)
    exact = glb.write(tmp_path / "b.glb", clip)
    written = glb.write(tmp_path / "a.glb", clip, tolerance=tolerance)
    back = glb.read_clip(tmp_path / "a.glb")
    off = np.linalg.norm(back.vertices.astype(float) - clip.vertices, axis=2) / mesh.diagonal * 100
    assert off.max() <= tolerance * (1 + 1e-5)
    assert_allclose(
        [off.max(), np.sqrt((off**2).mean())], [written.largest_percent, written.rms_percent], rtol=1e-3
    )
    assert written.targets < exact.targets and written.bytes < exact.bytes


def test_basis_of_a_motion_in_three_dimensions_has_three_targets(tmp_path, rng):
    mesh = grid()
    shapes, weights = rng.normal(size=(3, len(mesh.vertices), 3)), rng.normal(size=(30, 3))
    V = (mesh.vertices + np.tensordot(weights, shapes, 1)).astype(np.float32)
    written = glb.write(tmp_path / "a.glb", MeshClip(V, mesh), tolerance=1e-3)
    assert written.targets == 3 and written.largest_percent < 1e-4


def test_unreachable_tolerance_falls_back_to_one_target_a_frame(tmp_path, rng):
    mesh = grid()
    clip = MeshClip(rng.normal(size=(6, len(mesh.vertices), 3)), mesh)
    written = glb.write(tmp_path / "a.glb", clip, tolerance=1e-12)
    assert written.targets == 6


def test_trimesh_sees_the_same_surface_and_pygltflib_the_same_frames(tmp_path):
    clip = wave(grid(), 3)
    glb.write(tmp_path / "a.glb", clip)
    scene = trimesh.load(tmp_path / "a.glb", process=False)
    seen = scene.to_geometry()
    assert_allclose(seen.triangles, clip.rest[clip.faces], atol=1e-6)
    uv = clip.mesh.uv[clip.mesh.uv_faces]
    assert_allclose(seen.visual.uv[seen.faces], uv, atol=1e-6)
    file = pygltflib.GLTF2().load(tmp_path / "a.glb")
    primitive = file.meshes[0].primitives[0]
    base, vertex_of = (
        decoded(file, primitive.attributes.POSITION),
        decoded(file, primitive.attributes._VERTEX),
    )
    sampler = file.animations[0].samplers[0]
    times, weights = decoded(file, sampler.input), decoded(file, sampler.output).reshape(3, -1)
    assert_allclose(times, np.arange(3) / clip.fps, rtol=1e-6)
    for t in range(3):
        V = base + sum(
            w * decoded(file, target["POSITION"]) for w, target in zip(weights[t], primitive.targets)
        )
        assert_allclose(V, clip.vertices[t][vertex_of.astype(int)], atol=1e-6)


def test_moved_normals_are_those_of_the_moved_surface(tmp_path):
    clip = wave(grid(), 2)
    glb.write(tmp_path / "a.glb", clip)
    file = pygltflib.GLTF2().load(tmp_path / "a.glb")
    primitive = file.meshes[0].primitives[0]
    vertex_of = decoded(file, primitive.attributes._VERTEX).astype(int)
    N = decoded(file, primitive.attributes.NORMAL) + decoded(file, primitive.targets[1]["NORMAL"])
    sums = np.zeros_like(clip.rest)
    for a, b, c in clip.faces:
        p, q, r = clip.vertices[1][[a, b, c]].astype(float)
        sums[[a, b, c]] += np.cross(q - p, r - p)
    sums[-1] = [0, 0, 1]
    assert_allclose(N, (sums / np.linalg.norm(sums, axis=1, keepdims=True))[vertex_of], atol=1e-5)


@pytest.mark.parametrize("unit", [1e-20, 1.0, 1e18])
def test_normals_agree_with_those_of_the_geometry_package(unit):
    mesh = grid()
    N = UnitNormals(mesh.faces, len(mesh.vertices))(mesh.vertices * unit + 100 * unit)
    assert_allclose(N[:-1], vertex_normals(mesh.vertices, mesh.faces)[:-1], atol=1e-5)
    assert_array_equal(N[-1], [0, 0, 1])


def test_normals_of_a_compact_basis_fit_those_of_the_frames_best(tmp_path):
    clip = wave(grid(), 20)
    glb.write(tmp_path / "a.glb", clip, tolerance=2.0)
    file = pygltflib.GLTF2().load(tmp_path / "a.glb")
    primitive = file.meshes[0].primitives[0]
    vertex_of = decoded(file, primitive.attributes._VERTEX).astype(int)
    weights = decoded(file, file.animations[0].samplers[0].output).reshape(20, -1).astype(float)
    targets = np.stack([decoded(file, target["NORMAL"]) for target in primitive.targets])
    normals = UnitNormals(clip.faces, len(clip.rest))
    wanted = np.stack([normals(V) for V in clip.vertices]) - normals(clip.rest)
    missing = wanted[:, vertex_of] - np.tensordot(weights, targets, 1)
    assert len(targets) < 20
    # at the minimum of a least-squares problem the residual is orthogonal to its columns
    assert_allclose(np.tensordot(weights.T, missing, 1), 0, atol=1e-5)


def test_file_keeps_the_letter_of_the_format(tmp_path):
    glb.write(tmp_path / "a.glb", wave(grid(), 3))
    data = (tmp_path / "a.glb").read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIIII", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), 0x4E4F534A)
    assert size % 4 == 0 and length % 4 == 0
    head = json.loads(data[20 : 20 + size])
    file = pygltflib.GLTF2().load(tmp_path / "a.glb")
    for accessor, view in zip(head["accessors"], head["bufferViews"]):
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= head["buffers"][0]["byteLength"]
        values = decoded(file, head["accessors"].index(accessor)).reshape(accessor["count"], -1)
        if "min" in accessor:
            assert_array_equal(values.min(axis=0), accessor["min"])
            assert_array_equal(values.max(axis=0), accessor["max"])
    primitive = head["meshes"][0]["primitives"][0]
    assert all("min" in head["accessors"][t["POSITION"]] for t in primitive["targets"])
    assert "min" in head["accessors"][primitive["attributes"]["POSITION"]]
    assert "min" in head["accessors"][head["animations"][0]["samplers"][0]["input"]]


def decoded(file, index):
    accessor = file.accessors[index]
    view = file.bufferViews[accessor.bufferView]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor.type]
    dtype = "<f4" if accessor.componentType == 5126 else "<u4"
    values = np.frombuffer(file.binary_blob(), dtype, accessor.count * width, view.byteOffset)
    return values.reshape(-1, width) if width > 1 else values


def test_extras_that_no_longer_fit_are_ignored(tmp_path):
    mesh = grid()
    glb.write(tmp_path / "a.glb", mesh)
    data = (tmp_path / "a.glb").read_bytes()
    for old, new in (
        (b'"triangles":32', b'"triangles":31'),
        (b'"polygons":[[4,16]]', b'"polygons":[[5,16]]'),
        (b'"polygons":[[4,16]]', b'"polygons":[[4,{}]]'),
        (b'"_VERTEX"', b'"_VERTOX"'),
    ):
        assert old in data and len(old) == len(new)
        (tmp_path / "b.glb").write_bytes(data.replace(old, new))
        back = glb.read_mesh(tmp_path / "b.glb")
        assert (back.polygons is None) == (old != b'"_VERTEX"')
        assert_allclose(back.vertices[back.faces], mesh.vertices[mesh.faces], atol=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"up": "z"}, "always Y up"),
        ({"unit": 0.01}, "always Y up and in metres"),
        ({"tolerance": 0.0}, "tolerance must be a positive percentage, got 0"),
        ({"path": "a.gltf"}, "must end in .glb"),
        ({"thing": "mesh"}, "Mesh or a MeshClip"),
        ({"thing": Mesh(np.zeros((3, 3)), np.zeros((0, 3), int))}, "at least one face"),
        ({"thing": MeshClip(np.zeros((0, 3, 3)), Mesh(np.eye(3), [[0, 1, 2]]))}, "at least one frame"),
    ],
)
def test_what_gltf_cannot_hold_is_refused(tmp_path, change, message):
    given = {"path": "a.glb", "thing": grid(), **change}
    with pytest.raises(ValueError, match=message):
        glb.write(tmp_path / given.pop("path"), given.pop("thing"), **given)
    assert list(tmp_path.iterdir()) == []


def test_y_up_and_metres_are_accepted(tmp_path):
    glb.write(tmp_path / "a.glb", grid(), up="y", unit=1.0)


def test_cancelled_writing_leaves_the_old_file_and_nothing_else(tmp_path):
    class CancelError(Exception):
        pass

    def stop(done: int, total: int, stage: str) -> None:
        if stage == "writing" and done == 3:
            raise CancelError

    (tmp_path / "a.glb").write_bytes(b"old")
    with pytest.raises(CancelError):
        glb.write(tmp_path / "a.glb", wave(grid(), 3), progress=stop)
    assert (tmp_path / "a.glb").read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.glb"]


def test_same_clip_gives_the_same_bytes(tmp_path):
    for name in ("a.glb", "b.glb"):
        glb.write(tmp_path / name, wave(grid(), 12), tolerance=0.5)
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()
