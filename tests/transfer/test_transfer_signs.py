"""Signs of quaternions: the rotations stay, neighbours in the tree and in time agree."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_zoo import as_rotation, solver_for, tube, wxyz

from tempose.rotations import conjugate, multiply
from tempose.transfer import consistent_signs

TREE = np.array([-1, 0, 1, 1, 3, 0])


def relative(Q: np.ndarray, parents: np.ndarray) -> np.ndarray:
    above = np.maximum(parents, 0)
    return multiply(conjugate(Q[:, above]), Q)


def smooth_motion(rng: np.random.Generator, T: int = 60, speed: float = 1.0) -> Rotation:
    """Six bones that tumble without jumps; shape (T, 6) flattened."""
    t = np.linspace(0, 2, T)[:, None, None]
    vectors = rng.normal(size=(6, 3)) + speed * np.sin(2 * t * rng.random((6, 3)) + rng.random((6, 3)))
    return Rotation.from_rotvec(vectors.reshape(-1, 3))


def test_rotations_stay_and_the_first_frame_agrees_with_the_tree(rng) -> None:
    raw = wxyz(Rotation.random(40 * 6, rng=rng)).reshape(40, 6, 4)
    Q = consistent_signs(raw, TREE)
    same = np.abs(np.sum(Q * raw, axis=-1))
    assert_allclose(same, 1, rtol=0, atol=1e-12)
    assert (relative(Q, TREE)[0, 1:, 0] >= 0).all()


def test_relative_rotations_have_no_jump_in_time(rng) -> None:
    raw = wxyz(smooth_motion(rng)).reshape(60, 6, 4)
    raw *= rng.choice([-1.0, 1.0], size=(60, 6, 1))
    Q = consistent_signs(raw, TREE)
    r = relative(Q, TREE)[:, 1:]
    assert (np.sum(r[1:] * r[:-1], axis=-1) > 0.9).all()


def test_signs_of_the_input_mean_nothing(rng) -> None:
    """But for the root's, which flips all bones together."""
    raw = wxyz(smooth_motion(rng)).reshape(60, 6, 4)
    signs = rng.choice([-1.0, 1.0], size=(60, 6, 1))
    Q, other = consistent_signs(raw, TREE), consistent_signs(raw * signs, TREE)
    assert_allclose(other * signs[:, :1], Q, rtol=0, atol=1e-12)


def test_a_rotation_of_everything_keeps_all_relative_signs(rng) -> None:
    """So a body that faces backwards is as whole as one that faces forwards."""
    raw = wxyz(smooth_motion(rng)).reshape(60, 6, 4)
    Q = consistent_signs(raw, TREE)
    for degrees in (90, 179, 180, 181, 270, 360):
        turn = wxyz(Rotation.from_euler("y", degrees, degrees=True))
        turned = consistent_signs(multiply(turn, raw), TREE)
        assert_allclose(relative(turned, TREE), relative(Q, TREE), rtol=0, atol=1e-12)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_limb_may_turn_two_times_round(direction: int) -> None:
    angle = direction * np.radians(np.arange(0, 721, 15))
    turns = wxyz(Rotation.from_rotvec(angle[:, None] * [0.0, 0.6, 0.8]))
    body = wxyz(Rotation.from_rotvec(np.linspace(0, 7, len(angle))[:, None] * [0, 1.0, 0]))
    raw = np.stack([body, multiply(body, turns)], axis=1)
    raw[:, 1] *= np.where(raw[:, 1, :1] < 0, -1.0, 1.0)  # as a matrix conversion would give them
    Q = consistent_signs(raw, np.array([-1, 0]))
    half = angle / 2
    expected = np.column_stack([np.cos(half), np.sin(half)[:, None] * [0.0, 0.6, 0.8]])
    assert_allclose(relative(Q, np.array([-1, 0]))[:, 1], expected, rtol=0, atol=1e-12)


