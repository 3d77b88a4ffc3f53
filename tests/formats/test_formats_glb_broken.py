"""Broken glTF files: one error that names file and place, or a valid object; nothing else."""

from __future__ import annotations

import copy
import json
import struct
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from glb_builder import TRIANGLE, Builder, arm, pack
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tempose.clips import Mesh, MeshClip
from tempose.formats import glb
from tempose.formats.conventions import FormatError

READERS = (glb.clip_names, glb.read_mesh, glb.read_clip, glb.read_skeleton_clip, glb.read_skin)


def rig() -> Builder:
    """A skin with a morph target and two animations."""
    b, _ = arm(np.random.default_rng(4))
    n = b.json["accessors"][0]["count"]
    b.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": b.accessor(np.ones((n, 3)))}]
    b.animate((4, "weights", [0, 0.5, 0.6], np.arange(9), "CUBICSPLINE"))
    return b


def refused(tmp_path: Path, data: bytes, message: str, read=glb.read_clip) -> None:
    path = tmp_path / "bad.glb"
    path.write_bytes(data)
    with pytest.raises(FormatError, match=message) as caught:
        read(path)
    assert str(path) in str(caught.value) and "\n" not in str(caught.value)


def changed(*path: str | int, value: object) -> bytes:
    b = rig()
    at = b.json
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return b.bytes()


def test_the_rig_itself_is_fine(tmp_path):
    path = rig().save(tmp_path / "a.glb")
    for read in READERS:
        read(path)


def test_truncation_anywhere_is_noticed(tmp_path):
    data = rig().bytes()
    for size in [*range(0, 30), *range(30, len(data), 97), len(data) - 1]:
        refused(tmp_path, data[:size], "expected|cut short|left", glb.read_mesh)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", r"starts with b'glTF', found b''"),
        (b"solid cube", "starts with b'glTF', found b'soli'"),
        (b"glTF\2\0\0\0", "header of 20 bytes, the file has 8"),
        (b"glTF" + struct.pack("<IIII", 1, 20, 0, 0x4E4F534A), "GLB version 2, found 1"),
        (
            b"glTF" + struct.pack("<IIII", 2, 2**32 - 1, 0, 0x4E4F534A),
            "cut short: the header says 4294967295",
        ),
        (b"glTF" + struct.pack("<IIII", 2, 20, 2**31, 0x4E4F534A), "chunk at byte 12 says 2147483648 bytes"),
        (b"glTF" + struct.pack("<IIII", 2, 20, 0, 0x004E4942), "expected a JSON chunk"),
        (pack(b"{]", b""), "expected glTF JSON"),
        (pack(b"\xff\xfe", b""), "expected glTF JSON"),
        (pack(b"[" * 100_000, b""), "expected glTF JSON"),
        (pack(b"9" * 5000, b""), "expected glTF JSON"),
        (pack(b"[]", b""), r"expected a JSON object, found \[\]"),
        (pack(b'{"asset":{"version":"1.0"}}', b""), "asset.version: expected 2.0, found '1.0'"),
        (pack(b'{"asset":{"version":"2.0"}}', b""), "expected a mesh with triangles"),
    ],
)
def test_broken_containers(tmp_path, data, message):
    refused(tmp_path, data, message)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (
            ("accessors", 0, "count"),
            2**31,
            r"bad.glb: accessors\[0\]: 2147483648 elements of 12 bytes do not fit",
        ),
        (("accessors", 0, "count"), -1, r"accessors\[0\].count: expected a whole number from 1, found -1"),
        (("accessors", 0, "count"), True, r"accessors\[0\].count: .* found True"),
        (("accessors", 0, "count"), "3", r"accessors\[0\].count: .* found '3'"),
        (("accessors", 0, "count"), None, r"accessors\[0\].count: .* found nothing"),
        (("accessors", 0, "type"), "VEC9", r"accessors\[0\].type: expected VEC3, found 'VEC9'"),
        (("accessors", 0, "componentType"), 5124, r"accessors\[0\].componentType: expected one of 5120"),
        (("accessors", 0, "bufferView"), 99, r"accessors\[0\].bufferView: expected .* below 12, found 99"),
        (("accessors", 0, "byteOffset"), 1, r"accessors\[0\]: 12 elements of 12 bytes do not fit"),
        (
            ("bufferViews", 0, "byteLength"),
            10**9,
            r"bufferViews\[0\]: ends at byte 1000000000, its buffer at",
        ),
        (("bufferViews", 0, "byteOffset"), 10**30, r"bufferViews\[0\]: ends at byte 1000"),
        (("bufferViews", 0, "byteStride"), 4, r"bufferViews\[0\].byteStride: expected at least 12, found 4"),
        (("bufferViews", 0, "buffer"), 1, r"bufferViews\[0\].buffer: .* below 1, found 1"),
        (("buffers",), [{"byteLength": 10**9}], r"buffers\[0\].byteLength: says 1000000000 bytes, there are"),
        (("buffers",), [{"byteLength": 4, "uri": "data:,%%%"}], r"buffers\[0\].uri: expected base64"),
        (("buffers",), [{"byteLength": 4, "uri": "none.bin"}], r"buffers\[0\].uri: cannot read 'none.bin'"),
        (("buffers",), [{"byteLength": 4, "uri": "../../etc/passwd"}], "expected a file beside bad.glb"),
        (("buffers",), [{"byteLength": 4, "uri": "http://a/b"}], "expected a file beside bad.glb"),
        (("nodes", 2, "children"), [0], r"nodes\[0\]: is its own ancestor"),
        (("nodes", 3, "children"), [3], r"nodes\[3\]: expected one parent, found nodes 2 and 3"),
        (("nodes", 2, "children"), [7], r"nodes\[2\].children\[0\]: expected .* below 5, found 7"),
        (("nodes", 0, "scale"), [1, 1], r"nodes\[0\].scale: expected 3 numbers, found 2"),
        (("nodes", 0, "scale"), [1, "x", 1], r"nodes\[0\].scale\[1\]: expected a finite number, found 'x'"),
        (("nodes", 0, "scale"), [1, float("nan"), 1], r"scale\[1\]: expected a finite number, found nan"),
        (
            ("nodes", 0, "scale"),
            [1, 10**400, 1],
            r"scale\[1\]: expected a finite number, found a huge number",
        ),
        (("nodes", 4, "mesh"), 3, r"nodes\[4\].mesh: .* below 1, found 3"),
        (("nodes", 4, "skin"), 3, r"nodes\[4\].skin: .* below 1, found 3"),
        (("scene",), 2, "scene: expected a whole number from 0 and below 1, found 2"),
        (("skins", 0, "joints"), [1, 2, 30], r"skins\[0\].joints\[2\]: .* below 5, found 30"),
        (("skins", 0, "joints"), [1, 2], r"primitives\[0\].attributes.JOINTS_0: expected joints below 2"),
        (("skins", 0, "inverseBindMatrices"), 0, r"accessors\[0\].type: expected MAT4"),
        (("meshes", 0, "weights"), [1, 2, 3], r"meshes\[0\].weights: expected 1 weights"),
        (("meshes", 0, "primitives"), [7], r"meshes\[0\].primitives\[0\]: expected a JSON object, found 7"),
        (("meshes", 0, "primitives", 0, "indices"), 0, r"accessors\[0\].type: expected SCALAR"),
        (("animations", 0, "channels", 0, "sampler"), 9, r"channels\[0\].sampler: .* below 2, found 9"),
        (("animations", 0, "samplers", 0, "interpolation"), "EASE", "expected STEP, LINEAR or CUBICSPLINE"),
        (("animations", 0, "samplers", 0, "output"), 5, "expected VEC4|do not fit|one set a key"),
        (("extensionsRequired",), ["KHR_draco_mesh_compression"], "export it without compression"),
    ],
)
def test_broken_json_names_its_place(tmp_path, path, value, message):
    refused(tmp_path, changed(*path, value=value), message)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_positions_that_are_no_numbers(tmp_path, value):
    V = TRIANGLE.copy()
    V[1, 2] = value
    b = Builder()
    b.node(mesh=b.mesh(V))
    refused(tmp_path, b.bytes(), r"accessors\[0\]: expected finite numbers, found .* at element 1")


