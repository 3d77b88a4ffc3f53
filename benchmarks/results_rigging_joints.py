"""Joints of crane's skeleton moved to where the clip turns about them: the skin alone, and with detail.

python benchmarks/results_rigging_joints.py
"""

from __future__ import annotations

import numpy as np

from real_bodies import DATA
from results_page import line, table, write_block
from tempose.detail.evaluation import evaluate
from tempose.detail.inputs import motion_inputs
from tempose.detail.learners import LEARNERS
from tempose.detail.regions import region_grams
from tempose.detail.residuals import residuals
from tempose.detail.training import Training
from tempose.formats import load_clip
from tempose.rigging import Rig
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.refine import refine_joints
from tempose.rigging.skeletons.human import human_skin

LEARNED = ("mean", "gp", "regional-gp")
COLUMNS = ("rounds", "solved on", "farthest joint", "all frames", "worst frame", "last 30 %", *LEARNED)
TRAIN = 0.7


def main() -> None:
    clip = load_clip(DATA / "vlasic-crane")
    V = np.asarray(clip.vertices)
    skin = human_skin(clip.mesh.with_vertices(V[10].astype(np.float64))).skin
    percent = 100 / skin.mesh.diagonal
    cut = int(TRAIN * len(V))
    train, test = np.arange(cut), np.arange(cut, len(V))
    rows: list[str] = []
    for rounds, frames, name in ((0, V, "-"), (3, V, "all"), (3, V[:cut], "first 70 %"), (10, V, "all")):
        found = refine_joints(skin, None, frames, rounds=rounds)
        fit = fit_poses(found.skin, V)
        D = residuals(Rig(found.skin, fit.motion), fit.motion, V)
        training = Training(motion_inputs(fit.motion), *region_grams(D, skin.weights))
        rms = [fit.errors, fit.errors[fit.errors.argmax()], fit.errors[test]]
        shown = [f"{percent * np.sqrt(np.mean(e**2)):.3f}" for e in rms]
        sums = [f"{percent * evaluate(LEARNERS[k](), training, train, test).rms:.3f}" for k in LEARNED]
        rows.append(line(rounds, name, f"{percent * found.moved.max():.1f}", *shown, *sums))
        print(rows[-1], flush=True)
    write_block("rigging-joints", table(COLUMNS, rows))


if __name__ == "__main__":
    main()
