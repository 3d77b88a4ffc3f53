"""The solver: what is known exactly about a mesh moved by a few rotations."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_zoo import ZOO, as_rotation, centred, marked, near_rotations, sheet, solver_for, sphere, wxyz

from tempose.clips import Mesh
from tempose.rotations import multiply
from tempose.transfer import Anchor, MotionTransfer
from tempose.transfer.solver import fields
from tempose.transfer.solver.blocks import BLOCK

IDENTITY = np.array([1.0, 0, 0, 0])


@pytest.mark.parametrize("volume", [0.0, 1.0])
@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("name", ZOO)
def test_identity_gives_the_rest_pose(name: str, unit: float, volume: float) -> None:
    mesh = ZOO[name]()
    mesh = mesh.with_vertices(unit * (mesh.vertices + np.array([5.0, -3, 2])))
    V = solver_for(mesh, volume=volume).pose(np.tile(IDENTITY, (4, 1)))
    assert_allclose(V, mesh.vertices, rtol=0, atol=1e-9 * mesh.diagonal)


@pytest.mark.parametrize("name", ZOO)
def test_one_rotation_of_all_marks_rotates_the_rest_about_the_anchor(name: str, rng) -> None:
    mesh = ZOO[name]()
    solver = solver_for(mesh, volume=1.0)
    R = Rotation.random(3, rng=rng)
    V = solver.pose(np.repeat(wxyz(R)[:, None], 4, axis=1))
    middle = mesh.vertices[marked(mesh)[0]].mean(axis=0)
    expected = np.stack([r.apply(mesh.vertices - middle) for r in R]) + middle
    assert_allclose(V, expected, rtol=0, atol=1e-9 * mesh.diagonal)


@pytest.mark.parametrize("name", ZOO)
def test_a_constant_rotation_from_the_left_rotates_the_result(name: str, rng) -> None:
    mesh = ZOO[name]()
    solver = solver_for(mesh, volume=1.0)
    Q = near_rotations(rng, (5, 4))
    R = Rotation.random(rng=rng)
    turned = solver.pose(multiply(wxyz(R), Q))
    expected = np.stack([R.apply(V) for V in centred(solver.pose(Q))])
    assert_allclose(centred(turned), expected, rtol=0, atol=1e-9 * mesh.diagonal)
    # and the sign of all of them means nothing
    assert_allclose(solver.pose(-Q), solver.pose(Q), rtol=0, atol=1e-12 * mesh.diagonal)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_a_scaled_mesh_gives_the_scaled_result(unit: float, rng) -> None:
    # the tube is left out: its inner edges choose between partners at equal distance
    for name in ("sphere", "sheet", "pieces", "dirty"):
        mesh = ZOO[name]()
        Q = near_rotations(rng, (3, 4))
        small = solver_for(mesh.with_vertices(unit * mesh.vertices), volume=0.7).pose(Q)
        expected = unit * solver_for(mesh, volume=0.7).pose(Q)
        assert_allclose(small, expected, rtol=0, atol=1e-9 * unit * mesh.diagonal)


@pytest.mark.parametrize("name", ["sphere", "sheet", "pieces"])
def test_numbering_means_nothing(name: str, rng) -> None:
    mesh = ZOO[name]()
    vertices, bones = marked(mesh)
    Q = near_rotations(rng, (3, 4))
    expected = MotionTransfer(mesh, vertices, bones, 4, volume=1.0).pose(Q)
    order, faces = rng.permutation(len(mesh.vertices)), rng.permutation(len(mesh.faces))
    place = np.argsort(order)
    # faces may also start at another corner
    F = np.stack([np.roll(f, rng.integers(3)) for f in place[mesh.faces[faces]]])
    other = Mesh(mesh.vertices[order], F)
    V = MotionTransfer(other, place[vertices], bones, 4, volume=1.0).pose(Q)
    assert_allclose(V[:, place], expected, rtol=0, atol=1e-9 * mesh.diagonal)


def test_the_rest_pose_may_stand_anywhere_and_face_anywhere(rng) -> None:
    mesh, R, move = sphere(), Rotation.random(rng=rng), np.array([3.0, -2, 7])
    Q = near_rotations(rng, (3, 4))
    turned = Mesh(mesh.vertices @ R.as_matrix().T + move, mesh.faces)
    expected = solver_for(mesh).pose(Q) @ R.as_matrix().T + move
    solver = MotionTransfer(turned, *marked(mesh), 4)
    V = solver.pose(multiply(multiply(wxyz(R), Q), wxyz(R.inv())))
    assert_allclose(V, expected, rtol=0, atol=1e-9 * mesh.diagonal)


@pytest.mark.parametrize("workers", [1, 2, 3, 8])
def test_a_clip_is_its_frames_one_by_one_on_any_number_of_threads(workers: int, rng) -> None:
    mesh = sphere()
    Q = near_rotations(rng, (5 * BLOCK + 3, 4))
    batch = solver_for(mesh, volume=1.0, workers=workers).pose(Q)
    one = solver_for(mesh, volume=1.0, workers=1)
    assert_array_equal(batch, one.pose(Q))
    single = np.stack([one.pose(q) for q in Q])
    assert_allclose(batch, single, rtol=0, atol=1e-12 * mesh.diagonal)


@pytest.mark.parametrize("lead", [(), (0,), (1,), (3, 1, 2)])
def test_leading_axes_are_kept(lead: tuple[int, ...], rng) -> None:
    mesh = sheet(4)
    solver = solver_for(mesh)
    Q, place = near_rotations(rng, (*lead, 4)), rng.normal(size=(*lead, 3))
    V = solver.pose(Q, place)
    assert V.shape == (*lead, len(mesh.vertices), 3)
    for where in np.ndindex(lead):
        assert_allclose(V[where], solver.pose(Q[where], place[where]), rtol=0, atol=1e-12)


def test_blocks_arrive_in_order_and_cover_the_clip(rng) -> None:
    solver = solver_for(sheet(4), workers=3)
    Q = near_rotations(rng, (4 * BLOCK + 5, 4))
    seen: list[int] = []
    solver.pose_blocks(Q, lambda block, V: seen.extend(range(*block.indices(len(Q)))) or None)
    assert seen == list(range(len(Q)))


def test_what_a_receiver_raises_reaches_the_caller(rng) -> None:
    solver = solver_for(sheet(4), workers=3)

    def stop(block: slice, V: np.ndarray) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        solver.pose_blocks(near_rotations(rng, (6 * BLOCK, 4)), stop)


@pytest.mark.parametrize("name", ZOO)
def test_harmonic_weights_are_shares(name: str) -> None:
    basis = solver_for(ZOO[name]()).basis
    assert basis is not None
    assert_allclose(basis.sum(axis=1), 1, rtol=0, atol=1e-9)
    assert basis.min() >= -1e-12
    assert basis.max() <= 1 + 1e-12


def test_many_rotations_without_a_kept_basis_give_the_same(monkeypatch, rng) -> None:
    mesh, Q = sphere(), near_rotations(rng, (3, 4))
    dense = solver_for(mesh, volume=1.0)
    monkeypatch.setattr(fields, "DENSE_COLUMNS", 3)
    lazy = solver_for(mesh, volume=1.0)
    assert lazy.basis is None and dense.basis is not None
    assert_allclose(lazy.field(Q), dense.field(Q), rtol=0, atol=1e-12)
    assert_allclose(lazy.pose(Q), dense.pose(Q), rtol=0, atol=1e-12 * mesh.diagonal)


def test_the_field_is_exact_at_the_marks_and_short_between_opposite_ones() -> None:
    mesh = sphere()
    vertices, bones = marked(mesh, 2)
    solver = MotionTransfer(mesh, vertices, bones, 2)
    half = wxyz(Rotation.from_rotvec([[0, 0, 0], [0, np.radians(179), 0]]))
    field = solver.field(half[None])
    assert_allclose(field[vertices, :, 0], half[bones], rtol=0, atol=1e-12)
    # midway between rotations by an angle a the mean quaternion has length cos(a / 4)
    norms = np.linalg.norm(field[:, :, 0], axis=1)
    share = solver.basis[:, 1]
    assert_allclose(norms**2, 1 - 2 * share * (1 - share) * (1 - half[1, 0]), rtol=0, atol=1e-9)
    assert norms.min() == pytest.approx(np.cos(np.radians(179 / 4)), abs=1e-3)


def test_pieces_that_touch_at_one_link_turn_exactly_by_their_rotations(rng) -> None:
    ball = sphere(1)
    n = len(ball.vertices)
    low, high = ball.vertices.copy(), ball.vertices + np.array([0, 6.0, 0])
    # a thorn on either, tip against tip
    low[low[:, 1].argmax()], high[high[:, 1].argmin()] = [0, 3.0, 0], [0, 3.1, 0]
    V = np.concatenate([low, high])
    mesh = Mesh(V, np.concatenate([ball.faces, ball.faces + n]))
    bones = np.repeat([0, 1], n)
    solver = MotionTransfer(mesh, np.arange(2 * n), bones, 2)
    assert len(solver.links.pairs) == 1
    (i, j) = solver.links.pairs[0]
    Q = wxyz(Rotation.random(6, rng=rng)).reshape(3, 2, 4)
    Q[:, 1] *= np.sign(np.sum(Q[:, 0] * Q[:, 1], axis=1))[:, None]
    for X, q in zip(solver.pose(Q), Q):
        for b in range(2):
            expected = as_rotation(q[b]).apply(centred(V[bones == b]))
            assert_allclose(centred(X[bones == b]), expected, rtol=0, atol=1e-9)
        # the link turns by the mean of the two
        assert_allclose(X[i] - X[j], as_rotation(q.sum(axis=0)).apply(V[i] - V[j]), rtol=0, atol=1e-9)


def test_a_doubled_vertex_moves_with_its_twin(rng) -> None:
    mesh = ZOO["dirty"]()
    V = solver_for(mesh).pose(near_rotations(rng, (4, 4)))
    distance = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[None], axis=2)
    i, j = np.nonzero(np.triu(distance == 0, 1))
    assert len(i) > 10
    assert_array_equal(V[:, i], V[:, j])


def test_double_precision_is_double_throughout(rng) -> None:
    mesh = sphere(1)
    solver = solver_for(mesh)
    Q = near_rotations(rng, (2, 4))
    V = solver.pose(Q)
    assert V.dtype == np.float64
    assert solver.field(Q).dtype == np.float64 and solver.basis.dtype == np.float64
    tiny = 1e-11
    nudged = solver.pose(multiply(np.array([1.0, tiny, 0, 0]), Q))
    assert 0 < np.abs(nudged - V).max() < 100 * tiny


@pytest.mark.parametrize("side", [20, 60, 120])
def test_single_precision_stays_near_double_at_every_size(side: int, rng) -> None:
    mesh, Q = sheet(side), near_rotations(rng, (3, 4))
    single = solver_for(mesh, precision="single")
    double = solver_for(mesh).pose(Q)
    assert np.abs(single.pose(Q) - double).max() < 5e-6 * mesh.diagonal
    # and nothing of it shows at rest, or where the whole is turned
    rest = np.tile(IDENTITY, (2, 4, 1))
    assert_allclose(single.pose(rest)[1], mesh.vertices, rtol=0, atol=1e-9 * mesh.diagonal)
    R = Rotation.random(rng=rng)
    turned = centred(single.pose(np.tile(wxyz(R), (4, 1))))
    assert_allclose(turned, R.apply(centred(mesh.vertices)), rtol=0, atol=1e-9 * mesh.diagonal)
    with pytest.raises(ValueError, match="precision must be 'double' or 'single', got 'half'"):
        solver_for(mesh, precision="half")


def test_the_anchor_is_a_rigid_frame_that_goes_where_it_is_told(rng) -> None:
    mesh = sphere()
    weights = np.where(mesh.vertices[:, 1] > 1.2, 1.0, 0.0)
    weights /= weights.sum()
    point = np.array([0.2, 1.0, -0.1])
    solver = solver_for(mesh, anchor=Anchor(weights, 3, point))
    Q, place = near_rotations(rng, (3, 4)), rng.normal(size=(3, 3))
    for V, q, p in zip(solver.pose(Q, place), Q, place):
        arm = as_rotation(q[3]).apply(point - weights @ mesh.vertices)
        assert_allclose(weights @ V + arm, p, rtol=0, atol=1e-12)
    V = solver.pose(Q)
    carried = np.einsum("n,tni->ti", weights, V)
    arms = as_rotation(Q[:, 3]).apply(point - weights @ mesh.vertices)
    assert_allclose(carried + arms, np.tile(point, (3, 1)), rtol=0, atol=1e-12)


def test_quaternions_need_not_be_normalised_all_alike(rng) -> None:
    mesh = sphere(1)
    solver, Q = solver_for(mesh), near_rotations(rng, (2, 4))
    assert_allclose(solver.pose(7.0 * Q), solver.pose(Q), rtol=0, atol=1e-9)


def test_two_triangles_are_the_least(rng) -> None:
    square = Mesh([[0.0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    solver = MotionTransfer(square, [0, 1, 2], [0, 0, 0], 1)
    R = Rotation.random(rng=rng)
    V = solver.pose(wxyz(R)[None])
    assert_allclose(centred(V), R.apply(centred(square.vertices)), rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"vertices": [0, 1, 999]}, r"vertices must hold indices from 0 and below 42, got 999"),
        ({"vertices": [0, -1, 2]}, r"vertices must hold indices .* got -1"),
        ({"bones": [0, 1, 2]}, r"bones must hold indices from 0 and below 2, got 2"),
        ({"bones": [0, 1]}, r"bones must have shape \(3,\), got \(2,\)"),
        ({"vertices": [], "bones": []}, r"pairs must mark at least one face of the target, got none"),
    ],
)
def test_marks_that_do_not_fit_are_refused(change: dict[str, list[int]], message: str) -> None:
    marks = {"vertices": [0, 1, 2], "bones": [0, 1, 1]}
    MotionTransfer(sphere(1), **marks, n_bones=2)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=message):
        MotionTransfer(sphere(1), **(marks | change), n_bones=2)  # type: ignore[arg-type]


def test_what_is_no_surface_is_refused() -> None:
    with pytest.raises(ValueError, match=r"at least 2 triangles, got 1"):
        MotionTransfer(Mesh(np.eye(3), [[0, 1, 2]]), [0], [0], 1)
    with pytest.raises(ValueError, match=r"target must be"):
        MotionTransfer(Mesh(np.ones((4, 3)), [[0, 1, 2], [0, 2, 3]]), [0], [0], 1)


@pytest.mark.parametrize(
    ("Q", "message"),
    [
        (np.ones((2, 3, 4)), r"Q must have shape \(T, 4, 4\), got \(2, 3, 4\)"),
        (np.full((2, 4, 4), np.nan), r"Q must be finite, got nan"),
        (np.ones(4), r"Q must have shape"),
    ],
)
def test_rotations_that_do_not_fit_are_refused(Q: np.ndarray, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        solver_for(sphere(1)).pose(Q)


def test_a_place_that_does_not_fit_is_refused(rng) -> None:
    solver, Q = solver_for(sphere(1)), near_rotations(rng, (3, 4))
    with pytest.raises(ValueError, match="place"):
        solver.pose(Q, np.zeros((2, 3)))
    with pytest.raises(ValueError, match="place"):
        solver.pose(Q, np.full((3, 3), np.inf))
