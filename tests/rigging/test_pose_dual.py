"""The error of a dual-quaternion skin is that of its vertices; its gradient is that of differences."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose
from pose_cases import J, random_motion, random_skin

from tempose.kinematics import bone_transforms, dual_quaternion_skinning
from tempose.kinematics.dual_quaternion import dual_quaternions, rows_by_strength
from tempose.rigging.pose_fit.dual_kernels import dual_energy
from tempose.rotations import from_rotation_vector, multiply, rotate


def test_value_and_gradient_whatever_the_signs(rng) -> None:
    skin = random_skin(rng)
    rotations, root = random_motion(skin, rng, 1)
    V, rows = skin.mesh.vertices, rows_by_strength(skin.weights)
    Y = rng.normal(size=V.shape)
    turns, shifts = bone_transforms(skin.skeleton, rotations[0], root[0])
    turns *= np.array([1, -1, 1, -1, -1, 1.0])[:, None]

    def half_error(turns: np.ndarray, shifts: np.ndarray) -> tuple[float, np.ndarray]:
        F = np.zeros((J, 6))
        return 0.5 * dual_energy(*rows, *dual_quaternions(turns, shifts), V, Y, F), F

    value, F = half_error(turns, shifts)
    expected = ((dual_quaternion_skinning(skin, rotations, root)[0] - Y) ** 2).sum()
    assert_allclose(2 * value, expected, rtol=1e-12)
    h = 1e-5
    for j in range(J):
        for c, twist in enumerate(np.eye(6)):
            ends: list[float] = []
            for sign in (h, -h):
                q, moved = from_rotation_vector(sign * twist[:3]), (turns.copy(), shifts.copy())
                moved[0][j] = multiply(q, turns[j])
                moved[1][j] = rotate(q, shifts[j]) + sign * twist[3:]
                ends.append(half_error(*moved)[0])
            assert_allclose((ends[0] - ends[1]) / (2 * h), F[j, c], rtol=0, atol=1e-7 * np.abs(F).max())
