"""Distances to the outside are exact."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.ndimage import distance_transform_edt

from tempose.embedding._distance import distance_inside


@pytest.mark.parametrize("shape", [(1, 1, 7), (1, 9, 1), (8, 1, 1), (7, 9, 5), (20, 15, 25)])
@pytest.mark.parametrize("share", [0.0, 0.5, 0.95, 0.999])
def test_distances_agree_with_scipy(shape: tuple[int, ...], share: float, rng: np.random.Generator) -> None:
    inside = rng.random(shape) < share
    inside.flat[rng.integers(inside.size)] = False
    assert_allclose(distance_inside(inside), distance_transform_edt(inside), rtol=1e-14)


def test_a_ball_in_a_box_is_as_deep_as_its_radius() -> None:
    grid = np.indices((31, 31, 31)) - 15
    depth = distance_inside((grid**2).sum(axis=0) < 12**2)
    assert depth[15, 15, 15] == 12
    assert (depth[0] == 0).all()
