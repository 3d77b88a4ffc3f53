"""Small clips with known properties for the tests of the model."""

from __future__ import annotations

import numpy as np

from tempose.clips import Mesh, MeshClip

FACES = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])


def clip_of(V: np.ndarray, fps: float = 24.0, **mesh: object) -> MeshClip:
    return MeshClip(np.asarray(V, np.float32), Mesh(CORNERS, FACES, **mesh), fps)  # type: ignore[arg-type]


def wandering(T: int = 12, seed: int = 0, size: float = 0.3) -> MeshClip:
    """A tetrahedron whose corners walk at random: T - 1 dimensions where T <= 12, no pose twice."""
    rng = np.random.default_rng(seed)
    return clip_of(CORNERS + size * rng.normal(size=(T, 4, 3)).cumsum(axis=0))


def swinging(T: int = 40, period: float = 13.3) -> MeshClip:
    """Smooth motion with a few frequencies, no frame exactly repeated."""
    rng = np.random.default_rng(1)
    a = rng.normal(size=(4, 4, 3))
    w = 2 * np.pi * np.arange(T)[:, None, None] / period
    return clip_of(
        CORNERS
        + 0.2 * (a[0] * np.sin(w) + a[1] * np.cos(w))
        + 0.04 * (a[2] * np.sin(2 * w) + a[3] * np.cos(2.7 * w))
    )


def repeating() -> MeshClip:
    """Two cycles of five frames, the second the very first again."""
    phase = 2 * np.pi * (np.arange(10) % 5)[:, None, None] / 5
    return clip_of(CORNERS + 0.1 * np.sin(np.arange(4)[:, None] + np.arange(3) + phase))


def still(T: int = 5) -> MeshClip:
    return clip_of(np.repeat(CORNERS[None], T, axis=0))


def sliding(steps: tuple[float, ...] = (0, 1, 2, 3, 4, 5)) -> MeshClip:
    """A rigid body on a straight way: its poses lie on one line."""
    return clip_of(np.stack([CORNERS + np.array([x, 0, 0]) for x in steps]))
