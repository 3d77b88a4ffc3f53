"""Angles between bones that are known beforehand."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.metrics import direction_angles, limb_direction_errors


@pytest.mark.parametrize("angle", [0, 1e-7, 1e-3, 1, 45, 90, 135, 179.999, 180 - 1e-6, 180])
def test_a_turn_by_an_angle_is_read_as_that_angle(rng, angle: float) -> None:
    source = rng.normal(size=(5, 4, 3))
    axis = np.cross(source, rng.normal(size=3)).reshape(-1, 3)
    axis *= np.radians(angle) / np.linalg.norm(axis, axis=1, keepdims=True)
    target = Rotation.from_rotvec(axis).apply(source.reshape(-1, 3)).reshape(source.shape)
    assert_allclose(direction_angles(source, target), angle, rtol=1e-8, atol=3e-6 if angle == 180 else 1e-12)


def test_same_directions_give_exactly_zero(rng) -> None:
    source = rng.normal(size=(3, 2, 3))
    assert not direction_angles(source, source).any()


def test_length_and_common_rotation_do_not_matter_and_order_neither(rng) -> None:
    a, b = rng.normal(size=(2, 6, 3, 3))
    R = Rotation.random(rng=rng).as_matrix()
    expected = direction_angles(a, b)
    assert_allclose(direction_angles(7.0 * a @ R.T, 1e-3 * b @ R.T), expected, rtol=1e-9)
    assert_allclose(direction_angles(b, a), expected, rtol=1e-12)


def test_slow_twin(rng) -> None:
    a, b = rng.normal(size=(2, 4, 3, 3))
    for t in range(4):
        for k in range(3):
            cosine = a[t, k] @ b[t, k] / np.linalg.norm(a[t, k]) / np.linalg.norm(b[t, k])
            assert direction_angles(a, b)[t, k] == pytest.approx(np.degrees(np.arccos(cosine)), rel=1e-9)


@pytest.mark.parametrize("shape", [(0, 4, 3), (1, 1, 3), (2, 0, 3)])
def test_no_frame_one_bone_no_bone(shape: tuple[int, ...]) -> None:
    assert direction_angles(np.ones(shape), np.ones(shape)).shape == shape[:2]


def test_limbs_collect_mean_and_worst() -> None:
    angles = np.array([[1.0, 2.0, 30.0], [3.0, 6.0, 50.0]])
    errors = limb_direction_errors(angles, {"arm": [0, 1], "leg": [2]})
    assert list(errors) == ["arm", "leg"]
    assert (errors["arm"].mean, errors["arm"].max) == (3.0, 6.0)
    assert (errors["leg"].mean, errors["leg"].max) == (40.0, 50.0)


@pytest.mark.parametrize(
    ("source", "target", "message"),
    [
        (np.ones((2, 3, 3)), np.ones((2, 2, 3)), r"target must have shape \(2, 3, 3\), got \(2, 2, 3\)"),
        (np.ones((3, 3)), np.ones((3, 3)), "source must have shape"),
        (np.full((1, 1, 3), np.nan), np.ones((1, 1, 3)), "source must be finite"),
        (
            np.ones((2, 2, 3)),
            [[[1, 0, 0]] * 2, [[1, 0, 0], [0, 0, 0]]],
            "target .* zero vector in frame 1, bone 1",
        ),
    ],
)
def test_bad_directions_are_refused(source, target, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        direction_angles(source, target)


@pytest.mark.parametrize(
    ("angles", "bones", "message"),
    [
        (np.zeros((2, 3)), [3], r"limbs\['arm'\] must hold indices from 0 and below 3, got 3"),
        (np.zeros((2, 3)), [], r"limbs\['arm'\] must name at least one bone"),
        (np.zeros((0, 3)), [0], "at least one frame"),
    ],
)
def test_bad_limbs_are_refused(angles, bones, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        limb_direction_errors(angles, {"arm": bones})
