"""The skeleton of 18 joints inside the bodies that rigging promises, and the fit of the rig to a capture.

python benchmarks/results_rigging_embedding.py              both tables of docs/results.md
python benchmarks/results_rigging_embedding.py --pictures D   also a picture a body into the folder D

More bodies and poses stand in results_embedding.py. Real ones are found through TEMPOSE_DATA, else beside
the checkout.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from embedding_bodies import CASES, DATA, Case, crane
from results_page import line, table, write_block
from tempose.clips import Mesh
from tempose.formats import load_clip
from tempose.kinematics import rest_transforms
from tempose.render import contact_sheet, save_png
from tempose.rigging import Rig, fit_rig
from tempose.rigging.skeletons import joint_bones
from tempose.rigging.skeletons.inside import joints_outside, mesh_cells
from tempose.samples import human_character

STATURE = {"makehuman": 1.666, "male": 1.830, "sample": 1.750}
NAMES = {
    "MakeHuman body, A-pose": "makehuman",
    "human-male.glb, T-pose": "male",
    "sample human, A-pose": "sample",
    "sample human, T-pose": "sample T-pose",
    "sample human, mid-stride": "sample walk 60",
}
COLUMNS = ("body", "vertices", "inside", "mean %", "median %", "worst %", "worst joint", "penalty", "seconds")
FRAMES = (0, 10, 35, 70, 104, 139, 174)


def low_skirt() -> Case:
    """The sample human so coarse that its skirt joins the legs."""
    skin = human_character(4000).skin
    return skin.mesh, dict(zip(skin.skeleton.names, rest_transforms(skin.skeleton)[1]))


def row(name: str, mesh: Mesh, joints: dict[str, np.ndarray], stature: float) -> tuple[str, Rig]:
    start = time.process_time()
    rig = fit_rig(mesh)
    seconds = time.process_time() - start
    skeleton = rig.skin.skeleton
    inside = 18 - len(joints_outside(skeleton, mesh_cells(mesh).solid))
    P = dict(zip(skeleton.names, rest_transforms(skeleton)[1]))
    away = {n: 100 * float(np.linalg.norm(p - joints[n])) / stature for n, p in P.items() if n in joints}
    cells = ["-"] * 4
    if away:
        worst = max(away, key=lambda n: away[n])
        all_ = list(away.values())
        cells = [f"{np.mean(all_):.1f}", f"{np.median(all_):.1f}", f"{away[worst]:.1f}", worst]
    penalty = f"{rig.report['embedding']['penalty']:.2f}"
    n = len(mesh.vertices)
    return line(name, n, f"{inside} of 18", *cells, penalty, f"{seconds:.1f}"), rig


def picture(rig: Rig, folder: Path, name: str) -> None:
    bones, _ = joint_bones(rig.skin.skeleton)
    views = [contact_sheet(rig.skin.mesh, 1, (v,), cell=(260, 420), lines=bones) for v in ("front", "left")]
    save_png(np.concatenate(views, axis=1), folder / f"{name.replace(' ', '-')}.png")


def bodies(pictures: Path | None) -> list[str]:
    cases = {name: (*CASES[key](), STATURE[key.split()[0]]) for name, key in NAMES.items()}
    cases["sample human, 2000 vertices"] = (*low_skirt(), STATURE["sample"])
    cases["crane, frame 10"] = (crane(10), {}, 1.0)
    fit_rig(cases["MakeHuman body, A-pose"][0])  # compiles
    rows: list[str] = []
    for name, (mesh, joints, stature) in cases.items():
        text, rig = row(name, mesh, joints, stature)
        rows.append(text)
        print(text, flush=True)
        if pictures:
            picture(rig, pictures, name)
    return rows


def bind_frames() -> list[str]:
    """How much the frame matters that becomes the bind pose, before and after joints are moved."""
    clip = load_clip(DATA / "vlasic-crane")
    rows: list[str] = []
    for frame in (None, *FRAMES):
        start = time.process_time()
        rig = fit_rig(clip, frame=frame)
        seconds, rms = time.process_time() - start, rig.report["refined"]["rms_percent"]
        embedding = rig.report["embedding"]
        name = f"chosen: {rig.report['frame']}" if frame is None else str(frame)
        doubt = "doubtful" if embedding["doubtful"] else "sure"
        cells = [f"{rms[0]:.3f}", f"{rms[-1]:.3f}", f"{rig.report['errors']['max_percent']:.2f}"]
        rows.append(line(name, f"{embedding['penalty']:.2f}", doubt, *cells, f"{seconds:.1f}"))
        print(rows[-1], flush=True)
    return rows


def main() -> None:
    pictures = Path(sys.argv[2]) if sys.argv[1:2] == ["--pictures"] else None
    write_block("rigging-embedding", table(COLUMNS, bodies(pictures)))
    columns = ("bind frame", "penalty", "embedding", "rms % D", "joints moved", "worst vertex % D", "seconds")
    write_block("rigging-frames", table(columns, bind_frames()))


if __name__ == "__main__":
    main()
