"""The whole way from a mesh to a skeleton inside it."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np

from tempose.clips import Mesh, SkinnedMesh
from tempose.embedding.attempts import Attempt, read_body
from tempose.embedding.cells import Cells
from tempose.embedding.doubt import doubts, skirted, upside
from tempose.embedding.embedding import Embedding
from tempose.embedding.facing import axis_vector, body_frame, find_side, nearest_axis
from tempose.embedding.fallback import average_body
from tempose.embedding.heat import heat_weights
from tempose.embedding.human import NAMES, SIDES
from tempose.embedding.inside import pull_inside
from tempose.embedding.place import (
    HIPS_BACK,
    Arm,
    Leg,
    Trunk,
    centre_hips,
    place_arm,
    place_leg,
    place_toes,
    place_trunk,
)
from tempose.embedding.refine import refine_hinges
from tempose.embedding.search import WAY_PER_STATURE
from tempose.embedding.solid import make_solid
from tempose.embedding.symmetry import mirror_shoulders, unlike_bones
from tempose.typing import FloatArray, Progress, silent

_TILTED = np.cos(np.radians(40.0))


def embed_skeleton(mesh: Mesh, *, up: str | None = None, progress: Progress = silent) -> Embedding:
    """Place a human skeleton of 18 joints inside a mesh.

    Parameters
    ----------
    mesh : Mesh
        A person in any pose in which hands and feet stick out, of any size, with any axis up; closed or with
        holes, of one piece or many.
    up : str, optional
        Axis that ought to point up, such as ``"y"`` or ``"-z"``; a body found to lie or to stand on its head
        is then doubted. Without it, every axis will do.
    progress : Progress, optional
        Called after each stage.

    Returns
    -------
    Embedding
        Joints in the mesh's own coordinates. Where `doubtful`, it should not be used unseen.

    Raises
    ------
    ValueError
        If the mesh is empty, flat, or encloses no volume.

    Notes
    -----
    The stages of [1]_, with level sets of the distance from the head in the place of its packed spheres:
    what lies inside, how far every cell is from the ends of the body, which ends are head, hands and feet
    (all choices, by penalties), joints at their usual places along the middle lines.

    References
    ----------
    .. [1] Baran and Popovic, "Automatic Rigging and Animation of 3D Characters", SIGGRAPH 2007.
    """
    return embed_in_cells(mesh, up, progress)[0]


def embed_skin(
    mesh: Mesh, *, up: str | None = None, progress: Progress = silent
) -> tuple[SkinnedMesh, Embedding]:
    """Place a human skeleton inside a mesh and bind the mesh to it.

    Parameters
    ----------
    mesh : Mesh
        See `embed_skeleton`.
    up : str, optional
        See `embed_skeleton`.
    progress : Progress, optional
        Called after each stage.

    Returns
    -------
    skin : SkinnedMesh
        The mesh with 21 joints, named by their roles, and heat weights.
    embedding : Embedding
        How they were found.

    Raises
    ------
    ValueError
        If the mesh is empty, flat, or encloses no volume.
    """
    embedding, cells = embed_in_cells(mesh, up, progress)
    weights = heat_weights(mesh, embedding, cells=cells)
    progress(4, 4, "weights")
    return SkinnedMesh(mesh, embedding.skeleton, weights), embedding


def embed_in_cells(mesh: Mesh, up: str | None, progress: Progress) -> tuple[Embedding, Cells]:
    """Place a human skeleton inside a mesh, and keep the inside for what comes next.

    Parameters
    ----------
    mesh : Mesh
        See `embed_skeleton`.
    up : str or None
        See `embed_skeleton`.
    progress : Progress
        Called after each stage.

    Returns
    -------
    embedding : Embedding
        The skeleton.
    cells : Cells
        The inside as it was read.
    """
    wanted = None if up is None else axis_vector(up)
    clock = _Clock()
    solid = make_solid(mesh.vertices, mesh.faces)
    clock.stage("inside", 1, progress)
    body = read_body(solid)
    clock.stage("search", 2, progress)
    report: dict[str, Any] = {
        "extremities": body.n_ends,
        "reading": body.reading,
        "gap_closed_cells": solid.bridged,
        "lost_percent": 100 * solid.lost,
        "seconds": clock.seconds,
    }
    embedding = _placed(body, wanted, report) or average_body(body.cells, wanted, body.n_ends, report)
    clock.stage("place", 3, progress)
    return embedding, body.cells


def _placed(body: Attempt, wanted: FloatArray | None, report: dict[str, Any]) -> Embedding | None:
    cells, ends, limbs, terms = body.cells, body.ends, body.limbs, body.terms
    if ends is None or limbs is None or terms is None:
        return None
    arms = _pair([place_arm(cells, limbs.arms[i], ends.size, int(ends.cells[1 + i])) for i in range(2)])
    skirt = skirted(terms)
    legs = _pair([place_leg(cells, limb, ends.size, limbs.pit, skirted=skirt) for limb in limbs.legs])
    legs = centre_hips(legs, limbs.trunk)
    trunk = place_trunk(cells, limbs, ends, legs)
    arms, legs = refine_hinges(limbs, mirror_shoulders(arms, legs, trunk, ends.size), legs, ends.size)
    side, clearness, votes = find_side(trunk, arms, legs)
    if (arms[0].upper_arm - arms[1].upper_arm) @ side < 0:
        arms = (arms[1], arms[0])
    if (legs[0].thigh - legs[1].thigh) @ side < 0:
        legs = (legs[1], legs[0])
    spine = trunk.neck - trunk.hips
    spine = spine / max(float(np.linalg.norm(spine)), 1e-300)
    axis = nearest_axis(spine)
    upright = float(axis_vector(axis) @ spine)
    frame = body_frame(side, axis_vector(axis) if upright > _TILTED else spine)
    report |= {
        "penalties": terms,
        "skirt": skirt,
        "facing_votes": votes,
        "tilt_degrees": float(np.degrees(np.arccos(min(upright, 1.0)))),
        "stature": ends.size / WAY_PER_STATURE,
    }
    trunk = replace(trunk, hips=trunk.hips - HIPS_BACK * ends.size * np.cross(side, spine))
    placed, tips = _joints(trunk, arms, legs, side)
    joints = pull_inside(cells, placed, ends.size)
    report["moved_inside"] = [name for name, a, b in zip(NAMES, placed, joints) if (a != b).any()]
    ratios = unlike_bones(arms, legs)
    report["side_ratios"] = ratios
    reasons = doubts(body.penalty, terms, clearness, ratios) + upside(spine, wanted)
    return Embedding(joints, tips, body.penalty, frame, axis, reasons, report)


def _pair(items: list[Any]) -> tuple[Any, Any]:
    return items[0], items[1]


def _joints(
    trunk: Trunk, arms: tuple[Arm, Arm], legs: tuple[Leg, Leg], side: FloatArray
) -> tuple[FloatArray, dict[str, FloatArray]]:
    at: dict[str, FloatArray] = {name: getattr(trunk, name) for name in ("hips", "spine", "neck", "head")}
    tips = {"head": trunk.tip}
    for name, arm, leg in zip(SIDES, arms, legs):
        toes, tip = place_toes(leg, side)
        at |= {f"{name}_{part}": getattr(arm, part) for part in ("upper_arm", "forearm", "hand")}
        at |= {f"{name}_{part}": getattr(leg, part) for part in ("thigh", "shin", "foot")}
        at[f"{name}_toes"] = toes
        tips |= {f"{name}_hand": arm.tip, f"{name}_toes": tip}
    return np.array([at[name] for name in NAMES]), tips


class _Clock:
    """Seconds a stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def stage(self, name: str, done: int, progress: Progress) -> None:
        """Note the end of a stage."""
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now
        progress(done, 4, name)
