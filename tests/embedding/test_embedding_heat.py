"""Heat weights: closed forms, symmetry, what no bone sees."""

from __future__ import annotations

import numpy as np
import pytest
from capsule_people import block_person, capsule, joined, sphere
from numpy.testing import assert_allclose

from tempose.clips import Mesh
from tempose.embedding import embed_skin, heat_weights
from tempose.embedding._sight import sees
from tempose.embedding.segments import bone_segments, nearest_on_segments


def tube(length: float = 4.0, radius: float = 0.3, rings: int = 81, sides: int = 24) -> Mesh:
    """Closed cylinder along X, centred."""
    angle = np.arange(sides) * 2 * np.pi / sides
    x = np.linspace(-length / 2, length / 2, rings)
    V = np.stack(
        [
            np.repeat(x, sides),
            np.tile(radius * np.cos(angle), rings),
            np.tile(radius * np.sin(angle), rings),
        ],
        axis=1,
    )
    i = np.arange(rings - 1)[:, None] * sides
    j, k = np.arange(sides), (np.arange(sides) + 1) % sides
    F = np.concatenate(
        [
            np.stack(np.broadcast_arrays(*t), axis=-1).reshape(-1, 3)
            for t in ((i + j, i + k, i + sides + k), (i + j, i + sides + k, i + sides + j))
        ]
    )
    ends = np.array([[-length / 2, 0, 0], [length / 2, 0, 0]])
    n = len(V)
    caps = [[n, b, a] for a, b in zip(j, k)] + [[n + 1, n - sides + a, n - sides + b] for a, b in zip(j, k)]
    return Mesh(np.concatenate([V, ends]), np.concatenate([F, np.array(caps)])[:, ::-1])


TWO = np.array([[[-2.0, 0, 0], [0, 0, 0]], [[0, 0, 0], [2.0, 0, 0]]])


@pytest.mark.parametrize("unit", [1e-2, 1e2])
def test_two_bones_in_a_cylinder_have_the_exponential_as_their_weights(unit: float) -> None:
    # at the distance r from the bones, r^2 w'' = w - p: the solution falls off as exp(-|x| / r)
    mesh, r = tube(), 0.3
    weights = heat_weights(mesh.with_vertices(unit * mesh.vertices), unit * TWO)
    x = mesh.vertices[:, 0]
    middle = np.abs(x) < 1.2
    expected = np.where(x > 0, 1 - 0.5 * np.exp(-np.abs(x) / r), 0.5 * np.exp(-np.abs(x) / r))
    assert_allclose(weights[middle, 1], expected[middle], atol=0.03)
    assert_allclose(weights.sum(axis=1), 1.0, atol=1e-12)


def test_weights_mirror_with_the_body() -> None:
    weights = heat_weights(tube(), TWO)
    sides, rings = 24, 81
    grid = weights[: sides * rings].reshape(rings, sides, 2)
    assert_allclose(grid[:, :, 0], grid[::-1, :, 1], atol=0.02)


def test_renumbering_and_welding_move_the_rows(rng: np.random.Generator) -> None:
    mesh = tube(rings=41)
    weights = heat_weights(mesh, TWO)
    order = rng.permutation(len(mesh.vertices))
    place = np.argsort(order)
    renumbered = heat_weights(Mesh(mesh.vertices[order], place[mesh.faces]), TWO)
    assert_allclose(renumbered, weights[order], atol=1e-9)
    split = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    assert_allclose(heat_weights(split, TWO), weights[mesh.faces].reshape(-1, 2), atol=1e-9)


def test_a_shell_that_no_bone_sees_takes_the_weights_below_it() -> None:
    body = tube(rings=41)
    shell = tube(length=1.0, radius=0.4, rings=11)
    inner = tube(length=0.98, radius=0.38, rings=11)
    pipe = slice(0, 11 * 24), slice(0, 10 * 24 * 2)
    V, F = joined(
        [
            (body.vertices, body.faces),
            (shell.vertices[pipe[0]] + np.array([0.9, 0, 0]), shell.faces[pipe[1]]),
            (inner.vertices[pipe[0]] + np.array([0.9, 0, 0]), inner.faces[pipe[1], ::-1]),
        ]
    )
    weights = heat_weights(Mesh(V, F), TWO)
    n = len(body.vertices)
    nearest = np.linalg.norm(V[n:, None] - V[:n], axis=2).argmin(axis=1)
    assert_allclose(weights[:n], heat_weights(body, TWO), atol=0.02)
    assert_allclose(weights[n:], weights[nearest], atol=1e-12)


