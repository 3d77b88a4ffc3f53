"""Texture seams do not change the volume that a report gives, and a sheet has none."""

from __future__ import annotations

import numpy as np
import pytest

from tempose.transfer.quality.measures import _volume_measures

V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32)


def test_triangle_soup_encloses_what_its_closed_surface_does() -> None:
    frames = np.stack([V, V * [1, 1.1, 1], V * [1, 1, 0.5]])
    soup = np.arange(12, dtype=np.int32).reshape(4, 3)
    closed, split = _volume_measures(frames, F, V), _volume_measures(frames[:, F.ravel()], soup, V[F.ravel()])
    assert split == closed
    assert closed["volume"] == pytest.approx([0, 10, -50])
    assert closed["volume_worst"] == pytest.approx(-50)


def test_sheet_has_no_volume_to_lose() -> None:
    folded = np.concatenate([F[:1], F[:1, ::-1]])
    found = _volume_measures(np.stack([V, V]), folded, V)
    assert found == {"volume": None, "volume_worst": None, "volume_mean": None}
