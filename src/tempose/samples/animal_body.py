"""Trunk, neck, head and tail of the built-in animal, in units of its height at the withers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.samples.parts import Part, Point, frame
from tempose.samples.solids import cone, ellipsoid, loft, swell
from tempose.typing import FloatArray

UP: FloatArray = np.array([0.0, 1.0, 0.0])

# place along the body, centre height, half width, depth upwards, depth downwards, exponent
_BARREL = np.array(
    [
        [-0.53, 0.820, 0.070, 0.062, 0.090, 2.0],
        [-0.47, 0.820, 0.118, 0.112, 0.130, 2.0],
        [-0.38, 0.820, 0.142, 0.146, 0.165, 2.1],
        [-0.28, 0.805, 0.148, 0.160, 0.195, 2.1],
        [-0.16, 0.770, 0.150, 0.180, 0.195, 2.1],
        [-0.02, 0.740, 0.160, 0.192, 0.200, 2.1],
        [0.12, 0.740, 0.156, 0.206, 0.200, 2.1],
        [0.24, 0.740, 0.136, 0.250, 0.192, 2.0],
        [0.34, 0.745, 0.122, 0.225, 0.180, 2.0],
        [0.42, 0.740, 0.108, 0.150, 0.145, 2.0],
        [0.48, 0.740, 0.080, 0.090, 0.100, 2.0],
    ]
)
# place from the withers to the poll, half width, depth to the crest, depth to the throat
_NECK = np.array(
    [
        [0.00, 0.110, 0.190, 0.215],
        [0.25, 0.088, 0.152, 0.175],
        [0.50, 0.068, 0.122, 0.132],
        [0.75, 0.056, 0.098, 0.100],
        [1.00, 0.050, 0.070, 0.080],
    ]
)
# place from the poll to the lips, half width, depth to the forehead, depth to the jaw
_HEAD = np.array(
    [
        [0.00, 0.052, 0.042, 0.060],
        [0.15, 0.070, 0.058, 0.108],
        [0.30, 0.073, 0.062, 0.112],
        [0.45, 0.058, 0.057, 0.080],
        [0.63, 0.043, 0.049, 0.055],
        [0.80, 0.040, 0.044, 0.047],
        [0.92, 0.045, 0.042, 0.050],
        [1.00, 0.038, 0.034, 0.043],
    ]
)
# brush strokes on the left side and in the middle: centre, reach, height
_MUSCLES = (
    ((0.055, 0.660, 0.470), (0.070, 0.090, 0.070), 0.016),
    ((0.130, 0.890, -0.285), (0.070, 0.070, 0.085), 0.005),
    ((0.150, 0.790, -0.215), (0.060, 0.110, 0.075), -0.012),
    ((0.105, 0.960, 0.250), (0.060, 0.070, 0.100), -0.012),
    ((0.080, 0.960, -0.330), (0.070, 0.060, 0.130), 0.008),
)
_GROOVES = (
    ((0.0, 0.660, 0.510), (0.024, 0.110, 0.060), -0.012),
    ((0.0, 0.975, -0.360), (0.024, 0.060, 0.160), -0.007),
    ((0.0, 0.935, -0.050), (0.030, 0.050, 0.200), -0.005),
)


def barrel() -> list[Part]:
    """Body from the buttocks to the breast.

    Returns
    -------
    list of Part
        Parts of the node ``trunk``.
    """
    z0, z1 = _BARREL[0, 0], _BARREL[-1, 0]
    rows = [((z - z0) / (z1 - z0), 0, y, w, w, t, b, n, 0) for z, y, w, t, b, n in _BARREL]
    body = loft("trunk", (0, 0, z0), (0, 0, z1), UP, rows, 0.03, caps=(0.03, 0.04))
    left = [swell("trunk", c, r, h) for c, r, h in _MUSCLES]
    return [
        body,
        *left,
        *(part.mirrored() for part in left),
        *(swell("trunk", c, r, h) for c, r, h in _GROOVES),
    ]


def neck(base: Point, poll: Point) -> list[Part]:
    """Neck with its mane.

    Parameters
    ----------
    base, poll : (3,) float
        Ends of its axis.

    Returns
    -------
    list of Part
        Parts of the node ``trunk``.
    """
    rows = [(s, 0, 0, w, w, c, t, 2.0, 0) for s, w, c, t in _NECK]
    places = np.linspace(0.0, 1.0, 33)
    crest = np.interp(places, _NECK[:, 0], _NECK[:, 2])
    # scalloped: nine locks of hair
    height = 0.030 + 0.016 * np.sin(np.pi * places) + 0.007 * np.abs(np.sin(9.0 * np.pi * places))
    mane = [(s, 0, c, 0.020, 0.020, h, 0.06, 2.0, 0) for s, c, h in zip(places, crest, height)]
    return [
        loft("trunk", base, poll, UP, rows, 0.10, caps=(0.05, 0.05)),
        loft("trunk", base, poll, UP, mane, 0.012, caps=(0.05, 0.03), detail=0.55, thickness=0.020),
    ]


def head(poll: FloatArray, lips: FloatArray) -> list[Part]:
    """Head with eyes, nostrils, mouth and ears.

    Parameters
    ----------
    poll, lips : (3,) float
        Ends of its axis.

    Returns
    -------
    list of Part
        Parts of the nodes ``head`` and ``left_ear``, ``right_ear``.
    """
    across, front, along = frame(lips - poll, UP)
    length = float(np.linalg.norm(lips - poll))

    def at(s: float, u: float, v: float) -> FloatArray:
        return poll + s * length * along - u * across * np.sign(across[0]) * -1.0 + v * front

    rows = [(s, 0, 0, w, w, f, j, 2.2, 0) for s, w, f, j in _HEAD]
    skull = loft("head", poll, lips, UP, rows, 0.02, caps=(0.03, 0.028), detail=0.6)
    left = [
        swell("head", at(0.24, 0.060, -0.060), (0.050, 0.060, 0.070), 0.008, along=along, up=front),
        swell("head", at(0.46, 0.055, 0.000), (0.030, 0.030, 0.110), -0.007, along=along, up=front),
        swell("head", at(0.300, 0.066, 0.038), (0.036, 0.028, 0.044), 0.005, along=along, up=front),
        ellipsoid(
            "head", at(0.315, 0.062, 0.026), (0.014, 0.013, 0.018), 0.006, along=along, up=front, detail=0.45
        ),
        swell("head", at(0.945, 0.036, 0.022), (0.026, 0.018, 0.022), 0.006, along=along, up=front),
        swell("head", at(0.955, 0.038, 0.020), (0.020, 0.009, 0.014), -0.009, along=along, up=front),
        swell("head", at(0.950, 0.036, -0.018), (0.040, 0.007, 0.060), -0.004, along=along, up=front),
    ]
    tilt = np.array([0.16, 1.0, 0.18])
    leaf = ellipsoid(
        "left_ear", (0.052, 1.245, 0.672), (0.024, 0.015, 0.062), 0.01, along=tilt, up=(0.5, 0, 1), detail=0.5
    )
    ear = [
        replace(leaf, thickness=0.017),
        swell("left_ear", (0.060, 1.250, 0.690), (0.016, 0.016, 0.050), -0.008, along=tilt, up=(0.5, 0, 1)),
    ]
    forelock = [cone("head", at(-0.03, 0, 0.045), at(0.25, 0, 0.062), (0.018, 0.010), 0.016, 0.5)]
    left += ear
    return [skull, *left, *(part.mirrored() for part in left), *forelock]


def tail(joints: FloatArray) -> list[Part]:
    """Tail: a dock that carries long hair.

    Parameters
    ----------
    joints : (5, 3) float
        Joints of the tail and its end.

    Returns
    -------
    list of Part
        Parts of the node ``tail``.
    """
    top, end = joints[1], joints[4]
    along = (end - top) / np.linalg.norm(end - top)
    centres = [float(np.dot(p - top - np.dot(p - top, along) * along, (0, 0, 1))) for p in joints[1:]]
    places = [float(np.dot(p - top, along) / np.linalg.norm(end - top)) for p in joints[1:]]
    widths = (0.036, 0.052, 0.056, 0.018)
    rows = [
        (s, 0, c, w, w, w * 0.9, w, 2.0, f)
        for s, c, w, f in zip(places, centres, widths, (0.0, 0.06, 0.10, 0.10))
    ]
    start = joints[0] + (0.0, -0.005, 0.060)
    return [
        cone("tail", start, joints[0], (0.036, 0.033), 0.03, 0.7),
        cone("tail", joints[0], joints[1], (0.033, 0.035), 0.03, 0.7),
        loft("tail", top, end, (0, 0, 1), rows, 0.03, caps=(0.03, 0.025), folds=(7, 0.3), detail=0.7),
    ]
