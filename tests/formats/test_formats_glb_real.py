"""Real characters: counts, rates and poses as their makers meant them."""

from __future__ import annotations

import numpy as np
import pygltflib
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal

from tempose.formats import glb
from tempose.kinematics.skinning import bake

pytestmark = pytest.mark.real

COUNTS = {
    "human-male": (7399, 13757, 66),
    "horse-animations": (2146, 3414, 56),
    "Fox": (1728, 576, 24),
    "CesiumMan": (3273, 4672, 19),
    "AnimatedMorphSphere": (1876, 960, 0),
}
CLIPS = {
    "human-male": (),
    "horse-animations": (
        *("Death", "Eating", "Head_But", "Idle", "Kick", "lay_to_idle", "Rear"),
        *("Rest_Pose", "Run", "Sleep", "Trot", "Turn_Left", "Turn_Right", "Walk"),
    ),
    "Fox": ("Survey", "Walk", "Run"),
    "CesiumMan": ("clip_0",),
    "AnimatedMorphSphere": ("Globe",),
}
PLAYED = [(name, clip) for name, clips in CLIPS.items() for clip in clips]
SKINNED = [(name, clip) for name, clip in PLAYED if name != "AnimatedMorphSphere"] + [("human-male", None)]


@pytest.fixture
def file(data_folder):
    return lambda name: data_folder("rigged-gltf") / f"{name}.glb"


@pytest.mark.parametrize("name", COUNTS)
def test_counts_are_those_of_the_readme(file, name):
    n, m, J = COUNTS[name]
    mesh = glb.read_mesh(file(name))
    assert (len(mesh.vertices), len(mesh.faces)) == (n, m)
    assert glb.clip_names(file(name)) == CLIPS[name]
    if J:
        assert glb.read_skin(file(name)).weights.shape == (n, J)


@pytest.mark.parametrize("name", COUNTS)
def test_trimesh_reads_the_same_mesh(file, name):
    ours, theirs = glb.read_mesh(file(name)), trimesh.load(file(name), process=False).to_geometry()
    assert_array_equal(ours.faces, theirs.faces)
    assert_allclose(ours.vertices, theirs.vertices, atol=1e-6 * ours.diagonal)
    if ours.uv is not None:
        assert_allclose(ours.uv, theirs.visual.uv, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "clip", "fps", "frames"),
    [
        ("Fox", "Survey", 24, 83),
        ("Fox", "Walk", 24, 18),
        ("CesiumMan", None, 24, 49),
        ("AnimatedMorphSphere", "Globe", 30, 217),
        ("horse-animations", "Walk", 30, 29),
        ("horse-animations", "Turn_Left", 30, 140),
    ],
)
def test_rates_come_from_the_keys(file, name, clip, fps, frames):
    read = glb.read_clip(file(name), clip)
    assert (read.fps, read.n_frames, read.source.fps, read.source.guessed) == (fps, frames, fps, ())


def test_uneven_keys_are_noted(file):
    clip = glb.read_clip(file("Fox"), "Run")
    assert clip.fps == 24 and clip.source.guessed == ("fps",)
    assert "not evenly spaced" in clip.source.notes[0]


@pytest.mark.parametrize(("name", "clip"), SKINNED)
def test_skinning_by_rig_and_joint_motion_agrees_with_baking(file, name, clip):
    skin, baked = glb.read_skin(file(name)), glb.read_clip(file(name), clip)
    posed = bake(skin, glb.read_skeleton_clip(file(name), clip))
    assert np.abs(posed - baked.vertices).max() < 1e-5 * baked.mesh.diagonal


@pytest.mark.parametrize(("name", "clip"), PLAYED)
def test_written_clip_comes_back(file, tmp_path, name, clip):
    was = glb.read_clip(file(name), clip)
    glb.write(tmp_path / "a.glb", was)
    back = glb.read_clip(tmp_path / "a.glb")
    assert np.abs(back.vertices - was.vertices).max() <= 1e-7 * was.mesh.diagonal
    assert_array_equal(back.faces, was.faces)
    assert back.fps == was.fps and back.mesh.groups.keys() == was.mesh.groups.keys()
    if was.mesh.uv is not None:
        assert_allclose(back.mesh.uv, was.mesh.uv, atol=1e-7)


