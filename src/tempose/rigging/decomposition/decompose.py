"""Skinning decomposition: a few rigid bones and sparse weights that make the frames of a clip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, read_only
from tempose.rigging.decomposition.alternation import alternate
from tempose.rigging.decomposition.growth import exchange, grow
from tempose.rigging.decomposition.problem import Problem, State
from tempose.rigging.decomposition.steps import weight_step
from tempose.rotations import from_matrix, to_matrix
from tempose.typing import FloatArray, IntArray, Progress, silent

_EXACT = 1e-6  # rms distance, in diagonals, below which a clip counts as explained: float32 files reach 1e-7
_SEARCH = 1500  # vertices on which bones are sought; the whole mesh then settles them
_FEW = 4  # influences while bones are sought: with more of them a bone may lie far from all that it moves


@dataclass(frozen=True)
class Decomposition:
    """Bones and weights found in a clip."""

    rest: FloatArray
    """(n, 3) float64 rest positions, metres."""
    weights: FloatArray
    """(n, B) float64, rows >= 0 that sum to 1, at most as many entries as influences were asked for."""
    rotations: FloatArray
    """(T, B, 4) float64 wxyz, rest to frame."""
    translations: FloatArray
    """(T, B, 3) float64 metres: a bone takes rest position x to ``R x + t``."""
    rms: float
    """Root mean square distance of the vertices, metres."""
    iterations: int
    """Rounds of weights and bones on the whole mesh."""
    converged: bool
    """Whether the last round lowered the rms by less than the tolerance."""

    @property
    def n_bones(self) -> int:
        """Number of bones B."""
        return self.weights.shape[1]

    def vertices(self) -> FloatArray:
        """Return the frames that the bones make.

        Returns
        -------
        (T, n, 3) ndarray
            Positions, metres.
        """
        R = to_matrix(self.rotations)
        matrices = np.concatenate([R.transpose(0, 1, 3, 2), self.translations[:, :, None]], axis=2)
        u1 = np.column_stack([self.rest, np.ones(len(self.rest))])
        lifted = (self.weights[:, :, None] * u1[:, None, :]).reshape(len(u1), -1)
        return lifted @ matrices.reshape(len(R), -1, 3)


def decompose(
    frames: FloatArray,
    rest: FloatArray,
    *,
    bones: int,
    influences: int = 4,
    iterations: int = 30,
    tolerance: float = 1e-3,
    alone: float = 0.0,
    seed: int = 0,
    progress: Progress = silent,
) -> Decomposition:
    """Find rigid bones and sparse convex weights whose blend makes the frames of a clip.

    Parameters
    ----------
    frames : (T, n, 3) float
        Vertices in every frame.
    rest : (n, 3) float
        Vertices at rest, in the same unit; often one of the frames.
    bones : int
        Number of bones B.
    influences : int, default 4
        Most bones K that a vertex may follow.
    iterations : int, default 30
        Most rounds of weights and bones on the whole mesh, after the search for bones.
    tolerance : float, default 1e-3
        Rounds end when one lowers the rms by a smaller part than this.
    alone : float, default 0.0
        How much a bone must carry by itself what follows it, against the blend. 0 gives the smallest error,
        perhaps with bones that lie far from what they move; 0.003 gives bones that can be joined.
    seed : int, default 0
        Where bones are tried is drawn; the same seed gives the same answer.
    progress : Progress
        Told about every stage.

    Returns
    -------
    Decomposition
        Weights, motions and how well they fit.

    Raises
    ------
    ValueError
        If shapes or counts cannot be, or if the clip moves like fewer bones than asked for: then some would
        hold nothing, and the message says how many are enough.

    Notes
    -----
    The model and the two alternating steps are those of [1]_. The start is our own: bones are added one by
    one, each the rigid motion of the patch that helps the blend most, then those that are missed least are
    moved to where the error is largest while that helps. All products are taken over frames first, so a
    vertex's weights cost the same for any number of frames and a bone's motion for any number of vertices.

    References
    ----------
    .. [1] Le and Deng, "Smooth Skinning Decomposition with Rigid Bones", SIGGRAPH Asia 2012.
    """
    rest = as_floats(rest, "rest", ("n", 3))
    frames = as_floats(frames, "frames", ("T", len(rest), 3))
    B, K = _counts(frames, bones, influences)
    if not alone >= 0:
        raise ValueError(f"alone must not be negative, got {alone}")
    problem, (centre, centres, scale) = arranged(frames, rest, alone)
    state = _search(problem, B, K, np.random.default_rng(seed), progress)
    done, converged = alternate(problem, state, iterations, tolerance, progress)
    _refuse_empty(state, B)
    R = state.motions[..., :3]
    shift = scale * state.motions[..., 3] + centres[:, None] - R @ centre
    weights = dense(state)
    rms = scale * float(np.sqrt(state.left.mean() / len(frames)))
    turn = from_matrix(R)
    return Decomposition(rest, read_only(weights), read_only(turn), read_only(shift), rms, done, converged)


def arranged(
    frames: FloatArray, rest: FloatArray, alone: float = 0.0
) -> tuple[Problem, tuple[FloatArray, FloatArray, float]]:
    """Put a clip about its centroids, in units of the diagonal of its rest.

    Parameters
    ----------
    frames : (T, n, 3) float
        Vertices in every frame.
    rest : (n, 3) float
        Vertices at rest.
    alone : float, default 0.0
        How much a bone must carry by itself what follows it.

    Returns
    -------
    problem : Problem
        The clip so placed.
    placement : (3,), (T, 3) and float
        Centroid at rest, in every frame, and the diagonal.

    Raises
    ------
    ValueError
        If the rest vertices are all at one place.
    """
    centre, centres = rest.mean(axis=0), frames.mean(axis=1)
    scale = float(np.linalg.norm(np.ptp(rest, axis=0)))
    if not scale > 0:
        raise ValueError("rest must span some space, got all vertices at one place")
    problem = Problem.of((rest - centre) / scale, (frames - centres[:, None]) / scale, alone)
    return problem, (centre, centres, scale)


def dense(state: State) -> FloatArray:
    """Weights as a matrix.

    Parameters
    ----------
    state : State
        B bones, at most K a vertex.

    Returns
    -------
    (n, B) ndarray
        Rows sum to 1.
    """
    weights = np.zeros((len(state.bones), state.n_bones))
    np.add.at(weights, (np.arange(len(weights))[:, None], state.bones), state.weights)
    return weights


def search_part(n: int, rng: np.random.Generator) -> IntArray:
    """Draw the vertices on which bones are sought.

    Parameters
    ----------
    n : int
        Number of vertices.
    rng : Generator
        Draws them.

    Returns
    -------
    (k,) ndarray of int
        At most 1500, ascending.
    """
    return np.sort(rng.choice(n, min(n, _SEARCH), replace=False))


def _counts(frames: FloatArray, bones: int, influences: int) -> tuple[int, int]:
    T, n = frames.shape[:2]
    if T == 0 or n < 3:
        raise ValueError(f"frames must hold at least one frame of three vertices, got {T} of {n}")
    if not 1 <= bones <= n // 3:
        raise ValueError(f"bones must be from 1 to {n // 3}, a third of the vertices, got {bones}")
    if influences < 1:
        raise ValueError(f"influences must be at least 1, got {influences}")
    return int(bones), int(min(influences, bones))


def _search(problem: Problem, B: int, K: int, rng: np.random.Generator, progress: Progress) -> State:
    """Find bones on a part of the vertices, then weights for all."""
    n = len(problem.rest)
    chosen = search_part(n, rng)
    part = problem.part(chosen)
    progress(0, 3, "searching bones")
    few = min(K, _FEW)
    state, explained = grow(part, B, few, rng, _EXACT)
    if explained:
        raise ValueError(_too_many(B, state.n_bones))
    progress(1, 3, "searching bones")
    alternate(part, state, 10, 1e-3)
    state = exchange(part, state, rng, max(2, B // 3))
    progress(2, 3, "searching bones")
    alternate(part, state, 10, 1e-3)
    whole = State(state.motions, np.zeros((n, K), np.int64), np.zeros((n, K)), np.zeros(n))
    whole.bones[chosen, :few], whole.weights[chosen, :few] = state.bones, state.weights
    weight_step(problem, whole)
    progress(3, 3, "searching bones")
    return whole


def _refuse_empty(state: State, B: int) -> None:
    held = np.bincount(state.bones.ravel(), state.weights.ravel(), minlength=B)
    if (held <= 0).any():
        raise ValueError(_too_many(B, int((held > 0).sum())))


def _too_many(B: int, enough: int) -> str:
    if enough < 2:
        return f"bones={B} is more than the clip has: it moves as one rigid body, there are no bones to find"
    return f"bones={B} is more than the clip has: {enough} rigid bones explain it; ask for bones={enough}"
