"""People and a dog made of capsules, with known joints."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from tempose.clips import Mesh

SIDES = (("left", 1.0), ("right", -1.0))


def sphere(level: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """Unit sphere out of an octahedron."""
    V = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    F = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    for _ in range(level):
        edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
        unique, inverse = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
        a, b, c = (inverse.ravel() + len(V)).reshape(3, -1)
        V = np.concatenate([V, V[unique].mean(axis=1)])
        x, y, z = F.T
        F = np.concatenate([np.column_stack(t) for t in ((x, a, c), (a, y, b), (c, b, z), (a, b, c))])
    return V / np.linalg.norm(V, axis=1, keepdims=True), F


def capsule(start: np.ndarray, end: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Sphere pulled apart along a segment."""
    V, F = sphere()
    way = end - start
    far = (V @ way > 1e-9)[:, None]
    return radius * V + np.where(far, end, start), F


def joined(parts: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    shift = np.cumsum([0, *[len(V) for V, _ in parts]])
    return np.concatenate([V for V, _ in parts]), np.concatenate([F + s for (_, F), s in zip(parts, shift)])


def person_joints(arms: float = 40.0, stride: float = 0.0, knee: float = 0.0) -> dict[str, np.ndarray]:
    """Joints of a person of 1.75 m; degrees of the arms below the horizontal, of the stride, of a knee."""
    up = lambda y, z=0.0: np.array([0.0, y, z])  # noqa: E731
    at = {"hips": up(0.94), "spine": up(1.03), "neck": up(1.48), "head": up(1.58), "top": up(1.75)}
    a = np.radians(arms)
    for side, s in SIDES:
        along = np.array([s * np.cos(a), -np.sin(a), 0.0])
        shoulder = np.array([s * 0.18, 1.41, 0.0])
        at[f"{side}_upper_arm"] = shoulder
        at[f"{side}_forearm"] = shoulder + 0.28 * along
        at[f"{side}_hand"] = shoulder + 0.53 * along
        at[f"{side}_finger"] = shoulder + 0.70 * along
        t = np.radians(s * stride)
        k = t - (np.radians(knee) if side == "right" else 0.0)
        thigh = np.array([s * 0.095, 0.91, 0.0])
        at[f"{side}_thigh"] = thigh
        at[f"{side}_shin"] = shin = thigh + 0.42 * np.array([0, -np.cos(t), np.sin(t)])
        at[f"{side}_foot"] = foot = shin + 0.42 * np.array([0, -np.cos(k), np.sin(k)])
        ahead, down = np.array([0, np.sin(k), np.cos(k)]), np.array([0, -np.cos(k), np.sin(k)])
        at[f"{side}_heel"] = foot - 0.03 * ahead + 0.04 * down
        at[f"{side}_toes"] = foot + 0.12 * ahead + 0.05 * down
        at[f"{side}_tip"] = foot + 0.17 * ahead + 0.05 * down
    return at


_BONES = (
    ("upper_arm", "forearm", 0.048),
    ("forearm", "hand", 0.038),
    ("hand", "finger", 0.03),
    ("thigh", "shin", 0.075),
    ("shin", "foot", 0.05),
    ("foot", "heel", 0.04),
    ("heel", "tip", 0.035),
)


def segments_of(at: dict[str, np.ndarray]) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """Capsules of a body."""
    parts = [
        (at["neck"], at["head"], 0.055),
        (at["head"] + [0, 0.03, 0.02], at["top"] - [0, 0.09, 0], 0.09),
        (at["hips"], at["spine"], 0.11),
    ]
    for side, s in SIDES:
        parts.append((at["spine"] + [s * 0.05, 0, 0], at["neck"] + [s * 0.06, -0.14, 0], 0.10))
        parts.append((at["neck"] - [0, 0.06, 0], at[f"{side}_upper_arm"], 0.055))
        parts.append((at["hips"], at[f"{side}_thigh"], 0.085))
        parts += [(at[f"{side}_{a}"], at[f"{side}_{b}"], r) for a, b, r in _BONES]
    return parts


@lru_cache
def person(arms: float = 40.0, stride: float = 0.0, knee: float = 0.0) -> tuple[Mesh, dict[str, np.ndarray]]:
    """A doll of 23 overlapping closed pieces, with its joints."""
    at = person_joints(arms, stride, knee)
    return Mesh(*joined([capsule(*part) for part in segments_of(at)])), at


@lru_cache
def block_person(arms: float = 40.0, cell: float = 0.02) -> tuple[Mesh, dict[str, np.ndarray]]:
    """The same body as one closed surface of little squares."""
    at = person_joints(arms)
    parts = segments_of(at)
    low = np.min([np.minimum(a, b) - r for a, b, r in parts], axis=0) - 2 * cell
    high = np.max([np.maximum(a, b) + r for a, b, r in parts], axis=0) + 2 * cell
    axes = [np.arange(lo, hi, cell) for lo, hi in zip(low, high)]
    X = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    inside = np.zeros(X.shape[:3], dtype=bool)
    for a, b, r in parts:
        way = b - a
        t = np.clip((X - a) @ way / (way @ way), 0, 1)
        inside |= ((X - a - t[..., None] * way) ** 2).sum(axis=-1) < r * r
    return Mesh(*surface_of(inside, low, cell)), at


def surface_of(inside: np.ndarray, low: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray]:
    """Two triangles for every square between a cell inside and one outside."""
    corners: list[np.ndarray] = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        n = np.eye(3, dtype=int)[axis]
        for sign in (1, -1):
            outer = np.argwhere(inside & ~np.roll(inside, -sign, axis=axis))
            base = outer + (n if sign > 0 else 0)
            square = np.stack([base, base + u, base + u + v, base + v], axis=1)
            corners.append(square if sign > 0 else square[:, ::-1])
    squares = np.concatenate(corners)
    points, index = np.unique(squares.reshape(-1, 3), axis=0, return_inverse=True)
    q = index.reshape(-1, 4)
    return low + (points - 0.5) * cell, np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])


@lru_cache
def dog() -> Mesh:
    """Four legs under a level trunk, a head at one end and a tail at the other."""
    at = lambda *p: np.array(p, dtype=float)  # noqa: E731
    parts = [
        (at(0, 0.6, -0.4), at(0, 0.6, 0.4), 0.12),
        (at(0, 0.65, 0.4), at(0, 0.85, 0.6), 0.07),
        (at(0, 0.9, 0.6), at(0, 0.85, 0.85), 0.07),
        (at(0, 0.65, -0.45), at(0, 0.8, -0.8), 0.03),
    ]
    for _, s in SIDES:
        for z in (-0.4, 0.4):
            parts.append((at(s * 0.08, 0.55, z), at(s * 0.1, 0.05, z), 0.045))
    return Mesh(*joined([capsule(*part) for part in parts]))


def errors(joints: np.ndarray, names: tuple[str, ...], at: dict[str, np.ndarray]) -> dict[str, float]:
    """Distance of each embedded joint from the true one, percent of 1.75 m."""
    return {n: float(100 * np.linalg.norm(joints[i] - at[n]) / 1.75) for i, n in enumerate(names)}
