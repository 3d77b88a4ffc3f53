"""glTF files made by hand come out as the mathematics of the format says."""

from __future__ import annotations

import base64
import json
import math

import numpy as np
import pytest
from glb_builder import TRIANGLE, Builder, arm, turn
from numpy.testing import assert_allclose, assert_array_equal

from tempose.formats import glb
from tempose.formats.conventions import FormatError
from tempose.formats.glb_rate import key_rate
from tempose.kinematics import rest_transforms
from tempose.kinematics.skinning import bake

STRIP = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0]], np.float32)
FAN = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [-1, 1, 0]], np.float32)


def single(tmp_path, **node):
    b = Builder()
    b.node(mesh=b.mesh(), **node)
    return b.save(tmp_path / "a.glb")


def product(*matrices):
    """Product of 4 x 4 matrices as lists, in plain Python."""
    result = [[float(i == j) for j in range(4)] for i in range(4)]
    for M in matrices:
        result = [[sum(result[i][k] * float(M[k][j]) for k in range(4)) for j in range(4)] for i in range(4)]
    return result


def from_parts(translation=(0, 0, 0), rotation=(0, 0, 0, 1), scale=(1, 1, 1)):
    x, y, z, w = rotation
    R = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return [[R[i][j] * scale[j] for j in range(3)] + [translation[i]] for i in range(3)] + [[0, 0, 0, 1]]


def test_nested_nodes_move_a_mesh_as_the_product_of_their_matrices(tmp_path):
    b = Builder()
    mesh = b.mesh()
    parts = [
        {"translation": [1, 2, 3], "rotation": turn([1, 2, 3], 0.7), "scale": [2, 3, 4]},
        {"translation": [-1, 0, 5], "rotation": turn([0, 1, 0], -1.1)},
    ]
    b.node(children=[1], **parts[0])
    b.node(children=[2], matrix=np.array(from_parts(**parts[1])).T.ravel().tolist())
    b.node(mesh=mesh, scale=[0.5, 1, 1])
    M = np.array(product(*(from_parts(**p) for p in parts), from_parts(scale=(0.5, 1, 1))))
    V = glb.read_mesh(b.save(tmp_path / "a.glb")).vertices
    assert_allclose(V, TRIANGLE @ M[:3, :3].T + M[:3, 3], atol=1e-12)


def test_mirrored_node_keeps_the_outside_outside(tmp_path):
    V, F = (lambda m: (m.vertices, m.faces))(glb.read_mesh(single(tmp_path, scale=[-1, 1, 1])))
    a, b, c = V[F[0]]
    assert_allclose(np.cross(b - a, c - a), [0, 0, 1])


