"""Which bones turn for a part, how they share a turn, and how a displacement fades over a surface."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import human_body
from transfer_zoo import tube, wxyz

from tempose.kinematics import rest_transforms
from tempose.rotations import IDENTITY, angle_between, conjugate, multiply, rotate
from tempose.transfer.adjustments.chains import LimbChain, TurnChain, find_chain
from tempose.transfer.bodies.bones import Bones
from tempose.transfer.bodies.pose import BonePose
from tempose.transfer.solver.limb_field import limb_field
from tempose.transfer.solver.motion_transfer import MotionTransfer

SKELETON = human_body().skeleton
BONES = Bones(
    SKELETON.names,
    SKELETON.names,
    np.arange(SKELETON.n_joints),
    np.asarray(SKELETON.parents, dtype=np.int64),
)
STARTS = rest_transforms(SKELETON)[1]
TARGET = BonePose(np.tile(IDENTITY, (len(STARTS), 1)), STARTS, STARTS)
STILL = np.tile(IDENTITY, (1, len(STARTS), 1))


def joints_of(Q: np.ndarray) -> np.ndarray:
    """Joints that go with world rotations relative to the rest, the root in its place."""
    P = np.zeros((len(Q), len(STARTS), 3))
    for j, parent in enumerate(BONES.parents):
        arm = STARTS[j] - STARTS[parent] if parent >= 0 else STARTS[j]
        P[:, j] = P[:, parent] + rotate(Q[:, parent], arm) if parent >= 0 else arm
    return P


def chain(part: str, point: np.ndarray | None = None) -> LimbChain | TurnChain:
    bone = BONES.find(part)
    assert bone is not None
    found = find_chain(BONES, TARGET, bone, point, STILL)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("part", "turning"),
    [
        ("left_hand", ["left_upper_arm", "left_forearm"]),
        ("right_foot", ["right_thigh", "right_shin"]),
        ("left_toes", ["left_thigh", "left_shin"]),
        ("left_forearm", ["left_upper_arm"]),
        ("right_shin", ["right_thigh"]),
        ("left_upper_arm", ["left_clavicle"]),
        ("head", ["spine", "chest", "neck"]),
        ("chest", ["spine"]),
    ],
)
def test_the_bones_that_move_a_part(part: str, turning: list[str]) -> None:
    found = chain(part)
    if isinstance(found, LimbChain):
        assert [BONES.roles[found.limb.upper], BONES.roles[found.limb.lower]] == turning
    else:
        assert [BONES.roles[b] for b in found.pivots] == turning
    assert BONES.roles[found.top] == turning[0]


def test_what_hangs_on_the_root_has_no_chain() -> None:
    for part in ("hips", "spine", "left_thigh"):
        bone = BONES.find(part)
        assert bone is not None
        assert find_chain(BONES, TARGET, bone, None, STILL) is None


def test_a_point_on_the_shin_is_the_end_of_a_shorter_limb(rng: np.random.Generator) -> None:
    knee, ankle = (STARTS[BONES.find(f"left_{part}")] for part in ("shin", "foot"))
    point = knee + 0.7 * (ankle - knee)
    found = chain("left_shin", point)
    assert isinstance(found, LimbChain)
    shift = np.array([[0.0, 0.1, 0.02]])
    moved = found.move(STILL, shift, False)
    shin = BONES.find("left_shin")
    place = joints_of(moved)[:, shin] + rotate(moved[:, shin], point - knee)
    assert_allclose(place, point + shift, rtol=0, atol=1e-9)
    near = chain("left_shin", knee + 0.1 * (ankle - knee))
    assert isinstance(near, TurnChain) and BONES.roles[near.pivots[0]] == "left_thigh"


@pytest.mark.parametrize("follow", [True, False])
@pytest.mark.parametrize("part", ["head", "neck", "chest", "left_upper_arm", "right_shin"])
def test_a_part_goes_towards_its_goal_by_equal_steps(
    part: str, follow: bool, rng: np.random.Generator
) -> None:
    found = chain(part)
    assert isinstance(found, TurnChain)
    Q = multiply(wxyz(Rotation.from_rotvec(0.3 * rng.normal(size=(20, len(STARTS), 3)))), STILL)
    shift = 0.3 * found.length * rng.normal(size=(20, 3))
    moved = found.move(Q, shift, follow)
    before, after = joints_of(Q)[:, found.bone], joints_of(moved)[:, found.bone]
    pivot = joints_of(Q)[:, found.top]
    goal = before + shift - pivot
    reached = after - pivot
    cosine = np.sum(goal * reached, axis=1) / np.linalg.norm(goal, axis=1) / np.linalg.norm(reached, axis=1)
    assert_allclose(cosine, 1, rtol=0, atol=1e-7)
    # every bone of the chain turns about one axis, by an equal step more than the one below it
    turns = multiply(moved, conjugate(Q))
    steps = [angle_between(turns[:, a], turns[:, b]) for a, b in zip(found.pivots, found.pivots[1:])]
    first = angle_between(turns[:, found.top], IDENTITY)
    for step in steps:
        assert_allclose(step, first, rtol=0, atol=1e-6)
    kept = angle_between(turns[:, found.bone], turns[:, found.pivots[-1]] if follow else IDENTITY)
    assert_allclose(kept, 0, rtol=0, atol=1e-6)
    legs = [b for b, role in enumerate(BONES.roles) if role.startswith("left_") and "thigh" in role]
    assert_array_equal(moved[:, legs], Q[:, legs])


def test_a_body_without_names_has_limbs_by_its_tree() -> None:
    parents = np.array([-1, 0, 1, 2, 0, 4])
    bones = Bones(tuple("abcdef"), ("",) * 6, np.arange(6), parents)
    starts = np.array(
        [[0, 1, 0], [0.1, 1, 0], [0.1, 0.6, 0], [0.1, 0.2, 0.1], [0, 1.2, 0], [0, 1.4, 0]], float
    )
    pose = BonePose(np.tile(IDENTITY, (6, 1)), starts, starts)
    Q = np.tile(IDENTITY, (1, 6, 1))
    paw = find_chain(bones, pose, 3, None, Q)
    assert isinstance(paw, LimbChain) and (paw.limb.upper, paw.limb.lower) == (1, 2)
    tail = find_chain(bones, pose, 5, None, Q)
    assert isinstance(tail, TurnChain) and tail.pivots == (4,)


# ---- the field of a displacement


def test_the_field_of_a_tube_is_a_smooth_step_along_it() -> None:
    mesh = tube()
    y = mesh.vertices[:, 1]
    low, high = np.flatnonzero(y < y.min() + 1e-9), np.flatnonzero(y > y.max() - 1e-9)
    solver = MotionTransfer(mesh, low, np.zeros(len(low), dtype=int), 1)
    field = limb_field(solver, high, low)
    s = (y - y.min()) / np.ptp(y)
    assert_allclose(field, 3 * s**2 - 2 * s**3, rtol=0, atol=1e-5)
    assert_array_equal(field[high], 1)
    assert_array_equal(field[low], 0)
    assert_allclose(limb_field(solver, low, high), 1 - field, rtol=0, atol=1e-9)


def test_the_field_where_only_one_side_is_known() -> None:
    mesh = tube()
    solver = MotionTransfer(mesh, np.arange(3), np.zeros(3, dtype=int), 1)
    nothing = np.zeros(0, dtype=int)
    assert_array_equal(limb_field(solver, np.arange(3), nothing), 1)
    assert_array_equal(limb_field(solver, nothing, np.arange(3)), 0)
    assert_array_equal(limb_field(solver, nothing, nothing), 0)
    assert limb_field(solver, np.arange(3), np.arange(2, 9))[2] == 0
