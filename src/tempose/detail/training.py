"""What every learner is given: inputs a frame, and inner products of residuals; never the vertices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Inputs:
    """What a learner sees of a motion."""

    angles: FloatArray
    """(T, K, 3) rotation vectors of the K joints below the root, unwrapped over time."""
    velocity: FloatArray
    """(T, K, 3) their change since the frame before, in the frame time of the training."""
    extra: FloatArray
    """(T, E) further inputs, such as gravity and velocity in the basis of the root; E may be 0."""
    chains: IntArray
    """(T,) which clip every frame is from; frames of one clip follow one another."""
    joints: tuple[str, ...] = ()
    """K names."""
    fps: float = 30.0
    """Rate of the training: how long the frame is in which velocities and memories are counted."""

    def __len__(self) -> int:
        return len(self.angles)

    def take(self, frames: IntArray) -> Inputs:
        """Return some frames; runs that do not follow one another become chains of their own.

        Parameters
        ----------
        frames : (k,) int
            Sorted indices.

        Returns
        -------
        Inputs
            Those frames.
        """
        frames = np.asarray(frames)
        breaks = np.diff(frames) != 1
        breaks |= np.diff(self.chains[frames]) != 0
        chains = np.concatenate([[0], np.cumsum(breaks)])[: len(frames)]
        return replace(
            self,
            angles=self.angles[frames],
            velocity=self.velocity[frames],
            extra=self.extra[frames],
            chains=chains,
        )


@dataclass(frozen=True, eq=False)
class Training:
    """T frames to learn from."""

    inputs: Inputs
    """T frames."""
    grams: FloatArray
    """(R, T, T) inner products of the raw (not centred) residuals, shared out over R soft regions; they sum
    to the Gram matrix of the whole mesh. Metres squared."""
    sizes: FloatArray
    """(R,) coordinates (3 a vertex, by its shares) that each region holds; they sum to 3 n."""

    @property
    def gram(self) -> FloatArray:
        """(T, T) inner products over the whole mesh."""
        return self.grams.sum(axis=0)

    @property
    def centred_gram(self) -> FloatArray:
        """(T, T) the same of the residuals less their mean over the frames."""
        return centred(self.gram)

    def take(self, frames: IntArray) -> Training:
        """Return the training restricted to some frames.

        Parameters
        ----------
        frames : (k,) int
            Sorted indices.

        Returns
        -------
        Training
            Those frames.
        """
        frames = np.asarray(frames)
        return replace(self, inputs=self.inputs.take(frames), grams=self.grams[:, frames[:, None], frames])


def centred(gram: FloatArray) -> FloatArray:
    """Take the mean over the frames off what inner products were taken of.

    Parameters
    ----------
    gram : (T, T) float
        Inner products of T frames.

    Returns
    -------
    (T, T) ndarray
        Inner products of the frames less their mean.
    """
    rows = gram - gram.mean(axis=0)
    return rows - rows.mean(axis=1, keepdims=True)


@dataclass(frozen=True, eq=False)
class Mixture:
    """A prediction: the mean residual of the training plus a mixture of its centred residuals."""

    weights: FloatArray
    """(R or 1, Q, T): residual of query q in region r = mean + sum_t weights[r, q, t] (d_t - mean)."""
    variance: FloatArray
    """(Q, R or 1) predicted variance of one coordinate, metres squared."""


class Predictor(Protocol):
    """A fitted learner."""

    def mix(self, inputs: Inputs) -> Mixture:
        """Predict the residuals of some frames.

        Parameters
        ----------
        inputs : Inputs
            Q frames.

        Returns
        -------
        Mixture
            Weights of the training frames, variances.
        """
        ...


class Learner(Protocol):
    """Hyperparameters of a way to learn residuals."""

    @property
    def name(self) -> str:
        """Name in tables and options."""
        ...

    def fit(self, training: Training) -> Predictor:
        """Learn from T frames.

        Parameters
        ----------
        training : Training
            Inputs and Gram matrices.

        Returns
        -------
        Predictor
            What predicts.
        """
        ...