@pytest.mark.parametrize(
    ("mode", "V", "expected"),
    [
        (5, STRIP, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]),
        (6, FAN, [[1, 2, 0], [2, 3, 0], [3, 4, 0]]),
        (4, np.concatenate([TRIANGLE, TRIANGLE + 1]), [[0, 1, 2], [3, 4, 5]]),
    ],
)
def test_strips_fans_and_triangles_without_indices(tmp_path, mode, V, expected):
    b = Builder()
    b.node(mesh=b.mesh(V, mode=mode))
    mesh = glb.read_mesh(b.save(tmp_path / "a.glb"))
    assert_array_equal(mesh.faces, expected)
    corners = mesh.vertices[mesh.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (normal[:, 2] > 0).all()


def test_sparse_accessor_replaces_single_elements(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    rows, values = b.view(np.array([2, 0], "<u2").tobytes()), b.view(np.full((2, 3), 7, "<f4").tobytes())
    b.json["accessors"][0]["sparse"] = {
        "count": 2,
        "indices": {"bufferView": rows, "componentType": 5123},
        "values": {"bufferView": values},
    }
    V = glb.read_mesh(b.save(tmp_path / "a.glb")).vertices
    assert_array_equal(V, [[7, 7, 7], [1, 0, 0], [7, 7, 7]])


def test_accessor_without_data_is_zero(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    b.json["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC2"})
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 1
    assert_array_equal(glb.read_mesh(b.save(tmp_path / "a.glb")).uv, [[0, 1]] * 3)


@pytest.mark.parametrize(("dtype", "top"), [("u1", 255), ("u2", 65535), ("i1", 127), ("i2", 32767)])
def test_normalised_integers_span_the_unit_interval(tmp_path, dtype, top):
    b = Builder()
    mesh = b.mesh()
    low = -top - 1 if dtype[0] == "i" else 0
    uv = np.array([[0, top], [top, 0], [low, top]], f"<{dtype}")
    b.attribute(mesh, "TEXCOORD_0", uv, "VEC2", dtype, normalized=True)
    b.node(mesh=mesh)
    last = [-1.0 if dtype[0] == "i" else 0.0, 0.0]
    assert_allclose(glb.read_mesh(b.save(tmp_path / "a.glb")).uv, [[0, 0], [1, 1], last])


def test_quantised_positions_are_plain_integers_under_the_node(tmp_path):
    b = Builder()
    mesh = b.mesh()
    b.attribute(mesh, "POSITION", [[0, 0, 0], [1000, 0, 0], [0, -500, 0]], "VEC3", "i2")
    b.node(mesh=mesh, scale=[0.001] * 3)
    V = glb.read_mesh(b.save(tmp_path / "a.glb")).vertices
    assert_allclose(V, [[0, 0, 0], [1, 0, 0], [0, -0.5, 0]])


def test_interleaved_attributes_are_taken_apart(tmp_path):
    b = Builder()
    uv = np.array([[0, 0], [1, 0], [0, 1]], np.float32)
    view = b.view(np.hstack([TRIANGLE, uv]).astype("<f4").tobytes(), byteStride=20)
    for offset, kind in ((0, "VEC3"), (12, "VEC2")):
        entry = {"bufferView": view, "byteOffset": offset, "componentType": 5126, "count": 3, "type": kind}
        b.json["accessors"].append(entry)
    b.json["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]}]
    b.node(mesh=0)
    mesh = glb.read_mesh(b.save(tmp_path / "a.glb"))
    assert_array_equal(mesh.vertices, TRIANGLE)
    assert_array_equal(mesh.uv, np.column_stack([uv[:, 0], 1 - uv[:, 1]]))


def test_groups_are_named_by_node_mesh_and_material_and_colours_lose_alpha(tmp_path):
    b = Builder()
    one, two = b.mesh(name="shape"), b.mesh(TRIANGLE + 1, name="shape")
    b.attribute(two, "COLOR_0", [[255, 0, 51, 9]] * 3, "VEC4", "u1", normalized=True)
    b.json["meshes"][two]["primitives"][0]["material"] = 0
    b.json["materials"] = [{"name": "red"}]
    b.node(name="left", mesh=one)
    b.node(name="right", mesh=two)
    b.json["scenes"] = [{"nodes": [0, 1]}]
    mesh = glb.read_mesh(b.save(tmp_path / "a.glb"))
    assert {k: v.tolist() for k, v in mesh.groups.items()} == {
        "left": [0],
        "shape": [0, 1],
        "right": [1],
        "red": [1],
    }
    assert_allclose(mesh.colors, [[1, 1, 1]] * 3 + [[1, 0, 0.2]] * 3)


def test_primitives_over_the_same_attributes_share_vertices(tmp_path):
    b = Builder()
    mesh = b.mesh(STRIP, [0, 1, 2])
    primitive = b.json["meshes"][mesh]["primitives"][0]
    b.json["meshes"][mesh]["primitives"].append(
        {**primitive, "indices": b.accessor([1, 3, 2], "SCALAR", "u1")}
    )
    b.node(mesh=mesh)
    read = glb.read_mesh(b.save(tmp_path / "a.glb"))
    assert len(read.vertices) == 5
    assert_array_equal(read.faces, [[0, 1, 2], [1, 3, 2]])


def test_nodes_outside_the_scene_are_not_drawn_and_points_are_noted(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    b.node(mesh=b.mesh(TRIANGLE + 5))
    b.json["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 0})
    mesh = glb.read_mesh(b.save(tmp_path / "a.glb"))
    assert len(mesh.vertices) == 3
    assert "1 primitives" in mesh.source.notes[0]


def test_unit_and_up_are_applied_when_given(tmp_path):
    mesh = glb.read_mesh(single(tmp_path), up="z", unit=0.01)
    assert_allclose(mesh.vertices, [[0, 0, 0], [0.01, 0, 0], [0, 0, -0.01]], atol=1e-15)
    assert (mesh.source.up, mesh.source.unit) == ("z", 0.01)


def test_text_form_with_data_uri_and_with_a_file_beside_it(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    for uri in ("data:application/octet-stream;base64," + base64.b64encode(b.data).decode(), "my%20data.bin"):
        (tmp_path / "my data.bin").write_bytes(b.data)
        document = {**b.json, "buffers": [{"byteLength": len(b.data), "uri": uri}]}
        (tmp_path / "a.gltf").write_text(json.dumps(document))
        mesh = glb.read_mesh(tmp_path / "a.gltf")
        assert_array_equal(mesh.vertices, TRIANGLE)
        assert mesh.source.format == "gltf"


# animation


def test_linear_rotation_turns_at_constant_speed_the_shorter_way(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    far = [-x for x in turn([0, 0, 1], math.radians(90))]
    b.animate((0, "rotation", [0, 1], [turn([0, 0, 1], 0), far], "LINEAR"))
    clip = glb.read_clip(b.save(tmp_path / "a.glb"), fps=9)
    angle = np.degrees(np.arctan2(clip.vertices[:, 1, 1], clip.vertices[:, 1, 0]))
    assert_allclose(angle, np.arange(10) * 10.0, atol=1e-4)


def test_step_holds_until_the_next_key_and_ends_stay(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    b.animate(
        (0, "translation", [0, 0.5], [[0, 0, 0], [4, 0, 0]], "STEP"),
        (0, "scale", [0.2, 0.7], [[1, 1, 1], [2, 1, 1]], "LINEAR"),
        (0, "rotation", [0, 1], [[0, 0, 0, 1]] * 2, "LINEAR"),
    )
    x = glb.read_clip(b.save(tmp_path / "a.glb"), fps=10).vertices[:, :2, 0]
    assert_allclose(x[:, 0], [0] * 5 + [4] * 6)
    scale = np.clip(1 + (np.arange(11) / 10 - 0.2) / 0.5, 1, 2)
    assert_allclose(x[:, 1] - x[:, 0], scale, atol=1e-6)


def test_cubic_spline_reproduces_a_cubic(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    f, slope = (lambda t: t**3 - 2 * t + 1), (lambda t: 3 * t**2 - 2)
    keys = np.array([0.0, 0.5, 2.0])
    values = [[[slope(t), 0, 0], [f(t), 0, 0], [slope(t), 0, 0]] for t in keys]
    b.animate((0, "translation", keys, values, "CUBICSPLINE"))
    clip = glb.read_clip(b.save(tmp_path / "a.glb"), fps=20)
    assert_allclose(clip.vertices[:, 0, 0], f(np.arange(41) / 20), atol=1e-6)


def test_morph_targets_add_up_with_weights_linear_between_keys(tmp_path):
    b = Builder()
    mesh = b.mesh(weights=[0.5, 0.0])
    d = np.arange(18, dtype=np.float32).reshape(2, 3, 3)
    targets = [{"POSITION": b.accessor(d[0])}, {"POSITION": b.accessor(d[1])}]
    b.json["meshes"][mesh]["primitives"][0]["targets"] = targets
    b.node(mesh=mesh)
    b.animate((0, "weights", [0, 1], [0, 1, 2, 0], "LINEAR"))
    clip = glb.read_clip(b.save(tmp_path / "a.glb"), fps=4)
    for t, s in enumerate(np.arange(5) / 4):
        assert_allclose(clip.vertices[t], TRIANGLE + 2 * s * d[0] + (1 - s) * d[1], rtol=1e-6)
    assert_allclose(clip.rest, TRIANGLE + 0.5 * d[0])


def test_skinning_agrees_with_a_loop_over_vertices_joints_and_numbers(tmp_path, rng):
    b, made = arm(rng)
    clip = glb.read_clip(b.save(tmp_path / "a.glb"), "wave")
    assert clip.fps == 24.0 and clip.n_frames == 5
    armature = from_parts(rotation=turn([1, 0, 0], -np.pi / 2), scale=(0.5, 0.5, 0.5))
    lower = from_parts((0, 1, 0), turn([0, 1, 1], 0.6))
    for t in range(5):
        upper = product(armature, from_parts(made["path"][t], made["key"][t]))
        worlds = [upper, product(upper, lower), product(upper, lower, from_parts((0, 1, 0.5)))]
        for v, point in enumerate(made["V"]):
            expected = [0.0, 0.0, 0.0]
            for joint, weight in zip(made["joints"][v], made["weights"][v]):
                M = product(worlds[joint], made["inverse_bind"][joint])
                for i in range(3):
                    moved = sum(M[i][k] * float(point[k]) for k in range(3)) + M[i][3]
                    expected[i] += float(weight) * moved
            assert_allclose(clip.vertices[t, v], expected, atol=1e-5)


@pytest.mark.parametrize(
    "body", ["under the armature", "under the armature, lost", "beside it", "beside it, lost"]
)
def test_rig_and_joint_motion_give_the_same_frames_as_baking(tmp_path, rng, body):
    b, _ = arm(rng)
    if "beside" in body:
        b.json["nodes"][0]["children"] = [1]
        b.json["scenes"] = [{"nodes": [0, 4]}]
    b.json["nodes"][4]["translation"] = [9, 9, 9] if "lost" in body else [0, 0, 0]
    path = b.save(tmp_path / "a.glb")
    clip, skin, motion = glb.read_clip(path), glb.read_skin(path), glb.read_skeleton_clip(path)
    assert skin.skeleton.names == motion.skeleton.names == ("upper", "lower", "joint_2")
    assert_allclose(bake(skin, motion), clip.vertices, atol=1e-5)
    assert_allclose(skin.weights.sum(axis=1), 1)
    # the bind pose stands as the armature does: turned by a right angle about X, half as big
    _, joints = rest_transforms(skin.skeleton)
    assert_allclose(np.diff(joints, axis=0), [[0, 0, -0.5], [0, 0.25, -0.5]], atol=1e-6)
    assert np.linalg.norm(joints.mean(axis=0) - [0, 0.6, -0.5]) < 0.2


def test_mirrored_rig_is_skinned_like_any_other(tmp_path, rng):
    b, _ = arm(rng)
    b.json["nodes"][0]["scale"] = [-0.5, 0.5, 0.5]
    path = b.save(tmp_path / "a.glb")
    posed = bake(glb.read_skin(path), glb.read_skeleton_clip(path))
    assert_allclose(posed, glb.read_clip(path).vertices, atol=1e-5)


def test_quaternions_do_not_jump_between_q_and_minus_q(tmp_path, rng):
    b, _ = arm(rng)
    angles = np.linspace(0, 4 * np.pi, 49)
    b.animate(
        (1, "rotation", np.arange(49) / 24, [turn([1, 2, 3], a) for a in angles], "LINEAR"), name="spin"
    )
    q = glb.read_skeleton_clip(b.save(tmp_path / "a.glb"), "spin").rotations
    assert ((q[1:] * q[:-1]).sum(axis=-1) > 0.9).all()


def test_still_root_takes_over_the_path_of_travelling_hips(tmp_path):
    b = Builder()
    mesh = b.mesh()
    b.attribute(mesh, "JOINTS_0", [[1, 0, 0, 0]] * 3, "VEC4", "u1")
    b.attribute(mesh, "WEIGHTS_0", [[1, 0, 0, 0]] * 3, "VEC4")
    b.node(name="root", children=[1])
    b.node(name="hips", translation=[0, 1, 0])
    b.node(mesh=mesh, skin=0)
    b.json["scenes"] = [{"nodes": [0, 2]}]
    inverse = np.tile(np.eye(4), (2, 1, 1))
    inverse[1, 1, 3] = -1
    b.json["skins"] = [
        {"joints": [0, 1], "inverseBindMatrices": b.accessor(inverse.transpose(0, 2, 1), "MAT4")}
    ]
    b.animate((1, "translation", [0, 0.1, 0.2], [[0, 1, 0], [2, 1, 0], [4, 1, 1]], "LINEAR"))
    path = b.save(tmp_path / "a.glb")
    motion = glb.read_skeleton_clip(path)
    assert_allclose(motion.root_position, [[0, 0, 0], [2, 0, 0], [4, 0, 1]], atol=1e-6)
    assert "follows 'hips'" in motion.source.notes[-1]
    assert_allclose(bake(glb.read_skin(path), motion), glb.read_clip(path).vertices, atol=1e-6)


def test_stretching_bone_is_held_at_its_mean_and_noted(tmp_path, rng):
    b, _ = arm(rng)
    b.animate((2, "translation", [0, 0.1], [[0, 1, 0], [0, 1.4, 0]], "LINEAR"), name="stretch")
    motion = glb.read_skeleton_clip(b.save(tmp_path / "a.glb"), "stretch", fps=10)
    # mean 1.2, off by 0.2 either way, under an armature of scale one half
    assert_allclose(np.linalg.norm(motion.skeleton.offsets[1]), 0.6, atol=1e-6)
    assert "off by up to 0.1 m" in motion.source.notes[-1]


def test_mesh_without_a_skin_hangs_on_the_joint_above_it(tmp_path, rng):
    b, _ = arm(rng)
    b.node(name="hat", mesh=b.mesh(), translation=[0, 0, 0.25])
    b.json["nodes"][3]["children"] = [5]
    b.json["scenes"] = [{"nodes": [0]}]
    path = b.save(tmp_path / "a.glb")
    skin, motion, clip = glb.read_skin(path), glb.read_skeleton_clip(path), glb.read_clip(path)
    hat = np.concatenate([clip.mesh.faces[skin.mesh.groups["hat"]].ravel()])
    assert_array_equal(skin.weights[hat], [[0, 0, 1]] * 3)
    assert_allclose(bake(skin, motion), clip.vertices, atol=1e-5)


def test_animation_without_mesh_or_skin_moves_its_nodes(tmp_path):
    b = Builder()
    b.node(name="a", children=[1, 2])
    b.node(name="b", translation=[0, 1, 0])
    b.node(name="c", translation=[1, 0, 0])
    q = [turn([0, 0, 1], a) for a in (0.0, 0.3)]
    b.animate(*((i, "rotation", [0, 1 / 30], q, "LINEAR") for i in (1, 2)))
    clip = glb.read_skeleton_clip(b.save(tmp_path / "a.glb"))
    assert clip.skeleton.names == ("a", "b", "c")
    assert_allclose(clip.rotations[1, 1], [math.cos(0.15), 0, 0, math.sin(0.15)], atol=1e-7)


# clips and rates


def test_clips_are_found_by_name_and_unnamed_ones_by_number(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    for name, x in (("go", 1), (None, 2), ("go", 3)):
        b.animate((0, "translation", [0, 0.1], [[x, 0, 0]] * 2, "STEP"), name=name)
    path = b.save(tmp_path / "a.glb")
    assert glb.clip_names(path) == ("go", "clip_1", "go_2")
    found = [glb.read_clip(path, name).vertices[0, 0, 0] for name in (None, "go", "clip_1", "go_2")]
    assert found == [1, 1, 2, 3]
    with pytest.raises(FormatError, match=r"no clip named 'run'; the file has 'go', 'clip_1', 'go_2'"):
        glb.read_clip(path, "run")


def test_file_without_animation_is_one_frame(tmp_path):
    clip = glb.read_clip(single(tmp_path))
    assert clip.n_frames == 1 and clip.source.guessed == ("fps",)
    with pytest.raises(FormatError, match="the file has no animation"):
        glb.read_clip(single(tmp_path), "walk")


@pytest.mark.parametrize("fps", [12.0, 24.0, 29.97002997, 30.0, 59.94005994, 120.0, 240.0])
def test_rate_is_read_from_float32_keys(fps):
    keys = (np.arange(1000) / fps).astype(np.float32).astype(float)
    rate, even = key_rate(keys)
    assert even and rate == pytest.approx(fps, rel=1e-7)
    assert rate == round(fps) or fps != round(fps)
    assert key_rate(np.delete(keys, [3, 4, 200, 700])) == (pytest.approx(fps, rel=1e-7), True)


@pytest.mark.parametrize("keys", [[0.0], [0.0, 2.0], [0, 0.1, 0.13, 0.2, 0.31], [0, 1e-5, 2e-5, 3e-5]])
def test_rate_is_guessed_where_keys_tell_none(tmp_path, keys):
    assert key_rate(np.array(keys, dtype=float)) == (None, False)
    b = Builder()
    b.node(mesh=b.mesh())
    b.animate((0, "translation", keys, [[k, 0, 0] for k in keys], "LINEAR"))
    clip = glb.read_clip(b.save(tmp_path / "a.glb"))
    assert clip.fps == 30 and clip.source.guessed == ("fps",) and clip.source.fps is None
    assert clip.n_frames == int(keys[-1] * 30 + 1e-3) + 1


def test_clip_starts_at_its_first_key(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh())
    keys = np.arange(1, 6) / 30
    b.animate((0, "translation", keys, [[k, 0, 0] for k in keys], "LINEAR"))
    clip = glb.read_clip(b.save(tmp_path / "a.glb"))
    assert clip.fps == 30 and "start at 0.03333 s" in clip.source.notes[0]
    assert_allclose(clip.vertices[:, 0, 0], keys, atol=1e-7)
