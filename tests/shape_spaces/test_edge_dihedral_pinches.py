"""Surfaces that touch at a vertex turn freely about it, which no length and no angle tells."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from spaces_zoo import ZOO

from tempose.rotations import from_rotation_vector, to_matrix
from tempose.shape_spaces import shape_space, space_from_state
from tempose.shape_spaces.edge_dihedral.pinches import join_pinches, split_pinches


def hinged(turns: np.ndarray) -> np.ndarray:
    """Two balls that share vertex 0, the second turned about it."""
    V, _ = ZOO["pinched"]()
    n = (len(V) - 2) // 2 + 1
    frames = np.repeat(V[None], len(turns), axis=0)
    for X, turn in zip(frames, turns):
        X[n : 2 * n - 1] = (V[n : 2 * n - 1] - V[0]) @ to_matrix(from_rotation_vector(turn)).T + V[0]
    return frames


@pytest.mark.parametrize("name", ["edge-dihedral", "rotation-invariant"])
def test_surfaces_turning_about_a_shared_vertex_come_back(name: str) -> None:
    V, F = ZOO["pinched"]()
    frames = hinged(np.outer(np.linspace(0, 1.5, 6), [0.3, -0.8, 0.5]))
    assert np.abs(frames[-1] - V).max() > 0.5
    space = shape_space(name, V, F, frames)
    z = space.encode_path(frames)
    assert_allclose(space.decode(z), frames, atol=1e-9)
    assert_array_equal(space_from_state(name, space.state()).decode(z), space.decode(z))


@pytest.mark.parametrize("name", ZOO)
def test_copies_join_to_the_mesh_they_were_split_from(name: str) -> None:
    V, F = ZOO[name]()
    faces, source = split_pinches(np.asarray(F, np.int64), len(V))
    assert_array_equal(source[faces], F)
    assert_array_equal(np.unique(source), np.arange(len(V)))
    assert_allclose(join_pinches(V[source], source), V, atol=1e-15)
    assert len(source) - len(V) == (name == "pinched")
