"""Clips made by linear blend skinning, with the weights and turns that made them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tempose import formats
from tempose.clips import Skeleton, SkinnedMesh
from tempose.kinematics import bone_transforms
from tempose.kinematics.skinning import bake
from tempose.rotations import angle_between, from_matrix, multiply


@dataclass(frozen=True)
class Truth:
    """A clip and what it was made from."""

    name: str
    skin: SkinnedMesh
    frames: np.ndarray
    """(T, n, 3) metres."""
    posed: Skeleton
    """The joints with the bone lengths of the clip, which need not be those of the bind pose."""
    turns: np.ndarray
    """(T, J, 4) true rotation of every bone from the bind pose."""


def cheburashka(folder: Path) -> Truth:
    """Eleven poses of one mesh; bones are the edges of a graph, turns stand in files."""
    nodes, _, edges = (folder / "cheburashka.tgf").read_text().partition("#")
    P = np.array([line.split()[1:] for line in nodes.strip().splitlines()], dtype=float)
    E = np.array([line.split() for line in edges.split("#")[0].strip().splitlines()], dtype=int) - 1
    columns, rows = (int(w) for w in (folder / "cheburashka.DMAT").read_text().split("\n")[0].split())
    W = np.loadtxt(folder / "cheburashka.DMAT", skiprows=1).reshape(columns, rows).T
    order, parents = _tree(E)
    rest = P[E[order, 0]]
    joints = np.vstack([P[0], rest])
    offsets = joints - np.vstack([np.zeros(3), joints[parents[1:]]])
    names = ("root", *(f"bone {a + 1}-{b + 1}" for a, b in E[order]))
    mesh = formats.load_mesh(folder / "cheburashka.obj")
    weights = np.column_stack([np.zeros(rows), W[:, order]])
    skin = SkinnedMesh(mesh, Skeleton(names, parents, offsets), weights)
    poses = [folder / f"cheburashka-{k:02d}" for k in range(1, 12)]
    frames = np.stack([formats.load_mesh(p.with_suffix(".obj")).vertices for p in poses])
    T = np.stack([np.loadtxt(p.with_suffix(".Tmat")).reshape(-1, 4, 3)[order] for p in poses])
    turns = from_matrix(T[:, :, :3].transpose(0, 1, 3, 2))
    still = np.tile([1.0, 0, 0, 0], (len(turns), 1, 1))
    return Truth("cheburashka", skin, frames, skin.skeleton, np.concatenate([still, turns], axis=1))


def _tree(E: np.ndarray) -> tuple[list[int], np.ndarray]:
    """Bones in an order with parents first, below one more joint, the root, that holds nothing."""
    order: list[int] = []
    above: list[int] = []
    reached = {0: 0}
    while len(order) < len(E):
        for k, (a, b) in enumerate(E):
            if k not in order and a in reached:
                order.append(k)
                above.append(reached[a])
                reached[b] = len(order)
    return order, np.array([-1, *above])


def usd_lbs(folder: Path) -> Truth:
    """Three small meshes on three joints, and the frames another program baked."""
    skin, motion = (load(folder / "lbs.usda") for load in (formats.load_skin, formats.load_skeleton_clip))
    baked = formats.load_clip(folder / "lbs.baked.usda")
    turns, _ = bone_transforms(skin.skeleton, motion.rotations, motion.root_position, motion.skeleton)
    return Truth("usd-skel/lbs", skin, np.asarray(baked.vertices, dtype=float), motion.skeleton, turns)


def cesium_man(folder: Path) -> Truth:
    """A walk on nineteen joints, baked here by plain skinning."""
    path = folder / "CesiumMan.glb"
    skin, motion = formats.load_skin(path), formats.load_skeleton_clip(path)
    turns, _ = bone_transforms(skin.skeleton, motion.rotations, motion.root_position, motion.skeleton)
    return Truth("CesiumMan", skin, bake(skin, motion), motion.skeleton, turns)


def truths(data: Path) -> list[Truth]:
    return [
        cheburashka(data / "cheburashka-lbs"),
        usd_lbs(data / "usd-skel"),
        cesium_man(data / "rigged-gltf"),
    ]


def angle_errors(truth: Truth, turns: np.ndarray) -> np.ndarray:
    """(T, k) degrees: turn of every bone that holds vertices, relative to the nearest such bone above."""
    skin = truth.skin
    holds = skin.weights.sum(axis=0) > 1e-6 * len(skin.weights)
    found: list[np.ndarray] = []
    for j in np.flatnonzero(holds):
        above = int(skin.skeleton.parents[j])
        while above >= 0 and not holds[above]:
            above = int(skin.skeleton.parents[above])
        pair = [t[:, j] if above < 0 else _relative(t[:, above], t[:, j]) for t in (truth.turns, turns)]
        found.append(np.degrees(angle_between(*pair)))
    return np.stack(found, axis=1)


def _relative(above: np.ndarray, turn: np.ndarray) -> np.ndarray:
    return multiply(above * np.array([1.0, -1, -1, -1]), turn)