def test_the_mesh_shows_no_jump_while_its_end_turns_round() -> None:
    mesh = tube(15, 12)
    solver = solver_for(mesh, 2)
    angle = np.radians(np.arange(0, 721, 5.0))
    # at 360 degrees the two ends cancel half-way, whatever the sign: the clip stops before
    raw = wxyz(Rotation.from_rotvec(angle[:, None] * [0, 1.0, 0]))
    raw *= np.where(np.arange(len(raw)) % 3 == 0, -1.0, 1.0)[:, None]
    still = np.tile([1.0, 0, 0, 0], (len(angle), 1))
    Q = consistent_signs(np.stack([still, raw], axis=1), np.array([-1, 0]))
    V = solver.pose(Q[:60])
    steps = np.linalg.norm(np.diff(V, axis=0), axis=2).max(axis=1)
    # 295 degrees in 59 steps: each vertex moves by less than its own angle step asks for, and a bit
    assert steps.max() < 2 * np.radians(5) * 0.25
    torn = solver.pose(np.stack([still, raw], axis=1)[:60])
    assert np.linalg.norm(np.diff(torn, axis=0), axis=2).max() > 4 * steps.max()


def test_a_tree_is_followed_not_the_order(rng) -> None:
    """A child three half-turns along a chain is judged by its parent, not by the root."""
    chain = np.array([-1, 0, 1, 2])
    turn = Rotation.from_euler("x", 100, degrees=True)
    raw = wxyz(Rotation.concatenate([turn**k for k in range(4)]))[None]
    Q = consistent_signs(raw * [[[1.0], [-1.0], [1.0], [-1.0]]], chain)
    expected = [np.cos(np.radians(50 * k)) for k in range(4)]
    assert_allclose(Q[0, :, 0], expected, rtol=0, atol=1e-12)


def test_bones_without_a_parent_hang_on_the_first(rng) -> None:
    raw = wxyz(Rotation.random(3, rng=rng))[None]
    loose = consistent_signs(raw, np.array([-1, -1, -1]))
    star = consistent_signs(raw, np.array([-1, 0, 0]))
    assert_allclose(loose, star, rtol=0, atol=0)


@pytest.mark.parametrize("shape", [(1, 1, 4), (1, 3, 4), (5, 1, 4), (0, 3, 4)])
def test_few_frames_and_few_bones(shape: tuple[int, ...], rng) -> None:
    raw = wxyz(Rotation.random(max(shape[0] * shape[1], 1), rng=rng))[: shape[0] * shape[1]].reshape(shape)
    Q = consistent_signs(raw, np.array([-1, 0, 1])[: shape[1]])
    assert Q.shape == shape
    assert_allclose(np.abs(np.sum(Q * raw, axis=-1)), 1, rtol=0, atol=1e-12)


def test_the_input_is_left_alone(rng) -> None:
    raw = wxyz(Rotation.random(6, rng=rng)).reshape(2, 3, 4)
    before = raw.copy()
    consistent_signs(raw, np.array([-1, 0, 0]))
    assert (raw == before).all()


def test_a_forest_against_one_bone_and_one_frame_at_a_time(rng) -> None:
    for _ in range(20):
        B, T = int(rng.integers(1, 12)), int(rng.integers(1, 8))
        parents = np.array([-1] + [int(rng.integers(-1, b)) for b in range(1, B)])
        raw = wxyz(Rotation.random(T * B, rng=rng)).reshape(T, B, 4)
        Q = raw.copy()
        for b in range(1, B):
            above = max(parents[b], 0)
            for t in range(T):
                now = as_rotation(Q[t, above]).inv() * as_rotation(Q[t, b])
                w = np.sum(Q[t, above] * Q[t, b])
                if t == 0:
                    keep = w >= 0
                else:
                    before = as_rotation(Q[t - 1, above]).inv() * as_rotation(Q[t - 1, b])
                    # the product of two unit quaternions' real parts, from their angle and its sign
                    dot = np.sum(
                        multiply(conjugate(Q[t, above]), Q[t, b])
                        * multiply(conjugate(Q[t - 1, above]), Q[t - 1, b])
                    )
                    assert abs(dot) == pytest.approx(np.cos((before.inv() * now).magnitude() / 2), abs=1e-9)
                    keep = dot >= 0
                Q[t, b] *= 1 if keep else -1
        assert_array_equal(consistent_signs(raw, parents), Q)
