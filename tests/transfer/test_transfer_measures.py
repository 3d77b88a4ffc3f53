"""Measures of a transfer: their values where these are known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import clip_of, human_body
from transfer_zoo import marked, sheet, sphere, wxyz

from tempose.clips import Mesh
from tempose.kinematics.roles import find_roles
from tempose.metrics import skate
from tempose.rotations import rotate
from tempose.samples.skeletons import human_skeleton
from tempose.transfer import MotionTransfer
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.feet.feet import Feet
from tempose.transfer.quality.measures import (
    direction_measures,
    distortion_measures,
    foot_measures,
    soft_faces,
)
from tempose.transfer.turns.reference import bone_rest

SKELETON = human_skeleton()
ROLES = find_roles(SKELETON)
BONES = make_bones(SKELETON, SKELETON.names, ROLES)
REST = bone_rest(clip_of(SKELETON, {}, 1), BONES, ROLES)
UNTURNED = BonePose(np.tile([1.0, 0, 0, 0], (len(BONES.names), 1)), REST.starts, REST.ends)


def body_solver() -> tuple[MotionTransfer, np.ndarray]:
    body = human_body()
    owner = body.weights.argmax(axis=1)
    return MotionTransfer(body.mesh, np.arange(len(owner)), owner, len(BONES.names)), owner


def test_a_rigid_motion_distorts_nothing(rng) -> None:
    mesh = sphere()
    solver = MotionTransfer(mesh, *marked(mesh), 4)
    Q = np.repeat(wxyz(Rotation.random(20, rng=rng))[:, None], 4, axis=1)
    found = distortion_measures(solver, solver.pose(Q), Q, None)
    assert_allclose(found["edge_ratio"] + [found["edge_ratio_max"]], 1, atol=1e-9)
    assert found["flipped_percent"] == 0 and found["folded_percent"] == 0
    assert_allclose(found["volume"], 0, atol=1e-4)
    assert found["volume_worst"] == pytest.approx(0, abs=1e-7)
    assert found["quaternion_norm_min"] == pytest.approx(1, abs=1e-9)


def test_swelling_is_seen_in_edges_and_volume() -> None:
    mesh = sphere()
    solver = MotionTransfer(mesh, *marked(mesh), 4)
    Q = np.tile([1.0, 0, 0, 0], (3, 4, 1))
    frames = np.stack([s * np.array(mesh.vertices) for s in (1.0, 1.1, 0.9)])
    found = distortion_measures(solver, frames, Q, None)
    assert_allclose(found["edge_ratio"], [0.9, 1.1], atol=1e-9)
    assert_allclose(found["volume"], [0, 33.1, -27.1], atol=1e-3)
    assert found["volume_worst"] == pytest.approx(33.1)
    assert found["volume_mean"] == pytest.approx(2.0)


def test_a_texture_seam_does_not_open_the_volume_and_a_sheet_has_none() -> None:
    ball = sphere(1)
    n = len(ball.vertices)
    # the first faces have vertices of their own, at the same places
    F = np.array(ball.faces)
    F[:20] += n
    torn = Mesh(np.concatenate([ball.vertices, ball.vertices]), F)
    Q = np.tile([1.0, 0, 0, 0], (1, 4, 1))
    found = distortion_measures(
        MotionTransfer(torn, *marked(torn), 4), 1.1 * np.array(torn.vertices)[None], Q, None
    )
    assert found["volume"] == pytest.approx([33.1], abs=1e-3)
    curved = sheet(4)
    flat = curved.with_vertices(curved.vertices * np.array([1.0, 0, 1]))
    found = distortion_measures(
        MotionTransfer(flat, *marked(flat), 4), np.array(flat.vertices)[None], Q, None
    )
    assert found["volume"] is found["volume_worst"] is found["volume_mean"] is None
    assert found["edge_ratio"] == pytest.approx([1, 1])


def test_only_the_asked_faces_count_for_edges() -> None:
    mesh = sphere()
    solver = MotionTransfer(mesh, *marked(mesh), 4)
    V = np.array(mesh.vertices)
    up = V[:, 1] > 0
    V[up] *= 1.5
    still = ~up[mesh.faces].any(axis=1)
    found = distortion_measures(solver, V[None], np.tile([1.0, 0, 0, 0], (1, 4, 1)), still)
    assert_allclose(found["edge_ratio"] + [found["edge_ratio_max"]], 1, atol=1e-12)


def test_marks_that_contradict_each_other_are_seen_in_the_shortest_quaternion() -> None:
    mesh = sphere()
    solver = MotionTransfer(mesh, *marked(mesh, 2), 2)
    for degrees in (60, 170, 350):
        Q = wxyz(Rotation.from_rotvec(np.radians([[0.0, 0, 0], [0, degrees, 0]])))[None]
        found = distortion_measures(solver, solver.pose(Q), Q, None)["quaternion_norm_min"]
        share = solver.basis[:, 1]
        expected = np.sqrt(1 - 2 * share * (1 - share) * (1 - np.cos(np.radians(degrees) / 2)))
        assert found == pytest.approx(expected.min(), abs=1e-9)


def test_each_frame_is_judged_by_its_own_rotations(rng) -> None:
    """More frames than a block; a face is flipped against the rotation it was given, not against its rest."""
    mesh = sphere(1)
    solver = MotionTransfer(mesh, *marked(mesh), 4)
    Q = np.repeat(wxyz(Rotation.random(40, rng=rng))[:, None], 4, axis=1)
    V = solver.pose(Q)
    assert distortion_measures(solver, V, Q, None)["flipped_percent"] == 0
    mirrored = V * [1, 1, -1]
    assert distortion_measures(solver, mirrored, Q, None)["flipped_percent"] > 10


def test_soft_faces_are_those_of_no_end_part() -> None:
    mesh = Mesh(np.random.default_rng(0).normal(size=(4, 3)), [[0, 1, 2], [0, 1, 3], [1, 2, 3]])
    owner = np.array([0, 0, 0, 1])
    assert_array_equal(soft_faces(mesh.faces, owner, ("chest", "left_hand")), [True, False, False])
    assert soft_faces(mesh.faces, owner, ("chest", "left_thigh")) is None
    assert soft_faces(mesh.faces, np.ones(4, int), ("chest", "head")) is None


def test_a_body_that_turns_as_its_source_points_where_it_does(rng) -> None:
    solver, owner = body_solver()
    R = wxyz(Rotation.random(3, rng=rng))
    motion = BonePose(
        np.repeat(R[:, None], len(BONES.names), axis=1),
        *(rotate(R[:, None], x) for x in (REST.starts, REST.ends)),
    )
    V = rotate(R[:, None], solver.mesh.vertices)
    found = direction_measures(BONES, motion, UNTURNED, solver, owner, V)["bone_direction_deg"]
    assert found["max"] < 1e-5
    assert set(found["bones"]) == {
        s + p for s in ("left_", "right_") for p in ("upper_arm", "forearm", "thigh", "shin")
    }


def test_an_arm_that_points_elsewhere_is_seen_by_its_angle() -> None:
    solver, owner = body_solver()
    b = BONES.roles.index("left_forearm")
    axis = np.cross(REST.directions[b], [0.0, 1, 0])
    swing = wxyz(Rotation.from_rotvec(np.radians(25) * axis / np.linalg.norm(axis)))
    ends = REST.ends.copy()
    ends[b] = REST.starts[b] + rotate(swing, REST.ends[b] - REST.starts[b])
    motion = BonePose(REST.turns[None], REST.starts[None], ends[None])
    V = np.array(solver.mesh.vertices)[None]
    found = direction_measures(BONES, motion, UNTURNED, solver, owner, V)["bone_direction_deg"]
    assert found["bones"]["left_forearm"] == pytest.approx(25, abs=1e-3)
    assert found["max"] == pytest.approx(25, abs=1e-3)
    assert found["mean"] == pytest.approx(25 / 8, abs=1e-3)


def test_bodies_without_roles_are_judged_by_all_bones_but_the_roots() -> None:
    solver, owner = body_solver()
    nameless = make_bones(SKELETON, SKELETON.names, {})
    motion = BonePose(REST.turns[None], REST.starts[None], REST.ends[None])
    V = np.array(solver.mesh.vertices)[None]
    found = direction_measures(nameless, motion, UNTURNED, solver, owner, V)["bone_direction_deg"]
    assert set(found["bones"]) == set(SKELETON.names) - {"hips"}
    unknown = BonePose(UNTURNED.turns, UNTURNED.starts, UNTURNED.starts)
    assert direction_measures(nameless, motion, unknown, solver, owner, V) == {}


def test_feet_are_measured_in_heights_of_their_own_body() -> None:
    T = 12
    slide = np.arange(T)[:, None] * [0.02, 0, 0]
    foot = np.array([[0.0, 0, 0], [0.1, 0, 0], [0, 0.5, 0], [0, 1.5, 0]])
    V = foot + slide[:, None]
    contact = np.ones((T, 1), dtype=bool)
    feet = Feet(("left_foot",), 10 * slide[:, None] + [0, 0, 1.0], (np.array([0, 1]),), contact)
    found = foot_measures(feet, V, 1.5, 3.0, 0.0, 30.0)
    assert found["skate"] == pytest.approx(100 * 0.02 * 30 / 1.5)
    assert found["source_skate"] == pytest.approx(100 * 0.2 * 30 / 3.0)
    assert found["skate"] == skate(V, [np.array([0, 1])], contact, 1.5, 30.0)
    assert found["penetration_cm"] == pytest.approx(0, abs=1e-9)
    assert found["contact_frames"] == {"left_foot": 12}
    deep = foot_measures(feet, V - [0, 0.02, 0], 1.5, 3.0, 0.0, 30.0)
    assert deep["penetration_cm"] == pytest.approx(2.0)
    none = Feet((), np.zeros((T, 0, 3)), (), np.zeros((T, 0), dtype=bool))
    assert foot_measures(none, V, 1.5, 3.0, 0.0, 30.0) == {"skate": None, "source_skate": None}