def test_indices_beyond_the_vertices_and_triangles_cut_short(tmp_path):
    for F, message in (([0, 1, 3], "indices: expected indices below 3, found 3"), ([0, 1], "three corners")):
        b = Builder()
        b.node(mesh=b.mesh(TRIANGLE, F))
        refused(tmp_path, b.bytes(), message)


def test_negative_weights_and_joints_out_of_range(tmp_path):
    for joints, weights, message in (
        (
            [0, 9, 0, 0],
            [0.5, 0.5, 0, 0],
            r"JOINTS_0: expected joints below 3, found \[0, 9, 0, 0\] at vertex 0",
        ),
        ([0, 0, 0, 0], [1, -0.5, 0, 0], "WEIGHTS_0: expected weights from 0, found -0.5"),
    ):
        b = rig()
        b.attribute(0, "JOINTS_0", [joints] * 12, "VEC4", "u1")
        b.attribute(0, "WEIGHTS_0", [weights] * 12, "VEC4")
        refused(tmp_path, b.bytes(), message)


def test_joint_out_of_range_without_weight_is_padding(tmp_path):
    b = rig()
    b.attribute(0, "JOINTS_0", [[0, 255, 0, 0]] * 12, "VEC4", "u1")
    b.attribute(0, "WEIGHTS_0", [[2, 0, 0, 0]] * 12, "VEC4")
    assert glb.read_skin(b.save(tmp_path / "a.glb")).weights.tolist() == [[1, 0, 0]] * 12


def test_keys_that_run_backwards_and_durations_beyond_reason(tmp_path):
    for times, message in (
        ([0, 1, 0.5], "rising times, found 0.5 after 1"),
        ([0, 1, 1e9], "would make .* frames"),
    ):
        b = Builder()
        b.node(mesh=b.mesh())
        b.animate((0, "translation", times, np.zeros((3, 3)), "LINEAR"))
        refused(tmp_path, b.bytes(), message)


