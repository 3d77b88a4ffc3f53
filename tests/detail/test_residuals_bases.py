"""Residuals are what a skin lacks, in rotations that follow the body; regions share them out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from clothed_tube import blended_turns, clothed, faced, hanging, swing, tube_rig
from numpy.testing import assert_allclose

from tempose.clips import SkinnedMesh
from tempose.detail import region_grams, region_shares, residuals, vertex_bases
from tempose.detail.posing import BlockSkin
from tempose.rigging import Rig
from tempose.rotations import from_rotation_vector, rotate


@pytest.mark.parametrize("basis", ["blended", "root", "world"])
@pytest.mark.parametrize("blending", ["linear", "dual-quaternion"])
def test_skin_and_turned_residual_are_the_clip(basis, blending, rng) -> None:
    rig = tube_rig(blending=blending)
    motion = swing(rig, 5, turning=2.0)
    V = rig.vertices(motion) + rng.normal(size=(5, len(rig.skin.weights), 3))
    D = residuals(rig, motion, V, basis)
    turned = np.einsum("tvab,tvb->tva", vertex_bases(rig, motion, basis), D)
    assert_allclose(rig.vertices(motion) + turned, V, atol=1e-12)


def test_blended_bases_are_normalised_sums_of_quaternions() -> None:
    rig = tube_rig(joints=5)
    motion = swing(rig, 4, turning=6.0)
    assert_allclose(vertex_bases(rig, motion), blended_turns(rig, motion), atol=1e-12)


def test_a_vertex_of_one_joint_turns_with_it() -> None:
    rig = tube_rig()
    weights = np.zeros_like(rig.skin.weights)
    weights[:, 2] = 1.0
    bound = replace(rig, skin=SkinnedMesh(rig.skin.mesh, rig.skin.skeleton, weights))
    motion = swing(rig, 3)
    R = vertex_bases(bound, motion)
    moved = bound.vertices(motion)
    V = rig.skin.mesh.vertices
    assert_allclose(np.einsum("tab,vb->tva", R[:, 0], V - V[0]), moved - moved[:, :1], atol=1e-12)


def test_a_turned_body_has_the_same_blended_residuals(rng) -> None:
    rig, turn = tube_rig(), from_rotation_vector(np.array([0.3, 2.5, -0.7]))
    motion = swing(rig, 4)
    V = np.asarray(clothed(rig, motion).vertices, dtype=np.float64)
    for basis in ("blended", "root"):
        before = residuals(rig, motion, V, basis)
        assert_allclose(residuals(rig, faced(motion, turn), rotate(turn, V), basis), before, atol=1e-12)
    world = residuals(rig, motion, V, "world")
    after = residuals(rig, faced(motion, turn), rotate(turn, V), "world")
    assert_allclose(after, rotate(turn, world), atol=1e-12)
    assert np.abs(after - world).max() > 0.01


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_residuals_scale_with_the_body(unit: float) -> None:
    rig = tube_rig(unit=unit)
    motion = swing(rig, 4)
    found = residuals(rig, motion, clothed(rig, motion).vertices)
    assert_allclose(found, hanging(rig, motion), atol=2e-7 * unit)


def test_what_is_bound_to_nothing_has_no_residual(rng) -> None:
    rig = tube_rig()
    weights = np.array(rig.skin.weights)
    weights[7] = 0.0
    loose = Rig(SkinnedMesh(rig.skin.mesh, rig.skin.skeleton, weights), rig.motion)
    motion = swing(rig, 3)
    D = residuals(loose, motion, rng.normal(size=(3, len(weights), 3)))
    assert (D[:, 7] == 0).all() and (D[:, 8] != 0).all()


@pytest.mark.parametrize("blending", ["linear", "dual-quaternion"])
def test_short_numbers_suffice_far_from_the_origin(blending) -> None:
    rig = tube_rig(blending=blending)
    motion = swing(rig, 3)
    far = replace(motion, root_position=motion.root_position + np.array([3e5, 0, 0]))
    skin = BlockSkin(rig)
    V = np.zeros((len(rig.skin.weights), 3))
    rows, turns = skin.rows(far)
    for t, truth in enumerate(rig.vertices(motion)):
        skin.pose(rows[t], turns[t])
        skin.write(far.root_position[t], V)
        assert_allclose(V - [3e5, 0, 0], truth, atol=1e-6)


def test_frames_of_another_mesh_are_refused() -> None:
    rig = tube_rig()
    with pytest.raises(ValueError, match=r"V must have shape \(3, 240, 3\)"):
        residuals(rig, swing(rig, 3), np.zeros((3, 7, 3)))
    with pytest.raises(ValueError, match="basis must be one of blended, root, world, got 'local'"):
        residuals(rig, swing(rig, 3), np.zeros((3, 240, 3)), "local")  # type: ignore[arg-type]


def test_grams_are_shared_out_without_loss(rng) -> None:
    D, shares = rng.normal(size=(6, 40, 3)), rng.dirichlet(np.ones(4), size=40)
    shares[:5, 2] = 0.0
    shares /= shares.sum(axis=1, keepdims=True)
    grams, sizes = region_grams(D, shares)
    for r in range(4):
        slow = sum(s * (D[:, v] @ D[:, v].T) for v, s in enumerate(shares[:, r]))
        assert_allclose(grams[r], slow, atol=1e-12)
    assert_allclose(grams.sum(axis=0), D.reshape(6, -1) @ D.reshape(6, -1).T, atol=1e-12)
    assert_allclose(sizes.sum(), 120)
    order = rng.permutation(40)
    again, _ = region_grams(D[:, order], shares[order])
    assert_allclose(again, grams, atol=1e-12)


def test_short_numbers_keep_the_digits_of_many_products(rng) -> None:
    D, shares = rng.normal(size=(5, 5000, 3)) + 1.0, rng.dirichlet(np.ones(3), size=5000)
    long, _ = region_grams(D, shares)
    short, _ = region_grams(D.astype(np.float32), shares)
    assert_allclose(short, long, rtol=3e-6)


def test_shares_are_weights_without_tails() -> None:
    weights = np.array([[0.9, 0.06, 0.04, 0.0], [0.5, 0.5, 0, 0], [0, 0, 0, 0], [0.09, 0.08, 0.4, 0.43]])
    shares = region_shares(weights, 0.05)
    assert_allclose(shares[0], [0.85 / 0.86, 0.01 / 0.86, 0, 0])
    assert_allclose(shares.sum(axis=1), [1, 1, 0, 1])
    assert_allclose(shares[1], weights[1])
    many = np.full((1, 40), 1 / 40)
    assert_allclose(region_shares(many, 0.05), many)


@pytest.mark.parametrize("blending", ["linear", "dual-quaternion"])
def test_signs_of_quaternions_mean_nothing(blending, rng) -> None:
    rig = tube_rig(joints=5, blending=blending)
    motion = swing(rig, 6, turning=6.0)
    signs = rng.choice([-1.0, 1.0], size=(6, 5, 1))
    other = replace(motion, rotations=signs * motion.rotations)
    assert_allclose(vertex_bases(rig, other), vertex_bases(rig, motion), atol=1e-12)
    V = rng.normal(size=(6, len(rig.skin.weights), 3))
    assert_allclose(residuals(rig, other, V), residuals(rig, motion, V), atol=1e-12)


def test_frames_with_holes_are_named() -> None:
    rig = tube_rig()
    motion = swing(rig, 3)
    V = rig.vertices(motion).astype(np.float32)
    V[2, 7, 1] = np.nan
    with pytest.raises(ValueError, match="V must be finite, found NaN or infinity in frame 2, vertex 7"):
        residuals(rig, motion, V)
