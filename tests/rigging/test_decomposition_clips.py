"""Bones and weights of clips whose bones and weights are known."""

from __future__ import annotations

import numpy as np
import pytest
from bone_cases import chain, matched
from numpy.testing import assert_allclose

from tempose import formats
from tempose.kinematics import bone_transforms
from tempose.metrics import compare
from tempose.rigging.decomposition import count_bones, decompose, weights_for
from tempose.rotations import angle_between, from_rotation_vector, rotate, to_matrix


@pytest.fixture(scope="module")
def bent():
    return chain(3, 8, np.random.default_rng(3))


@pytest.fixture(scope="module")
def found(bent):
    skin, _, clip = bent
    return decompose(clip.vertices, skin.mesh.vertices, bones=3, iterations=100, tolerance=1e-5)


def test_bones_of_a_skinned_clip_come_back(bent, found):
    skin, _, clip = bent
    assert found.rms < 1e-4 * skin.mesh.diagonal
    order = matched(found.weights, skin.weights)
    assert sorted(order) == [0, 1, 2]
    assert_allclose(found.weights[:, order], skin.weights, atol=0.02)
    far = compare(clip.vertices, found.vertices(), skin.mesh.diagonal).rms
    assert far == pytest.approx(found.rms, abs=1e-8 * skin.mesh.diagonal)


def test_rows_are_convex_and_sparse(bent):
    skin, _, clip = bent
    few = decompose(clip.vertices, skin.mesh.vertices, bones=4, influences=2, iterations=5)
    assert (few.weights >= 0).all() and ((few.weights > 0).sum(axis=1) <= 2).all()
    assert_allclose(few.weights.sum(axis=1), 1, atol=1e-12)
    assert (few.weights.sum(axis=0) > 0).all()


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_a_scaled_and_moved_clip_gives_the_same_bones(bent, found, unit):
    skin, _, clip = bent
    turn = from_rotation_vector(np.array([0.3, -0.2, 0.9]))
    frames = unit * rotate(turn, clip.vertices.astype(float)) + unit * 5.0
    other = decompose(frames, unit * skin.mesh.vertices, bones=3, iterations=100, tolerance=1e-5)
    order = matched(other.weights, skin.weights)
    mine = matched(found.weights, skin.weights)
    assert_allclose(other.weights[:, order], found.weights[:, mine], atol=0.02)
    assert other.rms < 1e-4 * unit * skin.mesh.diagonal


def test_the_same_seed_gives_the_same_answer(bent):
    skin, _, clip = bent
    a, b = (decompose(clip.vertices, skin.mesh.vertices, bones=3, iterations=2, seed=4) for _ in range(2))
    assert np.array_equal(a.weights, b.weights) and np.array_equal(a.rotations, b.rotations)


def test_weights_for_true_bones_are_the_true_weights(bent):
    skin, motion, clip = bent
    turns, shifts = bone_transforms(skin.skeleton, motion.rotations, motion.root_position)
    W = weights_for(clip.vertices.astype(float), skin.mesh.vertices, turns, shifts)
    assert_allclose(W, skin.weights, atol=1e-4)
    kept = weights_for(clip.vertices.astype(float), skin.mesh.vertices, turns, shifts, weights=skin.weights)
    assert_allclose(kept, skin.weights, atol=1e-4)


def test_bones_carry_rest_to_frames(found):
    R = to_matrix(found.rotations)
    V = np.einsum("nb,tbij,nj->tni", found.weights, R, found.rest, optimize=True)
    V += np.einsum("nb,tbi->tni", found.weights, found.translations)
    assert_allclose(found.vertices(), V, atol=1e-12)


def test_the_count_grows_with_what_is_asked(bent):
    skin, _, clip = bent
    frames = clip.vertices.astype(float)
    coarse, fine = (count_bones(frames, skin.mesh.vertices, tolerance) for tolerance in (0.05, 2e-3))
    assert 1 <= coarse <= fine
    assert count_bones(frames, skin.mesh.vertices, 1e-9, most=4) == 4


def rigid_clip(V, T=5):
    rng = np.random.default_rng(1)
    turns = from_rotation_vector(rng.standard_normal((T, 1, 3)))
    return rotate(turns, V) + rng.standard_normal((T, 1, 3))


def test_more_bones_than_motions_is_refused_with_the_number(bent):
    V = bent[0].mesh.vertices
    frames = rigid_clip(V)
    assert decompose(frames, V, bones=1).rms < 1e-7
    with pytest.raises(ValueError, match=r"bones=3 is more than .*(1 rigid bones|one rigid body)"):
        decompose(frames, V, bones=3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (dict(bones=0), "bones must be from 1 to"),
        (dict(bones=10**6), "bones must be from 1 to"),
        (dict(alone=-1.0), "alone must not be negative"),
        (dict(influences=0), "influences must be at least 1"),
        (dict(rest=np.zeros((5, 3))), r"frames must have shape \(T, 5, 3\)"),
        (dict(frames=np.zeros((0, 370, 3))), "at least one frame"),
        (dict(rest=np.ones((370, 3))), "rest must span some space"),
    ],
)
def test_bad_input_is_refused(bent, change, message):
    given = dict(frames=bent[2].vertices, rest=bent[0].mesh.vertices, bones=3) | change
    frames, rest = given.pop("frames"), given.pop("rest")
    with pytest.raises(ValueError, match=message):
        decompose(frames, rest, **given)


def test_turns_agree_with_the_true_ones(bent, found):
    skin, motion, _ = bent
    turns, _ = bone_transforms(skin.skeleton, motion.rotations, motion.root_position)
    order = matched(found.weights, skin.weights)
    assert np.degrees(angle_between(found.rotations[:, order], turns)).max() < 0.5


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize(("bones", "most"), [(10, 7.5), (20, 2.8)])
def test_horse_poses_do_not_collapse(data_folder, bones, most):
    files = [data_folder("horse-poses") / f"{k}.obj" for k in range(1, 11)]
    V = np.stack([formats.load_mesh(p).vertices for p in files])
    found = decompose(V, V[0], bones=bones)
    D = float(np.linalg.norm(np.ptp(V[0], axis=0)))
    assert found.weights.sum(axis=0).min() > 1
    assert compare(V, found.vertices(), D).e_rms < most
