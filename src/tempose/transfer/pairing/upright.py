"""A target that lies, or stands along another axis than Y, is stood up before it is moved."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import Mesh
from tempose.formats.conventions import UNITS, guess_unit, to_inside
from tempose.rotations import shortest_rotation, to_matrix
from tempose.transfer.bodies.facing import UP
from tempose.transfer.pairing.pairs import Pairs
from tempose.typing import FloatArray

MOST_LEAN = np.radians(60.0)
"""A body that leans by more does not stand."""
_NEAR_AXIS = np.radians(30.0)
_HIGH = (("head",), ("neck",), ("left_upper_arm", "right_upper_arm"), ("chest",))
_HIPS = (("left_thigh", "right_thigh"), ("hips",))
_LOW = (("left_foot", "right_foot"), ("left_shin", "right_shin"))


@dataclass(frozen=True)
class Upright:
    """A target that stands along Y."""

    mesh: Mesh
    """The target, turned if it had to be."""
    turn: FloatArray
    """(3, 3) from the given target to `mesh`: a rotation, times a scale where the unit was a guess."""
    note: str = ""
    """What was done, for the report; empty where nothing was."""


def stand_up(mesh: Mesh, pairs: Pairs, roles: dict[str, str]) -> Upright:
    """Turn a target so that its body points along Y, if it does not by far.

    Parameters
    ----------
    mesh : Mesh
        Target at rest.
    pairs : Pairs
        Of kind ``"joints"``; they tell where head and hips are.
    roles : dict of str to str
        Joint of the source to body role.

    Returns
    -------
    Upright
        The axis of the target nearest to its body becomes Y. If the up axis was a guess it is noted as the
        file's, so that the result is written in the file's own axes, and a guessed unit is guessed again
        from the true height.
    """
    body = _upwards(mesh, pairs, roles)
    identity = np.eye(3)
    if body is None or _angle(body, UP) < MOST_LEAN:
        return Upright(mesh, identity)
    axis = np.zeros(3)
    axis[np.abs(body).argmax()] = np.sign(body[np.abs(body).argmax()])
    name = "xyz"[int(np.abs(axis).argmax())]
    along = f"{'-' if axis.sum() < 0 else ''}{name.upper()}"
    if "up" in mesh.source.guessed and axis.sum() > 0:
        turn = to_inside(identity, name, 1.0).T
        found = _again(mesh, turn, name)
        return Upright(*found, f"the target stands along {along}: its file was taken to have {along} up")
    direction = axis if _angle(body, axis) < _NEAR_AXIS else body
    turn = to_matrix(shortest_rotation(direction, UP))
    what = "is upside down" if _angle(body, -UP) < MOST_LEAN else "lies"
    note = f"the target {what}, its head along {along}: it was stood up, and the result stands"
    return Upright(mesh.with_vertices(mesh.vertices @ turn.T), turn, note)


def turned_pairs(pairs: Pairs, turn: FloatArray) -> Pairs:
    """Take the places that pairs name along with the target.

    Parameters
    ----------
    pairs : Pairs
        Pairs for the given target.
    turn : (3, 3) float
        From `stand_up`.

    Returns
    -------
    Pairs
        The same pairs for the target that stands.
    """
    moved = [{name: turn @ p for name, p in places.items()} for places in (pairs.joints, pairs.ends)]
    return replace(pairs, joints=moved[0], ends=moved[1])


def _again(mesh: Mesh, turn: FloatArray, up: str) -> tuple[Mesh, FloatArray]:
    """Read the file anew, as it were, with another up axis."""
    source = mesh.source
    V = mesh.vertices @ turn.T
    unit = source.unit
    if "unit" in source.guessed and unit in UNITS.values():
        unit = guess_unit(float(np.ptp(V[:, 1])) / source.unit)
    turn = turn * (unit / source.unit)
    return replace(mesh, vertices=mesh.vertices @ turn.T, source=replace(source, up=up, unit=unit)), turn


def _upwards(mesh: Mesh, pairs: Pairs, roles: dict[str, str]) -> FloatArray | None:
    """Point along the body, from the feet by way of the hips to the head, with unit length."""
    places: dict[str, FloatArray] = {}
    names = np.array(pairs.source)
    for name, role in roles.items():
        if name in pairs.joints:
            places[role] = pairs.joints[name]
        elif (names == name).any():
            places[role] = mesh.vertices[mesh.faces[pairs.target[names == name]]].mean(axis=(0, 1))
    hips, head, feet = (_middle(places, groups) for groups in (_HIPS, _HIGH, _LOW))
    # legs count as much as the trunk: who bows down or kneels does not lie
    parts = [_unit(b - a) for a, b in ((hips, head), (feet, hips)) if a is not None and b is not None]
    body = sum(parts, np.zeros(3))
    return _unit(body) if np.linalg.norm(body) > 0.1 else None


def _middle(places: dict[str, FloatArray], groups: tuple[tuple[str, ...], ...]) -> FloatArray | None:
    found = next((group for group in groups if all(role in places for role in group)), ())
    return np.mean([places[role] for role in found], axis=0) if found else None


def _unit(x: FloatArray) -> FloatArray:
    return x / max(float(np.linalg.norm(x)), 1e-300)


def _angle(a: FloatArray, b: FloatArray) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))
