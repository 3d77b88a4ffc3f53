"""Twist and rotations between two bones: followed through time, spread by place, exact in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import IDENTITY, about, clip_of, human_body, t_body, t_pose
from transfer_zoo import wxyz

from tempose.rotations import (
    angle_between,
    conjugate,
    from_rotation_vector,
    multiply,
    rotate,
    shortest_rotation,
)
from tempose.transfer import consistent_signs, pairs_from_skin
from tempose.transfer.from_skeleton import prepare_skeleton
from tempose.transfer.turns.columns import Between, Columns
from tempose.transfer.turns.twist import continuous_vectors, twist_angles

AXIS = np.array([0.6, 0.0, 0.8])
ROUNDS = np.radians(np.linspace(-100, 900, 301))


def turning(angles: np.ndarray, axis: np.ndarray = AXIS) -> np.ndarray:
    """Quaternions cos(a/2), sin(a/2): continuous in the angle, beyond a full turn too."""
    return np.column_stack([np.cos(angles / 2), np.sin(angles / 2)[:, None] * axis])


@pytest.mark.parametrize("direction", [1, -1])
def test_a_twist_is_followed_through_any_number_of_rounds(direction: int) -> None:
    q = turning(direction * ROUNDS)
    assert_allclose(twist_angles(q, AXIS), direction * ROUNDS, rtol=0, atol=1e-9)
    assert_allclose(continuous_vectors(q), direction * ROUNDS[:, None] * AXIS, rtol=0, atol=1e-9)


def test_a_swing_beside_it_does_not_change_the_twist(rng) -> None:
    swing = Rotation.from_rotvec(np.cross(rng.normal(size=(301, 3)), AXIS)).as_rotvec()
    swing *= np.minimum(1, 2 / np.linalg.norm(swing, axis=1, keepdims=True))
    q = multiply(from_rotation_vector(swing), turning(ROUNDS))
    assert_allclose(twist_angles(q, AXIS), ROUNDS, rtol=0, atol=1e-9)


def test_frames_that_swing_by_half_a_turn_take_their_twist_from_the_others() -> None:
    """There the twist is not defined: what stands there must not matter."""
    q = turning(np.linspace(0, 1, 21))
    q[10] = wxyz(Rotation.from_rotvec(np.pi * np.array([0, 1.0, 0])))
    assert_allclose(twist_angles(q, AXIS), np.linspace(0, 1, 21), rtol=0, atol=1e-9)


def test_vectors_are_logarithms_whatever_the_path(rng) -> None:
    t = np.linspace(0, 4, 200)[:, None]
    q = wxyz(Rotation.from_rotvec(2 * np.sin(t * rng.random(3) + rng.random(3))))
    q[1:] *= np.cumprod(np.where(np.sum(q[1:] * q[:-1], axis=1) < 0, -1.0, 1.0))[:, None]
    v = continuous_vectors(q)
    assert angle_between(from_rotation_vector(v), q).max() < 1e-2
    assert np.linalg.norm(np.diff(v, axis=0), axis=1).max() < 0.5


@pytest.mark.parametrize("T", [1, 2])
def test_rest_and_few_frames(T: int) -> None:
    q = np.tile(IDENTITY, (T, 1))
    assert (twist_angles(q, AXIS) == 0).all()
    assert (continuous_vectors(q) == 0).all()


def test_columns_between_two_bones_split_the_way_evenly(rng) -> None:
    Q = wxyz(Rotation.from_rotvec(0.5 * rng.normal(size=(30, 3)))).reshape(15, 2, 4)
    Q = consistent_signs(Q, np.array([-1, 0]))
    shares = (0.25, 0.5, 0.75, 1.0)
    columns = Columns(2, tuple(Between(0, 0, 1, s) for s in shares))
    found = columns.rotations(Q)
    whole = angle_between(Q[:, 0], Q[:, 1])
    assert_allclose(found[:, :2], Q, rtol=0, atol=0)
    for k, s in enumerate(shares):
        assert_allclose(angle_between(Q[:, 0], found[:, 2 + k]), s * whole, rtol=0, atol=1e-7)
        assert_allclose(angle_between(found[:, 2 + k], Q[:, 1]), (1 - s) * whole, rtol=0, atol=1e-7)


def test_a_bone_may_start_from_either_end() -> None:
    """The same rotation, stated from the bone above or from the bone itself."""
    Q = np.stack([turning(0 * ROUNDS), turning(ROUNDS)], axis=1)
    columns = Columns(2, (Between(0, 0, 1, 0.3), Between(1, 0, 1, -0.7)))
    found = columns.rotations(Q)
    assert_allclose(found[:, 2], found[:, 3], rtol=0, atol=1e-9)


def test_twist_columns_turn_about_the_bone_only(rng) -> None:
    Q = wxyz(Rotation.from_rotvec(0.6 * rng.normal(size=(40, 3)))).reshape(20, 2, 4)
    Q = consistent_signs(Q, np.array([-1, 0]))
    found = Columns(2, (Between(0, 0, 1, 0.5, AXIS), Between(0, 0, 1, 1.0, AXIS))).rotations(Q)
    for k in (2, 3):
        assert_allclose(rotate(found[:, k], AXIS), rotate(Q[:, 0], AXIS), rtol=0, atol=1e-12)
    # the whole twist and the swing that is left make the whole turn
    left = multiply(conjugate(found[:, 3]), Q[:, 1])
    straight = shortest_rotation(np.broadcast_to(AXIS, (20, 3)), rotate(left, AXIS))
    assert_allclose(angle_between(left, straight), 0, atol=1e-6)


def test_columns_belong_to_bones() -> None:
    columns = Columns(3, (Between(2, 0, 1, 0.5), Between(0, 0, 1, 0.5)))
    assert columns.bones.tolist() == [0, 1, 2, 2, 0] and len(columns) == 5
    assert_allclose(columns.of_bones(np.array([[1.0, 2, 3, 4, 5]])), [[6.0, 2, 7]])


def twisted(degrees: float, twist: bool) -> tuple[np.ndarray, np.ndarray, object]:
    """A T-pose whose left hand is turned about its forearm."""
    clip = clip_of(t_pose(), {"left_hand": about("x", degrees)}, 1)
    body = t_body()
    pairs = pairs_from_skin(clip.skeleton, body)
    job = prepare_skeleton(clip, body.mesh, pairs, twist=twist, lead=0)
    return job.solver.pose(job.rotations)[0], body.mesh.vertices, job


def smallest_ratio(V: np.ndarray, V_rest: np.ndarray, job) -> float:
    """Radius of the forearm and wrist, posed over rest, where it is thinnest."""
    b = job.bones.find("left_forearm")
    along = (V_rest - job.target.starts[b]) @ job.target.directions[b] / job.target.lengths[b]
    arm = np.isin(job.owner, [b, job.bones.find("left_hand")])
    ratios = []
    for s in np.arange(0.3, 1.0, 0.1):
        ring = arm & (np.abs(along - s) < 0.08)
        axis = [V[ring][:, 1:].mean(axis=0), V_rest[ring][:, 1:].mean(axis=0)]
        radius = [np.linalg.norm(X[ring][:, 1:] - c, axis=1).mean() for X, c in zip((V, V_rest), axis)]
        ratios.append(radius[0] / radius[1])
    return min(ratios)


def test_a_twisted_wrist_keeps_its_radius() -> None:
    """At 170 degrees; without the spread it shrinks to seven tenths."""
    assert smallest_ratio(*twisted(170.0, True)) > 0.85
    assert smallest_ratio(*twisted(170.0, False)) < 0.75


def test_rings_of_a_forearm_carry_the_share_of_their_place() -> None:
    _, _, job = twisted(120.0, True)
    b, hand = job.bones.find("left_forearm"), job.bones.find("left_hand")
    mine = [i for i, e in enumerate(job.columns.between) if e.bone == b]
    shares = np.array([job.columns.between[i].share for i in mine])
    assert len(shares) >= 4 and (shares > 0.25).all() and (shares < 1).all()
    angle = np.degrees(angle_between(job.rotations[0, b], job.rotations[0, job.columns.n_bones :][mine]))
    assert_allclose(angle, 120 * shares, atol=1e-6)
    assert np.degrees(angle_between(job.rotations[0, b], job.rotations[0, hand])) == pytest.approx(120)


def test_no_frame_jumps_while_the_hand_turns_two_times_round() -> None:
    angle = np.radians(np.arange(0, 721, 12.0))
    clip = clip_of(t_pose(), {"left_hand": wxyz(Rotation.from_rotvec(angle[:, None] * [1.0, 0, 0]))}, 61)
    body = t_body()
    job = prepare_skeleton(clip, body.mesh, pairs_from_skin(clip.skeleton, body))
    steps = np.linalg.norm(np.diff(job.solver.pose(job.rotations), axis=0), axis=2).max(axis=1)
    assert steps.max() < 1.3 * np.median(steps)


def test_without_twist_nothing_lies_between() -> None:
    clip, body = clip_of(t_pose(), {}, 1), human_body()
    job = prepare_skeleton(clip, body.mesh, pairs_from_skin(clip.skeleton, body), twist=False)
    assert job.columns.between == () and job.rotations.shape[1] == len(job.bones.names)
