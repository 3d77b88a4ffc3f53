"""A skin written to GLB comes back: mesh, joints, weights, and every frame of its vertices."""

from __future__ import annotations

import numpy as np
import pygltflib
import pytest
from moving_skins import odd_skeleton, odd_skin, wild_motion
from numpy.testing import assert_allclose, assert_array_equal

from tempose import formats
from tempose.clips import SkeletonClip, SkinnedMesh
from tempose.formats._influences import strongest
from tempose.kinematics import linear_blend_skinning, rest_transforms


def posed(skin: SkinnedMesh, motion: SkeletonClip) -> np.ndarray:
    return linear_blend_skinning(skin, motion.rotations, motion.root_position, motion.skeleton)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_everything_comes_back(tmp_path, size):
    skin = odd_skin(size)
    motion = wild_motion(skin.skeleton, fps=29.97)
    formats.save_skin(tmp_path / "a.glb", skin, motion)
    back, moves = formats.load_skin(tmp_path / "a.glb"), formats.load_skeleton_clip(tmp_path / "a.glb")
    assert back.skeleton.names == tuple(
        name for name in (skin.skeleton.names[j] for j in [0, 1, 3, 5, 2, 4])
    ), "parents first, as the nodes nest"
    order = [back.skeleton.index(name) for name in skin.skeleton.names]
    assert_allclose(back.weights[:, order], skin.weights, atol=1e-7)
    for here, there in zip(rest_transforms(back.skeleton), rest_transforms(skin.skeleton)):
        sign = np.sign((here[order] * there).sum(axis=1))[:, None] if here.shape[1] == 4 else 1.0
        assert_allclose(here[order] * sign, there, atol=1e-6 * max(size, 1e-3))
    assert_allclose(back.mesh.vertices, skin.mesh.vertices, atol=1e-6 * size)
    assert_array_equal(back.mesh.faces, skin.mesh.faces)
    assert_array_equal(back.mesh.polygons, skin.mesh.polygons)
    assert back.mesh.groups.keys() == skin.mesh.groups.keys() and back.mesh.name == skin.mesh.name
    assert_allclose(posed(back, moves), posed(skin, motion), atol=3e-6 * size)
    assert moves.n_frames == motion.n_frames and abs(moves.fps - motion.fps) < 1e-9


def test_baked_frames_are_the_posed_vertices(tmp_path):
    skin = odd_skin()
    motion = wild_motion(skin.skeleton)
    formats.save_skin(tmp_path / "a.glb", skin, motion)
    assert_allclose(formats.load_clip(tmp_path / "a.glb").vertices, posed(skin, motion), atol=3e-6)


def test_other_bone_lengths_of_the_motion_hold(tmp_path):
    skin = odd_skin()
    longer = odd_skeleton(1.0)
    motion = wild_motion(
        type(longer)(longer.names, longer.parents, longer.offsets * 1.3, longer.rest_rotations)
    )
    formats.save_skin(tmp_path / "a.glb", skin, motion)
    assert_allclose(formats.load_clip(tmp_path / "a.glb").vertices, posed(skin, motion), atol=3e-6)


def test_what_is_bound_to_nothing_stays(tmp_path):
    skin = odd_skin(loose=7)
    motion = wild_motion(skin.skeleton)
    formats.save_skin(tmp_path / "a.glb", skin, motion)
    V = formats.load_clip(tmp_path / "a.glb").vertices
    assert_allclose(V, posed(skin, motion), atol=3e-6)
    assert_array_equal(np.ptp(V[:, :7], axis=0), 0)


def test_without_motion_the_skin_rests(tmp_path):
    skin = odd_skin()
    formats.save_skin(tmp_path / "a.glb", skin)
    mesh = formats.load(tmp_path / "a.glb")
    assert_allclose(mesh.vertices, skin.mesh.vertices, atol=1e-6)


def test_four_weights_a_vertex_and_times_of_every_frame(tmp_path):
    skin = odd_skin(influences=6)
    motion = wild_motion(skin.skeleton)
    formats.save_skin(tmp_path / "a.glb", skin, motion)
    file = pygltflib.GLTF2().load(str(tmp_path / "a.glb"))
    attributes = file.meshes[0].primitives[0].attributes
    assert attributes.JOINTS_0 is not None and getattr(attributes, "JOINTS_1", None) is None
    assert file.accessors[attributes.JOINTS_0].componentType == 5123
    keys = {file.accessors[s.input].count for s in file.animations[0].samplers}
    assert keys == {motion.n_frames}
    weights = formats.load_skin(tmp_path / "a.glb").weights
    assert (weights > 0).sum(axis=1).max() == 4
    assert_allclose(weights.sum(axis=1), 1, atol=1e-7)


def test_keys_of_a_turn_stay_on_one_side(tmp_path):
    skin = odd_skin()
    formats.save_skin(tmp_path / "a.glb", skin, wild_motion(skin.skeleton, frames=60))
    channels = list(read_motion_channels(tmp_path / "a.glb"))
    assert len(channels) == skin.skeleton.n_joints
    for values in channels:
        assert (values[1:] * values[:-1]).sum(axis=1).min() > 0


def read_motion_channels(path):
    file = pygltflib.GLTF2().load(str(path))
    blob = file.binary_blob()
    for sampler in file.animations[0].samplers:
        accessor = file.accessors[sampler.output]
        if accessor.type == "VEC4":
            view = file.bufferViews[accessor.bufferView]
            yield np.frombuffer(blob, "<f4", 4 * accessor.count, view.byteOffset).reshape(-1, 4)


def test_strongest_keeps_sums_and_the_largest(rng):
    weights = rng.dirichlet(np.ones(7), size=50)
    joints, kept = strongest(weights, 3)
    assert_allclose(kept.sum(axis=1), 1)
    for row, chosen, share in zip(weights, joints, kept):
        assert set(chosen) == set(np.argsort(row)[-3:])
        assert_allclose(share / share[0], row[chosen] / row[chosen[0]])
    assert_array_equal(strongest(np.zeros((2, 3)), 4)[1], 0)


def test_broken_orders_are_refused(tmp_path):
    skin = odd_skin()
    motion = wild_motion(skin.skeleton)
    with pytest.raises(ValueError, match="other joint names"):
        formats.save_skin(
            tmp_path / "a.glb", skin, SkeletonClip(odd_other(), motion.rotations[:, :2], [[0, 0, 0]] * 12)
        )
    with pytest.raises(ValueError, match="at least one frame"):
        formats.save_skin(tmp_path / "a.glb", skin, motion.frames(slice(0, 0)))
    with pytest.raises(ValueError, match="always Y up"):
        formats.save_skin(tmp_path / "a.glb", skin, motion, up="z")
    with pytest.raises(formats.FormatError, match=r"goes into \.glb, \.usda"):
        formats.save_skin(tmp_path / "a.fbx", skin, motion)
    with pytest.raises(ValueError, match="blending must be"):
        formats.save_skin(tmp_path / "a.glb", skin, motion, blending="cubic")
    assert not list(tmp_path.iterdir())


def odd_other():
    from tempose.clips import Skeleton

    return Skeleton(("a", "b"), np.array([-1, 0]), np.zeros((2, 3)))
