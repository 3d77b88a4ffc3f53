"""Marks: closed rings where they are asked, end parts whole, each face once."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import human_body
from transfer_zoo import tube

from tempose.kinematics.roles import find_roles
from tempose.transfer import pairs_from_skin
from tempose.transfer.pairing.marks import RIGID_PARTS, RING_SIZE, mark_bones, owned_faces

LENGTH, RADIUS, AROUND, RINGS = 2.0, 0.25, 36, 41


def two_bones(
    turn: Rotation | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A tube whose halves belong to two bones, the upper one listed first: V, F, weights, starts, ends."""
    mesh = tube(RINGS, AROUND, LENGTH, RADIUS)
    V = np.array(mesh.vertices)
    upper = np.clip((V[:, 1] - 0.9) / 0.2, 0, 1)
    starts, ends = np.array([[0, 1.0, 0], [0, 0.0, 0]]), np.array([[0, 2.0, 0], [0, 1.0, 0]])
    if turn is not None:
        V, starts, ends = (turn.apply(x) + np.array([3.0, 1, -2]) for x in (V, starts, ends))
    return V, np.array(mesh.faces), np.column_stack([upper, 1 - upper]), starts, ends


def test_faces_belong_to_the_bone_that_holds_them_most() -> None:
    V, F, weights, _, _ = two_bones()
    owner = owned_faces(F, weights)
    y = V[F].mean(axis=1)[:, 1]
    assert (owner[y > 1.05] == 0).all() and (owner[y < 0.95] == 1).all()


def test_half_of_what_a_bone_has_at_its_best_is_enough() -> None:
    """A bone blended everywhere, as the neck of MakeHuman, still owns where it is strongest."""
    F = np.arange(12).reshape(4, 3)
    share = np.array([0.45, 0.40, 0.24, 0.21])
    weights = np.repeat(np.column_stack([share, 0.2 + 0 * share, (0.8 - share) / 3]), 3, axis=0)
    assert_array_equal(owned_faces(F, weights), [0, 0, 0, -1])
    weights[:] = [0.6, 0.4, 0.0]
    assert_array_equal(owned_faces(F, weights), [0, 0, 0, 0])


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("places", [(0.27, 0.73), (0.4, 0.6), (0.5,), (0.2, 0.5, 0.8)])
def test_rings_lie_where_they_are_asked_and_close(places: tuple[float, ...], seed: int | None) -> None:
    turn = None if seed is None else Rotation.random(rng=np.random.default_rng(seed))
    V, F, weights, starts, ends = two_bones(turn)
    faces, bones = mark_bones(V, F, weights, ("", "left_forearm"), starts, ends, places)
    assert len(np.unique(faces)) == len(faces) == 2 * len(places) * RING_SIZE
    for b in range(2):
        axis = (ends[b] - starts[b]) / np.linalg.norm(ends[b] - starts[b])
        mine = faces[bones == b]
        corners = (V[F[mine]] - starts[b]) @ axis
        middle = V[F[mine]].mean(axis=1) - starts[b]
        side = np.linalg.svd(axis[None])[2][1:]
        angle = np.arctan2(middle @ side[1], middle @ side[0])
        for place in places:
            ring = (corners.min(axis=1) <= place + 1e-9) & (corners.max(axis=1) >= place - 1e-9)
            # a face of a neighbouring row may touch the same line
            assert RING_SIZE <= ring.sum() <= 2 * RING_SIZE
            gaps = np.diff(np.sort(np.r_[angle[ring], angle[ring].min() + 2 * np.pi]))
            assert gaps.max() < 1.7 * 2 * np.pi / RING_SIZE
        assert (owned_faces(F, weights)[mine] == b).all()


