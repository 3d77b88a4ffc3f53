"""The fast count of flipped faces is the plain one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from transfer_zoo import ZOO, near_rotations

from tempose.metrics import flipped_percent
from tempose.rotations import normalise
from tempose.transfer.quality.flip_kernel import FlipCounter


@pytest.mark.parametrize("name", ZOO)
def test_it_agrees_with_the_measure(name: str, rng: np.random.Generator) -> None:
    mesh = ZOO[name]()
    F, V_rest = mesh.faces, mesh.vertices
    V = V_rest + 0.15 * mesh.diagonal * rng.normal(size=(5, *V_rest.shape)) / np.sqrt(len(V_rest))
    V[1] = V_rest
    V[2] = V_rest * [-1, 1, 1]
    V[3, :7] = V_rest[0]
    q = near_rotations(rng, (5, len(V_rest)), 120.0) * rng.uniform(0.2, 1, (5, len(V_rest), 1))
    q[1:3] = [1, 0, 0, 0]
    turns = normalise(q[:, F].sum(axis=2))
    found = FlipCounter(F, V_rest).percent(V.astype(np.float32), np.moveaxis(q, 0, 2))
    assert_allclose(found, flipped_percent(V.astype(np.float32), F, V_rest, turns), rtol=0, atol=1e-9)
    assert found[1] == 0 and found[2] > 50
