"""Morph targets of a clip: one a frame without loss, or a compact basis within a tolerance.

References
----------
.. [1] Alexa and Mueller, "Representing Animations by Principal Components", Eurographics 2000.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tempose.clips import MeshClip
from tempose.formats.glb_normals import UnitNormals
from tempose.typing import FloatArray, Progress


@dataclass(frozen=True)
class Targets:
    """K morph targets and their weights in T frames."""

    weights: FloatArray
    """(T, K) float32."""
    offsets: Callable[[int], FloatArray]
    """Offsets of one target from the rest pose, (n, 3) float32."""
    normals: Callable[[int], FloatArray]
    """Offsets of its normals, (n, 3) float32."""
    names: tuple[str, ...]
    """K names."""
    largest: float
    """Largest distance of a vertex from where it should be, metres, as a reader adds it up."""
    rms: float
    """Root of the mean squared distance, metres."""


def frame_targets(clip: MeshClip, progress: Progress) -> Targets:
    """One target for every frame that differs from the rest pose and from all frames before it.

    Parameters
    ----------
    clip : MeshClip
        T frames.
    progress : Progress
        Called per frame.

    Returns
    -------
    Targets
        Without loss but for float32: an offset is rounded to 24 bits.
    """
    T = clip.n_frames
    rest, normals = clip.rest.astype(np.float32), UnitNormals(clip.faces, len(clip.rest))
    N = normals(clip.rest)
    known: dict[bytes, int] = {}
    frames: list[int] = []
    column = np.full(T, -1)
    squares, largest = 0.0, 0.0
    for t in range(T):
        offset = clip.vertices[t] - rest
        gap = ((rest + offset).astype(np.float64) - clip.vertices[t]) ** 2
        squares, largest = squares + float(gap.sum()), max(largest, float(gap.sum(axis=1).max()))
        if offset.any():
            # -0 + 0 is 0: equal offsets have equal bytes
            key = hashlib.blake2b((offset + np.float32(0)).tobytes()).digest()
            column[t] = known.setdefault(key, len(frames))
            if column[t] == len(frames):
                frames.append(t)
        progress(t + 1, T, "comparing frames")
    # a clip that never leaves its rest pose still needs something to hang its keys on
    frames = frames or [0]
    weights = np.zeros((T, len(frames)), np.float32)
    moving = np.flatnonzero(column >= 0)
    weights[moving, column[moving]] = 1.0
    return Targets(
        weights,
        lambda k: clip.vertices[frames[k]] - rest,
        lambda k: normals(clip.vertices[frames[k]]) - N,
        tuple(f"frame_{t}" for t in frames),
        float(np.sqrt(largest)),
        float(np.sqrt(squares / (T * len(rest)))),
    )


def basis_targets(clip: MeshClip, tolerance: float, progress: Progress) -> Targets:
    """Find the fewest principal components that keep every vertex within a distance.

    Parameters
    ----------
    clip : MeshClip
        T frames.
    tolerance : float
        Largest allowed distance, metres.
    progress : Progress
        Called per step of the search.

    Returns
    -------
    Targets
        Components of the offsets from rest (not from the mean: rest must stay what weights of zero show),
        scaled so that the largest weight of each is 1.
    """
    T = clip.n_frames
    rest = clip.rest.astype(np.float32)
    weights, components, energy = _principal(clip.vertices - rest)
    # the rms error is known before anything is tried, and the largest is no smaller
    left = np.append(np.cumsum(energy[::-1])[::-1], 0.0) / (T * len(rest))
    low = high = max(int(np.argmax(left <= tolerance**2)), 1)
    stride = 1

    def misses(K: int) -> bool:
        progress(K, T, "finding components")
        return _errors(clip, rest, weights[:, :K], components[:K])[0] > tolerance

    while high < T and misses(high):
        low, high, stride = high + 1, min(high + stride, T), 2 * stride
    while low < high:
        middle = (low + high) // 2
        low, high = (middle + 1, high) if misses(middle) else (low, middle)
    weights, components = weights[:, :high], components[:high]
    largest, rms = _errors(clip, rest, weights, components)
    turned = _fitted_normals(clip, weights)
    names = tuple(f"component_{k}" for k in range(high))
    return Targets(weights, lambda k: components[k], lambda k: turned[k], names, largest, rms)


def _principal(offsets: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """All weights (T, T) of largest value 1, their components (T, n, 3), and the energy of each, falling."""
    T, n = offsets.shape[:2]
    X = offsets.reshape(T, 3 * n)
    blocks = [slice(start, start + 65536) for start in range(0, 3 * n, 65536)]
    gram = np.zeros((T, T))
    for block in blocks:
        columns = X[:, block].astype(np.float64)
        gram += columns @ columns.T
    energy, U = np.linalg.eigh(gram)
    energy, U = np.maximum(energy[::-1], 0.0), U[:, ::-1]
    peak = U[np.abs(U).argmax(axis=0), np.arange(T)]
    components = np.zeros((T, 3 * n), np.float32)
    for block in blocks:
        components[:, block] = peak[:, None] * (U.T @ X[:, block].astype(np.float64))
    return (U / peak).astype(np.float32), components.reshape(offsets.shape), energy


def _errors(
    clip: MeshClip, rest: FloatArray, weights: FloatArray, components: FloatArray
) -> tuple[float, float]:
    """Largest and rms distance, metres, as a reader gets them: summed in float64, stored in float32."""
    largest, squares = 0.0, 0.0
    T = len(weights)
    W, C = weights.astype(np.float64), components.astype(np.float64)
    for start in range(0, T, 64):
        rows = slice(start, start + 64)
        there = (np.tensordot(W[rows], C, 1) + rest).astype(np.float32)
        gap = ((there.astype(np.float64) - clip.vertices[rows]) ** 2).sum(axis=-1)
        largest, squares = max(largest, float(gap.max())), squares + float(gap.sum())
    return float(np.sqrt(largest)), float(np.sqrt(squares / (T * len(rest))))


def _fitted_normals(clip: MeshClip, weights: FloatArray) -> FloatArray:
    """Fit normal offsets (K, n, 3) to those of all frames under the same weights.

    The columns of the weights are orthogonal, so each target is a plain projection.
    """
    normals = UnitNormals(clip.faces, len(clip.rest))
    N = normals(clip.rest)
    result = np.zeros((weights.shape[1], *N.shape))
    for t in range(clip.n_frames):
        result += weights[t, :, None, None] * (normals(clip.vertices[t]) - N)
    return (result / np.maximum((weights**2).sum(axis=0), 1e-30)[:, None, None]).astype(np.float32)
