"""How human a body is in all, and why an embedding is doubted."""

from __future__ import annotations

import numpy as np

from tempose.embedding.limbs import Limbs
from tempose.embedding.search import Ends
from tempose.typing import FloatArray

_CROTCH, _CROTCH_SPREAD = 0.515, 0.035
_PIT, _PIT_SPREAD = 0.265, 0.045
DOUBTFUL = 1.45
"""Root mean square of the penalty terms, in standard deviations, from which a body is no longer human."""
_PITS_ALIKE = 0.025
_CLEAR, _RATIO = 0.15, 1.45
_TURNED = np.cos(np.radians(50.0))
_SKIRT, _ELSE_HUMAN, _OPEN = 2.0, 0.75, 3.0
"""What legs joined by a skirt cost, in standard deviations; how human the rest must be for that reading, and
how far out the legs."""


def whole_penalty(ends: Ends, limbs: Limbs) -> tuple[float, dict[str, float]]:
    """Penalty of ends and limbs together.

    Parameters
    ----------
    ends : Ends
        Head, hands and feet.
    limbs : Limbs
        The parts of the body.

    Returns
    -------
    penalty : float
        1 where doubt begins.
    terms : dict of str to float
        Each term, in standard deviations of the human body.
    """
    terms = dict(ends.terms)
    terms["crotch"] = (limbs.legs[0].start / ends.size - _CROTCH) / _CROTCH_SPREAD
    terms["armpits"] = (limbs.pit / ends.size - _PIT) / _PIT_SPREAD
    counted = dict(terms)
    if skirted(terms):
        counted |= {"feet": -_SKIRT, "crotch": _SKIRT}
    square = float(np.mean(np.square(list(counted.values()))))
    # of most bodies 0, so it may add but must not dilute
    terms["armpits alike"] = (limbs.arms[0].start - limbs.arms[1].start) / ends.size / _PITS_ALIKE
    square += terms["armpits alike"] ** 2 / len(terms)
    return float(np.sqrt(square)) / DOUBTFUL, terms


def skirted(terms: dict[str, float]) -> bool:
    """Tell whether a skirt or a long coat joins the legs of a body that is human otherwise.

    Parameters
    ----------
    terms : dict of str to float
        From `whole_penalty`.

    Returns
    -------
    bool
        Whether the legs part far too low and the feet are too near each other, while everything else is as
        usual. Four-legged animals, too, part low, but are unlike a human elsewhere.
    """
    legs = ("feet", "crotch")
    rest = [value for name, value in terms.items() if name not in legs]
    return terms["feet"] < -_OPEN and terms["crotch"] > _OPEN and _rms(rest) < _ELSE_HUMAN


def _rms(values: list[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def doubts(
    penalty: float, terms: dict[str, float], clearness: float, ratios: dict[str, float]
) -> tuple[str, ...]:
    """Say why an embedding is doubted.

    Parameters
    ----------
    penalty : float
        From `whole_penalty`.
    terms : dict of str to float
        Its terms.
    clearness : float
        How sure the front is.
    ratios : dict of str to float
        Longer to shorter bone of both sides, for each kind.

    Returns
    -------
    tuple of str
        Empty when there is no doubt.
    """
    reasons: list[str] = []
    if penalty > 1.0:
        worst = sorted(terms, key=lambda name: -abs(terms[name]))[:3]
        listed = ", ".join(f"{name} {terms[name]:+.1f}" for name in worst)
        reasons.append(
            f"the body is not shaped like a human's: penalty {penalty:.2f}, doubtful above 1; "
            f"furthest from usual, in standard deviations: {listed}"
        )
    if clearness < _CLEAR:
        reasons.append(
            f"front and back are hard to tell: clearness {clearness:.2f}, doubtful below {_CLEAR}; "
            "left and right may be exchanged"
        )
    reasons += [
        f"left and right {name} differ: {ratio:.2f} times as long, doubtful above {_RATIO}"
        for name, ratio in ratios.items()
        if ratio > _RATIO
    ]
    return tuple(reasons)


def upside(spine: FloatArray, up: FloatArray | None) -> tuple[str, ...]:
    """Say whether a body lies or stands on its head.

    Parameters
    ----------
    spine : (3,) float
        Unit vector from the hips to the neck.
    up : (3,) float or None
        Axis that ought to point up; None for any.

    Returns
    -------
    tuple of str
        Empty, or one reason to doubt.
    """
    if up is None:
        return ()
    upright = float(spine @ up)
    if upright < -_TURNED:
        return ("the body stands on its head: its spine points down",)
    if upright < _TURNED:
        angle = np.degrees(np.arccos(np.clip(upright, -1, 1)))
        return (f"the body lies or leans: its spine is {angle:.0f} degrees from upright",)
    return ()
