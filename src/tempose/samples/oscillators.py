"""Damped oscillators driven by a known force, stepped exactly."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

from tempose.typing import FloatArray


def oscillator_step(stiffness: FloatArray, damping: FloatArray, step: float) -> FloatArray:
    """Matrix that carries coupled oscillators over one step without error.

    Parameters
    ----------
    stiffness, damping : (d, d) float
        ``K`` and ``C`` of ``u'' + C u' + K u = f(t)``, 1/s^2 and 1/s.
    step : float
        Seconds.

    Returns
    -------
    (2 d, 4 d) ndarray
        Takes ``[u, u', f, f_next]`` to ``[u, u']`` one step later, with ``f`` linear in between.

    References
    ----------
    .. [1] Van Loan, "Computing Integrals Involving the Matrix Exponential", IEEE Transactions on Automatic
       Control 23, 1978.
    """
    d = len(stiffness)
    system = np.zeros((4 * d, 4 * d))
    system[:d, d : 2 * d] = np.eye(d)
    system[d : 2 * d, : 2 * d] = np.hstack([-stiffness, -damping])
    system[d : 2 * d, 2 * d : 3 * d] = np.eye(d)
    # the force grows by its slope, kept here as the change over one step
    system[2 * d : 3 * d, 3 * d :] = np.eye(d) / step
    whole = expm(step * system)[: 2 * d]
    state, level, change = whole[:, : 2 * d], whole[:, 2 * d : 3 * d], whole[:, 3 * d :]
    return np.hstack([state, level - change, change])


def oscillate(force: FloatArray, frequency: float, damping: float, fps: float) -> FloatArray:
    """Response of independent oscillators that start at rest.

    Parameters
    ----------
    force : (T, ...) float
        Acceleration that drives each, linear between frames, metres per second squared.
    frequency : float
        Of the undamped oscillator, Hz.
    damping : float
        Part of the critical damping.
    fps : float
        Frames per second.

    Returns
    -------
    (T, ...) ndarray
        Displacement, metres; exact for this force at any frame rate.
    """
    omega = 2.0 * np.pi * frequency
    step = oscillator_step(np.array([[omega**2]]), np.array([[2.0 * damping * omega]]), 1.0 / fps)
    f = force.reshape(len(force), -1)
    states = np.zeros((len(f), 2, f.shape[1]))
    for t in range(1, len(f)):
        states[t] = step[:, :2] @ states[t - 1] + step[:, 2:3] * f[t - 1] + step[:, 3:] * f[t]
    return states[:, 0].reshape(force.shape)


def acceleration(x: FloatArray, fps: float) -> FloatArray:
    """Second derivative of the cubic spline through equidistant samples.

    Parameters
    ----------
    x : (T, ...) float
        Samples.
    fps : float
        Frames per second.

    Returns
    -------
    (T, ...) ndarray
        Per second squared; linear between the frames, as `oscillate` takes it. Zero for fewer than four
        frames.
    """
    if len(x) < 4:
        return np.zeros_like(x)
    return CubicSpline(np.arange(len(x)) / fps, x, axis=0)(np.arange(len(x)) / fps, 2)
