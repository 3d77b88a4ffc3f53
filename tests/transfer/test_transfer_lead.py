"""Limbs that follow: the lead is nothing at rest, turns with the body, and takes the lag away."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import about, clip_of, scaled, t_body, t_pose, turned
from transfer_zoo import wxyz

from tempose.rotations import angle_between, multiply
from tempose.transfer import pairs_from_skin, transfer_motion
from tempose.transfer.from_skeleton import prepare_skeleton
from tempose.transfer.lead import Lead


def swinging(T: int = 24):
    """Arms and legs swing, elbows and knees bend."""
    phase = 2 * np.pi * np.arange(T) / T
    turns = {}
    for side, sign in (("left_", 1.0), ("right_", -1.0)):
        s = sign * np.sin(phase)[:, None]
        turns[side + "upper_arm"] = wxyz(Rotation.from_rotvec(s * [0.2, 0.3, 0.8]))
        turns[side + "forearm"] = wxyz(Rotation.from_rotvec((1 + s) * [0, 0.5 * sign, 0]))
        turns[side + "thigh"] = wxyz(Rotation.from_rotvec(s * [0.8, 0, 0.2]))
        turns[side + "shin"] = wxyz(Rotation.from_rotvec((1 - s) * [0.6, 0, 0]))
    return clip_of(t_pose(), turns, T)


def angles(lead: float) -> dict[str, float]:
    report = transfer_motion(swinging(12), t_body(), contacts=False, lead=lead).report
    return report["bone_direction_deg"]


def prepared(clip, body, **options):
    return prepare_skeleton(clip, body.mesh, pairs_from_skin(clip.skeleton, body), **options)


def test_limbs_point_where_the_source_points() -> None:
    off, some, all_ = (angles(lead) for lead in (0.0, 0.6, 1.0))
    assert some["mean"] < 0.6 * off["mean"] and some["max"] < 0.75 * off["max"]
    assert all_["mean"] < 0.3 * off["mean"]


def test_at_rest_nothing_leads() -> None:
    job = prepared(clip_of(t_pose(), {}, 3), t_body())
    assert_allclose(job.solver.pose(job.rotations)[0], t_body().mesh.vertices, rtol=0, atol=1e-5)


def test_only_arms_and_legs_lead() -> None:
    with_, without = (prepared(swinging(), t_body(), lead=lead) for lead in (0.6, 0.0))
    B = len(with_.bones.names)
    turned_by = angle_between(with_.rotations[:, :B], without.rotations[:, :B]).max(axis=0)
    for role, angle in zip(with_.bones.roles, turned_by):
        limb = role.split("_", 1)[-1] in ("upper_arm", "forearm", "thigh", "shin")
        assert (angle > 1e-3) == limb, role


def test_a_turn_of_everything_turns_the_lead_and_units_do_not_matter() -> None:
    turn = about("y", 130)
    plain = prepared(swinging(), t_body())
    other = prepared(turned(swinging(), turn), t_body())
    angle = angle_between(other.rotations, multiply(turn, plain.rotations))
    assert angle.max() < 1e-4
    large = prepared(scaled(swinging(), 100.0), t_body())
    assert angle_between(large.rotations, plain.rotations).max() < 1e-6


def test_the_lead_is_linear_and_continuous_past_half_a_turn() -> None:
    parents, matrix = np.array([-1, 0]), 0.1 * np.eye(3)
    half = np.radians(np.arange(0, 360, 2.0)) / 2
    Q = np.stack(
        [np.tile([1.0, 0, 0, 0], (180, 1)), np.c_[np.cos(half), np.sin(half), 0 * half, 0 * half]], 1
    )
    Lead(parents, {}).turned(Q)
    led = Lead(parents, {1: matrix}).turned(Q, 1.0)
    lead = angle_between(led[:, 1], Q[:, 1])
    assert_allclose(lead, 0.1 * 2 * np.sin(half), atol=1e-9)
    assert_allclose(
        angle_between(Lead(parents, {1: matrix}).turned(Q, 0.5)[:, 1], Q[:, 1]), lead / 2, atol=1e-9
    )
    assert (led[:, 0] == Q[:, 0]).all()