def test_overflow_is_an_error_not_a_warning(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh(TRIANGLE * 1e30), scale=[1e30] * 3)
    for read in (glb.read_mesh, glb.read_clip):
        refused(tmp_path, b.bytes(), "overflows", read)


def test_joints_beyond_all_size_are_an_error(tmp_path):
    b = rig()
    for node in b.json["nodes"][:3]:
        node["scale"] = [1e38, 1e38, 1e38]
    for read in READERS[1:]:
        refused(tmp_path, b.bytes(), "overflow", read)


def test_singular_bind_matrices_fall_back_to_the_node_or_are_refused(tmp_path):
    b = rig()
    b.json["skins"][0]["inverseBindMatrices"] = b.accessor(np.zeros((3, 4, 4)), "MAT4")
    refused(tmp_path, b.bytes(), r"skins\[0\].joints: expected joints and bind matrices that can be inverted")
    matrices = np.tile(np.eye(4), (3, 1, 1))
    matrices[1] = 0
    b.json["skins"][0]["inverseBindMatrices"] = b.accessor(matrices, "MAT4")
    assert glb.read_skin(b.save(tmp_path / "a.glb")).skeleton.n_joints == 3


def test_fps_must_be_positive(tmp_path):
    path = rig().save(tmp_path / "a.glb")
    for fps in (0, -1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="fps must be positive"):
            glb.read_clip(path, fps=fps)


def test_missing_file_is_an_os_error(tmp_path):
    for read in READERS:
        with pytest.raises(OSError, match=r"none\.glb"):
            read(tmp_path / "none.glb")


def outcome(path: Path) -> None:
    for read in READERS:
        try:
            read(path)
        except (FormatError, OSError) as error:
            if str(path) not in str(error):
                raise


@cache
def base(name: str) -> bytes:
    if name == "rig":
        return rig().bytes()
    mesh = Mesh(TRIANGLE, [[0, 1, 2]], uv=TRIANGLE[:, :2], uv_faces=[[2, 1, 0]], groups={"all": np.arange(1)})
    path = Path(name)
    glb.write(path, MeshClip(np.stack([TRIANGLE, 2 * TRIANGLE]), mesh, 24))
    return path.read_bytes()


HOSTILE = st.sampled_from(
    [
        None,
        True,
        -1,
        0,
        1,
        3,
        7,
        2**31,
        2**63,
        10**40,
        1e-320,
        1e38,
        -1e38,
        0.5,
        "",
        "VEC3",
        [],
        [0],
        {},
        [[]],
    ]
)
QUIET = settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])


@QUIET
@given(data=st.data(), name=st.sampled_from(["rig", "morph.glb"]))
def test_any_json_value_replaced_by_any_other(tmp_path, monkeypatch, data, name):
    monkeypatch.chdir(tmp_path)
    whole = base(name)
    size = struct.unpack_from("<I", whole, 12)[0]
    document = copy.deepcopy(json.loads(whole[20 : 20 + size]))
    for _ in range(data.draw(st.integers(1, 3))):
        at = document
        while True:
            keys = list(at) if isinstance(at, dict) else list(range(len(at)))
            if not keys:
                break
            key = data.draw(st.sampled_from(keys))
            deeper = isinstance(at[key], dict | list) and at[key]
            if deeper and data.draw(st.integers(0, 9)):
                at = at[key]
                continue
            at[key] = copy.deepcopy(data.draw(HOSTILE))
            break
    path = tmp_path / "fuzz.glb"
    path.write_bytes(pack(json.dumps(document).encode(), whole[28 + size :]))
    outcome(path)


EDITS = st.lists(st.tuples(st.floats(0, 1, exclude_max=True), st.binary(min_size=1, max_size=4)), max_size=8)


def edited(whole: bytes, edits: list[tuple[float, bytes]], keep: float) -> bytes:
    data = bytearray(whole)
    for place, raw in edits:
        at = int(place * len(data))
        data[at : at + len(raw)] = raw
    return bytes(data[: int(keep * len(data)) + 1])


@QUIET
@given(edits=EDITS, keep=st.one_of(st.just(1.0), st.floats(0, 1)), name=st.sampled_from(["rig", "morph.glb"]))
def test_any_bytes_changed_in_a_small_file(tmp_path, monkeypatch, edits, keep, name):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "fuzz.glb"
    path.write_bytes(edited(base(name), edits, keep))
    outcome(path)


@pytest.mark.real
@settings(QUIET, max_examples=25)
@given(edits=EDITS, keep=st.one_of(st.just(1.0), st.floats(0, 1)))
def test_any_bytes_changed_in_a_real_file(tmp_path, data_folder, edits, keep):
    path = tmp_path / "fox.glb"
    path.write_bytes(edited((data_folder("rigged-gltf") / "Fox.glb").read_bytes(), edits, keep))
    outcome(path)
