"""The cross-section rule: one picked pair on a limb becomes a ring of pairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.clips import Mesh
from tempose.rotations import rotate
from tempose.transfer.correspondence.limb import Limb, find_limb
from tempose.transfer.correspondence.rays import shoot_ring
from tempose.transfer.correspondence.section import Loop, Sections
from tempose.transfer.correspondence.similarity import Alignment
from tempose.transfer.pairing.marks import RING_SIZE
from tempose.typing import BoolArray, FloatArray, IntArray

_SURE = 0.25
_GAP = 2 * np.pi / 3
_LARGE = 6.0
"""A section so many thicknesses round is no limb's."""


@dataclass(frozen=True)
class Ring:
    """Pairs round a limb, in the order of the angle; the first is the picked one."""

    source: IntArray
    """(k,) int faces of the source; empty for a source that is no mesh."""
    target: IntArray
    """(k,) int faces of the target, each once."""
    angles: FloatArray
    """(k,) radians round the limb from the picked direction."""
    closed: bool
    """Whether the marks leave no third of the circle empty in the target."""
    limbs: tuple[Limb | None, Limb]
    """The section of source and of target."""
    warnings: tuple[str, ...] = ()
    """What is doubtful."""


def complete_ring(
    source: Mesh | Sections | None,
    target: Mesh | Sections,
    pair: tuple[int, int],
    *,
    count: int = RING_SIZE,
    alignment: Alignment | None = None,
    source_axis: FloatArray | None = None,
    target_axis: FloatArray | None = None,
) -> Ring:
    """Mark all round a limb from one picked pair.

    Parameters
    ----------
    source : Mesh or Sections or None
        Source at rest; None for a skeleton, whose bone moves the whole ring.
    target : Mesh or Sections
        Target at rest. `Sections` made once save the search for seams on every pick.
    pair : (int, int)
        Picked face of the source (ignored without one) and of the target.
    count : int, default 12
        Number of rays.
    alignment : Alignment, optional
        Source to target; tells which way round the ring runs where the shapes do not.
    source_axis, target_axis : (3,) float, optional
        Direction of the part from the body outwards, such as that of its bone; from its shape if not given.

    Returns
    -------
    Ring
        At most `count` pairs.

    Raises
    ------
    ValueError
        If a face does not exist, `count` is below 3, or there is no section at the pick.

    Notes
    -----
    Section 4.2 of [1]_: rays in the plane of the cross section, here from its centroid at equal angles from
    the picked direction, meet both meshes where they leave the section. Only the loop through the picked
    face is met, never the other leg.

    References
    ----------
    .. [1] de Aguiar, Zayer, Theobalt, Seidel, Magnor, "A Simple Framework for Natural Animation of Digitized
       Models", SIBGRAPI 2007.
    """
    if count < 3:
        raise ValueError(f"count must be at least 3, got {count}")
    there = _limb(target, pair[1], target_axis, "target")
    angles = np.arange(count) * 2 * np.pi / count
    if source is None:
        faces, _, met = shoot_ring(there, _point(target, pair[1]), angles)
        return _ring(pair[1], np.zeros(0, dtype=np.int64), faces, angles, met, (None, there), ())
    here = _limb(source, pair[0], source_axis, "source")
    sign, warnings = _same_way(here, there, alignment, source_axis is not None, target_axis is not None)
    faces, _, met = shoot_ring(there, _point(target, pair[1]), sign * angles)
    of_source, _, met_here = shoot_ring(here, _point(source, pair[0]), angles)
    of_source[0] = pair[0]
    return _ring(pair[1], of_source, faces, angles, met & met_here, (here, there), warnings)


def _ring(
    picked: int,
    source: IntArray,
    target: IntArray,
    angles: FloatArray,
    met: BoolArray,
    limbs: tuple[Limb | None, Limb],
    warnings: tuple[str, ...],
) -> Ring:
    target[0] = picked
    met[0] = True
    _, first = np.unique(target[met], return_index=True)
    kept = np.flatnonzero(met)[np.sort(first)]
    gaps = np.diff(np.append(angles[kept], 2 * np.pi))
    closed = bool(gaps.max() <= _GAP + 1e-9) and limbs[1].loop.closed
    if not closed:
        warnings = (
            *warnings,
            "the ring is not closed: the target has a hole there; mark the far side by hand",
        )
    for limb, name in zip(limbs, ("source", "target")):
        if limb is not None and _sprawls(limb.loop, limb.centre):
            warnings = (
                *warnings,
                f"the section of the {name} is no limb's: too far from round; mark by hand",
            )
    return Ring(source[kept] if len(source) else source, target[kept], angles[kept], closed, limbs, warnings)


def _sprawls(loop: Loop, centre: FloatArray) -> bool:
    radii = np.linalg.norm(loop.points - centre, axis=1)
    return bool(radii.max() > _LARGE * max(float(np.median(radii)), 1e-300)) or loop.length > 2.0 * (
        2 * np.pi * float(radii.max())
    )


def _limb(mesh: Mesh | Sections, face: int, axis: FloatArray | None, name: str) -> Limb:
    sections = mesh if isinstance(mesh, Sections) else Sections(mesh.vertices, mesh.faces)
    if not 0 <= face < len(sections.F):
        raise ValueError(f"pair names {name} face {face}, but it has {len(sections.F)}")
    limb = find_limb(sections, face, axis)
    if limb is None:
        raise ValueError(
            f"{name} face {face} has no cross section: it is degenerate or lies across the axis; pick another"
        )
    return limb


def _point(mesh: Mesh | Sections, face: int) -> FloatArray:
    V, F = (mesh.V, mesh.F) if isinstance(mesh, Sections) else (mesh.vertices, mesh.faces)
    return V[F[face]].mean(axis=0)


def _same_way(
    here: Limb, there: Limb, alignment: Alignment | None, known_here: bool, known_there: bool
) -> tuple[float, tuple[str, ...]]:
    """Whether both axes point the same way along the body: from it outwards, else by the alignment."""
    outwards = (1.0 if known_here else here.distal, 1.0 if known_there else there.distal)
    if min(abs(outwards[0]), abs(outwards[1])) > _SURE:
        return float(np.sign(outwards[0] * outwards[1])), ()
    turned = here.axis if alignment is None else rotate(alignment.rotation, here.axis)
    cosine = float(turned @ there.axis)
    doubt = "which way round the ring runs is doubtful: the parts lie across each other; check two pairs"
    return (1.0 if cosine >= 0 else -1.0), ((doubt,) if abs(cosine) < _SURE else ())
