"""A long clip from nothing, written block by block: someone who walks, runs and stands, round and round."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import numpy as np

from tempose.clips import MeshClip, SkeletonClip
from tempose.kinematics.skinning import bake
from tempose.rotations import from_rotation_vector, multiply, normalise, rotate
from tempose.samples import MOTIONS, Character, human_character
from tempose.signals.placement.spline import continuous_signs
from tempose.typing import FloatArray

FPS = 30.0
GAITS = (("walk", None), ("walk", 5), ("run", None), ("idle", None))
"""Motion and performer."""
ORDER = (0, 2, 1, 3, 0, 1, 2, 3)
"""Gaits one after another..."""
HOLD, FADE = 6.0, 1.5
"""...for so many seconds each, fading over so many."""
TURN = 0.16
"""Radians a second: the way is a circle."""


class Gait:
    """Whole strides, played by their phase."""

    def __init__(self, body: Character, motion: str, seed: int | None) -> None:
        clip: SkeletonClip = MOTIONS["human"][motion](body.skin.skeleton, fps=60.0, loop=True, seed=seed)
        T, J = clip.rotations.shape[:2]
        self.seconds = T / clip.fps
        q = np.concatenate([clip.rotations, clip.rotations[:1]])
        flat = np.concatenate([q, np.zeros((T + 1, J, 3))], axis=2)
        self.q = np.stack([continuous_signs(flat[:, j])[:, :4] for j in range(J)], axis=1)
        steps = clip.root_position[1:, 2] - clip.root_position[:-1, 2]
        self.speed = float(steps.mean() * clip.fps)
        away = np.arange(T)[:, None] * self.speed / clip.fps * np.array([0, 0, 1.0])
        root = clip.root_position - away
        self.root = np.concatenate([root, root[:1]])

    def __call__(self, phase: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return rotations (T, J, 4) and root (T, 3) at phases."""
        u = (phase % 1.0) * (len(self.q) - 1)
        i = np.minimum(u.astype(int), len(self.q) - 2)
        s = u - i
        q = (1 - s)[:, None, None] * self.q[i] + s[:, None, None] * self.q[i + 1]
        return normalise(q), (1 - s)[:, None] * self.root[i] + s[:, None] * self.root[i + 1]


@lru_cache(maxsize=2)
def body(vertices: int) -> Character:
    return human_character(2 * vertices)


def skeleton_clip(who: Character, T: int) -> SkeletonClip:
    gaits = [Gait(who, *gait) for gait in GAITS]
    t = np.arange(T) / FPS
    weights = _weights(t, len(gaits))
    rate = weights @ np.array([1 / g.seconds for g in gaits])
    phase = np.concatenate([[0.0], np.cumsum(rate[:-1]) / FPS])
    posed = [g(phase) for g in gaits]
    q = np.zeros_like(posed[0][0])
    for k, (rotations, _) in enumerate(posed):
        sign = np.where(np.sum(rotations * posed[0][0], axis=-1, keepdims=True) < 0, -1.0, 1.0)
        q += weights[:, k, None, None] * sign * rotations
    q = normalise(q)
    root = np.sum([weights[:, k, None] * there for k, (_, there) in enumerate(posed)], axis=0)
    speed = weights @ np.array([g.speed for g in gaits])
    up = np.array([0.0, 1.0, 0.0])
    heading = from_rotation_vector((TURN * t)[:, None] * up)
    ahead = rotate(heading, np.array([0, 0, 1.0])) * speed[:, None] / FPS
    way = np.concatenate([np.zeros((1, 3)), np.cumsum(ahead[:-1], axis=0)])
    q[:, 0] = multiply(heading, q[:, 0])
    return SkeletonClip(who.skin.skeleton, q, way + rotate(heading, root), FPS)


def _weights(t: FloatArray, count: int) -> FloatArray:
    """(T, count) how much each gait counts, smooth, rows summing to 1."""
    piece = (t / HOLD).astype(int)
    s = np.clip((t - HOLD * piece - (HOLD - FADE)) / FADE, 0, 1)
    fade = s**3 * (10 + s * (6 * s - 15))
    order = np.array(ORDER)
    eye = np.eye(count)
    here, following = eye[order[piece % len(order)]], eye[order[(piece + 1) % len(order)]]
    return (1 - fade)[:, None] * here + fade[:, None] * following


def write_long_clip(path: Path, T: int, vertices: int = 10_000) -> int:
    """Write the frames to a ``.npy``; return how many vertices there are."""
    who = body(vertices)
    clip = skeleton_clip(who, T)
    n = len(who.skin.mesh.vertices)
    out = np.lib.format.open_memmap(path, mode="w+", dtype=np.float32, shape=(T, n, 3))
    for start in range(0, T, 50):
        part = slice(start, min(start + 50, T))
        piece = SkeletonClip(clip.skeleton, clip.rotations[part], clip.root_position[part], FPS)
        out[part] = bake(who.skin, piece)
    out.flush()
    return n


def open_long_clip(path: Path, T: int, vertices: int = 10_000) -> MeshClip:
    """Open the first T of the frames that were written, as a memory map."""
    return MeshClip(np.load(path, mmap_mode="r")[:T], body(vertices).skin.mesh, FPS)
