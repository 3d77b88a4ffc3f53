"""Poses that made a clip are found again, whatever the unit, the place and the jumps between frames."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from pose_cases import J, posed, random_motion, random_skin

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.kinematics import dual_quaternion_skinning, linear_blend_skinning
from tempose.rigging.pose_fit import fit_poses
from tempose.rotations import angle_between, from_rotation_vector, multiply, rotate

TIGHT = {"tolerance": 1e-12}


def angles(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    return angle_between(found, truth)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("at", [0.0, 100.0])
def test_poses_are_found_again_in_any_unit_and_place(rng, unit, at) -> None:
    skin = random_skin(rng, unit, at)
    truth = random_motion(skin, rng)
    fit = fit_poses(skin, posed(skin, truth), **TIGHT)
    assert_allclose(angles(fit.motion.rotations, truth[0]), 0, atol=2e-6)
    assert_allclose(fit.motion.root_position, truth[1], rtol=0, atol=1e-7 * unit * (1 + at))
    assert fit.errors.max() < 1e-7 * unit * (1 + at)
    assert fit.converged.all() and (fit.iterations > 0).all()


def test_errors_are_the_distances_of_the_posed_skin(rng) -> None:
    skin = random_skin(rng)
    noisy = posed(skin, random_motion(skin, rng)) + 0.1 * rng.normal(size=(6, len(skin.weights), 3))
    fit = fit_poses(skin, noisy)
    distance = posed(skin, (fit.motion.rotations, fit.motion.root_position)) - noisy
    assert_allclose(fit.errors, np.sqrt((distance**2).sum(axis=2).mean(axis=1)), rtol=1e-8)


def test_no_small_turn_of_any_joint_fits_better(rng) -> None:
    skin = random_skin(rng)
    noisy = posed(skin, random_motion(skin, rng, 2)) + 0.2 * rng.normal(size=(2, len(skin.weights), 3))
    fit = fit_poses(skin, noisy, **TIGHT)
    for j in range(J):
        for axis in np.eye(3):
            for h in (-1e-3, 1e-3):
                pose = fit.motion.rotations.copy()
                pose[:, j] = multiply(pose[:, j], from_rotation_vector(h * axis))
                other = posed(skin, (pose, fit.motion.root_position)) - noisy
                assert (np.sqrt((other**2).sum(axis=2).mean(axis=1)) > fit.errors).all()


def test_a_turned_and_shifted_clip_has_the_same_poses_below_the_root(rng) -> None:
    skin = random_skin(rng)
    noisy = posed(skin, random_motion(skin, rng)) + 0.05 * rng.normal(size=(6, len(skin.weights), 3))
    turn, shift = from_rotation_vector(rng.normal(size=3)), rng.normal(size=3)
    here, there = fit_poses(skin, noisy, **TIGHT), fit_poses(skin, rotate(turn, noisy) + shift, **TIGHT)
    assert_allclose(angles(here.motion.rotations[:, 1:], there.motion.rotations[:, 1:]), 0, atol=1e-6)
    assert_allclose(
        angles(multiply(turn, here.motion.rotations[:, 0]), there.motion.rotations[:, 0]), 0, atol=1e-6
    )
    assert_allclose(there.errors, here.errors, rtol=1e-7)


def test_the_order_of_vertices_does_not_matter(rng) -> None:
    skin = random_skin(rng)
    noisy = posed(skin, random_motion(skin, rng)) + 0.05 * rng.normal(size=(6, len(skin.weights), 3))
    order = rng.permutation(len(skin.weights))
    other = SkinnedMesh(Mesh(skin.mesh.vertices[order], skin.mesh.faces), skin.skeleton, skin.weights[order])
    a, b = fit_poses(skin, noisy, **TIGHT), fit_poses(other, noisy[:, order], **TIGHT)
    assert_allclose(angles(a.motion.rotations, b.motion.rotations), 0, atol=1e-6)


def test_a_limb_that_jumps_is_found_without_the_frame_before(rng) -> None:
    skin = random_skin(rng)
    rotations, root = random_motion(skin, rng, 40, size=0.2)
    rotations[20:, 1] = multiply(rotations[20:, 1], from_rotation_vector(np.array([0.0, 0, 3.0])))
    rotations[20:, 2] = multiply(rotations[20:, 2], from_rotation_vector(np.array([2.9, 0, 0])))
    fit = fit_poses(skin, posed(skin, (rotations, root)), **TIGHT)
    assert fit.errors.max() < 1e-6
    assert_allclose(angles(fit.motion.rotations, rotations), 0, atol=1e-5)


def test_a_joint_that_turns_on_and_on_keeps_its_sign(rng) -> None:
    skin = random_skin(rng)
    turn = np.linspace(0, 6 * np.pi, 90)[:, None] * np.array([0.0, 1, 0])
    rotations = np.tile(skin.skeleton.rest_rotations, (90, 1, 1))
    rotations[:, 4] = multiply(rotations[:, 4], from_rotation_vector(turn))
    fit = fit_poses(skin, posed(skin, (rotations, np.zeros((90, 3)))), **TIGHT)
    q = fit.motion.rotations
    assert ((q[1:] * q[:-1]).sum(axis=-1) > 0.9).all()
    assert_allclose(angles(q, rotations), 0, atol=1e-5)


def test_joints_that_hold_nothing_do_no_harm(rng) -> None:
    skin = random_skin(rng)
    weights = skin.weights.copy()
    weights[:, [0, 1, 5]] = 0  # the root, one inside a limb, one at its end
    kept = weights.sum(axis=1) > 0
    weights[kept] /= weights[kept].sum(axis=1, keepdims=True)
    loose = SkinnedMesh(skin.mesh, skin.skeleton, weights)
    truth = random_motion(skin, rng)
    Y = linear_blend_skinning(loose, *truth)
    fit = fit_poses(loose, Y, **TIGHT)
    again = linear_blend_skinning(loose, fit.motion.rotations, fit.motion.root_position)
    assert_allclose(again, Y, rtol=0, atol=1e-6)
    assert np.isfinite(fit.motion.rotations).all()


def test_bones_may_be_longer_in_the_clip_than_in_the_bind_pose(rng) -> None:
    skin = random_skin(rng)
    tree = skin.skeleton
    longer = Skeleton(tree.names, tree.parents, 1.3 * tree.offsets, tree.rest_rotations)
    truth = random_motion(skin, rng)
    Y = linear_blend_skinning(skin, *truth, longer)
    fit = fit_poses(skin, Y, skeleton=longer, **TIGHT)
    assert fit.motion.skeleton is longer and fit.errors.max() < 1e-6
    assert_allclose(angles(fit.motion.rotations, truth[0]), 0, atol=2e-6)
    assert fit_poses(skin, Y).errors.min() > 1e-2


def test_dual_quaternion_poses_are_found_again(rng) -> None:
    skin = random_skin(rng)
    truth = random_motion(skin, rng, size=0.4)
    # half a turn of the whole: bones on both sides of it are written with opposite signs
    truth[0][:, 0] = multiply(from_rotation_vector(np.array([0.0, np.pi, 0])), truth[0][:, 0])
    Y = dual_quaternion_skinning(skin, *truth)
    fit = fit_poses(skin, Y, blending="dual-quaternion", steps=100, **TIGHT)
    assert_allclose(angles(fit.motion.rotations, truth[0]), 0, atol=1e-4)
    assert fit.errors.max() < 1e-5 and fit_poses(skin, Y).errors.min() > 1e-3


def test_dual_quaternion_errors_are_least_and_those_of_the_skin(rng) -> None:
    skin = random_skin(rng)
    noisy = posed(skin, random_motion(skin, rng)) + 0.05 * rng.normal(size=(6, len(skin.weights), 3))
    fit = fit_poses(skin, noisy, blending="dual-quaternion", steps=200, tolerance=1e-12)
    pose, root = fit.motion.rotations, fit.motion.root_position

    def error(pose: np.ndarray) -> np.ndarray:
        distance = dual_quaternion_skinning(skin, pose, root) - noisy
        return np.sqrt((distance**2).sum(axis=2).mean(axis=1))

    assert_allclose(fit.errors, error(pose), rtol=1e-10)
    for j in range(J):
        for h in 2e-3 * np.vstack([np.eye(3), -np.eye(3)]):
            other = pose.copy()
            other[:, j] = multiply(pose[:, j], from_rotation_vector(h))
            assert (error(other) > fit.errors).all()


def test_frames_from_a_memory_map_in_single_precision(rng, tmp_path) -> None:
    skin = random_skin(rng)
    Y = posed(skin, random_motion(skin, rng)).astype(np.float32)
    np.save(tmp_path / "frames.npy", Y)
    mapped = np.load(tmp_path / "frames.npy", mmap_mode="r")
    a, b = fit_poses(skin, Y), fit_poses(skin, mapped)
    assert_allclose(a.motion.rotations, b.motion.rotations, rtol=0, atol=0)


def test_no_frame_gives_no_pose(rng) -> None:
    skin = random_skin(rng)
    fit = fit_poses(skin, np.zeros((0, len(skin.weights), 3)))
    assert fit.motion.n_frames == 0 and fit.errors.shape == (0,)


def test_progress_counts_frames(rng) -> None:
    skin = random_skin(rng)
    calls: list[tuple[int, int, str]] = []
    fit_poses(skin, posed(skin, random_motion(skin, rng)), progress=lambda *a: calls.append(a))
    assert calls == [(6, 6, "poses")]


def test_what_cannot_be_fitted_is_refused(rng) -> None:
    skin = random_skin(rng)
    Y = posed(skin, random_motion(skin, rng))
    with pytest.raises(ValueError, match=r"frames must have shape \(T, 90, 3\), got \(6, 89, 3\)"):
        fit_poses(skin, Y[:, 1:])
    Y[4, 7, 1] = np.nan
    with pytest.raises(ValueError, match="frame 4, vertex 7"):
        fit_poses(skin, Y)
    with pytest.raises(ValueError, match="blending must be 'linear' or 'dual-quaternion', got 'cubic'"):
        fit_poses(skin, Y[:2], blending="cubic")
    with pytest.raises(ValueError, match="steps must be at least 1, got 0"):
        fit_poses(skin, Y[:2], steps=0)
    other = Skeleton(("x", "y"), np.array([-1, 0]), np.zeros((2, 3)))
    with pytest.raises(ValueError, match="skeleton must have the 6 joints of the skin in their order, got 2"):
        fit_poses(skin, Y[:2], skeleton=other)
