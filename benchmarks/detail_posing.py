"""Posed frames with detail: one at a time, as a studio does, against plain numpy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from bench_signals import interleaved
from tempose.clips import MeshClip
from tempose.detail import DetailModel
from tempose.detail.posing.poser import DetailPoser
from tempose.kinematics import bone_transforms
from tempose.kinematics.skinning import bake
from tempose.rigging import Rig
from tempose.rotations import rotate, to_matrix
from tempose.samples import MOTIONS, human_character, secondary_motion

FRAMES, TRIANGLES, ROUNDS = 100, 20_000, 60


@cache
def walking_model() -> DetailModel:
    """The built-in human of 10 000 vertices, its cloth learned from 100 frames by the default learner."""
    body = human_character(TRIANGLES)
    motion = MOTIONS["human"]["walk"](body.skin.skeleton, fps=30.0, duration=FRAMES / 30 - 0.01, seed=1)
    motion = replace(motion, name="walk").frames(slice(0, FRAMES))
    V = secondary_motion(body.skin, motion, bake(body.skin, motion), body.regions)
    clip = MeshClip(V, body.skin.mesh, motion.fps)
    return DetailModel("regional-gp", folds=0, tolerance=0.02).fit(clip, Rig(body.skin, motion), [motion])


def plain_numpy(model: DetailModel, C: np.ndarray) -> Callable[[], np.ndarray]:
    """The same frame as one writes it first: dense weights, a matrix product a step."""
    rig, motion = model.rig_, model.motions_[0]
    W, S = rig.skin.weights, model.shares_
    V1 = np.column_stack([rig.skin.mesh.vertices, np.ones(len(W))])
    modes = model.detail_.modes.reshape(len(model.detail_.modes), -1).astype(np.float32)

    def frame() -> np.ndarray:
        turns, shifts = bone_transforms(rig.skin.skeleton, motion.rotations[50], motion.root_position[50])
        M = np.concatenate([to_matrix(turns), shifts[:, :, None]], axis=-1)
        skin = np.einsum("nab,nb->na", (W @ M.reshape(-1, 12)).reshape(-1, 3, 4), V1)
        q = W @ np.where((turns @ turns[0] < 0)[:, None], -turns, turns)
        parts = (C @ modes).reshape(len(C), -1, 3)
        D = np.einsum("nr,rna->na", S, parts)
        return skin + rotate(q / np.linalg.norm(q, axis=1, keepdims=True), D)

    return frame


def rows() -> list[dict[str, Any]]:
    model = walking_model()
    motion = model.motions_[0]
    live, C = model.live(), model.coefficients(motion)[50]
    poser = DetailPoser(model.rig_, model.detail_, model.shares_, model.basis)
    row, turn = (part[50] for part in poser.skin.rows(motion))
    root, V = motion.root_position[50], np.zeros((len(model.shares_), 3), np.float32)
    padded = np.zeros((len(C), poser.columns), np.float32)
    padded[:, : C.shape[1]] = C
    for t in range(20):
        live.pose(motion.rotations[t], motion.root_position[t])
    tasks: dict[str, Callable[[], Any]] = {
        "plain numpy": plain_numpy(model, C),
        "live": lambda: live.pose(motion.rotations[50], root),
        "frame": lambda: poser.frame(row, turn, root, padded, V),
    }
    least = interleaved(tasks, ROUNDS)
    batch = interleaved({"batch": lambda: model.pose(motion)}, 3)["batch"] / motion.n_frames
    n, K = len(model.shares_), model.detail_.n_modes
    base = least["plain numpy"]

    def entry(name: str, what: str, seconds: float, goal: tuple[float, float] | None) -> dict[str, Any]:
        value = f"{1000 * seconds:.3f} ms"
        known = {"name": f"detail/pose/{name}", "what": what, "seconds": seconds, "value": value}
        return {**known, "ratio": seconds / base, "against": "the frame in plain numpy", "goal": goal}

    body = f"{n} vertices, 18 joints, {K} modes, {FRAMES} training frames"
    return [
        entry("frame", f"skin and detail posed, {body}", least["frame"], (0.6, 0.3)),
        entry(
            "live", "the same with joints, history and prediction by regional processes", least["live"], None
        ),
        entry("batch", f"a frame of {motion.n_frames} posed together, prediction included", batch, None),
    ]


if __name__ == "__main__":
    for found in rows():
        print(found["name"], found["value"], f"{found['ratio']:.3f}")
