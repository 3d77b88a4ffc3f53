"""The quadratic of the moments is the squared distance of vertices; derivatives are those of differences."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from pose_cases import J, posed, random_motion, random_skin

from tempose.clips import SkinnedMesh
from tempose.kinematics import bone_transforms, rest_transforms
from tempose.rigging.pose_fit import moments as moments_module
from tempose.rigging.pose_fit.linear_kernels import add_curvature, bone_rows, energy, twist_quadratic
from tempose.rigging.pose_fit.matrix_kernels import orthonormalise
from tempose.rigging.pose_fit.moments import SkinMoments, about_joints
from tempose.rigging.pose_fit.nearest_rotation import nearest_rotation
from tempose.rigging.pose_fit.starts import bone_sums, closed_form_start
from tempose.rigging.pose_fit.tree_kernels import (
    damped_step,
    normal_equations,
    place,
    turn_joints,
)
from tempose.rotations import from_rotation_vector, polar_rotation, to_matrix

N = 3 * J + 3


class Case:
    """One frame, one pose, the quadratic about the joints."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.skin = random_skin(rng)
        made = SkinMoments(self.skin)
        Y = rng.normal(size=(1, len(self.skin.mesh.vertices), 3))
        seen = made.frames(Y)
        self.Y = Y[0] - seen.centres[0]
        self.p = rest_transforms(self.skin.skeleton)[1] - made.centre
        self.x = self.skin.mesh.vertices - made.centre
        self.A, B = about_joints(made.A, seen.moments, self.p)
        self.B, self.constant = B[0], seen.energies[0]
        self.parents = self.skin.skeleton.parents.astype(np.int64)
        self.steps = self.p - self.p[np.maximum(self.parents, 0)]
        self.R = to_matrix(from_rotation_vector(rng.normal(size=(J, 3))))
        self.root = rng.normal(size=3)

    def rows(self, R: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        q, M = np.zeros((J, 3)), np.zeros((4 * J, 3))
        place(R, root, self.parents, self.steps, q)
        bone_rows(R, q, M)
        return q, M

    def value(self, step: np.ndarray) -> float:
        """Half the squared distance after a step."""
        R = np.zeros_like(self.R)
        turn_joints(step, self.parents, self.R, R)
        _, M = self.rows(R, self.root + step[3 * J :])
        return 0.5 * (energy(self.A, self.B, M, np.zeros_like(M)) + self.constant)

    def derivatives(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        q, M = self.rows(self.R, self.root)
        G, K, F = np.zeros_like(M), np.zeros((J, J, 36)), np.zeros((J, 6))
        energy(self.A, self.B, M, G)
        twist_quadratic(self.A, M, G, K, F)
        H, full, g = np.zeros((N, N)), np.zeros((N, N)), np.zeros(N)
        normal_equations(K, F, q, self.parents, H, g)
        add_curvature(M, G, q, self.parents, H, full)
        return g, symmetric(H), symmetric(full)


def symmetric(lower: np.ndarray) -> np.ndarray:
    return np.tril(lower) + np.tril(lower, -1).T


@pytest.fixture
def case(rng: np.random.Generator) -> Case:
    return Case(rng)


def test_the_quadratic_is_the_squared_distance_of_the_vertices(case) -> None:
    q, _ = case.rows(case.R, case.root)
    V = np.einsum("nj,jab,njb->na", case.skin.weights, case.R, case.x[:, None] - case.p)
    V += case.skin.weights @ q
    assert_allclose(2 * case.value(np.zeros(N)), ((V - case.Y) ** 2).sum(), rtol=1e-12)


def test_the_gradient_is_that_of_differences(case) -> None:
    g, _, _ = case.derivatives()
    h = 1e-5
    found = [(case.value(h * e) - case.value(-h * e)) / (2 * h) for e in np.eye(N)]
    assert_allclose(g, found, rtol=0, atol=1e-7 * np.abs(g).max())


def test_the_hessian_is_that_of_second_differences(case) -> None:
    # the order of turns about one joint is symmetrised, which second differences along a line do not see
    _, _, full = case.derivatives()
    h = 1e-4
    zero = case.value(np.zeros(N))
    for u in [*np.eye(N), *np.random.default_rng(1).normal(size=(30, N))]:
        second = (case.value(h * u) + case.value(-h * u) - 2 * zero) / h**2
        assert_allclose(u @ full @ u, second, rtol=1e-5, atol=1e-5 * np.abs(full).max())


def test_without_residual_gauss_newton_is_the_hessian(case) -> None:
    _, M = case.rows(case.R, case.root)
    case.B = case.A @ M
    _, H, full = case.derivatives()
    assert_allclose(H, full, rtol=0, atol=1e-12 * np.abs(H).max())
    assert np.linalg.eigvalsh(H).min() > 0


def test_the_damped_step_solves_its_system(rng) -> None:
    X, g = rng.normal(size=(20, N)), rng.normal(size=N)
    H = X.T @ X + np.eye(N)
    L, step = np.zeros((N, N)), np.zeros(N)
    fall = damped_step(H, g, 0.1, L, step)
    expected = -np.linalg.solve(H + 0.1 * np.diag(np.diag(H)), g)
    assert_allclose(step, expected, rtol=1e-7)
    assert_allclose(fall, -g @ expected, rtol=1e-7)
    assert damped_step(H - 100 * np.eye(N), g, 0.0, L, step) == -1


@pytest.mark.parametrize("hinged", [True, False])
def test_the_closed_form_start_is_exact_for_rigid_bones(rng, hinged) -> None:
    skin = random_skin(rng)
    rigid = SkinnedMesh(skin.mesh, skin.skeleton, (skin.weights > 0.5).astype(float))
    rotations, root = random_motion(rigid, rng, 1, size=2.0)
    made = SkinMoments(rigid)
    seen = made.frames(posed(rigid, (rotations, root)))
    p = rest_transforms(skin.skeleton)[1] - made.centre
    A, B = about_joints(made.A, seen.moments, p)
    parents = skin.skeleton.parents.astype(np.int64)
    R, start = np.zeros((J, 3, 3)), np.zeros(3)
    closed_form_start(bone_sums(A), B[0], parents, p - p[np.maximum(parents, 0)], hinged, R, start)
    turns, _ = bone_transforms(skin.skeleton, rotations[0], root[0])
    assert_allclose(R, to_matrix(turns), rtol=0, atol=1e-9)
    assert_allclose(start, root[0] - seen.centres[0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", ["any", "flat", "reflected", "half turn"])
def test_the_nearest_rotation_is_the_polar_factor(rng, kind) -> None:
    for _ in range(50):
        M = rng.normal(size=(3, 3))
        if kind == "flat":
            M = M[:, :2] @ rng.normal(size=(2, 3))
        elif kind == "reflected":
            M *= -np.sign(np.linalg.det(M))
        elif kind == "half turn":
            M = np.diag([1.0, -1, -1]) + 1e-9 * M
        R = np.zeros((3, 3))
        nearest_rotation(M, R)
        assert_allclose(R.T @ R, np.eye(3), atol=1e-12)
        best = np.trace(polar_rotation(M).T @ M)
        assert_allclose(np.trace(R.T @ M), best, rtol=1e-10)
        assert_allclose(np.linalg.det(R), 1, rtol=1e-10)


def test_nothing_is_turned_by_the_identity() -> None:
    R = np.zeros((3, 3))
    nearest_rotation(R.copy(), R)
    assert_allclose(R, np.eye(3))


def test_orthonormal_rows_come_back(rng) -> None:
    R = to_matrix(from_rotation_vector(rng.normal(size=(4, 3))))
    near = R + 1e-7 * rng.normal(size=R.shape)
    orthonormalise(near)
    assert_allclose(near @ near.transpose(0, 2, 1), np.tile(np.eye(3), (4, 1, 1)), atol=1e-13)
    assert_allclose(near, R, atol=1e-6)


def test_sparse_and_dense_moments_agree_block_by_block(rng, monkeypatch) -> None:
    skin = random_skin(rng)
    Y = posed(skin, random_motion(skin, rng, 7))
    dense = SkinMoments(skin)
    expected = dense.frames(Y)
    monkeypatch.setattr(moments_module, "_DENSE", 2.0)
    monkeypatch.setattr(moments_module, "_BLOCK", 2 * Y[0].size)
    sparse = SkinMoments(skin)
    assert type(sparse.lifted) is not type(dense.lifted)
    found = sparse.frames(Y)
    for a, b in zip(vars(found).values(), vars(expected).values()):
        assert_allclose(a, b, rtol=1e-12, atol=1e-12)


def test_vertices_bound_to_nothing_count_where_they_stay(rng) -> None:
    skin = random_skin(rng)
    weights = skin.weights.copy()
    weights[3] = 0
    loose = SkinnedMesh(skin.mesh, skin.skeleton, weights)
    Y = posed(skin, random_motion(skin, rng, 2))
    expected = ((Y[:, 3] - skin.mesh.vertices[3]) ** 2).sum(axis=1)
    assert_allclose(SkinMoments(loose).frames(Y).loose, expected, rtol=1e-12)


def test_a_skin_without_weights_is_refused(rng) -> None:
    skin = random_skin(rng)
    nothing = SkinnedMesh(skin.mesh, skin.skeleton, np.zeros_like(skin.weights))
    with pytest.raises(ValueError, match="weights must bind at least one vertex"):
        SkinMoments(nothing)
