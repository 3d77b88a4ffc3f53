"""Rough alignment of two rest poses: the similarity that lays one over the other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tempose.clips import Mesh
from tempose.rotations import angle_between, from_matrix, to_matrix
from tempose.transfer.bodies.facing import yaw
from tempose.transfer.correspondence.closest import Cloud, make_cloud, match_clouds
from tempose.transfer.correspondence.front import feet_front
from tempose.transfer.correspondence.similarity import Alignment, fit_similarity
from tempose.typing import FloatArray

UPRIGHT_LEAD = 1.5
"""Bodies are assumed to stand unless lying fits so many times better."""
FEET_LEAD = 1.25
"""Feet that point the other way count like so much of a worse fit: front and back of a body look alike."""
_DISTINCT = np.radians(30.0)
_FIRST, _LAST, _KEPT = 5, 40, 2
_CERTAIN = 0.9
_SETTLED, _EXACT = 2e-4, 1e-6


def align_meshes(source: Mesh, target: Mesh, *, upright: bool | None = None) -> Alignment:
    """Lay the source over the target by shape alone.

    Parameters
    ----------
    source, target : Mesh
        Rest poses, as alike as may be; proportions may differ.
    upright : bool, optional
        True allows only turns about the vertical, False any. Not given: upright unless another turn fits
        half as well again.

    Returns
    -------
    Alignment
        Scale, turn and translation with residual and ambiguity; never a reflection.

    Raises
    ------
    ValueError
        If a mesh has no extent.

    Notes
    -----
    The starts are the 24 turns between the principal axes of the two surfaces and eight about the vertical;
    each is refined by iterated closest points both ways, trimmed to the best 80 %.
    """
    for mesh, name in ((source, "source"), (target, "target")):
        if len(mesh.faces) < 4 or mesh.diagonal == 0:
            raise ValueError(f"{name} must be a surface of at least 4 triangles, got {len(mesh.faces)}")
    here, there = make_cloud(source.vertices, source.faces), make_cloud(target.vertices, target.faces)
    standing = [to_matrix(yaw(k * np.pi / 4)) for k in range(8)]
    free = [] if upright else _turns_between(here.axes, there.axes)
    found = _best(here, there, standing, True)
    if free:
        found += _best(here, there, free, False)
    front = feet_front(target.vertices, target.faces)
    found = [replace(fit, backwards=_backwards(source, fit.R, front)) for fit in found]
    return _decide(found, upright is None)


@dataclass(frozen=True)
class _Fit:
    scale: float
    R: FloatArray
    shift: FloatArray
    residual: float
    overall: float
    upright: bool
    backwards: bool = False


def _backwards(source: Mesh, R: FloatArray, front: FloatArray | None) -> bool:
    if front is None:
        return False
    mine = feet_front(source.vertices @ R.T, source.faces)
    return mine is not None and float(mine @ front) < 0


def _turns_between(A: FloatArray, B: FloatArray) -> list[FloatArray]:
    """All 24 rotations that carry one set of axes (columns) onto the other."""
    found: list[FloatArray] = []
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
        for signs in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            C = B[:, list(order)] * np.array([*signs, 1.0])
            C[:, 2] *= np.sign(np.linalg.det(C)) * np.sign(np.linalg.det(A))
            found.append(C @ A.T)
    return found


def _best(here: Cloud, there: Cloud, starts: list[FloatArray], upright: bool) -> list[_Fit]:
    """Refine a little from every start, then the best of them fully."""
    first = [_refine(here, there, R, upright, _FIRST, coarse=True) for R in starts]
    first.sort(key=lambda fit: fit.overall)
    distinct: list[_Fit] = []
    for fit in first:
        if all(_angle(fit.R, other.R) > _DISTINCT / 2 for other in distinct):
            distinct.append(fit)
    return [_refine(here, there, fit.R, upright, _LAST, fit=fit) for fit in distinct[:_KEPT]]


def _refine(
    here: Cloud,
    there: Cloud,
    R: FloatArray,
    upright: bool,
    rounds: int,
    coarse: bool = False,
    fit: _Fit | None = None,
) -> _Fit:
    scale = there.size / here.size if fit is None else fit.scale
    shift = there.centre - scale * R @ here.centre if fit is None else fit.shift
    for _ in range(rounds):
        match = match_clouds(here, there, scale, R, shift, coarse)
        residual, before = match.residual, (scale, R, shift)
        scale, R, shift = fit_similarity(match.source, match.target, match.weights, upright)
        if residual > _EXACT and _moved(before, (scale, R, shift), there) < _SETTLED:
            break
    match = match_clouds(here, there, scale, R, shift, coarse)
    return _Fit(scale, R, shift, match.residual, match.overall, upright)


def _moved(
    a: tuple[float, FloatArray, FloatArray], b: tuple[float, FloatArray, FloatArray], at: Cloud
) -> float:
    return abs(a[0] / b[0] - 1) + float(np.abs(a[1] - b[1]).max() + np.abs(a[2] - b[2]).max() / at.size)


def _angle(A: FloatArray, B: FloatArray) -> float:
    return float(angle_between(from_matrix(A), from_matrix(B)))


def _decide(found: list[_Fit], prefer: bool) -> Alignment:
    def cost(fit: _Fit) -> float:
        lying = UPRIGHT_LEAD if prefer and not fit.upright else 1.0
        return fit.overall * lying * (FEET_LEAD if fit.backwards else 1.0)

    found.sort(key=cost)
    best = found[0]
    q = from_matrix(best.R)
    others = [fit for fit in found[1:] if _angle(fit.R, best.R) > _DISTINCT]
    if not others:
        return Alignment(best.scale, q, best.shift, best.residual)
    ratio = max(cost(best), _EXACT) / max(cost(others[0]), _EXACT)
    warnings = ()
    if ratio > _CERTAIN:
        degrees = np.degrees(_angle(others[0].R, best.R))
        warnings = (
            f"turned by {degrees:.0f} degrees the source fits almost as well "
            f"({100 * others[0].overall:.1f} against {100 * best.overall:.1f} % of the diagonal): check it",
        )
    return Alignment(
        best.scale, q, best.shift, best.residual, float(ratio), from_matrix(others[0].R), warnings
    )
