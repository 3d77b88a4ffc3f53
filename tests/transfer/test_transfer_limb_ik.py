"""A limb of two bones reaches what it can, smoothly, and turns no further than it must."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import human_body, t_body
from transfer_zoo import wxyz

from tempose.clips import SkinnedMesh
from tempose.rotations import IDENTITY, angle_between, multiply, rotate
from tempose.transfer.bodies.bones import Bones
from tempose.transfer.bodies.limb_ik import Limb, bend_axis, bones_below, find_limb, reach, two_bone_turns
from tempose.transfer.bodies.limb_range import SOFT_FAR, SOFT_NEAR, within_range
from tempose.transfer.bodies.pose import BonePose

X, Y, Z = np.eye(3)


def knee(angle: np.ndarray | float, a: float = 0.4, b: float = 0.35) -> tuple[np.ndarray, np.ndarray]:
    """A leg hanging down, bent backwards by an angle about +X."""
    angle = np.asarray(angle, dtype=float)
    upper = np.broadcast_to(-a * Y, (*angle.shape, 3))
    return upper, rotate(np.stack([np.cos(angle / 2), np.sin(angle / 2), 0 * angle, 0 * angle], -1), -b * Y)


def ends(upper: np.ndarray, lower: np.ndarray, goal: np.ndarray, hinge: np.ndarray = X) -> np.ndarray:
    first, second = two_bone_turns(upper, lower, goal, hinge)
    return rotate(first, upper) + rotate(second, lower)


def bend(upper: np.ndarray, lower: np.ndarray) -> np.ndarray:
    """Signed angle of the joint of a leg that hangs in the plane of X."""
    return np.arctan2(np.cross(upper, lower) @ X, np.sum(upper * lower, axis=-1))


def body_limb(body: SkinnedMesh, part: str) -> tuple[Limb, Bones]:
    skeleton = body.skeleton
    bones = Bones(
        skeleton.names, skeleton.names, np.arange(skeleton.n_joints), np.asarray(skeleton.parents, dtype=int)
    )
    starts = np.cumsum(np.zeros((skeleton.n_joints, 3)), axis=0)
    for j, parent in enumerate(skeleton.parents):
        starts[j] = skeleton.offsets[j] + (starts[parent] if parent >= 0 else 0)
    limb = find_limb(bones, BonePose(np.tile(IDENTITY, (len(starts), 1)), starts, starts), part)
    assert limb is not None
    return limb, bones


# ---- reaching


def test_what_is_within_reach_is_reached(rng: np.random.Generator) -> None:
    k = 400
    upper, lower = knee(rng.uniform(0.1, 2.5, k))
    turn = wxyz(Rotation.random(k, rng=rng))
    upper, lower, hinge = rotate(turn, upper), rotate(turn, lower), rotate(turn, np.tile(X, (k, 1)))
    direction = rng.normal(size=(k, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    goal = rng.uniform(0.05 + 0.05 * 0.75, 0.75 * (1 - SOFT_FAR) - 1e-9, k)[:, None] * direction
    first, second = two_bone_turns(upper, lower, goal, hinge)
    assert_allclose(rotate(first, upper) + rotate(second, lower), goal, rtol=0, atol=1e-12)
    assert_allclose(np.linalg.norm([first, second], axis=-1), 1, rtol=0, atol=1e-12)


@pytest.mark.parametrize("angle", [-0.15, -1e-3, 0.0, 1e-9, 1e-3, 0.3, 1.5, 3.0, np.pi])
def test_without_a_displacement_nothing_turns(angle: float) -> None:
    upper, lower = knee(angle)
    first, second = two_bone_turns(upper, lower, upper + lower, X)
    # the arc cosine loses half of the digits where the limb is straight or folded
    assert_allclose(angle_between(first, IDENTITY), 0, rtol=0, atol=2e-5)
    assert_allclose(angle_between(second, IDENTITY), 0, rtol=0, atol=2e-5)


def test_a_bent_limb_bends_in_its_own_plane(rng: np.random.Generator) -> None:
    """Whatever hinge is given, the normal of the plane turns only as the line to the goal does."""
    upper, lower = knee(0.8)
    goal = 0.9 * (upper + lower)
    for hinge in (X, -X, Z, np.array([0.6, 0, 0.8])):
        first, second = two_bone_turns(upper, lower, goal, hinge)
        assert_allclose(rotate(first, upper) @ X, 0, rtol=0, atol=1e-12)
        assert_allclose(rotate(second, lower) @ X, 0, rtol=0, atol=1e-12)
        assert_allclose(rotate(first, upper) + rotate(second, lower), goal, rtol=0, atol=1e-12)


def test_a_goal_at_the_same_distance_is_reached_by_the_shortest_rotation(rng: np.random.Generator) -> None:
    upper, lower = knee(0.9)
    end = upper + lower
    turn = wxyz(Rotation.random(50, rng=rng))
    goal = rotate(turn, end)
    first, second = two_bone_turns(upper, lower, goal, X)
    cosine = goal @ end / (end @ end)
    assert_allclose(angle_between(first, IDENTITY), np.arccos(cosine), rtol=0, atol=1e-7)
    assert_allclose(angle_between(first, second), 0, rtol=0, atol=1e-7)


def test_turned_and_scaled_limbs_do_alike(rng: np.random.Generator) -> None:
    upper, lower = knee(rng.uniform(0, 2, 30))
    goal = upper + lower + 0.2 * rng.normal(size=(30, 3))
    first, second = two_bone_turns(upper, lower, goal, X)
    turn = wxyz(Rotation.random(rng=rng))
    for unit in (1e-3, 1e3):
        u, v, g = (unit * rotate(turn, x) for x in (upper, lower, goal))
        other = two_bone_turns(u, v, g, rotate(turn, X))
        assert_allclose(multiply(other[0], turn), multiply(turn, first), rtol=0, atol=1e-8)
        assert_allclose(multiply(other[1], turn), multiply(turn, second), rtol=0, atol=1e-8)


def test_frames_together_are_frames_one_by_one(rng: np.random.Generator) -> None:
    upper, lower = knee(rng.uniform(0, 2, (2, 3)))
    goal = upper + lower + 0.2 * rng.normal(size=(2, 3, 3))
    together = two_bone_turns(upper, lower, goal, X)
    for i in np.ndindex(2, 3):
        alone = two_bone_turns(upper[i], lower[i], goal[i], X)
        assert_array_equal(together[0][i], alone[0])
        assert_array_equal(together[1][i], alone[1])


# ---- straight limbs, limits


def test_a_straight_limb_bends_about_its_hinge() -> None:
    for angle in (0.0, 0.02, -0.02, -0.15):
        upper, lower = knee(angle)
        first, second = two_bone_turns(upper, lower, 0.8 * (upper + lower), X)
        assert bend(rotate(first, upper), rotate(second, lower)) > 0.5


def test_noise_at_full_stretch_does_not_flip_the_knee(rng: np.random.Generator) -> None:
    """The plane in which a straight leg bends does not follow the noise of its direction."""
    upper, lower = knee(rng.normal(scale=0.03, size=200))
    lower = lower + 0.005 * rng.normal(size=lower.shape)
    first, second = two_bone_turns(upper, lower, 0.85 * (upper + lower), X)
    normal = np.cross(rotate(first, upper), rotate(second, lower))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert (normal @ X).min() > 0.99


@pytest.mark.parametrize("angle", [0.0, 0.05, 0.5, 2.0])
def test_a_goal_out_of_reach_is_approached_along_its_line(angle: float) -> None:
    upper, lower = knee(angle)
    for direction in (-Y, X, np.array([0.6, 0.0, -0.8])):
        far = np.array([1.0, 1.5, 10.0, 1e6])[:, None] * direction
        end = ends(*np.broadcast_arrays(upper, lower, far))
        assert_allclose(np.cross(end, direction), 0, rtol=0, atol=1e-9)
        distance = end @ direction
        assert (distance <= 0.75 + 1e-12).all()
        assert (distance > 0.75 * (1 - 0.34 * SOFT_FAR)).all()
        assert (np.diff(distance) >= -1e-12).all()


def test_range_joins_the_identity_with_two_derivatives() -> None:
    near, far, now, h = 0.05, 0.75, 0.4, 1e-4
    x = np.arange(0.0, 0.9, h)
    y = within_range(x, np.full_like(x, now), np.full_like(x, near), np.full_like(x, far))
    assert (y[x <= far] > near).all() and (y <= far).all() and (np.diff(y) >= 0).all()
    middle = np.logical_and(x > near + SOFT_NEAR * far, x < far * (1 - SOFT_FAR))
    assert_allclose(y[middle], x[middle], rtol=0, atol=1e-15)
    second = np.diff(y, 2) / h**2
    # a jump of the second derivative would be 1 / (SOFT far) between two samples
    assert np.abs(np.diff(second)).max() < 0.05 / (SOFT_FAR * far)


@pytest.mark.parametrize("now", [0.05, 0.051, 0.3, 0.74, 0.7499999, 0.75])
def test_range_keeps_what_is(now: float) -> None:
    assert within_range(*(np.array(v) for v in (now, now, 0.05, 0.75))) == pytest.approx(now, abs=1e-12)


# ---- smooth


def test_turns_are_differentiable_in_everything(rng: np.random.Generator) -> None:
    """Central differences of two step lengths agree: there is a derivative, and it is bounded."""
    k = 300
    upper, lower = knee(rng.uniform(0.02, 2.5, k))
    goal = upper + lower + rng.uniform(0, 0.4, (k, 1)) * rng.normal(size=(k, 3))
    moves = [rng.normal(size=(k, 3)) for _ in range(4)]

    def turned(s: float) -> np.ndarray:
        parts = [x + s * d for x, d in zip((upper, lower, goal, np.tile(X, (k, 1))), moves)]
        parts[3] /= np.linalg.norm(parts[3], axis=1, keepdims=True)
        return np.concatenate(two_bone_turns(*parts), axis=1)

    coarse, fine = ((turned(s) - turned(-s)) / (2 * s) for s in (2e-7, 1e-7))
    error = np.abs(coarse - fine).max(axis=1) / np.maximum(np.abs(fine).max(axis=1), 1)
    assert np.quantile(error, 0.98) < 1e-4
    assert error.max() < 2e-2


def test_a_path_through_full_stretch_and_back_has_no_jump() -> None:
    s = np.linspace(0, 1, 2001)
    upper, lower = knee(0.6)
    goal = (0.5 + 0.6 * np.sin(np.pi * s))[:, None] * np.array([0.2, -1.0, 0.3])
    first, second = two_bone_turns(np.tile(upper, (2001, 1)), np.tile(lower, (2001, 1)), goal, X)
    for q in (first, second):
        steps = angle_between(q[1:], q[:-1])
        assert steps.max() < 0.02
        assert np.abs(np.diff(steps)).max() < 0.004


def test_a_leg_pressed_back_comes_to_bend_without_a_jump() -> None:
    angle = np.linspace(-0.15, 0.3, 3001)
    upper, lower = knee(angle)
    for share in (0.999, 0.99, 0.9):
        first, second = two_bone_turns(upper, lower, share * (upper + lower), X)
        new = bend(rotate(first, upper), rotate(second, lower))
        assert np.abs(np.diff(new)).max() < 0.02


# ---- limbs of a body


@pytest.mark.parametrize("part", ["left_hand", "right_hand", "left_foot", "right_foot"])
def test_the_end_of_a_limb_moves_by_the_shift(part: str, rng: np.random.Generator) -> None:
    limb, bones = body_limb(human_body(), part)
    Q = np.tile(IDENTITY, (20, len(bones.names), 1))
    Q[:, limb.upper] = wxyz(Rotation.from_rotvec(0.3 * rng.normal(size=(20, 3))))
    Q[:, limb.lower] = multiply(wxyz(Rotation.from_rotvec(1.4 * limb.hinge)), Q[:, limb.upper])

    def place(Q: np.ndarray) -> np.ndarray:
        first = rotate(Q[:, limb.upper], limb.second - limb.first)
        return limb.first + first + rotate(Q[:, limb.lower], limb.end - limb.second)

    shift = 0.05 * rng.normal(size=(20, 3))
    for follow in (False, True):
        moved = reach(limb, Q, shift, follow=follow)
        assert_allclose(place(moved), place(Q) + shift, rtol=0, atol=1e-9)
        other = np.setdiff1d(np.arange(len(bones.names)), [limb.upper, limb.lower, *limb.carried])
        assert_array_equal(moved[:, other], Q[:, other])
        end = bones.find(part)
        if follow:
            assert_allclose(
                angle_between(moved[:, end], Q[:, end]),
                angle_between(moved[:, limb.lower], Q[:, limb.lower]),
                rtol=0,
                atol=1e-6,
            )
        else:
            assert_array_equal(moved[:, limb.carried], Q[:, limb.carried])
    still = reach(limb, Q, np.zeros(3))
    assert_allclose(angle_between(still, Q), 0, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("part", "axis"), [("left_foot", X), ("right_foot", X), ("left_hand", -Y), ("right_hand", Y)]
)
def test_limbs_straight_at_rest_bend_like_a_persons(part: str, axis: np.ndarray) -> None:
    limb, _ = body_limb(t_body(), part)
    assert_allclose(limb.hinge, axis, rtol=0, atol=1e-9)


def test_the_clip_tells_how_a_limb_bends() -> None:
    upper, lower = knee(0.0)
    Q = np.tile(IDENTITY, (5, 2, 1))
    Q[1:, 1] = wxyz(Rotation.from_rotvec(np.array([0.2, 0.5, 0.9, 1.2])[:, None] * Z))
    turn = wxyz(Rotation.random(rng=np.random.default_rng(1)))
    for frames in (Q, multiply(turn, Q), Q[::-1]):
        assert_allclose(bend_axis(upper, lower, -Z, frames), Z, rtol=0, atol=1e-9)
    # frames that contradict each other tell nothing
    Q[1:3, 1] = wxyz(Rotation.from_rotvec(np.array([-1.2, -0.9])[:, None] * Z))
    assert_allclose(bend_axis(upper, lower, -Z, Q), X, rtol=0, atol=1e-9)


def test_what_hangs_on_a_bone() -> None:
    parents = np.array([-1, 0, 1, 2, 0, 4])
    assert_array_equal(bones_below(parents, 0), np.arange(6))
    assert_array_equal(bones_below(parents, 1), [1, 2, 3])
    assert_array_equal(bones_below(parents, 5), [5])


def test_a_body_without_that_limb_has_none() -> None:
    bones = Bones(("a", "b"), ("hips", "left_hand"), np.arange(2), np.array([-1, 0]))
    pose = BonePose(np.tile(IDENTITY, (2, 1)), np.zeros((2, 3)), np.zeros((2, 3)))
    assert find_limb(bones, pose, "left_hand") is None
    assert find_limb(bones, pose, "head") is None