def test_limbs_side_by_side_keep_their_own_bones() -> None:
    one = capsule(np.zeros(3), np.array([0, 2.0, 0]), 0.2)
    other = capsule(np.array([0.5, 0, 0]), np.array([0.5, 2.0, 0]), 0.2)
    bones = np.array([[[0.15, 0, 0], [0.15, 2, 0]], [[0.5, 0, 0], [0.5, 2, 0]]])
    V, F = joined([one, other])
    beam = capsule(np.array([0.0, 2.0, 0]), np.array([0.5, 2.0, 0]), 0.1)
    weights = heat_weights(Mesh(*joined([(V, F), beam])), bones)
    # the inner side of the second limb is as near to the first bone, across the gap
    n = len(one[0])
    low = V[:n, 1] < 1.0
    assert weights[:n, 0][low].min() > 0.99 and weights[n : 2 * n, 1][low].min() > 0.99


def test_sight_ends_at_walls_and_outside() -> None:
    inside = np.ones((12, 6, 6), dtype=bool)
    inside[6, :, :3] = False
    walls = np.zeros((3, 12, 6, 6), dtype=bool)
    starts = np.tile([1.0, 2.0, 0.0], (3, 1))
    starts[:, 2] = [1.0, 4.0, 4.0]
    ends = starts + np.array([9.0, 0.3, 0.2])
    assert sees(inside, walls, True, starts, ends).tolist() == [False, True, True]
    walls[0, 6, :, 4] = True
    assert sees(inside, walls, True, starts, ends).tolist() == [False, False, False]
    assert sees(inside, walls, False, starts, ends).tolist() == [False, True, True]


def test_nearest_points_beat_every_sample(rng: np.random.Generator) -> None:
    points, segments = rng.normal(size=(20, 3)), rng.normal(size=(5, 2, 3))
    segments[4, 1] = segments[4, 0]
    nearest, away = nearest_on_segments(points, segments)
    share = np.linspace(0, 1, 201)[:, None, None]
    samples = (1 - share) * segments[:, 0] + share * segments[:, 1]
    brute = np.linalg.norm(points[:, None, None] - samples, axis=3).min(axis=1)
    assert_allclose(away, brute, atol=0.01)
    assert (away <= brute + 1e-12).all()
    assert_allclose(np.linalg.norm(points[:, None] - nearest, axis=2), away)


def test_a_skin_of_a_person_moves_each_limb_by_its_bones() -> None:
    mesh, at = block_person()
    skin, embedding = embed_skin(mesh)
    assert skin.mesh is mesh and skin.skeleton.names == embedding.skeleton.names
    assert_allclose(skin.weights.sum(axis=1), 1.0, atol=1e-9)
    names = skin.skeleton.names
    for bone, end in (
        ("left_upper_arm", "left_forearm"),
        ("right_shin", "right_foot"),
        ("left_thigh", "left_shin"),
    ):
        middle = (at[bone] + at[end]) / 2
        near = np.linalg.norm(mesh.vertices - middle, axis=1) < 0.09
        assert near.any()
        assert {names[j] for j in skin.weights[near].argmax(axis=1)} == {bone}
    segments = bone_segments(skin.skeleton)
    assert_allclose(
        segments[names.index("left_shin"), 1], embedding.joints[embedding.names.index("left_foot")]
    )


def test_bones_outside_and_of_wrong_shape_are_refused() -> None:
    V, F = sphere(2)
    with pytest.raises(ValueError, match="no bone is seen from any vertex"):
        heat_weights(Mesh(V, F), np.array([[[5.0, 0, 0], [6.0, 0, 0]]]))
    with pytest.raises(ValueError, match=r"bones must have shape \(B, 2, 3\)"):
        heat_weights(Mesh(V, F), np.zeros((4, 3)))
