"""Identities of the transfer: the second table of docs/results.md.

python benchmarks/results_identities.py
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from real_bodies import DATA, motion, person
from results_page import table, write_block
from tempose.clips import Mesh, SkinnedMesh
from tempose.formats import load_clip
from tempose.metrics import compare
from tempose.rotations import multiply, rotate
from tempose.transfer import MotionTransfer, Pairs, TransferResult, load_pairs, transfer_motion
from tempose.transfer.bodies.facing import yaw


def horse_itself(every_face: bool) -> TransferResult:
    clip = load_clip(DATA / "horse-gallop", fps=24)
    if every_face:
        faces = np.arange(len(clip.faces))
        return transfer_motion(clip, clip.mesh, Pairs("faces", faces, faces))
    marks = np.asarray(load_pairs(DATA / "horse-camel-poses" / "horse_camel.cons").source)
    return transfer_motion(clip, clip.mesh, Pairs("vertices", marks, marks))


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


if __name__ == "__main__":
    checks = identities()
    print("\n".join(checks))
    write_block("identities", table(("check", "found", "asked"), checks))
