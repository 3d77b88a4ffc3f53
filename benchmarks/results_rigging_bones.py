"""Skeletons from frames alone: against the truth where it is known, and for animals.

python benchmarks/results_rigging_bones.py           both tables of docs/results.md
python benchmarks/results_rigging_bones.py FOLDER    the same, and pictures of the animals
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy.optimize import linear_sum_assignment

from lbs_truth import Truth, truths
from real_bodies import DATA
from results_page import line, table, write_block
from tempose import formats
from tempose.clips import MeshClip
from tempose.metrics import compare
from tempose.rigging import Rig
from tempose.rigging.decomposition import Decomposition, decompose
from tempose.rigging.joints import auto_skin, settle, skeleton_from_bones
from tempose.rigging.pose_fit import fit_poses
from tempose.rotations import angle_between

TRUTH_COLUMNS = (
    "clip",
    "frames",
    "vertices",
    "true bones",
    "bones, influences",
    "e_rms free",
    "e_rms skeleton",
    "joints held in the mesh",
    "weights apart %",
    "turns apart median °",
    "seconds",
)
ANIMAL_COLUMNS = ("clip", "frames", "vertices", "bones", "e_rms free", "e_rms skeleton", "rms % D", "seconds")
SETTINGS = {
    "cheburashka": ((11, 4), (11, 11), (16, 8)),
    "usd-skel/lbs": ((3, 4),),
    "CesiumMan": ((19, 4), (24, 4)),
}


def apart(truth: Truth, found: Decomposition) -> tuple[float, float]:
    """Percent of the weight that lies on other bones, and the median turn between matched bones."""
    W = truth.skin.weights
    holds = np.flatnonzero(W.sum(axis=0) > 1e-6 * len(W))
    away = np.abs(W[:, holds, None] - found.weights[:, None, :]).sum(axis=0)
    true, mine = linear_sum_assignment(away)
    rest = len(W) - np.minimum(W[:, holds[true]], found.weights[:, mine]).sum()
    turns = angle_between(truth.turns[:, holds[true]], found.rotations[:, mine])
    return 100 * rest / len(W), float(np.degrees(np.median(turns)))


def truth_row(truth: Truth, bones: int, influences: int) -> str:
    rest, D = truth.skin.mesh.vertices, truth.skin.mesh.diagonal
    cpu = time.process_time()
    found = decompose(truth.frames, rest, bones=bones, influences=influences, iterations=60)
    skeleton, weights, motion = skeleton_from_bones(found, truth.skin.mesh.faces)
    joined = [
        settle(rest, skeleton, weights, motion, truth.frames, influences, pull=pull) for pull in (1e-3, 0.02)
    ]
    cpu = time.process_time() - cpu
    cells = [compare(truth.frames, V, D).e_rms for V in (found.vertices(), *(j.vertices for j in joined))]
    weights_apart, turns_apart = apart(truth, found)
    holds = int((truth.skin.weights.sum(axis=0) > 1e-6 * len(rest)).sum())
    T, n = truth.frames.shape[:2]
    return line(
        *(truth.name, T, n, holds, f"{bones}, {influences}", *(f"{e:.3f}" for e in cells)),
        *(f"{weights_apart:.1f}", f"{turns_apart:.2f}", f"{cpu:.1f}"),
    )


def sequence(name: str) -> MeshClip:
    files = sorted((DATA / name).glob("*.obj"), key=lambda p: int(p.stem))
    meshes = [formats.load_mesh(p) for p in files]
    return MeshClip(np.stack([m.vertices for m in meshes]).astype(np.float32), meshes[0], 24)


def animals() -> dict[str, MeshClip]:
    horse = formats.load_clip(DATA / "rigged-gltf" / "horse-animations.glb")
    return {
        "horse gallop": sequence("horse-gallop"),
        "horse poses": sequence("horse-poses"),
        "elephant poses": sequence("elephant-poses"),
        "horse-animations.glb": horse,
    }


def animal_row(name: str, clip: MeshClip, folder: Path | None) -> str:
    cpu = time.process_time()
    skin, report = auto_skin(clip)
    motion = fit_poses(skin, clip.vertices, fps=clip.fps).motion
    cpu = time.process_time() - cpu
    rig = Rig(skin, motion)
    e = compare(clip.vertices, rig.vertices(), clip.mesh.diagonal)
    if folder is not None:
        from tempose.render import save_png
        from tempose.rigging.pictures.plot import rig_sheet

        folder.mkdir(exist_ok=True)
        sheet = rig_sheet(rig, clip, frames=4, views=("side", "front"), cell=300)
        save_png(sheet, folder / f"{name.replace(' ', '-')}.png")
    cells = (name, clip.n_frames, len(clip.rest), report["bones"], f"{report['e_rms_free']:.2f}")
    return line(*cells, f"{e.e_rms:.2f}", f"{e.rms_percent:.2f}", f"{cpu:.1f}")


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    rows: list[str] = []
    for truth in truths(DATA):
        for bones, influences in SETTINGS[truth.name]:
            rows.append(truth_row(truth, bones, influences))
            print(rows[-1], flush=True)
    write_block("rigging-bones", table(TRUTH_COLUMNS, rows))
    rows = []
    for name, clip in animals().items():
        rows.append(animal_row(name, clip, folder))
        print(rows[-1], flush=True)
    write_block("rigging-animals", table(ANIMAL_COLUMNS, rows))


if __name__ == "__main__":
    main()
