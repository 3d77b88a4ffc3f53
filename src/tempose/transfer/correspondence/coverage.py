"""What a list of pairs leaves out, contradicts or exchanges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tempose.clips import Mesh, Skeleton
from tempose.transfer.correspondence.agreement import disagreeing_pairs, exchanged_sides
from tempose.transfer.correspondence.reach import face_pieces, far_regions, mark_distances, name_place
from tempose.transfer.correspondence.ring_check import open_rings
from tempose.transfer.correspondence.source_parts import unpaired_parts
from tempose.transfer.pairing.pairs import FEWEST, Pairs
from tempose.typing import IntArray

Severity = Literal["error", "warning", "note"]
_ORDER = ("error", "warning", "note")


@dataclass(frozen=True)
class Finding:
    """One thing to look at."""

    kind: str
    """``"few"``, ``"far"``, ``"piece"``, ``"part"``, ``"sides"``, ``"ring"`` or ``"neighbours"``."""
    severity: Severity
    """``"error"`` where the result will be wrong, ``"warning"`` where it may be, ``"note"`` else."""
    place: str
    """Where, in words: a part, or what it is beside."""
    message: str
    """What was found."""
    advice: str
    """What to do."""
    faces: IntArray
    """(k,) int faces of the target to show; may be empty."""
    pairs: tuple[int, ...] = ()
    """Pairs that are meant; may be empty."""

    def as_dict(self) -> dict[str, object]:
        """Return the finding ready for JSON.

        Returns
        -------
        dict
            All but `faces`, of which the number and the first are kept.
        """
        return {
            "kind": self.kind,
            "severity": self.severity,
            "place": self.place,
            "message": self.message,
            "advice": self.advice,
            "faces": len(self.faces),
            "first_face": int(self.faces[0]) if len(self.faces) else None,
            "pairs": list(self.pairs),
        }


def check_coverage(
    pairs: Pairs, target: Mesh, source: Mesh | Skeleton | None = None, *, far: float = 0.15
) -> tuple[Finding, ...]:
    """Check pairs before they are used.

    Parameters
    ----------
    pairs : Pairs
        The pairs.
    target : Mesh
        Target at rest, upright.
    source : Mesh or Skeleton, optional
        Source at rest; without it only the target's side is checked.
    far : float, default 0.15
        Way along the surface from the nearest mark, share of the diagonal, from which a place counts as
        uncovered.

    Returns
    -------
    tuple of Finding
        Errors first; empty where nothing is wrong.

    Raises
    ------
    ValueError
        If a pair names what does not exist; the message names the first such pair.
    """
    faces = pairs.kind != "vertices"
    limits = (0, len(target.faces) if faces else len(target.vertices))
    names: tuple[str, ...] = source.names if isinstance(source, Skeleton) else ()
    if isinstance(source, Mesh):
        limits = (len(source.faces) if faces else len(source.vertices), limits[1])
    if len(pairs) and int(pairs.target.max()) >= limits[1]:
        raise ValueError(f"pairs name target {pairs.target.max()}, but the target has {limits[1]}")
    found = _few(pairs)
    if source is not None and not found:
        pairs.check(*limits, names)
    ways = mark_distances(target, pairs)
    found += _far(pairs, target, ways, far)
    found += _pieces(pairs, target, ways)
    found += _parts(pairs, source)
    found += _sides(pairs, target, source)
    found += _rings(pairs, target)
    found += _neighbours(pairs, target, source)
    return tuple(sorted(found, key=lambda f: _ORDER.index(f.severity)))


def _few(pairs: Pairs) -> list[Finding]:
    distinct = len(set(pairs.source)) if pairs.kind == "joints" else len(pairs)
    if distinct >= FEWEST[pairs.kind]:
        return []
    return [
        Finding(
            "few",
            "error",
            "",
            f"{distinct} different {pairs.kind} are paired, at least {FEWEST[pairs.kind]} are needed",
            "pick more pairs",
            np.zeros(0, dtype=np.int64),
        )
    ]


def _far(pairs: Pairs, target: Mesh, ways: tuple[np.ndarray, np.ndarray], far: float) -> list[Finding]:
    distance, nearest = ways
    found: list[Finding] = []
    for region in far_regions(target, distance, far):
        depth = float(distance[region].max()) / target.diagonal
        tip = int(region[distance[region].argmax()])
        place = name_place(target, pairs, tip, int(nearest[tip]))
        found.append(
            Finding(
                "far",
                "warning" if depth > 1.5 * far else "note",
                place,
                f"{len(region)} triangles lie up to {100 * depth:.0f} % of the diagonal from any mark",
                "pick a pair there if it should move by itself",
                region,
            )
        )
    return found


def _pieces(pairs: Pairs, target: Mesh, ways: tuple[np.ndarray, np.ndarray]) -> list[Finding]:
    piece = face_pieces(target)
    count = int(piece.max()) + 1 if len(piece) else 0
    if count <= 1:
        return []
    marked = pairs.target if pairs.kind != "vertices" else None
    if marked is None:
        bearing = np.isin(target.faces, pairs.target).any(axis=1)
        marked = np.flatnonzero(bearing)
    sizes, marks = np.bincount(piece, minlength=count), np.bincount(piece[marked], minlength=count)
    largest = int(sizes.argmax())
    found: list[Finding] = []
    if marks[largest] == 0:
        message = f"the largest of {count} unconnected pieces ({sizes[largest]} triangles) bears no mark"
        advice = "mark the body itself; clothes and hair follow it"
        found.append(Finding("piece", "error", "body", message, advice, np.flatnonzero(piece == largest)))
    loose = np.flatnonzero(marks == 0)
    if len(loose):
        faces = np.flatnonzero(np.isin(piece, loose))
        message = f"{len(loose)} of {count} unconnected pieces bear no mark ({len(faces)} triangles)"
        found.append(Finding("piece", "note", "", message, "they follow what they are nearest to", faces))
    return found


def _parts(pairs: Pairs, source: Mesh | Skeleton | None) -> list[Finding]:
    none = np.zeros(0, dtype=np.int64)
    advice = "pick a triangle of the target for it, or leave it to move with its neighbours"
    return [
        Finding("part", severity, name, f"{name} of the source has no partner", advice, none)
        for name, severity in unpaired_parts(pairs, source)
    ]


def _sides(pairs: Pairs, target: Mesh, source: Mesh | Skeleton | None) -> list[Finding]:
    found: list[Finding] = []
    for place, message, rows in exchanged_sides(pairs, target, source):
        faces = pairs.target[list(rows)] if pairs.kind != "vertices" else np.zeros(0, dtype=np.int64)
        advice = "exchange left and right in these pairs"
        found.append(Finding("sides", "error", place, message, advice, faces, rows))
    return found


def _rings(pairs: Pairs, target: Mesh) -> list[Finding]:
    return [
        Finding(
            "ring",
            "warning",
            name,
            f"the marks of {name} leave {gap:.0f} of 360 degrees round it empty",
            "complete the ring: a limb marked on one side only does not follow fully",
            pairs.target[list(rows)] if pairs.kind != "vertices" else np.zeros(0, dtype=np.int64),
            rows,
        )
        for name, gap, rows in open_rings(pairs, target)
    ]


def _neighbours(pairs: Pairs, target: Mesh, source: Mesh | Skeleton | None) -> list[Finding]:
    if not isinstance(source, Mesh) or pairs.kind == "joints":
        return []
    return [
        Finding(
            "neighbours",
            "warning",
            pairs.parts[i] if pairs.parts else f"pair {i}",
            f"pair {i} lies {100 * off:.0f} % of the diagonal from where the pairs round it would put it",
            "look whether it is on the right limb and the right side of it",
            pairs.target[[i]] if pairs.kind == "faces" else np.zeros(0, dtype=np.int64),
            (i,),
        )
        for i, off in disagreeing_pairs(pairs, source, target)
    ]
