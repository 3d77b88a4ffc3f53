"""The whole way from a mesh to a skeleton inside it."""

from __future__ import annotations

import time

import numpy as np

from tempose.clips import Mesh, SkinnedMesh
from tempose.embedding.cells import body_cells
from tempose.embedding.embedding import Embedding
from tempose.embedding.extremities import find_extremities
from tempose.embedding.facing import body_frame, nearest_axis
from tempose.embedding.heat import heat_weights
from tempose.embedding.human import NAMES
from tempose.embedding.limbs import cut_limbs
from tempose.embedding.place import place_arm, place_leg, place_trunk
from tempose.embedding.search import choose_ends
from tempose.embedding.solid import make_solid
from tempose.typing import FloatArray, Progress, silent


def embed_skeleton(mesh: Mesh, *, up: str | None = None, progress: Progress = silent) -> Embedding:
    """Place a human skeleton of 18 joints inside a mesh."""
    t0 = time.perf_counter()
    solid = make_solid(mesh.vertices, mesh.faces)
    cells = body_cells(solid)
    ends = choose_ends(cells, find_extremities(cells))
    if ends is None:
        raise ValueError("no human shape")
    limbs = cut_limbs(cells, ends)
    arms = tuple(place_arm(cells, limbs.arms[i], ends.size, int(ends.cells[1 + i])) for i in range(2))
    legs = tuple(place_leg(cells, limbs.legs[i], ends.size) for i in range(2))
    trunk = place_trunk(cells, limbs, ends, legs)
    frame, swap_arms, swap_legs, clear = body_frame(trunk, arms, legs)
    if swap_arms:
        arms = arms[::-1]
    if swap_legs:
        legs = legs[::-1]
    at: dict[str, FloatArray] = {name: getattr(trunk, name) for name in ("hips", "spine", "neck", "head")}
    ends_at = {"head": trunk.tip}
    for side, arm, leg in zip(("left", "right"), arms, legs):
        at |= {f"{side}_{name}": getattr(arm, name) for name in ("upper_arm", "forearm", "hand")}
        at |= {f"{side}_{name}": getattr(leg, name) for name in ("thigh", "shin", "foot", "toes")}
        ends_at |= {f"{side}_hand": arm.tip, f"{side}_toes": leg.tip}
    return Embedding(
        np.array([at[name] for name in NAMES]),
        ends_at,
        ends.penalty,
        frame,
        nearest_axis(frame[1]),
        (),
        {"seconds": time.perf_counter() - t0, "clear": clear},
    )


def embed_skin(
    mesh: Mesh, *, up: str | None = None, progress: Progress = silent
) -> tuple[SkinnedMesh, Embedding]:
    """Place a human skeleton inside a mesh and bind the mesh to it."""
    embedding = embed_skeleton(mesh, up=up, progress=progress)
    return SkinnedMesh(mesh, embedding.skeleton, heat_weights(mesh, embedding)), embedding
