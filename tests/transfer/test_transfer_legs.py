"""Legs: which vertices give way, how far they reach, and how a displacement is spread over them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import clip_of, human_body

from tempose.clips import Mesh, Skeleton, SkeletonClip
from tempose.samples.skeletons import animal_skeleton
from tempose.transfer import pairs_from_skin
from tempose.transfer.bodies.bones import make_bones
from tempose.transfer.feet.leg_spread import LegSpread, spread_legs
from tempose.transfer.feet.legs import Leg, bone_leg, mesh_leg
from tempose.transfer.from_skeleton import Prepared, prepare_skeleton
from tempose.transfer.solver.links import ExtraEdges, link_pieces
from tempose.transfer.turns.reference import bone_rest


@lru_cache
def prepared() -> Prepared:
    body = human_body()
    still = clip_of(body.skeleton, {}, 2)
    return prepare_skeleton(still, body.mesh, pairs_from_skin(body.skeleton, body))


def tube(around: int = 16, along: int = 41, length: float = 1.0) -> Mesh:
    """An open tube along Y, its rings evenly spaced, lowest first."""
    turn = 2 * np.pi * np.arange(around) / around
    ring = 0.1 * np.column_stack([np.cos(turn), 0 * turn, np.sin(turn)])
    V = np.concatenate([ring + np.array([0, y, 0]) for y in np.linspace(0, length, along)])
    i = np.arange(around)
    j = (i + 1) % around
    F = []
    for k in range(along - 1):
        a, b = k * around, (k + 1) * around
        F += [np.column_stack([a + i, b + i, a + j]), np.column_stack([a + j, b + i, b + j])]
    return Mesh(V, np.concatenate(F))


def leg_of(foot: np.ndarray, limb: np.ndarray) -> Leg:
    return Leg(foot, limb, (foot[None, :1], np.ones((1, 1))))


# ---- legs


def test_a_leg_goes_from_the_foot_to_the_hip() -> None:
    job, body = prepared(), human_body()
    assert job.bones is not None and job.target is not None
    for foot, leg, side in zip(job.feet.vertices, job.feet.legs, ("left_", "right_")):
        assert_array_equal(leg.foot, foot)
        names = {job.bones.roles[b] for b in job.owner[leg.limb]}
        assert names == {side + "thigh", side + "shin"}
        thigh, ankle = (job.bones.find(side + part) for part in ("thigh", "foot"))
        assert thigh is not None and ankle is not None
        V = body.mesh.vertices[None]
        hips = leg.hips(V)
        assert hips is not None
        assert_allclose(hips[0], job.target.starts[thigh], rtol=0, atol=1e-9)
        assert_allclose(leg.ankles(V)[0], job.target.starts[ankle], rtol=0, atol=1e-9)
        knee = job.target.ends[thigh]
        assert leg.length == pytest.approx(
            np.linalg.norm(knee - hips[0]) + np.linalg.norm(leg.ankles(V)[0] - knee), rel=1e-6
        )


def test_legs_without_roles_end_where_the_tree_branches() -> None:
    skeleton = animal_skeleton()
    clip: SkeletonClip = clip_of(skeleton, {}, 1)
    bones = make_bones(skeleton, skeleton.names, {})
    rest = bone_rest(clip, bones, {})
    owner = np.repeat(np.arange(len(bones.names)), 3)
    rng = np.random.default_rng(0)
    V = rest.starts[owner] + 0.05 * rng.normal(size=(len(owner), 3))
    for hoof in (b for b, name in enumerate(bones.names) if name.endswith("hoof")):
        leg = bone_leg(bones, [hoof], rest, owner, V)
        chain = np.unique(owner[leg.limb])
        children = [(np.asarray(bones.parents) == b).sum() for b in chain]
        assert len(chain) >= 2 and set(children) == {1}
        assert 0 not in chain


def test_the_root_is_no_part_of_a_leg() -> None:
    """A body of one leg: the tree does not branch, and still its root keeps its place."""
    names = ("body", "upper", "lower", "paw")
    skeleton = Skeleton(names, np.array([-1, 0, 1, 2]), np.array([[0, 1.0, 0], *3 * [[0, -0.3, 0]]]))
    bones = make_bones(skeleton, names, {})
    rest = bone_rest(clip_of(skeleton, {}, 1), bones, {})
    owner = np.repeat(np.arange(4), 5)
    V = rest.starts[owner] + 0.05 * np.random.default_rng(0).normal(size=(20, 3))
    leg = bone_leg(bones, [3], rest, owner, V)
    assert_array_equal(np.unique(owner[leg.limb]), [1, 2])
    assert leg.length == pytest.approx(0.6)


def test_the_leg_of_a_mesh_is_what_is_low_but_no_other_foot() -> None:
    V = np.column_stack([np.zeros(11), np.arange(11.0), np.zeros(11)])
    leg = mesh_leg(V, np.array([0, 1]), np.array([3]))
    assert_array_equal(leg.limb, [2, 4])
    assert leg.hips(V[None]) is None and leg.length == np.inf
    assert_allclose(leg.ankles(V[None])[0], [0, 0.5, 0])


# ---- spread


def test_along_a_tube_the_weight_falls_evenly() -> None:
    mesh = tube()
    y = mesh.vertices[:, 1]
    leg = leg_of(np.flatnonzero(y < 0.25), np.flatnonzero((y >= 0.25) & (y < 0.8)))
    spread = spread_legs(mesh.vertices, mesh.faces, [leg], ExtraEdges.none())
    weights = np.zeros(len(y))
    weights[spread.vertices[0]] = spread.weights[0]
    assert_allclose(weights, np.clip((0.8 - y) / (0.8 - 0.225), 0, 1), rtol=0, atol=1e-5)


def test_feet_follow_wholly_and_the_trunk_not_at_all() -> None:
    job, mesh = prepared(), human_body().mesh
    spread = spread_legs(mesh.vertices, mesh.faces, job.feet.legs, job.solver.links)
    V = np.zeros((2, len(mesh.vertices), 3), dtype=np.float32)
    paths = np.array([[[0.1, 0, 0], [0, 0, 0]], [[0, 0.2, 0], [0, 0, -0.3]]])
    spread.add(V, paths)
    left, right = job.feet.legs
    assert_allclose(V[:, left.foot], np.broadcast_to(paths[:, :1], V[:, left.foot].shape), rtol=0, atol=1e-7)
    assert_allclose(V[1, right.foot], np.broadcast_to([0, 0, -0.3], (len(right.foot), 3)), rtol=0, atol=1e-7)
    legs = np.concatenate([left.foot, left.limb, right.foot, right.limb])
    assert not V[:, np.setdiff1d(np.arange(len(mesh.vertices)), legs)].any()
    for weights in spread.weights:
        assert weights.min() > 0 and weights.max() == 1


def test_copies_of_a_vertex_move_alike_and_pieces_follow_their_links() -> None:
    """The tube cut through its middle: equal positions on both sides, then a gap bridged by links."""
    mesh = tube()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    high = V[F, 1].min(axis=1) > 0.499
    copies = np.unique(F[high])
    place = np.arange(len(V))
    place[copies] = len(V) + np.arange(len(copies))
    split_V, split_F = np.concatenate([V, V[copies]]), np.where(high[:, None], place[F], F)
    y = split_V[:, 1]
    leg = leg_of(np.flatnonzero(y < 0.25), np.flatnonzero((y >= 0.25) & (y < 0.8)))
    one = spread_legs(split_V, split_F, [leg], ExtraEdges.none())
    weights = np.zeros(len(y))
    weights[one.vertices[0]] = one.weights[0]
    assert_allclose(weights[copies], weights[place[copies]], rtol=0, atol=0)
    split_V[place[copies], 1] += 1e-4
    two = spread_legs(split_V, split_F, [leg], link_pieces(split_V, split_F))
    apart = np.zeros(len(y))
    apart[two.vertices[0]] = two.weights[0]
    used = np.unique(split_F)
    assert np.abs(apart - weights)[used].max() < 0.05


def test_no_legs_move_nothing() -> None:
    V = np.ones((3, 4, 3))
    LegSpread((), ()).add(V, np.zeros((3, 0, 3)))
    assert_allclose(V, 1.0, rtol=0, atol=0)


def test_a_foot_without_a_leg_moves_alone() -> None:
    mesh = tube()
    foot = np.flatnonzero(mesh.vertices[:, 1] < 0.25)
    spread = spread_legs(mesh.vertices, mesh.faces, [leg_of(foot, foot[:0])], ExtraEdges.none())
    assert_array_equal(spread.vertices[0], foot)
    assert_allclose(spread.weights[0], 1, rtol=0, atol=0)
