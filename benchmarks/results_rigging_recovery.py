"""Poses of clips whose bones and weights are known: turns of the joints and distances, in docs/results.md.

python benchmarks/results_rigging_recovery.py
"""

from __future__ import annotations

import time

import numpy as np

from lbs_truth import Truth, angle_errors, truths
from real_bodies import DATA
from results_page import line, table, write_block
from tempose.clips import Skeleton
from tempose.kinematics import bone_transforms
from tempose.rigging.pose_fit import fit_poses

COLUMNS = (
    "clip",
    "frames x vertices",
    "joints",
    "bone lengths",
    "e_rms",
    "joint angles off, median",
    "worst",
    "steps a frame",
    "ms a frame",
)


def row(truth: Truth, skeleton: Skeleton, lengths: str) -> str:
    fit_poses(truth.skin, truth.frames[:2])
    start = time.process_time()
    fit = fit_poses(truth.skin, truth.frames, skeleton=skeleton, tolerance=1e-10)
    seconds = time.process_time() - start
    motion = fit.motion
    turns, _ = bone_transforms(truth.skin.skeleton, motion.rotations, motion.root_position, skeleton)
    degrees = angle_errors(truth, turns)
    T, n = truth.frames.shape[:2]
    e_rms = 1000 * np.sqrt((fit.errors**2).mean() / 3) * 2 / truth.skin.mesh.diagonal
    return line(
        truth.name,
        f"{T} x {n}",
        truth.skin.skeleton.n_joints,
        lengths,
        f"{e_rms:.2g}",
        f"{np.median(degrees):.1g}°",
        f"{degrees.max():.2g}°",
        f"{fit.iterations.mean():.1f}",
        f"{1000 * seconds / T:.2f}",
    )


def main() -> None:
    rows: list[str] = []
    for truth in truths(DATA):
        rows.append(row(truth, truth.posed, "the clip's"))
        if np.abs(truth.posed.offsets[1:] - truth.skin.skeleton.offsets[1:]).max() > 1e-5:
            rows.append(row(truth, truth.skin.skeleton, "the bind pose's"))
    write_block("rigging-recovery-given", table(COLUMNS, rows))
    print("\n".join(rows))


if __name__ == "__main__":
    main()
