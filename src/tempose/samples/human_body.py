"""Trunk, arms, legs and skirt of the built-in human, as tables of cross-sections and muscles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from tempose.samples.parts import Part
from tempose.samples.solids import loft, swell
from tempose.typing import FloatArray

FRONT: FloatArray = np.array([0.0, 0.0, 1.0])

# height, centre z, half width, depth to the front, depth to the back, exponent; metres
_TORSO = np.array(
    [
        [0.840, -0.012, 0.105, 0.072, 0.085, 2.1],
        [0.885, -0.012, 0.150, 0.090, 0.100, 2.2],
        [0.935, -0.012, 0.164, 0.097, 0.103, 2.3],
        [0.990, -0.012, 0.160, 0.099, 0.096, 2.3],
        [1.050, -0.012, 0.147, 0.099, 0.085, 2.3],
        [1.120, -0.014, 0.134, 0.098, 0.078, 2.3],
        [1.190, -0.018, 0.137, 0.103, 0.083, 2.3],
        [1.260, -0.022, 0.149, 0.112, 0.094, 2.3],
        [1.330, -0.026, 0.161, 0.114, 0.103, 2.3],
        [1.390, -0.030, 0.163, 0.103, 0.104, 2.3],
        [1.430, -0.033, 0.146, 0.086, 0.094, 2.2],
        [1.455, -0.034, 0.129, 0.075, 0.085, 2.1],
        [1.478, -0.034, 0.103, 0.064, 0.075, 2.1],
        [1.500, -0.033, 0.078, 0.056, 0.067, 2.0],
        [1.525, -0.030, 0.061, 0.050, 0.059, 2.0],
        [1.560, -0.024, 0.055, 0.047, 0.054, 2.0],
        [1.610, -0.015, 0.054, 0.046, 0.052, 2.0],
    ]
)
# place from shoulder to wrist; radii outwards, inwards, to the front, to the back
_ARM = np.array(
    [
        [0.00, 0.040, 0.046, 0.048, 0.050],
        [0.10, 0.051, 0.048, 0.052, 0.053],
        [0.22, 0.048, 0.045, 0.048, 0.049],
        [0.35, 0.041, 0.041, 0.046, 0.045],
        [0.45, 0.037, 0.038, 0.040, 0.040],
        [0.54, 0.036, 0.036, 0.036, 0.037],
        [0.62, 0.041, 0.037, 0.038, 0.036],
        [0.72, 0.037, 0.034, 0.036, 0.033],
        [0.85, 0.028, 0.027, 0.030, 0.028],
        [0.94, 0.022, 0.022, 0.028, 0.027],
        [1.00, 0.020, 0.020, 0.028, 0.028],
    ]
)
# place from hip to ankle; radii outwards, inwards, to the front, to the back
_LEG = np.array(
    [
        [0.00, 0.068, 0.070, 0.080, 0.080],
        [0.10, 0.074, 0.070, 0.083, 0.082],
        [0.22, 0.072, 0.067, 0.080, 0.073],
        [0.34, 0.062, 0.060, 0.070, 0.064],
        [0.44, 0.051, 0.053, 0.058, 0.053],
        [0.505, 0.047, 0.048, 0.053, 0.047],
        [0.56, 0.045, 0.046, 0.047, 0.049],
        [0.64, 0.048, 0.050, 0.043, 0.062],
        [0.72, 0.045, 0.047, 0.041, 0.058],
        [0.82, 0.036, 0.036, 0.037, 0.041],
        [0.93, 0.027, 0.026, 0.029, 0.034],
        [1.00, 0.027, 0.027, 0.031, 0.034],
    ]
)
# brush strokes on the left side: centre, reach, height, direction of the third axis; metres
_MUSCLES = (
    ((0.084, 1.352, 0.080), (0.098, 0.072, 0.075), 0.012, (0.30, 0.10, 1.0)),
    ((0.040, 1.170, 0.085), (0.046, 0.130, 0.050), 0.004, (0.0, 0.0, 1.0)),
    ((0.088, 1.447, 0.030), (0.020, 0.020, 0.090), 0.006, (0.135, 0.020, -0.040)),
    ((0.070, 1.470, 0.026), (0.040, 0.026, 0.035), -0.003, (0.0, 0.0, 1.0)),
    ((0.031, 1.525, 0.010), (0.019, 0.022, 0.090), 0.006, (-0.038, -0.135, 0.055)),
    ((0.092, 1.355, -0.125), (0.062, 0.085, 0.050), 0.009, (0.0, 0.0, 1.0)),
    ((0.040, 1.150, -0.090), (0.042, 0.140, 0.050), 0.006, (0.0, 0.0, 1.0)),
    ((0.140, 1.300, -0.050), (0.050, 0.140, 0.070), 0.010, (0.0, 0.0, 1.0)),
    ((0.065, 1.482, -0.060), (0.060, 0.055, 0.045), 0.006, (0.0, 0.0, 1.0)),
)
_GROOVES = (
    ((0.0, 1.250, -0.115), (0.030, 0.260, 0.050), -0.010, (0.0, 0.0, 1.0)),
    ((0.0, 1.355, 0.080), (0.022, 0.080, 0.050), -0.006, (0.0, 0.0, 1.0)),
    ((0.0, 1.180, 0.085), (0.020, 0.120, 0.050), -0.005, (0.0, 0.0, 1.0)),
    ((0.0, 1.450, 0.036), (0.020, 0.018, 0.030), -0.008, (0.0, 0.0, 1.0)),
    ((0.0, 1.122, 0.085), (0.012, 0.012, 0.030), -0.006, (0.0, 0.0, 1.0)),
    ((0.0, 1.525, 0.022), (0.014, 0.024, 0.020), 0.005, (0.0, 0.0, 1.0)),
)
# height, centre z, half width, depth to the front, depth to the back, depth of folds
_SKIRT = np.array(
    [
        [1.075, -0.012, 0.1460, 0.103, 0.089, 0.000],
        [1.000, -0.012, 0.1690, 0.111, 0.112, 0.004],
        [0.930, -0.012, 0.1860, 0.118, 0.133, 0.008],
        [0.800, -0.012, 0.2000, 0.136, 0.147, 0.020],
        [0.680, -0.012, 0.2210, 0.156, 0.164, 0.035],
        [0.560, -0.012, 0.2450, 0.178, 0.182, 0.050],
    ]
)


def torso() -> list[Part]:
    """Trunk from the crotch to the root of the neck.

    Returns
    -------
    list of Part
        Parts of the node ``trunk``.
    """
    y0, y1 = _TORSO[0, 0], _TORSO[-1, 0]
    rows = [((y - y0) / (y1 - y0), 0, z, a, a, f, b, n, 0) for y, z, a, f, b, n in _TORSO]
    trunk = loft("trunk", (0, y0, 0), (0, y1, 0), FRONT, rows, 0.03, caps=(0.03, 0.02))
    left = [swell("trunk", c, r, h, along=d) for c, r, h, d in _MUSCLES]
    middle = [swell("trunk", c, r, h, along=d) for c, r, h, d in _GROOVES]
    return [trunk, *left, *(part.mirrored() for part in left), *middle]


def arm(shoulder: FloatArray, elbow: FloatArray, wrist: FloatArray) -> list[Part]:
    """Left arm without its hand.

    Parameters
    ----------
    shoulder, elbow, wrist : (3,) float
        Joints, metres.

    Returns
    -------
    list of Part
        Parts of the node ``left_arm``.
    """
    rows = _limb_rows(_ARM, shoulder, elbow, wrist, FRONT, 2.1)
    along = (wrist - shoulder) / np.linalg.norm(wrist - shoulder)
    outwards = np.cross(FRONT, along)
    return [
        loft("left_arm", shoulder, wrist, FRONT, rows, 0.02, caps=(0.045, 0.02), thickness=0.024),
        swell(
            "left_arm", shoulder + 0.065 * along + 0.030 * outwards, (0.06, 0.07, 0.085), 0.007, along=along
        ),
        swell(
            "left_arm", shoulder + 0.175 * along + 0.040 * FRONT, (0.045, 0.045, 0.085), 0.006, along=along
        ),
        swell(
            "left_arm", shoulder + 0.150 * along - 0.040 * FRONT, (0.045, 0.045, 0.100), 0.006, along=along
        ),
        swell("left_arm", elbow - 0.038 * FRONT, (0.025, 0.025, 0.030), 0.006, along=along),
        swell("left_arm", np.add(wrist, (0.004, 0.016, -0.020)), (0.018, 0.018, 0.018), 0.005),
    ]


def leg(hip: FloatArray, knee: FloatArray, ankle: FloatArray) -> list[Part]:
    """Left leg without its foot.

    Parameters
    ----------
    hip, knee, ankle : (3,) float
        Joints, metres.

    Returns
    -------
    list of Part
        Parts of the node ``left_leg``.
    """
    rows = _limb_rows(_LEG, hip, knee, ankle, FRONT, 2.1)
    return [
        loft("left_leg", hip, ankle, FRONT, rows, 0.03, caps=(0.06, 0.03), thickness=0.030),
        swell("left_leg", np.add(knee, (-0.003, 0.012, 0.050)), (0.036, 0.046, 0.040), 0.006),
        swell("left_leg", np.add(knee, (-0.003, -0.060, 0.042)), (0.024, 0.040, 0.030), 0.002),
        swell("left_leg", np.add(knee, (0.000, 0.000, -0.045)), (0.030, 0.045, 0.030), -0.005),
        swell("left_leg", np.add(knee, (0.022, -0.120, -0.045)), (0.035, 0.090, 0.050), 0.005),
        swell("left_leg", np.add(knee, (-0.022, -0.140, -0.045)), (0.035, 0.090, 0.050), 0.006),
        swell("left_leg", np.add(ankle, (0.028, -0.010, -0.004)), (0.020, 0.026, 0.022), 0.006),
        swell("left_leg", np.add(ankle, (-0.028, 0.006, 0.006)), (0.020, 0.026, 0.022), 0.006),
    ]


def skirt(filled: bool) -> list[Part]:
    """Knee-length skirt with a belt: thick cloth around a hollow from which the legs come.

    Parameters
    ----------
    filled : bool
        Leave the hollow away.

    Returns
    -------
    list of Part
        Parts of the node ``skirt``.
    """
    belt = [(s, 0, -0.012, 0.151, 0.151, 0.107, 0.094, 2.2, 0.0) for s in (0.0, 0.5, 1.0)]
    cloth = [
        _bell("skirt", 1.075, 0.560, 0.0, caps=(0.010, 0.012)),
        loft("skirt", (0, 1.085, 0), (0, 1.050, 0), FRONT, belt, 0.006, caps=(0.006, 0.006)),
    ]
    if filled:
        return cloth
    hem = replace(_bell("skirt", 0.582, 0.560, -0.001, caps=(0.004, 0.012)), blend=0.004, thickness=0.012)
    hollow = _bell("skirt", 0.860, 0.500, 0.018, caps=(0.020, 0.020))
    return [*cloth, hem, replace(hollow, carve=True, detail=2.0)]


def _bell(node: str, top: float, bottom: float, wall: float, caps: tuple[float, float]) -> Part:
    columns = CubicSpline(-_SKIRT[:, 0], _SKIRT[:, 1:])
    rows: list[tuple[float, ...]] = []
    for s in np.linspace(0.0, 1.0, 7):
        z, a, f, b, fold = columns(-(top + s * (bottom - top)))
        rows.append((s, 0, z, a - wall, a - wall, f - wall, b - wall, 2.1, fold))
    return loft(node, (0, top, 0), (0, bottom, 0), FRONT, rows, 0.01, caps=caps, folds=(16, 0.4))


def _limb_rows(
    table: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray, front: FloatArray, exponent: float
) -> list[tuple[float, ...]]:
    """Bend the axis of a straight sweep so that it passes through the middle joint."""
    along = (c - a) / np.linalg.norm(c - a)
    v = front - np.dot(front, along) * along
    v /= np.linalg.norm(v)
    u = np.cross(v, along)
    at = np.dot(b - a, along) / np.linalg.norm(c - a)
    off = b - a - np.dot(b - a, along) * along
    rows: list[tuple[float, ...]] = []
    for s, *radii in table:
        bend = s / at if s < at else (1.0 - s) / (1.0 - at)
        bend = bend * bend * (3.0 - 2.0 * bend)
        rows.append((s, bend * np.dot(off, u), bend * np.dot(off, v), *radii, exponent, 0.0))
    return rows
