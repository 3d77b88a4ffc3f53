"""A mesh moves another: the tree between marks, the frames themselves."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import human_body
from transfer_zoo import centred, pieces, sphere, tube

from tempose.clips import Mesh, MeshClip
from tempose.transfer import Pairs, from_mesh, transfer_motion
from tempose.transfer.from_mesh import geodesic_tree, prepare_mesh


def is_tree(order: np.ndarray, parents: np.ndarray, k: int) -> None:
    assert_array_equal(np.sort(order), np.arange(k))
    assert (parents < np.arange(k)).all()
    assert (parents[1:] >= 0).all() and parents[0] == -1


def dense_distances(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """All shortest paths along edges, by Floyd and Warshall."""
    n = len(V)
    D = np.full((n, n), np.inf)
    np.fill_diagonal(D, 0)
    for i, j in np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]):
        D[i, j] = D[j, i] = np.linalg.norm(V[i] - V[j])
    for k in range(n):
        D = np.minimum(D, D[:, [k]] + D[[k]])
    return D


def smallest_span(D: np.ndarray) -> float:
    """Length of a minimum spanning tree, by Prim."""
    inside, total = {0}, 0.0
    while len(inside) < len(D):
        i = list(inside)
        gap = D[i].copy()
        gap[:, i] = np.inf
        total += gap.min()
        inside.add(int(np.unravel_index(gap.argmin(), gap.shape)[1]))
    return total


def test_the_tree_between_marks_is_the_shortest(rng) -> None:
    mesh = sphere(2)
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    marks = rng.permutation(len(V))[:25]
    order, parents = geodesic_tree(V, F, marks)
    is_tree(order, parents, 25)
    D = dense_distances(V, F)[np.ix_(marks, marks)]
    length = sum(D[order[i], order[p]] for i, p in enumerate(parents) if p >= 0)
    assert length == pytest.approx(smallest_span(D), rel=1e-6)


def test_left_and_right_legs_are_no_neighbours() -> None:
    """Feet that nearly touch are joined through the hips, not through the air."""
    body = human_body().mesh
    V, F = np.array(body.vertices), np.array(body.faces)
    legs = np.flatnonzero(V[:, 1] < 0.45)[::20]
    hips = np.flatnonzero((V[:, 1] > 0.9) & (V[:, 1] < 1.0) & (np.abs(V[:, 0]) < 0.12))[:3]
    marks = np.r_[hips, legs]
    order, parents = geodesic_tree(V, F, marks)
    is_tree(order, parents, len(marks))
    low = V[marks[order], 1] < 0.45
    side = np.sign(V[marks[order], 0])
    joined = [(i, p) for i, p in enumerate(parents) if p >= 0 and low[i] and low[p]]
    assert len(joined) > 10
    assert all(side[i] == side[p] for i, p in joined)


def test_marks_on_one_vertex_and_on_several_pieces() -> None:
    mesh = pieces()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    marks = np.array([0, 0, 5, len(V) - 1, 60, 60, 60])
    order, parents = geodesic_tree(V, F, marks)
    is_tree(order, parents, len(marks))


def test_one_mark_is_a_root() -> None:
    mesh = sphere(0)
    order, parents = geodesic_tree(mesh.vertices, mesh.faces, np.array([3]))
    assert_array_equal(order, [0])
    assert_array_equal(parents, [-1])


@pytest.mark.parametrize("make", [sphere, pieces])
def test_the_tree_of_many_marks_is_a_tree_too(make, monkeypatch, rng) -> None:
    monkeypatch.setattr(from_mesh, "MANY_PAIRS", 10)
    mesh = make()
    V, F = np.array(mesh.vertices), np.array(mesh.faces)
    marks = np.array(mesh.faces[:, 0])
    order, parents = geodesic_tree(V, F, marks)
    is_tree(order, parents, len(marks))
    # neighbours in the tree lie near each other on the surface
    gap = np.array(
        [np.linalg.norm(V[marks[order[i]]] - V[marks[order[p]]]) for i, p in enumerate(parents) if p >= 0]
    )
    assert np.percentile(gap, 90) < 0.15 * mesh.diagonal


def bent(mesh: Mesh, T: int = 6, degrees: float = 60) -> MeshClip:
    """The mesh bending about Z along its height, isometric on its axis."""
    V = np.array(mesh.vertices)
    s = (V[:, 1] - V[:, 1].min()) / np.ptp(V[:, 1])
    frames = []
    for angle in np.radians(np.linspace(0, degrees, T)):
        R = Rotation.from_rotvec(np.outer(s * angle, [0, 0, 1.0]))
        L = np.ptp(V[:, 1])
        a = max(angle, 1e-9)
        centre = np.stack([-L / a * (1 - np.cos(s * a)), L / a * np.sin(s * a), 0 * s], axis=1)
        frames.append(centre + R.apply(V * [1.0, 0, 1]))
    return MeshClip(np.array(frames), mesh, 30.0)


def test_all_faces_of_a_mesh_marked_reproduce_a_bend() -> None:
    mesh = tube(31, 16, 2.0, 0.1)
    clip = bent(mesh)
    every = np.arange(len(mesh.faces))
    result = transfer_motion(clip, mesh, Pairs("faces", every, every), contacts=False)
    error = np.linalg.norm(centred(result.clip.vertices) - centred(clip.vertices), axis=2)
    assert error.max() < 0.01 * mesh.diagonal
    # and by the mean of vertex pairs
    few = np.arange(0, len(mesh.vertices), 3)
    other = transfer_motion(clip, mesh, Pairs("vertices", few, few), contacts=False)
    error = np.linalg.norm(centred(other.clip.vertices) - centred(clip.vertices), axis=2)
    assert error.max() < 0.02 * mesh.diagonal


@pytest.mark.parametrize("kind", ["vertices", "faces"])
def test_a_rigidly_moving_source_moves_another_mesh_rigidly(kind: str, rng) -> None:
    source, target = sphere(), tube(9, 12)
    R = Rotation.from_rotvec(np.linspace(0, 5, 8)[:, None] * [0.48, 0.6, 0.64])
    frames = np.stack([r.apply(source.vertices.copy()) for r in R]) + rng.normal(size=(8, 1, 3))
    picked = rng.permutation(min(len(source.faces), len(target.faces), 100))[:10]
    result = transfer_motion(
        MeshClip(frames, source, 30.0),
        target,
        Pairs(kind, picked, picked),
        contacts=False,  # type: ignore[arg-type]
    )
    V = centred(np.asarray(result.clip.vertices, dtype=float))
    expected = np.stack([r.apply(centred(np.array(target.vertices))) for r in R])
    assert_allclose(V, expected, rtol=0, atol=2e-5 * target.diagonal)
    assert result.report["quaternion_norm_min"] > 1 - 1e-6


def test_the_reference_may_be_stored_in_another_size() -> None:
    mesh = tube(15, 12, 2.0, 0.2)
    clip = bent(mesh)
    marks = np.arange(0, len(mesh.vertices), 7)
    pairs = Pairs("vertices", marks, marks)
    expected = prepare_mesh(clip, mesh, pairs)
    for unit in (0.6, 1.0, 100.0):
        job = prepare_mesh(clip, mesh, pairs, rest=unit * np.array(mesh.vertices))
        assert_allclose(job.rotations, expected.rotations, rtol=0, atol=1e-6)
        assert_allclose(job.anchor_path, expected.anchor_path, rtol=0, atol=1e-6)
        assert job.leg_ratio == pytest.approx(expected.leg_ratio, rel=1e-6)


def test_a_larger_target_travels_further() -> None:
    source = sphere()
    path = np.outer(np.arange(5), [0.0, 0, 0.3])
    clip = MeshClip(np.array(source.vertices)[None] + path[:, None], source, 30.0)
    marks = np.arange(0, 100, 9)
    big = source.with_vertices(2.5 * source.vertices)
    result = transfer_motion(clip, big, Pairs("vertices", marks, marks), contacts=False)
    travel = result.clip.vertices.mean(axis=1)
    assert_allclose(np.diff(travel, axis=0), np.tile([0, 0, 0.75], (4, 1)), rtol=0, atol=1e-5)


def test_a_target_in_the_sources_numbering_turns_with_the_source(rng) -> None:
    """A rotated source gives a rotated target."""
    mesh = tube(15, 12, 2.0, 0.2)
    clip = bent(mesh)
    marks = np.arange(0, len(mesh.vertices), 7)
    pairs = Pairs("vertices", marks, marks)
    R = Rotation.random(rng=rng)
    frames = np.stack([R.apply(V.astype(float)) for V in clip.vertices])
    plain = transfer_motion(clip, mesh, pairs, contacts=False).clip.vertices
    turned = transfer_motion(MeshClip(frames, mesh, 30.0), mesh, pairs, contacts=False).clip.vertices
    expected = np.stack([R.apply(V) for V in centred(plain.astype(float))])
    assert_allclose(centred(turned.astype(float)), expected, rtol=0, atol=1e-5 * mesh.diagonal)


def test_a_mesh_rolled_up_keeps_its_signs_along_the_surface(rng) -> None:
    """Ends that differ by 300 degrees agree with their neighbours, whatever the order of the pairs."""
    mesh = tube(41, 12, 3.0, 0.1)
    rolled = bent(mesh, 2, 300)
    clip = MeshClip(rolled.vertices[1:], mesh, 30.0)
    marks = rng.permutation(40 * 12)[:150]
    result = transfer_motion(clip, mesh, Pairs("vertices", marks, marks), contacts=False)
    assert result.report["quaternion_norm_min"] > 0.95
    error = np.linalg.norm(centred(result.clip.vertices) - centred(clip.vertices), axis=2)
    assert error.max() < 0.03 * mesh.diagonal
