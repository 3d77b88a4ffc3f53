"""Whether anything moves, in any unit."""

from __future__ import annotations

import numpy as np
import pytest

from tempose.clips import Mesh, MeshClip
from tempose.clips.still import stands_still


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_one_vertex_that_moves_in_one_frame_is_seen(size):
    V = size * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    frames = np.tile(V, (5, 1, 1))
    mesh = Mesh(V, np.array([[0, 1, 2]]))
    assert stands_still(MeshClip(frames, mesh)) and stands_still(MeshClip(frames[:1], mesh))
    frames[3, 1, 2] += 1e-3 * size
    assert not stands_still(MeshClip(frames, mesh))
    assert stands_still(MeshClip(frames, mesh), 1e-2)
