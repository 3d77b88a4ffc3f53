"""Does a bone point where the source's bone points: the one test of pose that distortion does not see."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tempose._validate import as_floats, as_indices
from tempose.typing import FloatArray


@dataclass(frozen=True)
class DirectionError:
    """Angles between source and target bones over a clip."""

    mean: float
    """Mean over frames and bones, degrees."""
    max: float
    """Worst bone of the worst frame, degrees."""


def direction_angles(source: FloatArray, target: FloatArray) -> FloatArray:
    """Angle between the directions of corresponding bones.

    Parameters
    ----------
    source, target : (T, B, 3) float
        Direction of each bone, of any length but zero.

    Returns
    -------
    (T, B) ndarray
        Degrees, 0 to 180.

    Raises
    ------
    ValueError
        If shapes differ, a value is not finite, or a bone has no length.
    """
    a = _unit(as_floats(source, "source", ("T", "B", 3)), "source")
    b = _unit(as_floats(target, "target", a.shape), "target")
    # arctan2 of both chords stays exact where arccos of the dot product loses half the digits
    half = np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return np.degrees(2 * half)


def _unit(x: FloatArray, name: str) -> FloatArray:
    length = np.linalg.norm(x, axis=-1, keepdims=True)
    if x.size and length.min() <= 0:
        t, b, _ = (int(i) for i in np.argwhere(length <= 0)[0])
        raise ValueError(f"{name} must hold directions, got a zero vector in frame {t}, bone {b}")
    return x / length


def limb_direction_errors(
    angles: FloatArray, limbs: Mapping[str, Sequence[int]]
) -> dict[str, DirectionError]:
    """Collect the angles of bones into limbs.

    Parameters
    ----------
    angles : (T, B) float
        Degrees, from `direction_angles`; at least one frame.
    limbs : mapping of str to sequence of int
        Name of a limb to the indices of its bones, at least one each.

    Returns
    -------
    dict
        Name to `DirectionError`, in the order of `limbs`.

    Raises
    ------
    ValueError
        If there is no frame, or a limb has no bone or one that does not exist.
    """
    angles = as_floats(angles, "angles", ("T", "B"))
    if len(angles) == 0:
        raise ValueError("angles must hold at least one frame, got none")
    errors: dict[str, DirectionError] = {}
    for name, bones in limbs.items():
        index = as_indices(list(bones), f"limbs[{name!r}]", ("k",), limit=angles.shape[1])
        if len(index) == 0:
            raise ValueError(f"limbs[{name!r}] must name at least one bone, got none")
        part = angles[:, index]
        errors[name] = DirectionError(mean=float(part.mean()), max=float(part.max()))
    return errors
