"""The solids a character is sculpted from, and the tree in which they blend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tempose.typing import FloatArray

Point = Sequence[float] | FloatArray

ROUND_CONE, ELLIPSOID, LOFT, SWELL = range(4)
"""Kinds of part; the last is a brush stroke over the parts before it."""

MIRROR: FloatArray = np.array([-1.0, 1.0, 1.0])
"""Takes the left side to the right."""


@dataclass(frozen=True, eq=False)
class Node:
    """A limb: its parts blend with one another, then as a whole with its parent, never with a sibling."""

    name: str
    """Name, unique in a character."""
    parent: str
    """Name of the node it grows from; empty for the trunk."""
    blend: float
    """Radius of the fillet between the two, metres."""
    chain: tuple[str, ...] = ()
    """Joints that move its surface, from the body outwards."""
    chart: str = ""
    """Texture chart that its surface belongs to."""
    web: float = 0.0
    """Radius of the fillet between its children, metres: felt only where they nearly touch."""


@dataclass(frozen=True, eq=False)
class Part:
    """One solid of a node."""

    node: str
    """Name of the node."""
    kind: int
    """One of `ROUND_CONE`, `ELLIPSOID`, `LOFT`, `SWELL`."""
    data: FloatArray
    """Parameters as `primitives` wants them."""
    blend: float
    """Radius of the fillet with the parts before it, metres."""
    detail: float = 1.0
    """Edge length of triangles here, relative to the rest of the body."""
    carve: bool = False
    """Take the solid away instead of adding it."""
    table: FloatArray | None = None
    """(TABLE_ROWS, 8) cross-sections of a loft."""
    thickness: float = np.inf
    """Half of what must not vanish when triangles are few, metres; known for cones."""

    @property
    def bounds(self) -> FloatArray:
        """(2, 3) corners of a box around the solid, metres."""
        q = self.data
        if self.kind == ROUND_CONE:
            a, b = q[:3] - q[6], q[:3] + q[6]
            return np.array([np.minimum(a, q[3:6] - q[7]), np.maximum(b, q[3:6] + q[7])])
        if self.kind in (ELLIPSOID, SWELL):
            half = np.sqrt(((q[3:12].reshape(3, 3) * q[12:15, None]) ** 2).sum(axis=0))
            return np.array([q[:3] - half, q[:3] + half])
        assert self.table is not None
        axes = q[3:12].reshape(3, 3)
        t = np.linspace(0.0, q[12], len(self.table))
        t[0], t[-1] = -q[13], q[12] + q[14]
        centre = q[:3] + self.table[:, :2] @ axes[:2] + t[:, None] * axes[2]
        reach = self.table[:, 2:6].max() * (1.0 + self.table[:, 7].max())
        return np.array([centre.min(axis=0) - reach, centre.max(axis=0) + reach])

    @property
    def longest(self) -> float:
        """Longest edges that still show the solid, metres: a prism on an equilateral triangle inside it."""
        thinnest = float(self.data[6:8].min()) if self.kind == ROUND_CONE else np.inf
        return float(np.sqrt(3.0)) * min(self.thickness, thinnest)

    def mirrored(self) -> Part:
        """Return the same part on the other side of the body.

        Returns
        -------
        Part
            Reflected in the plane x = 0, ``left_`` in its node's name turned into ``right_``.
        """
        vectors = 2 if self.kind == ROUND_CONE else 4
        data = self.data.copy()
        data[: 3 * vectors] *= np.tile(MIRROR, vectors)
        return replace(self, node=self.node.replace("left_", "right_"), data=data)

    def scaled(self, factor: float) -> Part:
        """Return the same part larger or smaller.

        Parameters
        ----------
        factor : float
            Factor on every length, about the origin.

        Returns
        -------
        Part
            The scaled part.
        """
        data, table = self.data.copy(), self.table
        lengths = np.ones(len(data), dtype=bool)
        if self.kind != ROUND_CONE:
            lengths[3:12] = False
        if table is not None:
            lengths[15:] = False
            table = table * np.where(np.arange(8) < 6, factor, 1.0)
        data[lengths] *= factor
        sizes = {"blend": self.blend * factor, "thickness": self.thickness * factor}
        return replace(self, data=data, table=table, **sizes)


def frame(along: Point, up: Point) -> FloatArray:
    """Right-handed axes from a direction and a hint.

    Parameters
    ----------
    along : (3,) float
        Direction of the third axis.
    up : (3,) float
        Rough direction of the second.

    Returns
    -------
    (3, 3) ndarray
        Unit axes, one a row.
    """
    third = np.asarray(along, dtype=np.float64) / np.linalg.norm(along)
    second = np.asarray(up, dtype=np.float64) - np.dot(up, third) * third
    second /= np.linalg.norm(second)
    return np.array([np.cross(second, third), second, third])


def sided(table: dict[str, float]) -> dict[str, float]:
    """Give every entry of a table to both sides of the body, too.

    Parameters
    ----------
    table : dict of str to float
        By name of a joint, without its side.

    Returns
    -------
    dict of str to float
        The table, and the same under names with ``left_`` and ``right_`` before them.
    """
    return {f"{side}{name}": value for side in ("", "left_", "right_") for name, value in table.items()}


def ease(x: FloatArray) -> FloatArray:
    """Go from 0 to 1 without a kink.

    Parameters
    ----------
    x : (...) float
        0 and less gives 0, 1 and more gives 1.

    Returns
    -------
    (...) ndarray
        Smooth step with continuous second derivative.
    """
    x = np.clip(x, 0.0, 1.0)
    return x * x * x * (x * (6.0 * x - 15.0) + 10.0)
