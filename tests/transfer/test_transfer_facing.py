"""Yaw: which way bodies face, and the turn between them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from transfer_bodies import clip_of
from transfer_zoo import as_rotation

from tempose.kinematics.roles import find_roles
from tempose.rotations import angle_between, rotate
from tempose.samples.skeletons import human_skeleton
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.bodies.facing import heading, lateral, yaw, yaw_between
from tempose.transfer.turns.reference import bone_rest

SKELETON = human_skeleton()
ROLES = find_roles(SKELETON)
BONES = make_bones(SKELETON, SKELETON.names, ROLES)
STARTS = bone_rest(clip_of(SKELETON, {}, 1), BONES, ROLES).starts


def test_yaw_turns_from_front_to_left() -> None:
    front = np.array([0.0, 0, 1])
    assert_allclose(rotate(yaw(np.pi / 2), front), [1, 0, 0], atol=1e-15)
    assert_allclose(heading(np.array([[0, 5.0, 1], [1, -3, 0], [0, 0, -2]])), [0, np.pi / 2, np.pi])


def test_heading_undoes_yaw(rng) -> None:
    angles = rng.uniform(-np.pi, np.pi, size=(4, 3))
    assert_allclose(heading(rotate(yaw(angles), np.array([0.0, 0.3, 1]))), angles, atol=1e-12)


def test_lateral_points_from_right_to_left() -> None:
    across = lateral(BONES, STARTS)
    assert across is not None
    assert_allclose(across / np.linalg.norm(across), [1, 0, 0], atol=1e-12)
    assert lateral(make_bones(SKELETON, ("hips", "head"), ROLES), STARTS[:2]) is None


@pytest.mark.parametrize("roles", [ROLES, {}])
def test_the_turn_between_a_body_and_itself_turned_is_that_turn(roles: dict[str, int], rng) -> None:
    """Known sides or none: then the best fit of all joints from above."""
    bones = make_bones(SKELETON, SKELETON.names, roles)
    angles = rng.uniform(-np.pi, np.pi, size=6)
    source = np.stack([rotate(yaw(a), STARTS) for a in angles]) + rng.normal(size=(6, 1, 3))
    found = yaw_between(bones, source, STARTS)
    assert_allclose(angle_between(found, yaw(angles)), 0, atol=1e-7)
    assert_allclose(
        rotate(found[:, None], STARTS), source - source[:, :1] + rotate(found, STARTS[0])[:, None]
    )


def test_the_fit_from_above_is_the_best_of_all_yaws(rng) -> None:
    bones = make_bones(SKELETON, SKELETON.names, {})
    source = STARTS + 0.1 * rng.normal(size=STARTS.shape)
    best = yaw_between(bones, source, STARTS)

    def misfit(q: np.ndarray) -> float:
        p, t = source - source.mean(axis=0), STARTS - STARTS.mean(axis=0)
        return float(((p - rotate(q, t))[:, [0, 2]] ** 2).sum())

    others = [misfit(yaw(a)) for a in np.linspace(-np.pi, np.pi, 721)]
    assert misfit(best) <= min(others) + 1e-9
    assert as_rotation(best).as_rotvec()[[0, 2]] == pytest.approx([0, 0])
