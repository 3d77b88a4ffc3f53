"""The whole solver against a slow twin: the paper's equations (2)-(4), dense, in plain loops."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from transfer_zoo import ZOO, as_rotation, marked, near_rotations

from tempose.clips import Mesh
from tempose.transfer import MotionTransfer
from tempose.transfer.solver.links import inner_edges

LINK = 5.0
TRACE = 1e-7


def cotangent(a: list[float], b: list[float]) -> float:
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    area = sum(x * x for x in cross) ** 0.5
    return sum(x * y for x, y in zip(a, b)) / area if area > 1e-14 else 0.0


def face_matrix(corners: np.ndarray) -> np.ndarray:
    """Laplacian of a triangle alone: minus the half cotangent opposite to every edge."""
    L = np.zeros((3, 3))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        w = 0.5 * cotangent((corners[i] - corners[k]).tolist(), (corners[j] - corners[k]).tolist())
        L[[i, j], [j, i]] -= w
        L[[i, j], [i, j]] += w
    return L


def add_edge(L: np.ndarray, i: int, j: int, w: float) -> None:
    L[i, i] += w
    L[j, j] += w
    L[i, j] -= w
    L[j, i] -= w


def welded(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, list[int]]:
    place: dict[tuple[float, ...], int] = {}
    index = [place.setdefault(tuple(v + 0.0), len(place)) for v in mesh.vertices]
    return np.array(list(place)), np.array([[index[v] for v in f] for f in mesh.faces]), index


def inner_weights(V: np.ndarray, F: np.ndarray, strength: float) -> list[tuple[int, int, float]]:
    """Weights of inner edges by their formula; which vertices they join is tested with the links."""
    area = np.zeros(len(V))
    for f in F:
        for v in f:
            area[v] += np.linalg.norm(np.cross(V[f[1]] - V[f[0]], V[f[2]] - V[f[0]])) / 6
    pairs = inner_edges(V, F, strength).pairs
    return [(i, j, strength * 4 * area[i] / np.linalg.norm(V[i] - V[j]) ** 2) for i, j in pairs]


def slow_pose(
    mesh: Mesh, marks: np.ndarray, bones: np.ndarray, links: np.ndarray, Q: np.ndarray, strength: float
) -> tuple[np.ndarray, np.ndarray]:
    """Field at the vertices and the mesh, its first vertex at the origin."""
    V, F, index = welded(mesh)
    n = len(V)
    extra = [(i, j, LINK) for i, j in links] + (inner_weights(V, F, strength) if strength else [])
    # eq. (2): harmonic components, with rows of the identity at the marks
    edges = np.zeros((n, n))
    for f in F:
        edges[np.ix_(f, f)] -= face_matrix(V[f]) if len(set(f)) == 3 else 0
    np.fill_diagonal(edges, 0)
    edges = np.maximum(edges, 0)
    A = np.diag(edges.sum(axis=1)) - edges
    for i, j in links:
        add_edge(A, i, j, LINK)
    for f in F:
        for k in range(3):
            add_edge(A, f[k], f[(k + 1) % 3], TRACE)
    values: dict[int, list[int]] = {}
    for v, b in zip(marks, bones):
        values.setdefault(index[v], []).append(b)
    right = np.zeros((n, 4))
    for v, mine in values.items():
        A[v] = 0
        A[v, v] = 1
        right[v] = np.mean([Q[b] for b in mine], axis=0)
    q = np.linalg.solve(A, right)
    # eqs. (3)-(4): the fragmented mesh, its own Laplacian, summed by the connectivity of the mesh
    L, u = np.zeros((n, n)), np.zeros((n, 3))
    for f in F:
        if len(set(f)) < 3:
            continue
        fragment = as_rotation(q[f].mean(axis=0)).apply(V[f])
        local = face_matrix(V[f])
        L[np.ix_(f, f)] += local
        u[f] += local @ fragment
    for i, j, w in extra:
        add_edge(L, i, j, w)
        turned = w * as_rotation(q[i] + q[j]).apply(V[i] - V[j])
        u[i] += turned
        u[j] -= turned
    x = np.linalg.lstsq(L, u, rcond=1e-13)[0]
    assert np.abs(L @ x - u).max() < 1e-9
    return q[index], (x - x[0])[index]


@pytest.mark.parametrize("strength", [0.0, 0.8])
@pytest.mark.parametrize("name", ["sphere", "sheet", "pieces", "dirty"])
def test_the_fast_way_is_the_slow_way(name: str, strength: float, rng) -> None:
    mesh = ZOO[name]() if name != "sphere" else ZOO[name](1)
    vertices, bones = marked(mesh, 5)
    # a vertex with marks of three bones, one of them twice
    vertices = np.r_[vertices, np.repeat(mesh.faces[7, 0], 4)]
    bones = np.r_[bones, [0, 1, 1, 4]]
    solver = MotionTransfer(mesh, vertices, bones, 5, volume=strength)
    Q = near_rotations(rng, (1, 5), 100)
    q, V = slow_pose(mesh, vertices, bones, solver.links.pairs, Q[0], strength)
    assert_allclose(solver.field(Q)[:, :, 0], q, rtol=0, atol=1e-9)
    fast = solver.pose(Q)[0]
    assert_allclose(fast - fast[0], V, rtol=0, atol=1e-9 * mesh.diagonal)


@pytest.mark.parametrize(
    ("mesh", "frames"),
    [(ZOO["sphere"](1), 3), (ZOO["sphere"](2), 2), (ZOO["sphere"](3), 1), (ZOO["pieces"](), 1)],
)
def test_single_precision_drifts_by_less_than_5e6_of_the_height(mesh: Mesh, frames: int, rng) -> None:
    vertices, bones = marked(mesh, 5)
    solver = MotionTransfer(mesh, vertices, bones, 5, precision="single")
    Q = near_rotations(rng, (frames, 5), 100)
    for V, rotations in zip(solver.pose(Q), Q):
        slow = slow_pose(mesh, vertices, bones, solver.links.pairs, rotations, 0.0)[1]
        drift = V - slow
        assert np.abs(drift - drift.mean(axis=0)).max() < 5e-6 * mesh.height
