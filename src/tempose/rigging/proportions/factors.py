"""How much longer and thicker each bone becomes, as a person writes it."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tempose.clips import Skeleton

_KEYS = ("length", "thickness")
_SIDES = ("left_", "right_")


@dataclass(frozen=True)
class Factor:
    """Factors of one bone."""

    length: float = 1.0
    """Along the bone."""
    thickness: float = 1.0
    """Across it."""


def read_factors(skeleton: Skeleton, factors: Mapping[str, Any]) -> tuple[Factor, ...]:
    """Read the factors of all bones.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    factors : mapping of str to float or mapping
        Joint name to the factor of the length of the bone that starts there, or to ``{"length": a,
        "thickness": b}``. ``"thigh"`` stands for ``"left_thigh"`` and ``"right_thigh"`` where no joint has
        that very name.

    Returns
    -------
    tuple of J Factor
        1 where nothing is said.

    Raises
    ------
    ValueError
        If a joint or key is unknown, a factor is no positive number, or a joint is named twice.
    """
    read: dict[str, Factor] = {}
    for name, value in factors.items():
        for joint in _joints(skeleton, name):
            if joint in read:
                raise ValueError(f"factors names the joint {joint!r} twice, once as {name!r}")
            read[joint] = _factor(name, value)
    return tuple(read.get(name, Factor()) for name in skeleton.names)


def _joints(skeleton: Skeleton, name: str) -> list[str]:
    if name in skeleton.names:
        return [name]
    both = [side + name for side in _SIDES if side + name in skeleton.names]
    if both:
        return both
    close = difflib.get_close_matches(name, skeleton.names, n=5, cutoff=0.4) or skeleton.names
    raise ValueError(f"factors names a joint {name!r}; the skeleton has {', '.join(close)}")


def _factor(name: str, value: Any) -> Factor:
    if isinstance(value, Factor):
        value = {"length": value.length, "thickness": value.thickness}
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in _KEYS]
        if unknown:
            raise ValueError(
                f"factors[{name!r}] has an unknown key {unknown[0]!r}; known are length, thickness"
            )
        return Factor(**{key: _positive(name, number) for key, number in value.items()})
    return Factor(length=_positive(name, value))


def _positive(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        raise ValueError(f"factors[{name!r}] must be a positive number, got {value!r}")
    if not 0 < float(value) < float("inf"):
        raise ValueError(f"factors[{name!r}] must be a positive number, got {value}")
    return float(value)
