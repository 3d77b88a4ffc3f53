"""Splitting off the placement of a captured walk leaves fewer modes to the shape."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.formats import load_clip
from tempose.linalg.pca import GramPCA
from tempose.signals.placement import place, split_placement
from tempose.typing import FloatArray

pytestmark = [pytest.mark.real, pytest.mark.slow]


def modes(V: FloatArray, limit: float) -> int:
    """Fewest principal components that leave out at most `limit` (rms distance of a vertex)."""
    s = GramPCA(V.reshape(len(V), -1)).singular_values
    left = np.append(np.cumsum(np.square(s)[::-1])[::-1], 0.0)
    return int(np.argmax(np.sqrt(left / (V.shape[0] * V.shape[1])) <= limit))


def test_crane_needs_9_modes_instead_of_15_for_one_percent(data_folder: Callable[[str], Path]) -> None:
    clip = load_clip(str(data_folder("vlasic-crane")))
    V = np.asarray(clip.vertices, dtype=float)
    placements, bodies = split_placement(V, clip.rest)
    assert_allclose(place(bodies, placements), V, atol=1e-12)
    D = clip.mesh.diagonal
    assert [modes(V, p * D / 100) for p in (1.0, 0.5)] == [15, 21]
    assert [modes(bodies, p * D / 100) for p in (1.0, 0.5)] == [9, 15]
