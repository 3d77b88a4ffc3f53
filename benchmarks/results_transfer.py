"""Transfer on real clips: every number of docs/results.md, and the contact sheets of docs/gallery.

    python benchmarks/results_transfer.py              all pairs, writes docs/results.md and docs/gallery
    python benchmarks/results_transfer.py walk-makehuman   one pair, prints its row

Real clips are found through TEMPOSE_DATA, else beside the checkout.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.formats import load_clip, load_mesh, load_skeleton_clip, load_skin
from tempose.metrics import compare
from tempose.render import contact_sheet, save_png
from tempose.rotations import multiply
from tempose.transfer import Pairs, TransferResult, load_pairs, transfer_motion
from tempose.transfer.facing import yaw

ROOT = Path(__file__).resolve().parents[1]
DATA = Path(os.environ.get("TEMPOSE_DATA") or ROOT.parent / "shared" / "data")
SHEET_FRAMES = 8

MOTIONS = {
    "walk": ("mocap-cmu/cmu_12_01_walk.bvh", 4),
    "run": ("mocap-cmu/02_03.amc", 4),
    "jump": ("mocap-cmu/02_04.amc", 4),
    "bandai-run": ("mocap-bandai-namco/dataset-1_run_normal_001.bvh", 1),
    "bandai-walk": ("mocap-bandai-namco/dataset-1_walk_normal_001.bvh", 1),
}
BANDAI_REST = "mocap-bandai-namco/dataset-1_bow_normal_001.bvh"
PEOPLE = ("makehuman", "human-male")

# findings/transfer.md section 8, MakeHuman: direction mean / max, edge p1 / p99, worst volume, skate
TARGETS = {
    "walk": {0: "3 / 7 · .85 / 1.15 · -5 · 3", 1: "3 / 7 · .83 / 1.20 · -1.5 · 3"},
    "run": {0: "5 / 9 · .80 / 1.20 · -6 · 5", 1: "5 / 9 · .75 / 1.25 · -2 · 5"},
    "jump": {0: "5 / 9 · .80 / 1.20 · -15 · -", 1: "5 / 9 · .78 / 1.25 · -4 · -"},
}


def motion(name: str) -> SkeletonClip:
    path, step = MOTIONS[name]
    clip = load_skeleton_clip(DATA / path)
    if step == 1:
        return clip
    # frame 0 is kept whatever the step: in the converted CMU files it is the T-pose
    frames = np.r_[0, np.arange(1, clip.n_frames, step)]
    return replace(clip.frames(frames), fps=clip.fps / step)


def person(name: str) -> SkinnedMesh:
    if name == "human-male":
        return load_skin(DATA / "rigged-gltf" / "human-male.glb")
    folder = DATA / "makehuman-base"
    return load_skin(folder / "default_weights.mhw", mesh=load_mesh(folder / "base.obj", group="body"))


def person_pair(clip: str, target: str, volume: float) -> TransferResult:
    rest = load_skeleton_clip(DATA / BANDAI_REST) if clip.startswith("bandai") else None
    frame = 0 if rest else None
    return transfer_motion(motion(clip), person(target), source_rest=rest, rest_frame=frame, volume=volume)


def camel(volume: float) -> TransferResult:
    folder = DATA / "horse-camel-poses"
    return transfer_motion(
        load_clip(DATA / "horse-gallop", fps=24),
        load_mesh(folder / "camel_ref.obj"),
        load_pairs(folder / "horse_camel.cons"),
        source_rest=load_mesh(folder / "horse_ref.obj"),
        volume=volume,
    )


def horse_itself(every_face: bool) -> TransferResult:
    clip = load_clip(DATA / "horse-gallop", fps=24)
    if every_face:
        faces = np.arange(len(clip.faces))
        return transfer_motion(clip, clip.mesh, Pairs("faces", faces, faces))
    marks = np.asarray(load_pairs(DATA / "horse-camel-poses" / "horse_camel.cons").source)
    return transfer_motion(clip, clip.mesh, Pairs("vertices", marks, marks))


PAIRS: dict[str, Callable[[float], TransferResult]] = {
    f"{clip}-{target}": (lambda volume, c=clip, t=target: person_pair(c, t, volume))
    for target in PEOPLE
    for clip in MOTIONS
}
PAIRS["gallop-camel"] = camel


def row(name: str, result: TransferResult, volume: float) -> str:
    r = result.report
    direction = r.get("bone_direction_deg")
    angles = f"{direction['mean']:.1f} / {direction['max']:.1f}" if direction else "-"
    skate = "-" if r["skate"] is None else f"{r['skate']:.1f} ({r['source_skate']:.1f})"
    clip, _, target = name.partition("-makehuman")
    goal = TARGETS.get(clip, {}).get(round(volume), "") if target == "" and name.endswith("makehuman") else ""
    seconds = r["seconds"]
    cells = [
        name,
        f"{volume:g}",
        str(result.clip.n_frames),
        angles,
        f"{r['flipped_percent']:.3f}",
        f"{r['folded_percent']:.3f}",
        f"{r['edge_ratio'][0]:.2f} / {r['edge_ratio'][1]:.2f}",
        f"{r['volume_mean']:.1f} / {r['volume_worst']:.1f}",
        skate,
        f"{r.get('penetration_cm', 0):.1f}",
        f"{r['quaternion_norm_min']:.2f}",
        f"{seconds['set-up']:.1f} + {1000 * seconds['frames'] / result.clip.n_frames:.0f} ms",
        goal,
    ]
    return "| " + " | ".join(cells) + " |"


COLUMNS = (
    "pair",
    "inner edges",
    "frames",
    "direction mean / max °",
    "flipped %",
    "folded %",
    "edges p1 / p99",
    "volume mean / worst %",
    "skate (source's) % H/s",
    "sinks cm",
    "min q",
    "set-up s + a frame",
    "goal: direction · edges · volume · skate",
)
HEAD = "| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS)


def sheet(name: str, result: TransferResult) -> None:
    clips = [result.source, result.clip]
    if name.startswith("gallop"):
        clips = [load_clip(DATA / "horse-gallop", fps=24), result.clip]
    last = 23 if name.startswith("gallop") else result.clip.n_frames - 1
    frames = [int(t) for t in np.linspace(0, last, SHEET_FRAMES)]
    image = contact_sheet([c for c in clips if c is not None], frames=frames, views=("front", "side"))
    save_png(image, ROOT / "docs" / "gallery" / f"transfer-{name}.png")


def centred(V: np.ndarray) -> np.ndarray:
    V = np.asarray(V, dtype=np.float64)
    return V - V.mean(axis=1, keepdims=True)


def identities() -> list[str]:
    """Rest gives rest, a rotated source a rotated target, units do not matter, the gallop onto itself."""
    lines: list[str] = []
    skin = person("makehuman")
    clip = motion("run").frames(np.arange(0, 40, 8))
    plain = transfer_motion(clip, skin)
    lines.append(f"| rest gives rest, makehuman, largest error | {rest_error(skin.mesh):.1e} D | 1e-9 D |")
    turn = yaw(np.radians(70.0))
    rotations = np.array(clip.rotations)
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    from tempose.rotations import rotate

    turned = transfer_motion(
        replace(clip, rotations=rotations, root_position=rotate(turn, clip.root_position)), skin
    )
    difference = centred(turned.clip.vertices) - rotate(turn, centred(plain.clip.vertices))
    lines.append(
        f"| source turned by 70°, run on makehuman | {np.abs(difference).max() / skin.mesh.diagonal:.1e} D |"
        " float32 storage, 1e-6 D |"
    )
    small = scaled(skin, 0.01)
    tiny = transfer_motion(clip, small)
    difference = tiny.clip.vertices * 100.0 - plain.clip.vertices
    lines.append(
        f"| target a hundred times smaller | {np.abs(difference).max() / skin.mesh.diagonal:.1e} D |"
        " float32 storage, 1e-6 D |"
    )
    for every_face, what in ((True, "all 16843 faces"), (False, "107 vertices")):
        result = horse_itself(every_face)
        source = load_clip(DATA / "horse-gallop", fps=24)
        error = compare(centred(source.vertices), centred(result.clip.vertices), source.mesh.diagonal)
        lines.append(
            f"| gallop onto itself, {what} marked | kg {error.kg:.2f} %, rms {error.rms_percent:.2f} % D,"
            f" worst {error.max_percent:.1f} % D | prototype: rms {1.55 if every_face else 3.65} % D |"
        )
    return lines


def rest_error(mesh: Mesh) -> float:
    from tempose.transfer import MotionTransfer

    rng = np.random.default_rng(0)
    faces = rng.choice(len(mesh.faces), 200, replace=False)
    solver = MotionTransfer(mesh, mesh.faces[faces].ravel(), np.repeat(np.arange(200) % 20, 3), 20)
    V = solver.pose(np.tile([1.0, 0, 0, 0], (20, 1)))
    return float(np.abs(V - mesh.vertices).max() / mesh.diagonal)


def scaled(skin: SkinnedMesh, factor: float) -> SkinnedMesh:
    skeleton = replace(
        skin.skeleton, offsets=skin.skeleton.offsets * factor, tips=skin.skeleton.tips * factor
    )
    return SkinnedMesh(skin.mesh.with_vertices(skin.mesh.vertices * factor), skeleton, skin.weights)


def gap_change(result: TransferResult) -> float:
    """Largest change of the gap between linked pieces, percent of D."""
    from tempose.geometry import weld
    from tempose.transfer.links import link_pieces

    mesh = result.clip.mesh
    first, inverse = weld(mesh.vertices)
    pairs = link_pieces(mesh.vertices[first], inverse[mesh.faces]).pairs
    if len(pairs) == 0:
        return 0.0
    i, j = first[pairs[:, 0]], first[pairs[:, 1]]
    rest = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1)
    now = np.linalg.norm(result.clip.vertices[:, i].astype(float) - result.clip.vertices[:, j], axis=2)
    return float(100 * np.abs(now - rest).max() / mesh.diagonal)


def main(names: list[str]) -> None:
    start = time.time()
    chosen = {name: PAIRS[name] for name in names} if names else PAIRS
    rows: list[str] = []
    for name, run in chosen.items():
        for volume in (0.0, 1.0):
            result = run(volume)
            rows.append(row(name, result, volume))
            print(rows[-1], flush=True)
            if name.endswith("human-male"):
                print(f"  gap between pieces changes by at most {gap_change(result):.2f} % D")
            if not names and volume == 0:
                sheet(name, result)
    if names:
        return
    lines = identities()
    print("\n".join(lines))
    write_page(rows, lines)
    print(f"{time.time() - start:.0f} s")


def write_page(rows: list[str], lines: list[str]) -> None:
    page = ROOT / "docs" / "results.md"
    text = page.read_text(encoding="utf-8")
    for mark, block in (
        ("pairs", [HEAD, *rows]),
        ("identities", ["| check | found | asked |\n|---|---|---|", *lines]),
    ):
        begin, end = f"<!-- {mark} -->", f"<!-- /{mark} -->"
        before, _, rest = text.partition(begin)
        text = before + begin + "\n" + "\n".join(block) + "\n" + end + rest.partition(end)[2]
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
