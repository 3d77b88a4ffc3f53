"""Motions whose detail follows a known law: what a learner can find in two frames, and what it cannot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.detail.evaluation import evaluate
from tempose.detail.training import Inputs, Learner, Training

FPS = 30.0
JOINTS = 6
OUTPUTS = 30


@dataclass(frozen=True)
class Motion:
    """Angles of a body."""

    angles: np.ndarray
    """(T, 6, 3) rotation vectors, radians."""
    swings: np.ndarray
    """(T, 2) what moves them."""

    @property
    def velocity(self) -> np.ndarray:
        """(T, 6, 3) change since the frame before."""
        change = np.diff(self.angles, axis=0, prepend=self.angles[:1])
        change[0] = change[1]
        return change


def smooth(rng: np.random.Generator, T: int, count: int, width: float) -> np.ndarray:
    """(T, count) smooth random curves of variance 1."""
    reach = int(3 * width)
    window = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    noise = rng.normal(size=(T + 2 * reach, count))
    curves = np.stack([np.convolve(column, window, "valid") for column in noise.T], axis=1)
    return (curves - curves.mean(axis=0)) / curves.std(axis=0)


def swinging(seed: int = 0, T: int = 300) -> Motion:
    """Two swings at 1 and 1.35 Hz drive 18 angles; speed and amplitude wander.

    Every pose is passed in both directions and at several speeds, so that a pose alone does not tell its
    velocity.
    """
    rng = np.random.default_rng(seed)
    pace = 1 + 0.35 * np.tanh(smooth(rng, T, 2, 20.0))
    size = 1 + 0.25 * np.tanh(smooth(rng, T, 2, 20.0))
    phase = np.cumsum(2 * np.pi * np.array([1.0, 1.35]) * pace / FPS, axis=0) + rng.uniform(0, 6, 2)
    swings = size * np.sin(phase)
    angles = 0.3 * swings @ rng.normal(size=(2, 3 * JOINTS))
    return Motion(angles.reshape(T, JOINTS, 3), swings)


def free(seed: int = 0, T: int = 200) -> Motion:
    """18 angles that have nothing to do with each other."""
    rng = np.random.default_rng(seed)
    curves = smooth(rng, T, 3 * JOINTS, 5.0)
    return Motion(0.3 * curves.reshape(T, JOINTS, 3), curves[:, :2])


def with_idle_joints(motion: Motion, seed: int = 1) -> Motion:
    """Six more joints that move and do not matter, as where arms are edited and a skirt is not."""
    T = len(motion.angles)
    more = 0.6 * smooth(np.random.default_rng(seed), T, 3 * JOINTS, 6.0).reshape(T, JOINTS, 3)
    return Motion(np.concatenate([motion.angles, more], axis=1), motion.swings)


def spread_out(driver: np.ndarray, seed: int = 2) -> np.ndarray:
    """(T, OUTPUTS) random mixtures of the columns of a driver, rms 1."""
    T = len(driver)
    D = driver.reshape(T, -1) @ np.random.default_rng(seed).normal(
        size=(driver.reshape(T, -1).shape[1], OUTPUTS)
    )
    return D / np.sqrt(np.mean(D**2))


def static(motion: Motion) -> np.ndarray:
    """A bent function of the pose."""
    return spread_out(np.tanh(1.5 * spread_out(motion.swings, 5)))


def drag(motion: Motion) -> np.ndarray:
    """Against the velocity."""
    return spread_out(-motion.velocity[:, :JOINTS])


def trailing(motion: Motion, tau: float) -> np.ndarray:
    """Behind the pose by a time constant of so many frames."""
    theta = motion.angles[:, :JOINTS].reshape(len(motion.angles), -1)
    behind = theta.copy()
    for t in range(1, len(theta)):
        behind[t] = theta[t] + (behind[t - 1] - theta[t]) * np.exp(-1.0 / tau)
    return spread_out(behind - theta)


def spring(motion: Motion, hertz: float, damping: float) -> np.ndarray:
    """A mass on a spring, shaken by the acceleration of the pose; 20 steps a frame."""
    theta = motion.angles[:, :JOINTS].reshape(len(motion.angles), -1)
    acceleration = np.gradient(np.gradient(theta, axis=0), axis=0) * FPS**2
    w, h = 2 * np.pi * hertz, 1 / (20 * FPS)
    u, speed, out = np.zeros(theta.shape[1]), np.zeros(theta.shape[1]), np.zeros_like(theta)
    for t, push in enumerate(acceleration):
        for _ in range(20):
            speed += h * (-(w**2) * u - 2 * damping * w * speed - push)
            u = u + h * speed
        out[t] = u
    return spread_out(out)


def bent_sheet(motion: Motion) -> np.ndarray:
    """``tanh(2 v) (1 + 0.7 p)`` of two swings p and their velocities v: little to see it in many angles."""
    p = motion.swings / motion.swings.std(axis=0)
    v = np.gradient(motion.swings, axis=0)
    v = v / v.std(axis=0)
    return spread_out(np.tanh(2 * v) * (1 + 0.7 * p))


def training_of(motion: Motion, D: np.ndarray, fps: float = FPS) -> Training:
    """Inputs and Gram matrix, one region."""
    T = len(D)
    chains = np.zeros(T, dtype=np.int64)
    inputs = Inputs(motion.angles, motion.velocity, np.zeros((T, 0)), chains, fps=fps)
    return Training(inputs, (D @ D.T)[None], np.array([float(D.shape[1])]))


def held_out_error(learner: Learner, motion: Motion, D: np.ndarray, fps: float = FPS) -> float:
    """Rms error on the last 30 %, over the rms of the detail there."""
    T = len(D)
    cut = int(0.7 * T)
    test = np.arange(cut, T)
    found = evaluate(learner, training_of(motion, D, fps), np.arange(cut), test)
    return found.rms / np.sqrt(3 * np.mean(D[test] ** 2))
