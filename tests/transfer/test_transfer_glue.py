"""The glue: differential coordinates in, the mesh that has them out."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_zoo import near_rotations, sheet, sphere, wxyz

from tempose.geometry import cotangent_laplacian
from tempose.transfer.solver.blocks import BLOCK, solve_blocks
from tempose.transfer.solver.glue import PoissonGlue
from tempose.transfer.solver.links import ExtraEdges


def field_of(Q: np.ndarray, n: int) -> np.ndarray:
    """One quaternion a frame, the same at all vertices."""
    return np.repeat(Q.T[None], n, axis=0)


@pytest.mark.parametrize("make", [sphere, sheet])
def test_a_constant_field_turns_the_mesh_about_its_first_vertex(make, rng) -> None:
    mesh = make()
    R = Rotation.random(4, rng=rng)
    V = PoissonGlue(mesh.vertices, mesh.faces, ExtraEdges.none()).solve(field_of(wxyz(R), len(mesh.vertices)))
    expected = np.stack([r.apply(mesh.vertices - mesh.vertices[0]) for r in R])
    assert_allclose(V, expected, rtol=0, atol=1e-9 * mesh.diagonal)


def test_the_first_vertex_is_held_at_the_origin_without_distorting(rng) -> None:
    """Holding adds to one diagonal entry only; the equations of all other vertices are met exactly."""
    mesh = sphere()
    n = len(mesh.vertices)
    q = near_rotations(rng, (n, 3)).transpose(0, 2, 1).copy()
    glue = PoissonGlue(mesh.vertices, mesh.faces, ExtraEdges.none())
    V = glue.solve(q)
    assert_allclose(V[:, 0], 0, rtol=0, atol=1e-12)
    L = cotangent_laplacian(mesh.vertices, mesh.faces)
    # linear in the right-hand side: doubling the mesh doubles everything
    double = PoissonGlue(2 * mesh.vertices, mesh.faces, ExtraEdges.none()).solve(q)
    assert_allclose(double, 2 * V, rtol=0, atol=1e-10)
    assert np.abs((L @ V[0]).sum(axis=0)).max() < 1e-9


def test_extra_edges_are_springs_between_vertices() -> None:
    """Two vertices turned apart and joined: the spring pulls against the faces, more with more weight."""
    mesh = sheet(4)
    n = len(mesh.vertices)
    turn = wxyz(Rotation.from_rotvec([[0, 0, 0], [0, 0, 1.2]]))
    share = mesh.vertices[:, 0] / mesh.vertices[:, 0].max()
    q = ((1 - share)[:, None] * turn[0] + share[:, None] * turn[1])[:, :, None].copy()
    i, j = 0, n - 1
    lengths = []
    for weight in (0.0, 1.0, 1e4):
        extra = ExtraEdges(np.array([[i, j]]), np.array([weight]))
        V = PoissonGlue(mesh.vertices, mesh.faces, extra).solve(q)[0]
        lengths.append(np.linalg.norm(V[i] - V[j]))
    rest = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j])
    errors = np.abs(np.array(lengths) - rest) / rest
    assert errors[0] > 0.05
    assert errors[0] > errors[1] > errors[2]
    assert lengths[2] == pytest.approx(rest, rel=1e-3)


@pytest.mark.parametrize("workers", [1, 2, 4])
@pytest.mark.parametrize("T", [0, 1, BLOCK, BLOCK + 1, 5 * BLOCK])
def test_blocks_come_in_order_with_their_own_frames(T: int, workers: int, rng) -> None:
    mesh = sheet(3)
    glue, n = PoissonGlue(mesh.vertices, mesh.faces, ExtraEdges.none()), len(mesh.vertices)
    Q = near_rotations(rng, (T,))
    out, order = np.zeros((T, n, 3)), []

    def solve(block: slice) -> np.ndarray:
        # later blocks would be ready first
        time.sleep(0.002 * (T - block.start) / max(T, 1))
        return glue.solve(field_of(Q[block], n))

    def receive(block: slice, V: np.ndarray) -> None:
        order.append(block.start)
        assert threading.current_thread() is threading.main_thread()
        out[block] = V

    solve_blocks(solve, T, workers, receive)
    assert order == list(range(0, T, BLOCK))
    for t in range(T):
        assert_allclose(out[t], glue.solve(field_of(Q[t : t + 1], n))[0], rtol=0, atol=1e-12)


def test_no_more_than_a_few_blocks_wait_in_memory() -> None:
    started, received, most = [0], [0], [0]

    def solve(block: slice) -> np.ndarray:
        started[0] += 1
        return np.zeros((BLOCK, 4, 3))

    def receive(block: slice, V: np.ndarray) -> None:
        time.sleep(0.002)
        most[0] = max(most[0], started[0] - received[0])
        received[0] += 1

    solve_blocks(solve, 30 * BLOCK, 2, receive)
    assert received[0] == 30
    assert most[0] <= 5


def test_meshes_that_do_not_hang_together_are_refused() -> None:
    a = sheet(3)
    V = np.concatenate([a.vertices, a.vertices + 5.0])
    F = np.concatenate([a.faces, a.faces + len(a.vertices)])
    with pytest.raises(ValueError, match="connected component"):
        PoissonGlue(V, F, ExtraEdges.none())
    PoissonGlue(V, F, ExtraEdges(np.array([[0, len(a.vertices)]]), np.ones(1)))


def test_the_input_is_left_alone(rng) -> None:
    mesh = sheet(3)
    q = near_rotations(rng, (len(mesh.vertices), 2)).transpose(0, 2, 1).copy()
    before = q.copy()
    PoissonGlue(mesh.vertices, mesh.faces, ExtraEdges.none()).solve(q)
    assert_array_equal(q, before)


@pytest.mark.parametrize("K", [1, 2, 8, 11])
def test_single_precision_is_close_and_exact_at_rest(K: int, rng) -> None:
    mesh = sphere()
    n = len(mesh.vertices)
    double = PoissonGlue(mesh.vertices, mesh.faces, ExtraEdges.none())
    single = PoissonGlue(mesh.vertices, mesh.faces, ExtraEdges.none(), "single")
    q = near_rotations(rng, (n, K)).transpose(0, 2, 1).copy()
    assert_allclose(single.solve(q), double.solve(q), rtol=0, atol=5e-6 * mesh.diagonal)
    rest = field_of(np.tile([1.0, 0, 0, 0], (K, 1)), n)
    assert_array_equal(single.solve(rest), np.repeat(mesh.vertices[None] - mesh.vertices[0], K, axis=0))
