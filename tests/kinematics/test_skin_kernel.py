"""The kernel for single frames agrees with the batch, at every size and precision."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, Skeleton, SkinnedMesh
from tempose.kinematics import SkinKernel, bone_transforms, linear_blend_skinning
from tempose.kinematics.skin_kernel import LANES

J = 6


def make_skin(n: int, rng: np.random.Generator) -> SkinnedMesh:
    tree = Skeleton(tuple("abcdef"), np.array([-1, 0, 1, 1, 0, 4]), rng.normal(size=(J, 3)))
    weights = rng.random((n, J)) * (rng.random((n, J)) < 0.5)
    weights[:, 0] += 0.05
    weights /= weights.sum(axis=1, keepdims=True)
    weights[n // 2] = 0
    return SkinnedMesh(Mesh(rng.normal(size=(n, 3)), np.array([[0, 1, 2]])), tree, weights)


@pytest.mark.parametrize("n", [3, LANES, LANES + 1, 700])
@pytest.mark.parametrize(("precision", "tolerance"), [(np.float32, 3e-6), (np.float64, 1e-13)])
def test_agrees_with_the_batch(rng, n, precision, tolerance) -> None:
    skin = make_skin(n, rng)
    q = rng.normal(size=(2, J, 4))
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    root = rng.normal(size=(2, 3))
    turns, shifts = bone_transforms(skin.skeleton, q, root)
    kernel = SkinKernel(skin, precision)
    room = np.full((n, 3), np.nan, precision)
    for t, expected in enumerate(linear_blend_skinning(skin, q, root)):
        posed = kernel.pose(kernel.matrices(turns[t], shifts[t]), room)
        assert posed is room and posed.dtype == precision
        assert_allclose(posed, expected, rtol=0, atol=tolerance * np.abs(expected).max())
    loose = skin.mesh.vertices[n // 2]
    assert_array_equal(room[n // 2], loose.astype(precision))


def test_small_weights_are_dropped_and_rows_still_sum_to_one(rng) -> None:
    skin = make_skin(300, rng)
    kernel = SkinKernel(skin, np.float64, least_weight=0.1)
    sums = np.zeros((len(kernel.rest), LANES))
    for b in range(len(sums)):
        sums[b] = kernel.shares[kernel.starts[b] : kernel.starts[b + 1]].sum(axis=0)
    assert_allclose(sums.ravel()[kernel.order >= 0], 1, rtol=1e-12)
    assert kernel.shares[kernel.shares > 0].min() >= 0.1


def test_every_vertex_has_one_lane(rng) -> None:
    kernel = SkinKernel(make_skin(300, rng))
    assert_array_equal(np.sort(kernel.order[kernel.order >= 0]), np.arange(300))
