"""The template: closed bones, carried rigidly."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import clip_of
from transfer_zoo import near_rotations, volume_of

from tempose.geometry import find_defects
from tempose.kinematics.roles import find_roles
from tempose.rotations import angle_between, conjugate, multiply
from tempose.samples.skeletons import human_skeleton
from tempose.transfer import template_clip
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.bodies.template import bone_mesh
from tempose.transfer.turns.mesh_source import face_patches, patch_rotations
from tempose.transfer.turns.reference import bone_motion


@pytest.mark.parametrize(("length", "radius"), [(1.0, 0.2), (0.01, 1.0), (300.0, 5.0)])
def test_a_bone_is_closed_and_faces_outwards(length: float, radius: float) -> None:
    V, F = bone_mesh(length, radius)
    defects = find_defects(V, F)
    assert defects.pieces == 1
    assert defects.boundary_edges == defects.nonmanifold_edges == defects.degenerate_faces == 0
    edges = np.unique(np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1), axis=0)
    assert len(V) - len(edges) + len(F) == 2
    assert volume_of(V, F) > 0
    assert_allclose(V[0], 0)
    assert_allclose(V[-1], [0, length, 0])
    assert np.hypot(V[:, 0], V[:, 2]).max() == pytest.approx(radius)


def test_every_face_turns_as_its_bone_does(rng) -> None:
    skeleton = human_skeleton()
    bones = make_bones(skeleton, skeleton.names, find_roles(skeleton))
    q = near_rotations(rng, (5, skeleton.n_joints))
    clip = clip_of(skeleton, {name: q[:, j] for j, name in enumerate(skeleton.names)}, 5)
    motion = bone_motion(clip, bones, find_roles(skeleton))
    made = template_clip(bones.names, motion, 24.0, "walk")
    assert made.fps == 24.0 and made.name == "walk" and set(made.mesh.groups) == set(bones.names)
    V, F = np.asarray(made.vertices, dtype=float), np.asarray(made.faces)
    assert find_defects(made.rest, F).pieces == len(bones.names)
    assert find_defects(made.rest, F).boundary_edges == 0
    for b, name in enumerate(bones.names):
        faces = made.mesh.groups[name][::9]
        turns = patch_rotations(V, made.rest, F, face_patches(F, len(made.rest), faces, 2))
        expected = multiply(motion.turns[:, b], conjugate(motion.turns[0, b]))
        assert angle_between(turns, expected[:, None]).max() < 2e-4
        # from the bone's start to its end
        mine = np.unique(F[made.mesh.groups[name]])
        assert_allclose(V[:, mine[0]], motion.starts[:, b], atol=1e-6)
        assert_allclose(V[:, mine[-1]], motion.ends[:, b], atol=1e-6)


def test_bones_without_length_become_small_ones() -> None:
    turns = np.tile([1.0, 0, 0, 0], (2, 3, 1))
    starts = np.array([[[0, 0, 0], [0, 1.0, 0], [1, 1, 1]]] * 2)
    ends = starts + np.array([[0, 1.0, 0], [0, 0, 0], [0.5, 0, 0]])
    made = template_clip(("a", "b", "c"), BonePose(turns, starts, ends), 30.0)
    mine = np.unique(made.faces[made.mesh.groups["b"]])
    size = np.ptp(made.rest[mine], axis=0)
    assert 0 < size.min() and size.max() < 0.5
    assert volume_of(made.rest, np.asarray(made.faces)[made.mesh.groups["b"]]) > 0
    nothing = template_clip(("a",), BonePose(turns[:, :1], starts[:, :1], starts[:, :1]), 30.0)
    assert np.ptp(nothing.rest, axis=0).min() > 0
    assert_array_equal(nothing.vertices[0], nothing.vertices[1])
