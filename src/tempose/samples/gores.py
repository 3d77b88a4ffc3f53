"""The gores of a skirt: pendulums in a ring, tied to their neighbours, pushed by legs."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline

from tempose.samples.oscillators import oscillator_step
from tempose.typing import FloatArray

FREQUENCY = 1.2
"""Of a free gore, Hz."""

DAMPING = 0.28
"""Part of the critical damping: air and cloth."""

CLOTH = 0.35
"""Stiffness of the coupling to the neighbours, relative to that of a gore."""

CONTACT = 14.0
"""Frequency of the spring by which a leg pushes a gore, Hz."""

FLIGHT = 0.4
"""Radians from rest or from the leg below beyond which a flying gore is slowed by the air and its own hem."""

RATE = 720.0
"""Least number of steps a second."""


def swing_gores(force: FloatArray, fps: float, least: FloatArray | None) -> FloatArray:
    """Angles of coupled gores that start at rest.

    Parameters
    ----------
    force : (T, G) float
        Radians per second squared.
    fps : float
        Frames per second.
    least : (T, G) float or None
        Angles at which legs stand in the way, radians.

    Returns
    -------
    (T, G) ndarray
        Radians from the rest pose.

    Notes
    -----
    Free gores are stepped exactly. A leg is a stiff one-sided spring, critically damped, which pushes and
    never pulls: unlike a hard stop it gives the same answer at every frame rate.
    """
    T, G = force.shape
    substeps = max(int(np.ceil(RATE / fps)), 1)
    frames, fine = np.arange(T), np.arange((T - 1) * substeps + 1) / substeps
    free = oscillator_step(*_cloth(G), 1.0 / (fps * substeps))
    driving = make_interp_spline(frames, force, k=1)(fine)
    state, angles = np.zeros(2 * G), np.zeros((T, G))
    legs, speed = np.full_like(driving, -np.inf), np.zeros_like(driving)
    if least is not None:
        curve = make_interp_spline(frames, least, k=min(3, T - 1))
        legs, speed = curve(fine), curve(fine, 1) * fps
        state[:G] = angles[0] = np.maximum(0.0, least[0])
    for k in range(1, len(fine)):
        push = _push(state[:G] - legs[k - 1], state[G:] - speed[k - 1], CONTACT)
        high = np.maximum(legs[k - 1], 0.0) + FLIGHT
        push -= _push(high - state[:G], np.minimum(speed[k - 1], 0.0) - state[G:], 0.25 * CONTACT)
        state = free @ np.concatenate([state, driving[k - 1] + push, driving[k] + push])
        if k % substeps == 0:
            angles[k // substeps] = state[:G]
    return angles


def _cloth(G: int) -> tuple[FloatArray, FloatArray]:
    """Stiffness and damping of a ring of gores, each tied to its neighbours."""
    omega = 2.0 * np.pi * FREQUENCY
    ring = 2.0 * np.eye(G) - np.roll(np.eye(G), 1, axis=0) - np.roll(np.eye(G), -1, axis=0)
    ties = CLOTH * (G / (2.0 * np.pi)) ** 2 * ring
    return omega**2 * (np.eye(G) + ties), omega * (2.0 * DAMPING * np.eye(G) + 0.04 * ties)


def _push(gap: FloatArray, speed: FloatArray, frequency: float) -> FloatArray:
    """Acceleration by which gores are pushed back when their gap is negative."""
    omega = 2.0 * np.pi * frequency
    inside = np.maximum(-gap, 0.0)
    # the damper sets in over the first hundredth of a radian, so that contact begins without a blow
    damper = np.maximum(-2.0 * omega * speed, 0.0) * np.minimum(inside / 0.01, 1.0)
    return omega**2 * inside + damper
