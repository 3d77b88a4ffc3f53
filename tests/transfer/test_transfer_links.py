"""Extra edges: pieces hang together, opposite sides keep their distance."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation
from transfer_zoo import ZOO, pieces, sheet, solver_for, sphere, tube, volume_of, wxyz

from tempose.clips import Mesh
from tempose.geometry import cotangent_laplacian, edge_laplacian, vertex_normals
from tempose.transfer import MotionTransfer
from tempose.transfer.solver.links import (
    LINK_RADIUS,
    LINK_WEIGHT,
    SHELL,
    ExtraEdges,
    inner_edges,
    link_pieces,
    shell_edges,
)


def joined(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0] + [len(m.vertices) for m in meshes])
    V = np.concatenate([m.vertices for m in meshes])
    return Mesh(V, np.concatenate([m.faces + s for m, s in zip(meshes, starts)]))


def moved(mesh: Mesh, by: tuple[float, float, float], scale: float = 1.0) -> Mesh:
    return mesh.with_vertices(scale * mesh.vertices + by)


def n_components(mesh: Mesh, links: ExtraEdges) -> int:
    n = len(mesh.vertices)
    L = cotangent_laplacian(mesh.vertices, mesh.faces) + edge_laplacian(links.pairs, links.weights, n)
    return connected_components(abs(L) > 1e-9, directed=False)[0]


def as_set(links: ExtraEdges) -> set[tuple[int, int]]:
    return {(int(min(p)), int(max(p))) for p in links.pairs}


@pytest.mark.parametrize("name", ["sphere", "sheet", "tube"])
def test_a_mesh_of_one_piece_needs_no_links(name: str) -> None:
    mesh = ZOO[name]()
    assert len(link_pieces(mesh.vertices, mesh.faces).pairs) == 0


def test_two_spheres_become_one_component() -> None:
    mesh = joined(sphere(1), moved(sphere(1), (3.0, 1, 0)))
    links = link_pieces(mesh.vertices, mesh.faces)
    assert n_components(mesh, ExtraEdges.none()) == 2
    assert n_components(mesh, links) == 1
    assert (links.weights == LINK_WEIGHT).all()
    # the nearest two vertices are among them, and no link is much longer
    n = len(mesh.vertices) // 2
    gaps = np.linalg.norm(mesh.vertices[:n, None] - mesh.vertices[None, n:], axis=2)
    i, j = np.unravel_index(gaps.argmin(), gaps.shape)
    assert (int(i), int(j) + n) in as_set(links)
    lengths = np.linalg.norm(np.diff(mesh.vertices[links.pairs], axis=1), axis=2)
    assert lengths.max() <= 1.5 * gaps.min() + 1e-9


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_many_scattered_pieces_become_one_component_in_any_unit(unit: float, rng) -> None:
    mesh = joined(*[moved(sphere(0), tuple(unit * rng.normal(size=3) * 4), unit * 0.5) for _ in range(15)])
    links = link_pieces(mesh.vertices, mesh.faces)
    assert n_components(mesh, links) == 1
    same = link_pieces(mesh.vertices / unit, mesh.faces)
    assert as_set(links) == as_set(same)


def test_near_vertices_of_other_pieces_are_linked_as_brute_force_finds_them() -> None:
    # two curved sheets cross at a small angle; a third piece far off makes the radius several edges wide
    a = sheet(14)
    b = a.with_vertices(a.vertices @ Rotation.from_euler("x", 6, degrees=True).as_matrix().T + 0.013)
    mesh = joined(a, b, moved(sheet(4), (0.5, 40.0, 0.1)))
    V, n = mesh.vertices, len(a.vertices)
    D = np.linalg.norm(np.ptp(V, axis=0))
    links = as_set(link_pieces(V, mesh.faces))
    expected = set()
    for i in range(2 * n):
        others = np.arange(n, 2 * n) if i < n else np.arange(n)
        gap = np.linalg.norm(V[others] - V[i], axis=1)
        if gap.min() <= LINK_RADIUS * D:
            j = int(others[gap.argmin()])
            expected.add((min(i, j), max(i, j)))
    assert len(expected) > 100
    within = np.linalg.norm(V[:n, None] - V[None, n : 2 * n], axis=2) <= LINK_RADIUS * D
    assert within.sum() > 2 * len(expected)
    assert {pair for pair in links if pair[1] < 2 * n} == expected


def test_the_gap_between_pieces_is_kept_when_everything_turns(rng) -> None:
    mesh = pieces()
    solver = solver_for(mesh)
    R = Rotation.random(rng=rng)
    V = solver.pose(np.tile(wxyz(R), (4, 1)))
    i, j = solver.links.pairs.T
    before, after = mesh.vertices[i] - mesh.vertices[j], V[i] - V[j]
    assert_allclose(after, R.apply(before), rtol=0, atol=1e-10)


def test_a_jointed_limb_of_two_pieces_stays_together_when_it_bends() -> None:
    gap = 0.004
    lower = tube(14, 16, 1.0, 0.15)
    mesh = joined(lower, moved(lower, (0, 1.0 + gap, 0)))
    n = len(lower.vertices)
    rings = np.r_[np.arange(2 * 16, 4 * 16), n + np.arange(9 * 16, 11 * 16)]
    solver = MotionTransfer(mesh, rings, np.repeat([0, 1], 32), 2)
    V = solver.pose(wxyz(Rotation.from_rotvec([[0, 0, 0], [0, 0, np.radians(60)]])))
    i, j = solver.links.pairs.T
    change = np.linalg.norm(V[i] - V[j], axis=1) - np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    assert np.abs(change).max() < 0.003 * mesh.diagonal
    tip = V[-1] - V[0]
    assert np.linalg.norm(tip) < 0.95 * 2.0


def test_loose_vertices_follow_the_nearest_held_one(rng) -> None:
    ball = sphere(1)
    V = np.concatenate([[[0.0, 5.0, 0.3]], ball.vertices, [[0.2, 0.1, 4.0]]])
    F = ball.faces + 1
    links = link_pieces(V, F)
    nearest = [1 + int(np.linalg.norm(ball.vertices - V[k], axis=1).argmin()) for k in (0, -1)]
    assert as_set(links) == {(0, nearest[0]), (nearest[1], len(V) - 1)}


def test_faces_without_area_hold_nothing() -> None:
    ball = sphere(1)
    far = moved(ball, (4.0, 0, 0))
    mesh = joined(ball, far)
    # a needle of no width bridges the gap
    bridge = np.array([[0, len(ball.vertices), 0]])
    with_needle = np.concatenate([mesh.faces, bridge])
    plain, other = link_pieces(mesh.vertices, mesh.faces), link_pieces(mesh.vertices, with_needle)
    assert len(plain.pairs) > 0
    assert_array_equal(plain.pairs, other.pairs)


def test_nothing_but_loose_vertices_and_one_face() -> None:
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5], [6, 5, 5]])
    links = link_pieces(V, np.array([[0, 1, 2]]))
    assert n_components(Mesh(V, [[0, 1, 2]]), links) == 1


def test_inner_edges_of_a_tube_cross_it() -> None:
    mesh = tube(9, 24, 2.0, 0.25)
    extra = inner_edges(mesh.vertices, mesh.faces, 1.0)
    wall = extra.pairs[(extra.pairs < 9 * 24).all(axis=1)]
    middle = wall[(wall[:, 0] >= 24) & (wall[:, 0] < 8 * 24)]
    assert len(middle) == 7 * 24
    lengths = np.linalg.norm(np.diff(mesh.vertices[middle], axis=1)[:, 0], axis=1)
    # straight across, or to a neighbour of the opposite vertex that rounding makes nearer
    assert lengths.min() > 0.9 * 0.5
    assert lengths.max() <= 0.5 + 1e-12


def test_inner_weights_follow_their_formula_and_scale_with_strength() -> None:
    mesh = sphere()
    one, third = (inner_edges(mesh.vertices, mesh.faces, s) for s in (1.0, 1 / 3))
    assert_array_equal(one.pairs, third.pairs)
    assert_allclose(one.weights, 3 * third.weights, rtol=1e-12)
    i, j = one.pairs.T
    corners = mesh.vertices[mesh.faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    around = np.array([areas[(mesh.faces == v).any(axis=1)].sum() / 3 for v in i])
    squared = ((mesh.vertices[i] - mesh.vertices[j]) ** 2).sum(axis=1)
    assert_allclose(one.weights, 4 * around / squared, rtol=1e-12)


def test_nothing_lies_opposite_on_an_open_sheet_or_without_strength() -> None:
    mesh = sheet()
    assert len(inner_edges(mesh.vertices, mesh.faces, 1.0).pairs) == 0
    ball = sphere(1)
    assert len(inner_edges(ball.vertices, ball.faces, 0.0).pairs) == 0
    assert len(inner_edges(ball.vertices, ball.faces[:0], 1.0).pairs) == 0


@pytest.mark.parametrize("make", [lambda: sphere(1), lambda: sphere(3), pieces, ZOO["dirty"]])
def test_partners_lie_inwards_face_the_other_way_and_are_about_the_nearest(make) -> None:
    mesh = make()
    V = mesh.vertices
    N = vertex_normals(V, mesh.faces)
    extra = inner_edges(V, mesh.faces, 1.0)
    nearest = np.full(len(V), np.inf)
    for i in range(len(V)):
        gap = V - V[i]
        far = np.linalg.norm(gap, axis=1)
        opposite = (-(gap @ N[i]) > 0.9 * far) & (N @ N[i] < -0.5) & (far > 0)
        if opposite.any():
            nearest[i] = far[opposite].min()
    i, j = extra.pairs.T
    across = V[i] - V[j]
    length = np.linalg.norm(across, axis=1)
    assert (np.einsum("ek,ek->e", across, N[i]) > 0.9 * length).all()
    assert (np.einsum("ek,ek->e", N[i], N[j]) < -0.5).all()
    assert len(np.unique(i)) == len(i) >= 0.9 * np.isfinite(nearest).sum()
    assert np.percentile(length / nearest[i], 90) < 1.2


@pytest.mark.parametrize("degrees", [60, 100])
def test_inner_edges_hold_the_volume_of_a_bent_tube(degrees: float) -> None:
    mesh = tube(41, 24, 2.0, 0.22)
    y = mesh.vertices[:, 1]
    low, high = np.flatnonzero(y < 0.6), np.flatnonzero(y > 1.4)
    turn = wxyz(Rotation.from_rotvec([[0, 0, 0], [0, 0, np.radians(degrees)]]))
    loss = []
    for strength in (0.0, 0.3, 1.0):
        solver = MotionTransfer(
            mesh, np.r_[low, high], np.repeat([0, 1], [len(low), len(high)]), 2, volume=strength
        )
        loss.append(1 - volume_of(solver.pose(turn), mesh.faces) / volume_of(mesh.vertices, mesh.faces))
    assert loss[0] > 0.02
    assert loss[0] > loss[1] > loss[2]
    assert loss[2] < 0.5 * loss[0]


def cloth(thickness: float, n: int = 25) -> Mesh:
    """Make a flat closed cloth of 1 by 1 in x and y, two layers in z."""
    x = np.linspace(0.0, 1.0, n)
    V = np.array([(a, b, z) for z in (thickness, 0.0) for b in x for a in x])
    at = np.arange(n * n).reshape(n, n)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    above = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    rim = np.r_[at[0, :-1], at[:-1, -1], at[-1, :0:-1], at[:0:-1, 0]]
    after = np.roll(rim, -1)
    low, low_after = rim + n * n, after + n * n
    side = np.concatenate([np.stack([rim, low, after], 1), np.stack([after, low, low_after], 1)])
    return Mesh(V, np.concatenate([above, above[:, ::-1] + n * n, side]))


def test_the_sides_of_a_thin_cloth_are_tied_and_those_of_a_thick_one_are_not() -> None:
    thin, thick = cloth(0.8 * SHELL), cloth(2.0 * SHELL)
    tied = shell_edges(thin.vertices, thin.faces)
    half = len(thin.vertices) // 2
    inside = {(int(i), int(i) + half) for i in np.arange(half).reshape(25, 25)[1:-1, 1:-1].ravel()}
    assert inside <= as_set(tied)
    assert_array_equal(tied.weights, LINK_WEIGHT)
    assert len(shell_edges(thick.vertices, thick.faces).pairs) == 0
    assert len(shell_edges(thin.vertices, thin.faces[:0]).pairs) == 0


def test_layers_of_a_cloth_whose_sides_are_moved_differently_do_not_cross() -> None:
    mesh = cloth(0.8 * SHELL)
    half = len(mesh.vertices) // 2
    x = mesh.vertices[:half, 0]
    upper = [np.flatnonzero(x < 0.2), np.flatnonzero(x > 0.8)]
    lower = [half + np.flatnonzero(x < 0.4), half + np.flatnonzero(x > 0.6)]
    ends = [np.concatenate(both) for both in zip(upper, lower)]
    solver = MotionTransfer(mesh, np.concatenate(ends), np.repeat([0, 1], [len(e) for e in ends]), 2)
    bend = wxyz(Rotation.from_rotvec([0, np.pi / 3, 0]))
    V = solver.pose(np.stack([[1.0, 0, 0, 0], bend]))
    gap = V[:half] - V[half:]
    outwards = vertex_normals(V, mesh.faces)[:half]
    inner = np.arange(half).reshape(25, 25)[1:-1, 1:-1].ravel()
    apart = np.einsum("nk,nk->n", gap, outwards)[inner] / (0.8 * SHELL)
    assert apart.min() > 0.7
    assert apart.max() < 1.4


def test_edges_add_up() -> None:
    a, b = ExtraEdges(np.array([[0, 1]]), np.ones(1)), ExtraEdges(np.array([[1, 2]]), np.full(1, 2.0))
    both = a + b + ExtraEdges.none()
    assert_array_equal(both.pairs, [[0, 1], [1, 2]])
    assert_array_equal(both.weights, [1, 2])


def test_a_finger_is_thin_but_not_tied() -> None:
    finger = tube(60, 16, 1.0, 0.45 * SHELL)
    assert len(shell_edges(finger.vertices, finger.faces).pairs) == 0
