"""Clips made to be hard for a pose plane: gestures that pass nearly the same pose, and an elastic ring."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from tempose.clips import Mesh, MeshClip
from tempose.kinematics.skinning import linear_blend_skinning
from tempose.rotations import from_rotation_vector, multiply
from tempose.samples import human_character

# joint, axis of the swing, degrees: one gesture each
GESTURES = (
    ("left_upper_arm", (0.0, 0.0, 1.0), 50.0),
    ("right_upper_arm", (0.0, 0.0, 1.0), 50.0),
    ("left_thigh", (1.0, 0.0, 0.0), 40.0),
    ("right_thigh", (1.0, 0.0, 0.0), 40.0),
)
LEAN = ("spine", (1.0, 0.0, 0.0), 9.0)


def four_gestures(n_frames: int = 97, triangles: int = 4000) -> MeshClip:
    """A human that swings one limb after another through nearly the same pose, leaning now forward, now back.

    Half way through every swing the body stands in its rest pose but for the lean: four similar poses with
    four different motions through them, as in figure 3 of the paper.
    """
    skin = human_character(triangles).skin
    names = list(skin.skeleton.names)
    keys = np.zeros((3 * len(GESTURES), len(GESTURES) + 1))
    for k in range(len(GESTURES)):
        keys[3 * k : 3 * k + 3, k] = -1.0, 0.0, 1.0
        keys[3 * k : 3 * k + 3, -1] = 1.0 if k % 2 == 0 else -1.0
    curve = CubicSpline(np.arange(len(keys), dtype=np.float64), keys, bc_type="natural")
    angles = curve(np.linspace(0, len(keys) - 1, n_frames))
    rotations = np.repeat(np.asarray(skin.skeleton.rest_rotations)[None], n_frames, axis=0)
    for part, (joint, axis, degrees) in enumerate((*GESTURES, LEAN)):
        j = names.index(joint)
        turn = from_rotation_vector(np.radians(degrees) * angles[:, part, None] * np.array(axis))
        rotations[:, j] = multiply(turn, rotations[:, j])
    V = linear_blend_skinning(skin, rotations, np.repeat(skin.skeleton.offsets[:1], n_frames, axis=0))
    return MeshClip(V, skin.mesh, 24.0)


def elastic_ring(n_frames: int = 204, around: int = 66, across: int = 44, fps: float = 25.0) -> MeshClip:
    """A soft ring that is lifted at one place after another and dropped: 2904 vertices, as the paper's cow.

    Overlapping clusters are drawn towards the best rigid and linear fit of their rest shape, a step of
    a 400th of a second at a time.
    """
    V, F = _torus(around, across)
    clusters = _Clusters(V, np.arctan2(V[:, 2], V[:, 0]))
    x, v = V + np.array([0.0, 0.6, 0.0]), np.zeros_like(V)
    steps, frames = round(400 / fps), []
    dt = 1.0 / (steps * fps)
    for frame in range(n_frames):
        frames.append(x)
        for step in range(steps):
            t = (frame + step / steps) / fps
            v = v + dt * np.array([0.0, -9.81, 0.0]) + 0.09 * (clusters.goals(x) - x) / dt
            v += dt * _pull(V, x, t) - 0.4 * dt * v
            low = x[:, 1] + dt * v[:, 1] < 0
            v[low] = v[low] * [0.3, -0.3, 0.3]
            x = x + dt * v
            x[:, 1] = np.maximum(x[:, 1], 0.0)
    return MeshClip(np.array(frames), Mesh(V, F), fps)


def _pull(V: np.ndarray, x: np.ndarray, t: float) -> np.ndarray:
    """Acceleration of the patch that is being lifted: one of five places, 1.6 s each, held for 1.1 s."""
    turn, held = divmod(t, 1.6)
    force = np.zeros_like(x)
    if 0.4 < held < 1.5:
        angle = 2.4 * turn + 0.5
        patch = np.exp(-np.square((V - [np.cos(angle), 0.0, np.sin(angle)]) / 0.45).sum(axis=1))
        hook = np.array([0.5 * np.cos(1.7 * turn), 1.9, 0.5 * np.sin(1.7 * turn)])
        force += patch[:, None] * (60.0 * (hook - x))
    return force


class _Clusters:
    def __init__(self, V: np.ndarray, angle: np.ndarray, count: int = 10) -> None:
        self.members, self.rest = [], []
        self.share = np.zeros(len(V))
        for c in range(count):
            away = np.abs((angle - 2 * np.pi * c / count + np.pi) % (2 * np.pi) - np.pi)
            near = np.flatnonzero(away <= 2 * np.pi / count)
            rest = V[near] - V[near].mean(axis=0)
            self.members.append(near)
            self.rest.append((rest, np.linalg.inv(rest.T @ rest)))
            self.share[near] += 1.0

    def goals(self, x: np.ndarray) -> np.ndarray:
        sums = np.zeros_like(x)
        for near, (rest, inverse) in zip(self.members, self.rest):
            centre = x[near].mean(axis=0)
            A = rest.T @ (x[near] - centre)
            U, _, Wt = np.linalg.svd(A)
            U[:, -1] *= np.sign(np.linalg.det(U @ Wt))
            linear = inverse @ A
            linear /= max(abs(np.linalg.det(linear)), 0.1) ** (1 / 3)
            sums[near] += centre + rest @ (0.5 * U @ Wt + 0.5 * linear)
        return sums / self.share[:, None]


def _torus(around: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    a = np.repeat(2 * np.pi * np.arange(around) / around, across)
    b = np.tile(2 * np.pi * np.arange(across) / across, around)
    thick = 0.28 * (1 + 0.25 * np.cos(3 * a))
    r = 1.0 + thick * np.cos(b)
    V = np.stack([r * np.cos(a), thick * np.sin(b), r * np.sin(a)], axis=1)
    i, j = np.divmod(np.arange(around * across), across)
    right, up = (i + 1) % around * across + j, i * across + (j + 1) % across
    both = (i + 1) % around * across + (j + 1) % across
    here = np.arange(around * across)
    return V, np.concatenate([np.stack([here, up, both], 1), np.stack([here, both, right], 1)])