def test_written_first_frame_is_what_trimesh_draws(file, tmp_path):
    clip = glb.read_clip(file("horse-animations"), "Walk")
    glb.write(
        tmp_path / "a.glb", type(clip)(clip.vertices, clip.mesh.with_vertices(clip.vertices[0]), clip.fps)
    )
    seen = trimesh.load(tmp_path / "a.glb", process=False).to_geometry()
    assert_array_equal(seen.vertices.astype(np.float32), clip.vertices[0])
    assert_array_equal(seen.faces, clip.faces)


def test_horse_walks_on_moving_legs_and_stays_in_one_piece(file):
    clip = glb.read_clip(file("horse-animations"), "Walk")
    skin = glb.read_skin(file("horse-animations"))
    travel = np.ptp(clip.vertices, axis=0).max(axis=1) / clip.mesh.diagonal
    low = clip.rest[:, 1] < 0.15 * clip.mesh.height
    assert (travel[low] > 0.1).all() and np.median(travel[~low]) < 0.1
    edges = np.unique(np.sort(clip.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    rest = np.linalg.norm(clip.rest[edges[:, 0]] - clip.rest[edges[:, 1]], axis=1)
    moved = np.linalg.norm(clip.vertices[:, edges[:, 0]] - clip.vertices[:, edges[:, 1]], axis=2)
    ratio = moved[:, rest > 1e-3 * clip.mesh.diagonal] / rest[rest > 1e-3 * clip.mesh.diagonal]
    assert 0.3 < np.percentile(ratio, 1) and np.percentile(ratio, 99) < 2
    assert skin.skeleton.names[0] == "root"


def test_people_and_animals_stand_upright_in_their_bind_pose(file):
    for name in ("human-male", "CesiumMan"):
        V = glb.read_mesh(file(name)).vertices
        assert np.ptp(V, axis=0).argmax() == (1 if name == "CesiumMan" else 0)
        assert 1.4 < np.ptp(V[:, 1]) < 1.9 and abs(V[:, 1].min()) < 0.02
    names = glb.read_skin(file("human-male")).skeleton.names
    assert {"pelvis", "head"} <= set(names)


def test_baking_agrees_with_a_loop_over_another_readers_file(file):
    """Frame 7 of CesiumMan, matrix by matrix in plain Python from what pygltflib reads."""
    g = pygltflib.GLTF2().load(file("CesiumMan"))
    frame, skin = 7, g.skins[0]
    local = {i: still(node) for i, node in enumerate(g.nodes)}
    pose = {i: {} for i in local}
    for channel in g.animations[0].channels:
        values = decoded(g, g.animations[0].samplers[channel.sampler].output)
        pose[channel.target.node][channel.target.path] = values[frame]
    parents = {c: i for i, node in enumerate(g.nodes) for c in node.children}

    def world(i):
        M = moved(g.nodes[i], pose[i]) if pose[i] else local[i]
        return world(parents[i]) @ M if i in parents else M

    inverse = decoded(g, skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
    matrices = [world(j) @ inverse[k] for k, j in enumerate(skin.joints)]
    attributes = g.meshes[0].primitives[0].attributes
    V, joints, weights = (
        decoded(g, i) for i in (attributes.POSITION, attributes.JOINTS_0, attributes.WEIGHTS_0)
    )
    ours = glb.read_clip(file("CesiumMan")).vertices[frame]
    for v in range(0, len(V), 37):
        point, total = np.append(V[v], 1.0), weights[v].astype(float).sum()
        expected = sum(
            w / total * (matrices[j] @ point)[:3] for j, w in zip(joints[v], weights[v].astype(float))
        )
        assert_allclose(ours[v], expected, atol=2e-6)


def still(node):
    if node.matrix is not None:
        return np.array(node.matrix).reshape(4, 4).T
    return moved(node, {})


def moved(node, pose):
    x, y, z, w = pose.get("rotation", node.rotation if node.rotation is not None else (0, 0, 0, 1))
    R = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ],
        dtype=float,
    )
    M = np.eye(4)
    M[:3, :3] = R * np.asarray(pose.get("scale", node.scale if node.scale is not None else (1, 1, 1)))
    M[:3, 3] = pose.get("translation", node.translation if node.translation is not None else (0, 0, 0))
    return M


def decoded(g, index):
    accessor = g.accessors[index]
    view = g.bufferViews[accessor.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[accessor.type]
    dtype = np.dtype({5123: "<u2", 5126: "<f4"}[accessor.componentType])
    step = view.byteStride or width * dtype.itemsize
    start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
    blob = g.binary_blob()
    rows = [np.frombuffer(blob, dtype, width, start + i * step) for i in range(accessor.count)]
    return np.stack(rows) if width > 1 else np.concatenate(rows)
