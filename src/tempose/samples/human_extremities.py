"""Head, hands and feet of the built-in human."""

from __future__ import annotations

import numpy as np

from tempose.samples.parts import Part, frame
from tempose.samples.solids import cone, ellipsoid, loft, swell
from tempose.typing import FloatArray

FINE = 0.45
"""Relative edge length in the face."""

# face from chin to forehead: height, half width, depth to the front, depth to the back
_FACE = np.array(
    [
        [1.530, 0.024, 0.064, 0.010],
        [1.550, 0.040, 0.081, 0.026],
        [1.575, 0.051, 0.085, 0.050],
        [1.600, 0.058, 0.086, 0.070],
        [1.625, 0.061, 0.083, 0.078],
        [1.650, 0.060, 0.075, 0.074],
        [1.680, 0.050, 0.058, 0.060],
    ]
)
# brush strokes on the left half and in the middle: centre, reach, height; metres
_LEFT_FACE = (
    ((0.031, 1.650, 0.080), (0.027, 0.021, 0.030), -0.010),
    ((0.027, 1.672, 0.080), (0.036, 0.013, 0.030), 0.005),
    ((0.046, 1.623, 0.062), (0.028, 0.022, 0.030), 0.006),
    ((0.048, 1.590, 0.060), (0.026, 0.026, 0.030), -0.004),
    ((0.074, 1.665, 0.045), (0.035, 0.035, 0.035), -0.004),
    ((0.054, 1.570, 0.020), (0.030, 0.025, 0.030), 0.003),
)
_MIDDLE_FACE = (
    ((0.0, 1.5960, 0.088), (0.036, 0.0100, 0.030), 0.005),
    ((0.0, 1.5825, 0.088), (0.032, 0.0105, 0.030), 0.006),
    ((0.0, 1.5895, 0.092), (0.036, 0.0040, 0.030), -0.0025),
    ((0.0, 1.5480, 0.080), (0.026, 0.0190, 0.030), 0.007),
    ((0.0, 1.5690, 0.090), (0.030, 0.0100, 0.030), -0.004),
)
# place along the hand, towards the thumb, length, splay, radius at the knuckle, radius at the tip; metres
_FINGERS = {
    "index": (0.087, 0.0305, 0.074, 0.21, 0.0084, 0.0069),
    "middle": (0.092, 0.0100, 0.081, 0.05, 0.0086, 0.0071),
    "ring": (0.088, -0.0105, 0.075, -0.12, 0.0083, 0.0068),
    "little": (0.078, -0.0300, 0.060, -0.33, 0.0076, 0.0063),
}
# towards the little toe, where it starts and ends along the foot, radius
_TOES = (
    (-0.0260, 0.150, 0.196, 0.0145),
    (-0.0020, 0.150, 0.196, 0.0108),
    (0.0150, 0.146, 0.189, 0.0102),
    (0.0300, 0.138, 0.178, 0.0098),
    (0.0425, 0.126, 0.163, 0.0096),
)


def head(top: FloatArray) -> list[Part]:
    """Skull, face and ears.

    Parameters
    ----------
    top : (3,) float
        Crown of the head, metres.

    Returns
    -------
    list of Part
        Parts of the node ``head``.
    """
    x, y, z = top[0], top[1] - 1.75, top[2] + 0.004

    def at(*p: float) -> tuple[float, float, float]:
        return (p[0] + x, p[1] + y, p[2] + z)

    rows = [((h - 1.530) / 0.150, 0, 0, a, a, f, b, 2.15, 0) for h, a, f, b in _FACE]
    face = loft(
        "head", at(0, 1.530, 0), at(0, 1.680, 0), (0, 0, 1), rows, 0.03, caps=(0.010, 0.020), detail=FINE
    )
    skull = ellipsoid("head", at(0, 1.662, -0.012), (0.0755, 0.0880, 0.0970), 0.01, detail=0.7)
    left = [swell("head", at(*c), r, h) for c, r, h in _LEFT_FACE]
    left += [
        ellipsoid("head", at(0.030, 1.648, 0.068), (0.0135, 0.0095, 0.0120), 0.006, detail=FINE),
        ellipsoid(
            "head",
            at(0.074, 1.638, -0.016),
            (0.008, 0.031, 0.018),
            0.006,
            along=(-0.35, 0, 1),
            up=(0.2, 1, -0.25),
            detail=FINE,
        ),
        swell("head", at(0.083, 1.641, -0.008), (0.020, 0.022, 0.012), -0.006),
    ]
    nose = [
        cone("head", at(0, 1.660, 0.079), at(0, 1.624, 0.100), (0.006, 0.0090), 0.014, FINE),
        ellipsoid("head", at(0, 1.618, 0.090), (0.0145, 0.0075, 0.0110), 0.010, detail=FINE),
    ]
    middle = [swell("head", at(*c), r, h) for c, r, h in _MIDDLE_FACE]
    return [skull, face, *left, *(part.mirrored() for part in left), *nose, *middle]


