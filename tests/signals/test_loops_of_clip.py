"""Loops of a clip do not depend on where the body is when that is left out."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip
from tempose.signals.loops import find_loops
from tempose.signals.loops.of_clip import clip_coordinates, travels


def swinging(speed: float) -> MeshClip:
    rng = np.random.default_rng(1)
    rest, sway = rng.normal(size=(20, 3)), rng.normal(size=(2, 20, 3))
    t = 2 * np.pi * np.arange(36) / 12
    V = rest + 0.1 * (np.sin(t)[:, None, None] * sway[0] + np.cos(t)[:, None, None] * sway[1])
    V[:, :, 0] += speed * np.arange(36)[:, None]
    return MeshClip(V.astype(np.float32), Mesh(rest, np.array([[0, 1, 2]])), 24.0)


def test_distances_of_coordinates_are_those_of_the_frames() -> None:
    clip = swinging(0.3)
    X, V = clip_coordinates(clip), clip.vertices.astype(np.float64)
    assert_allclose(np.linalg.norm(X[3] - X[17]), np.linalg.norm(V[3] - V[17]), rtol=1e-6)


def test_a_walk_has_the_loops_of_the_same_motion_on_the_spot() -> None:
    assert travels(swinging(0.3)) and not travels(swinging(0.0))
    here, there = (find_loops(clip_coordinates(swinging(v), True)) for v in (0.0, 0.3))
    assert there[0].period == here[0].period == 12 and there[0].distance < 1e-3
    assert all(loop.distance > 0.1 for loop in find_loops(clip_coordinates(swinging(0.3))))


def test_one_frame_has_no_loop() -> None:
    clip = swinging(0.0)
    with pytest.raises(ValueError, match="2 frames"):
        clip_coordinates(MeshClip(clip.vertices[:1], clip.mesh, 24.0))
