"""Rotations found from vectors: shortest, polar, Procrustes, swing and twist, means."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.linalg import polar
from scipy.spatial.transform import Rotation

from tempose.rotations import (
    IDENTITY,
    angle_between,
    from_matrix,
    from_rotation_vector,
    mean_rotation,
    multiply,
    polar_rotation,
    procrustes_rotation,
    rotate,
    shortest_rotation,
    slerp,
    swing_twist,
    to_matrix,
    to_rotation_vector,
)

SHAPES = [(), (1,), (3, 1, 2), (0,)]


def unit(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    x = rng.normal(size=shape)
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


@pytest.mark.parametrize("shape", SHAPES)
def test_shortest_rotation_carries_a_to_b_by_their_angle(rng, shape) -> None:
    a, b = rng.normal(size=(*shape, 3)), rng.normal(size=(*shape, 3))
    q = shortest_rotation(a, b)
    assert q.shape == (*shape, 4)
    unit_b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    unit_a = a / np.linalg.norm(a, axis=-1, keepdims=True)
    assert_allclose(rotate(q, unit_a), unit_b, rtol=0, atol=1e-13)
    cosine = np.sum(unit_a * unit_b, axis=-1)
    assert_allclose(angle_between(q, IDENTITY), np.arccos(cosine), rtol=0, atol=1e-7)


@pytest.mark.parametrize("a", [*np.eye(3), [1, 1, 1], [1, -1, 0], [1e-9, 1, 1e-9], [0.3, 0.3, -0.9]])
def test_opposite_directions_turn_by_half_about_a_perpendicular_axis(a) -> None:
    a = np.array(a, dtype=float)
    q = shortest_rotation(a, -2 * a)
    assert_allclose(rotate(q, a), -a, rtol=0, atol=1e-15)
    assert_allclose([q[0], q[1:] @ a], 0, rtol=0, atol=1e-15)


@pytest.mark.parametrize("gap", [1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10])
def test_nearly_opposite_directions_are_met_to_rounding(rng, gap: float) -> None:
    a = unit(rng, (200, 3))
    across = unit(rng, (200, 3))
    b = -a + gap * across
    b /= np.linalg.norm(b, axis=1, keepdims=True)
    assert_allclose(rotate(shortest_rotation(a, b), a), b, rtol=0, atol=1e-14)


def test_same_direction_or_no_direction_is_no_rotation(rng) -> None:
    a = rng.normal(size=(50, 3))
    assert_allclose(shortest_rotation(a, 3 * a), np.tile(IDENTITY, (50, 1)), rtol=0, atol=1e-15)
    for x, y in [(0 * a, a), (a, 0 * a), (0 * a, 0 * a)]:
        assert_array_equal(shortest_rotation(x, y), np.tile(IDENTITY, (50, 1)))


def test_one_direction_broadcasts_against_many(rng) -> None:
    b = rng.normal(size=(5, 3))
    many = shortest_rotation(np.array([0.0, 1, 0]), b)
    for row, target in zip(many, b):
        assert_array_equal(row, shortest_rotation(np.array([0.0, 1, 0]), target))


@pytest.mark.parametrize("shape", SHAPES)
def test_polar_rotation_splits_off_a_symmetric_stretch(rng, shape) -> None:
    R = to_matrix(unit(rng, (*shape, 4)))
    B = rng.normal(size=(*shape, 3, 3))
    S = B @ np.swapaxes(B, -1, -2) + 0.1 * np.eye(3)
    assert_allclose(polar_rotation(R @ S), R, rtol=0, atol=1e-12)


def test_polar_rotation_agrees_with_scipy_and_is_the_nearest(rng) -> None:
    A = rng.normal(size=(40, 3, 3))
    A *= np.sign(np.linalg.det(A))[:, None, None]
    ours = polar_rotation(A)
    assert_allclose(ours, [polar(a)[0] for a in A], rtol=0, atol=1e-10)
    for _ in range(20):
        other = Rotation.random(40, rng=rng).as_matrix()
        assert (np.linalg.norm(A - ours, axis=(1, 2)) <= np.linalg.norm(A - other, axis=(1, 2))).all()


def test_a_reflection_is_answered_by_the_nearest_rotation(rng) -> None:
    A = -to_matrix(unit(rng, (40, 4))) * [1.0, 2.0, 3.0]
    ours = polar_rotation(A)
    assert_allclose(np.linalg.det(ours), 1, rtol=0, atol=1e-12)
    for _ in range(20):
        other = Rotation.random(40, rng=rng).as_matrix()
        assert (np.linalg.norm(A - ours, axis=(1, 2)) <= np.linalg.norm(A - other, axis=(1, 2)) + 1e-12).all()


@pytest.mark.parametrize("rank", [0, 1, 2])
def test_singular_matrices_still_give_a_rotation(rng, rank: int) -> None:
    A = rng.normal(size=(20, 3, rank)) @ rng.normal(size=(20, rank, 3))
    R = polar_rotation(A)
    assert_allclose(R @ np.swapaxes(R, 1, 2), np.tile(np.eye(3), (20, 1, 1)), rtol=0, atol=1e-13)
    assert_allclose(np.linalg.det(R), 1, rtol=0, atol=1e-13)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("weighted", [False, True])
def test_procrustes_recovers_a_known_motion(rng, shape, weighted: bool) -> None:
    P = rng.normal(size=(*shape, 9, 3))
    R = to_matrix(unit(rng, (*shape, 4)))
    Q = P @ np.swapaxes(R, -1, -2) * 2.5 + rng.normal(size=(*shape, 1, 3))
    weights = rng.random(9) if weighted else None
    assert_allclose(procrustes_rotation(P, Q, weights), R, rtol=0, atol=1e-12)


def test_procrustes_of_noisy_points_cannot_be_improved(rng) -> None:
    P, w = rng.normal(size=(12, 3)), rng.random(12)
    Q = P @ Rotation.random(rng=rng).as_matrix().T + 0.3 * rng.normal(size=(12, 3))
    R = procrustes_rotation(P, Q, w)

    def cost(R: np.ndarray) -> float:
        centre_p, centre_q = w @ P / w.sum(), w @ Q / w.sum()
        return float(w @ np.square((P - centre_p) @ R.T - (Q - centre_q)).sum(axis=1))

    for v in np.concatenate([1e-3 * unit(rng, (20, 3)), unit(rng, (20, 3))]):
        assert cost(Rotation.from_rotvec(v).as_matrix() @ R) > cost(R)
    assert cost(R) <= Rotation.align_vectors(Q - w @ Q / w.sum(), P - w @ P / w.sum(), w)[1] ** 2 + 1e-9


def test_procrustes_ignores_points_of_no_weight(rng) -> None:
    P = rng.normal(size=(6, 3))
    R = Rotation.random(rng=rng).as_matrix()
    Q = P @ R.T
    Q[5] += 100
    assert_allclose(procrustes_rotation(P, Q, np.array([1, 1, 1, 1, 1, 0])), R, rtol=0, atol=1e-12)


def test_planar_points_get_a_proper_rotation(rng) -> None:
    P = rng.normal(size=(8, 3)) * [1, 1, 0]
    R = Rotation.random(rng=rng).as_matrix()
    assert_allclose(procrustes_rotation(P, P @ R.T), R, rtol=0, atol=1e-12)


@pytest.mark.parametrize("weights", [[0.0, 0, 0], [1.0, -1, 0], [np.nan, 1, 1], [1.0, 1]])
def test_weights_that_mean_nothing_are_refused(rng, weights) -> None:
    P = rng.normal(size=(3, 3))
    with pytest.raises(ValueError, match="weights must"):
        procrustes_rotation(P, P, np.array(weights))
    with pytest.raises(ValueError, match="weights must"):
        mean_rotation(unit(rng, (3, 4)), np.array(weights))


@pytest.mark.parametrize("shape", SHAPES)
def test_swing_times_twist_is_the_rotation(rng, shape) -> None:
    q, axis = unit(rng, (*shape, 4)), unit(rng, (*shape, 3))
    swing, twist = swing_twist(q, axis)
    assert swing.shape == twist.shape == (*shape, 4)
    assert_allclose(multiply(swing, twist), q, rtol=0, atol=1e-14)
    assert_allclose(np.sum(swing[..., 1:] * axis, axis=-1), np.zeros(shape), rtol=0, atol=1e-14)
    assert_allclose(rotate(twist, axis), axis, rtol=0, atol=1e-14)
    # the swing is the shortest way for the axis
    assert_allclose(
        angle_between(swing, shortest_rotation(axis, rotate(q, axis))), np.zeros(shape), rtol=0, atol=1e-6
    )


@pytest.mark.parametrize("angle", [0, 1e-9, 1, np.pi, -3, 6])
def test_a_pure_twist_has_no_swing_and_a_pure_swing_no_twist(rng, angle: float) -> None:
    axis = unit(rng, (20, 3))
    swing, twist = swing_twist(from_rotation_vector(angle * axis), axis)
    assert_allclose(swing, np.tile(IDENTITY, (20, 1)), rtol=0, atol=1e-14)
    assert_allclose(to_matrix(twist), to_matrix(from_rotation_vector(angle * axis)), rtol=0, atol=1e-14)
    across = np.cross(axis, unit(rng, (20, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    tilt = from_rotation_vector(0.9 * angle / 2 * across)
    _, twist = swing_twist(tilt, axis)
    assert_allclose(to_matrix(twist), np.tile(np.eye(3), (20, 1, 1)), rtol=0, atol=1e-14)


def test_a_half_turn_of_the_axis_itself_is_all_swing(rng) -> None:
    q = np.array([0.0, 1, 0, 0])
    swing, twist = swing_twist(q, np.array([0.0, 0, 1]))
    assert_array_equal(twist, IDENTITY)
    assert_array_equal(swing, q)


def test_the_mean_of_equals_is_that_rotation_whatever_the_signs(rng) -> None:
    q = unit(rng, (4,))
    signs = np.array([1, -1, -1, 1, -1.0])[:, None]
    assert_allclose(mean_rotation(signs * q), q * np.sign(q[0]), rtol=0, atol=1e-14)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_mean_ignores_signs_and_order_and_follows_both_sides(rng, shape) -> None:
    q = unit(rng, (6, *shape, 4))
    mean = mean_rotation(q)
    assert mean.shape == (*shape, 4) and (mean[..., 0] >= 0).all()
    signs = rng.choice([-1.0, 1.0], size=(6, *shape, 1))
    assert_allclose(mean_rotation((signs * q)[::-1]), mean, rtol=0, atol=1e-12)
    p, r = unit(rng, (4,)), unit(rng, (4,))
    moved = mean_rotation(multiply(multiply(p, q), r))
    assert_allclose(angle_between(moved, multiply(multiply(p, mean), r)), np.zeros(shape), rtol=0, atol=1e-7)


def test_the_mean_of_two_lies_half_way_and_weights_pull(rng) -> None:
    p = unit(rng, (4,))
    q = multiply(p, from_rotation_vector(np.array([0.5, 0.1, -0.2])))
    assert angle_between(mean_rotation(np.stack([p, -q])), slerp(p, q, 0.5)) < 1e-7
    assert_allclose(
        angle_between(mean_rotation(np.stack([p, q]), np.array([1.0, 0])), p), 0, rtol=0, atol=1e-7
    )
    thrice = mean_rotation(np.stack([p, p, p, q]))
    assert angle_between(mean_rotation(np.stack([p, q]), np.array([3.0, 1])), thrice) < 1e-7


def test_the_mean_maximises_the_summed_squared_cosine(rng) -> None:
    q = multiply(unit(rng, (4,)), from_rotation_vector(0.5 * rng.normal(size=(15, 3))))
    mean = mean_rotation(q)

    def score(m: np.ndarray) -> float:
        return float(np.square(q @ m).sum())

    for v in 1e-3 * unit(rng, (30, 3)):
        assert score(multiply(mean, from_rotation_vector(v))) < score(mean)


def test_the_mean_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one rotation"):
        mean_rotation(np.zeros((0, 4)))


def test_matrix_and_vector_forms_agree_on_a_kabsch_fit(rng) -> None:
    P = rng.normal(size=(7, 3))
    v = np.array([0.3, -1.2, 2.0])
    R = procrustes_rotation(P, rotate(from_rotation_vector(v), P))
    assert_allclose(to_rotation_vector(from_matrix(R)), v, rtol=0, atol=1e-12)