def test_a_stout_bone_has_its_rings_across_what_it_covers() -> None:
    """The hips cover only a stretch of their bone: rings go where it is, not where it is not."""
    V, F, weights, starts, ends = two_bones()
    ends[1] = [0, 4.0, 0]
    faces, bones = mark_bones(V, F, weights, ("", "hips"), starts, ends)
    along = V[F[faces[bones == 1]]][:, :, 1]
    covered = V[F[owned_faces(F, weights) == 1]][:, :, 1].max()
    for place in (0.27, 0.73):
        crossing = (along.min(axis=1) <= place * covered) & (along.max(axis=1) >= place * covered)
        assert crossing.sum() >= RING_SIZE


def test_faces_beyond_the_joint_do_not_move_the_rings() -> None:
    """The tube reaches below where its lower bone begins: places are measured from the joint."""
    V, F, weights, starts, ends = two_bones()
    starts[1], ends[1] = [0, 0.3, 0], [0, 0.9, 0]
    faces, bones = mark_bones(V, F, weights, ("", "left_shin"), starts, ends, (0.27, 0.73))
    y = V[F[faces[bones == 1]]][:, :, 1]
    for place in (0.3 + 0.27 * 0.6, 0.3 + 0.73 * 0.6):
        assert ((y.min(axis=1) <= place) & (y.max(axis=1) >= place)).sum() >= RING_SIZE
    assert y.min() > 0.3


def test_a_limb_and_the_cloth_round_it_are_both_marked() -> None:
    """A leg inside a wide skirt, both weighted to one bone: a ring on either."""
    leg, skirt = tube(41, 36, 2.0, 0.1), tube(41, 36, 2.0, 0.3)
    n, m = len(leg.vertices), len(leg.faces)
    wall = skirt.faces[(skirt.faces < 41 * 36).all(axis=1)]
    V, F = np.concatenate([leg.vertices, skirt.vertices]), np.concatenate([leg.faces, wall + n])
    ends = np.array([[0, 2.0, 0]])
    faces, _ = mark_bones(V, F, np.ones((2 * n, 1)), ("left_thigh",), np.zeros((1, 3)), ends, (0.5,))
    assert ((faces < m).sum(), (faces >= m).sum()) == (RING_SIZE, RING_SIZE)


@pytest.mark.parametrize("part", RIGID_PARTS)
def test_end_parts_are_marked_whole(part: str) -> None:
    V, F, weights, starts, ends = two_bones()
    role = part if part == "head" else "left_" + part
    faces, bones = mark_bones(V, F, weights, (role, "left_shin"), starts, ends)
    assert_array_equal(np.sort(faces[bones == 0]), np.flatnonzero(owned_faces(F, weights) == 0))
    assert (bones == 1).sum() == 2 * RING_SIZE


def test_bones_with_hardly_a_face_are_marked_whole_and_others_not_at_all() -> None:
    V, F, weights, starts, ends = two_bones()
    weights = np.column_stack([weights, np.zeros(len(V))])
    weights[F[5], :] = [0, 0, 1]
    starts, ends = np.vstack([starts, starts[:1]]), np.vstack([ends, ends[:1]])
    faces, bones = mark_bones(V, F, weights, ("", "", "neck"), starts, ends)
    assert 5 in faces[bones == 2] and (bones == 2).sum() <= RING_SIZE
    no_length = mark_bones(V, F, weights, ("", "", ""), starts, starts)
    assert set(no_length[1]) == {0, 1, 2}
    weights[:, 2], weights[F[5], 0] = 0, 1
    assert set(mark_bones(V, F, weights, ("", "", "neck"), starts, ends)[1]) == {0, 1}


def test_a_body_has_marks_on_every_bone_and_on_no_face_twice() -> None:
    body = human_body()
    pairs = pairs_from_skin(body.skeleton, body)
    assert set(pairs.source) == set(find_roles(body.skeleton))
    assert len(np.unique(pairs.target)) == len(pairs)
    pairs.check(0, len(body.mesh.faces), body.skeleton.names)
    # limbs carry rings of two dozen, hands and feet all they own
    count = {name: pairs.source.count(name) for name in set(pairs.source)}
    for name in ("left_thigh", "right_upper_arm", "left_shin"):
        assert RING_SIZE <= count[name] <= 2 * RING_SIZE
    assert count["left_hand"] > 2 * RING_SIZE