def hand(wrist: FloatArray, tip: FloatArray, mitten: bool) -> list[Part]:
    """Left hand: palm in ``left_hand``, each finger in a node of its own.

    Parameters
    ----------
    wrist, tip : (3,) float
        Joint, and end of the middle finger, metres.
    mitten : bool
        One solid for four fingers.

    Returns
    -------
    list of Part
        Parts of ``left_hand`` and of ``left_thumb`` to ``left_little``.
    """
    size = float(np.linalg.norm(tip - wrist)) / 0.1855
    back, thumbwards, along = frame(tip - wrist, (0.0, 0.0, 1.0))

    def at(t: float, v: float, u: float) -> FloatArray:
        return wrist + size * (t * along + v * thumbwards + u * back)

    palm = [
        (0.00, 0, 0.000, 0.018, 0.018, 0.026, 0.026, 2.3, 0),
        (0.35, -0.001, 0.002, 0.016, 0.018, 0.035, 0.033, 2.4, 0),
        (0.70, -0.001, 0.001, 0.014, 0.016, 0.039, 0.037, 2.5, 0),
        (1.00, 0, 0.001, 0.012, 0.013, 0.038, 0.036, 2.5, 0),
    ]
    parts = [
        loft(
            "left_hand", at(0, 0, 0), at(0.080, 0, 0), thumbwards, palm, 0.01, caps=(0.02, 0.012), detail=0.5
        ),
        cone("left_hand", at(0.020, 0.016, -0.010), at(0.048, 0.036, -0.012), (0.016, 0.013), 0.015, 0.45),
    ]
    parts += _chain(
        "left_thumb",
        [
            at(0.040, 0.030, -0.010),
            at(0.066, 0.052, -0.014),
            at(0.090, 0.064, -0.019),
            at(0.110, 0.069, -0.026),
        ],
        [0.0125, 0.0112, 0.0100, 0.0082],
    )
    if mitten:
        fingers = [
            (0.0, 0, 0.000, 0.012, 0.013, 0.038, 0.036, 2.5, 0),
            (0.5, 0, -0.006, 0.010, 0.011, 0.035, 0.035, 2.5, 0),
            (1.0, 0, -0.020, 0.008, 0.008, 0.024, 0.030, 2.3, 0),
        ]
        rows = [(s, c, b, *r) for s, b, c, *r in fingers]
        a, b = at(0.075, 0, 0), at(0.165, 0, 0)
        return [
            *parts,
            loft("left_hand", a, b, thumbwards, rows, 0.01, caps=(0.01, 0.012), detail=0.5, thickness=0.014),
        ]
    for name, (t, v, length, splay, r0, r1) in _FINGERS.items():
        points, angle = [at(t, v, 0.0)], 0.10
        here = np.array([t, v, 0.0])
        for phalanx, bend in zip((0.46, 0.30, 0.24), (0.14, 0.20, 0.16)):
            step = np.array([np.cos(angle), splay * np.cos(angle), -np.sin(angle)])
            here = here + length * phalanx * step
            points.append(at(*here))
            angle += bend
        parts += _chain(f"left_{name}", points, [r0, 0.45 * r0 + 0.55 * r1, 0.2 * r0 + 0.8 * r1, r1])
    return parts


def foot(ankle: FloatArray, toes: FloatArray, shoe: bool) -> list[Part]:
    """Left foot with its sole on the ground.

    Parameters
    ----------
    ankle, toes : (3,) float
        Joints, metres; the ground is at height 0.
    shoe : bool
        One solid for all toes.

    Returns
    -------
    list of Part
        Parts of the node ``left_foot``.
    """
    forward = (toes - ankle) * (1.0, 0.0, 1.0)
    side, up, forward = frame(forward, (0.0, 1.0, 0.0))
    ground = ankle * (1.0, 0.0, 1.0)

    def at(s: float, lateral: float, y: float) -> FloatArray:
        return ground + s * forward + lateral * side + y * up

    sole = [
        (-0.028, 0.000, 0.031, 0.027, 0.027, 0.038, 0.031),
        (0.000, 0.000, 0.030, 0.028, 0.029, 0.046, 0.030),
        (0.040, 0.002, 0.030, 0.033, 0.034, 0.045, 0.024),
        (0.080, 0.004, 0.030, 0.038, 0.038, 0.031, 0.025),
        (0.115, 0.005, 0.028, 0.043, 0.043, 0.017, 0.028),
        (0.145, 0.004, 0.022, 0.040, 0.043, 0.009, 0.022),
    ]
    rows = [((s + 0.028) / 0.173, c, h, a, b, f, g, 2.6, 0) for s, c, h, a, b, f, g in sole]
    parts = [
        loft("left_foot", at(-0.028, 0, 0), at(0.145, 0, 0), up, rows, 0.02, caps=(0.027, 0.035), detail=0.6)
    ]
    if shoe:
        a, b = at(0.14, -0.016, 0.018), at(0.186, -0.016, 0.015)
        parts.append(cone("left_foot", a, b, (0.018, 0.015), 0.012, 0.6))
        a, b = at(0.13, 0.022, 0.016), at(0.168, 0.020, 0.014)
        return [*parts, cone("left_foot", a, b, (0.018, 0.014), 0.012, 0.6)]
    for lateral, start, end, r in _TOES:
        a, b = at(start - 0.012, lateral * 0.92, r + 0.004), at(end, lateral, r * 0.92)
        parts.append(cone("left_foot", a, b, (r * 1.05, r * 0.92), 0.006, 0.42))
    return parts


def _chain(node: str, points: list[FloatArray], radii: list[float]) -> list[Part]:
    return [
        cone(node, points[i], points[i + 1], (radii[i], radii[i + 1]), 0.002, 0.28)
        for i in range(len(points) - 1)
    ]
