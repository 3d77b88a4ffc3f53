"""Legs and hooves of the built-in animal, in units of its height at the withers."""

from __future__ import annotations

import numpy as np

from tempose.samples.parts import Part
from tempose.samples.solids import cone, ellipsoid, loft, swell
from tempose.typing import FloatArray

FRONT: FloatArray = np.array([0.0, 0.0, 1.0])

# height, centre x, centre z; radii outwards, inwards, to the front, to the back
_FORE = np.array(
    [
        [0.620, 0.112, 0.340, 0.050, 0.046, 0.078, 0.074],
        [0.550, 0.116, 0.338, 0.046, 0.040, 0.064, 0.064],
        [0.470, 0.117, 0.342, 0.039, 0.034, 0.047, 0.047],
        [0.390, 0.115, 0.347, 0.030, 0.027, 0.034, 0.034],
        [0.335, 0.113, 0.351, 0.028, 0.026, 0.032, 0.029],
        [0.305, 0.112, 0.352, 0.029, 0.027, 0.033, 0.029],
        [0.265, 0.111, 0.350, 0.023, 0.023, 0.026, 0.027],
        [0.215, 0.110, 0.348, 0.019, 0.019, 0.021, 0.025],
        [0.175, 0.110, 0.346, 0.020, 0.020, 0.022, 0.026],
        [0.140, 0.110, 0.346, 0.025, 0.025, 0.026, 0.030],
    ]
)
_HIND = np.array(
    [
        [0.800, 0.085, -0.392, 0.064, 0.060, 0.118, 0.122],
        [0.720, 0.095, -0.380, 0.060, 0.058, 0.115, 0.124],
        [0.640, 0.108, -0.366, 0.053, 0.052, 0.102, 0.110],
        [0.570, 0.116, -0.380, 0.045, 0.042, 0.082, 0.082],
        [0.500, 0.117, -0.414, 0.038, 0.034, 0.058, 0.058],
        [0.430, 0.114, -0.456, 0.031, 0.028, 0.043, 0.045],
        [0.385, 0.112, -0.481, 0.029, 0.028, 0.038, 0.040],
        [0.350, 0.112, -0.487, 0.029, 0.028, 0.036, 0.038],
        [0.305, 0.112, -0.483, 0.025, 0.025, 0.029, 0.031],
        [0.245, 0.112, -0.478, 0.020, 0.020, 0.023, 0.027],
        [0.190, 0.112, -0.472, 0.021, 0.021, 0.023, 0.027],
        [0.148, 0.112, -0.468, 0.026, 0.026, 0.027, 0.031],
    ]
)


def fore_leg() -> list[Part]:
    """Left fore leg with its shoulder blade.

    Returns
    -------
    list of Part
        Parts of the node ``left_fore``.
    """
    blade = np.array([0.045, -0.265, 0.155])
    return [
        _column("left_fore", _FORE),
        ellipsoid("left_fore", (0.098, 0.800, 0.362), (0.044, 0.075, 0.170), 0.04, along=blade, up=FRONT),
        ellipsoid("left_fore", (0.112, 0.645, 0.385), (0.038, 0.060, 0.100), 0.06, along=(0, 0.6, 1)),
        swell("left_fore", (0.140, 0.680, 0.320), (0.070, 0.110, 0.100), 0.007),
        swell("left_fore", (0.112, 0.306, 0.385), (0.030, 0.034, 0.030), 0.004),
        swell("left_fore", (0.112, 0.320, 0.322), (0.024, 0.028, 0.024), 0.006),
        *_hoof("left_fore", np.array([0.110, 0.145, 0.346]), 1.0),
    ]


def hind_leg() -> list[Part]:
    """Left hind leg with its thigh.

    Returns
    -------
    list of Part
        Parts of the node ``left_hind``.
    """
    return [
        _column("left_hind", _HIND),
        ellipsoid("left_hind", (0.098, 0.760, -0.400), (0.058, 0.130, 0.125), 0.05),
        cone("left_hind", (0.113, 0.585, -0.440), (0.112, 0.395, -0.515), (0.020, 0.0150), 0.035),
        cone("left_hind", (0.112, 0.395, -0.515), (0.112, 0.300, -0.500), (0.0150, 0.012), 0.025),
        swell("left_hind", (0.140, 0.620, -0.285), (0.045, 0.060, 0.045), 0.010),
        swell("left_hind", (0.150, 0.700, -0.480), (0.050, 0.150, 0.050), 0.008),
        *_hoof("left_hind", np.array([0.112, 0.150, -0.468]), 0.96),
    ]


def _column(node: str, table: FloatArray) -> Part:
    y0, y1 = table[0, 0], table[-1, 0]
    rows = [((y - y0) / (y1 - y0), x, z, *radii, 2.1, 0) for y, x, z, *radii in table]
    return loft(
        node, (0, y0, 0), (0, y1, 0), FRONT, rows, 0.03, caps=(0.05, 0.02), detail=0.7, thickness=0.020
    )


def _hoof(node: str, fetlock: FloatArray, size: float) -> list[Part]:
    """Pastern, sloping forwards, and a hoof with a flat sole at height 0."""
    x, y, z = fetlock
    coronet = np.array([x, 0.070, z + 0.050 * size])
    wall = [
        (0.0, x, z + 0.052 * size, 0.031, 0.031, 0.030, 0.030, 2.1, 0),
        (0.5, x, z + 0.062 * size, 0.037, 0.037, 0.040, 0.038, 2.2, 0),
        (1.0, x, z + 0.070 * size, 0.042, 0.042, 0.052, 0.044, 2.3, 0),
    ]
    return [
        cone(node, np.add(fetlock, (0, -0.006, 0)), coronet, (0.025, 0.024), 0.012, 0.6),
        loft(
            node,
            (0, 0.066, 0),
            (0, 0.006, 0),
            FRONT,
            wall,
            0.007,
            caps=(0.010, 0.006),
            detail=0.55,
            thickness=0.024,
        ),
        swell(node, (x, y - 0.010, z - 0.030), (0.024, 0.024, 0.020), 0.007),
    ]
