"""The pictures of docs/rigging.md and docs/detail.md: python benchmarks/pictures_detail.py [NAME...]

Reads vlasic-crane from TEMPOSE_DATA, or where `tempose data fetch` put it; the rest is built in.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import tempose
from real_bodies import DATA
from tempose.clips import MeshClip, SkeletonClip
from tempose.detail import DetailModel
from tempose.detail.fitting import training_inputs
from tempose.detail.pictures import (
    draw_heldout,
    draw_latent,
    edit_sheet,
    latent_plane,
    skin_clip,
    variance_sheet,
)
from tempose.kinematics import forward_kinematics, rest_motion
from tempose.render import contact_sheet, save_png
from tempose.render.drawing import save_drawing
from tempose.rigging import Rig, fit_rig
from tempose.rigging.pictures import bone_lines, weight_colors
from tempose.rigging.pictures.plot import rest_clip
from tempose.rigging.pictures.views import abreast, body_views
from tempose.rotations import conjugate, from_rotation_vector, multiply

GALLERY = Path(__file__).resolve().parents[1] / "docs" / "gallery"
CELL = 190


def save(name: str, picture: Any) -> None:
    save_png(picture, GALLERY / f"{name}.png")
    print(f"{name}.png", flush=True)


@cache
def crane() -> tuple[MeshClip, Rig, DetailModel]:
    clip = tempose.formats.load_clip(DATA / "vlasic-crane")
    rig = fit_rig(clip)
    return clip, rig, DetailModel("regional-gp").fit(clip, rig)


def pointed(motion: SkeletonClip, joint: str, child: str, way: Any, amount: Any) -> SkeletonClip:
    """Turn the bone from a joint to its child towards a direction of the world, part of the way."""
    skeleton = motion.skeleton
    j, k = skeleton.index(joint), skeleton.index(child)
    world, places = forward_kinematics(skeleton, motion.rotations, motion.root_position)
    bone = places[:, k] - places[:, j]
    bone /= np.linalg.norm(bone, axis=1, keepdims=True)
    way = np.asarray(way, dtype=float) / np.linalg.norm(way)
    axis = np.cross(bone, way)
    size = np.linalg.norm(axis, axis=1, keepdims=True)
    angle = np.arctan2(size, (bone * way).sum(axis=1, keepdims=True))
    turn = from_rotation_vector(axis / np.maximum(size, 1e-9) * angle * np.asarray(amount)[:, None])
    rotations = np.array(motion.rotations)
    rotations[:, j] = multiply(conjugate(world[:, skeleton.parents[j]]), multiply(turn, world[:, j]))
    return replace(motion, rotations=rotations)


def ramp(count: int, start: int, stop: int, ease: int = 15) -> np.ndarray:
    t = np.arange(count)
    part = np.clip(np.minimum((t - start) / ease, (stop - t) / ease), 0.0, 1.0)
    return part * part * (3 - 2 * part)


def rig_pictures() -> None:
    _, rig, _ = crane()
    names, at_rest = ("front", "side", "back"), rest_motion(rig.skin.skeleton)
    look: dict[str, Any] = {"views": body_views(at_rest, names), "cell": 300}
    one = abreast(rest_clip(rig), 1, names, segments=bone_lines(at_rest), **look)
    colors = weight_colors(rig.skin.weights, rig.skin.skeleton)
    two = abreast(rest_clip(rig), 1, names, colors=colors, **look)
    save("rig-crane", np.concatenate([one, two], axis=1))


def arm_raised() -> None:
    _, _, model = crane()
    motion = model.rig_.motion
    T = motion.n_frames
    up = pointed(motion, "right_upper_arm", "right_forearm", [0.0, 1.0, 0.25], ramp(T, 30, 150))
    edited = pointed(up, "right_forearm", "right_hand", [0.0, 1.0, 0.1], ramp(T, 30, 150))
    frames = [15, 40, 60, 80, 100, 130]
    before, after = model.pose(motion), model.pose(edited)
    save("detail-edit", edit_sheet(before, after, motion, edited, frames, cell=CELL))
    save("detail-variance", variance_sheet(after, model.variance(edited), edited, frames, cell=CELL))


def charts() -> None:
    _, _, model = crane()
    chains = training_inputs(model.motions_).chains
    D = model.rig_.skin.mesh.diagonal
    drawing = draw_heldout(model.report_["heldout"], "regional-gp", D, chains)
    save_drawing(drawing, GALLERY / "detail-heldout.png", 1.25)
    print("detail-heldout.png", flush=True)
    clip, rig, _ = crane()
    other = DetailModel("gplvm", folds=0).fit(clip, rig)
    sizes = 3 * other.shares_.sum(axis=0)
    plane = latent_plane(other.predictor_, training_inputs(other.motions_), sizes)
    save_drawing(draw_latent(plane), GALLERY / "detail-latent.png", 1.25)
    print("detail-latent.png", flush=True)


def skirt() -> None:
    """Walks teach the skirt; a run, never seen, is posed with it."""
    body = tempose.samples.human_character(8000)
    walks = [walk(speed, True) for speed in (0.9, 1.2, 1.5)]
    motions = [walk_motion(body.skin.skeleton, speed) for speed in (0.9, 1.2, 1.5)]
    rig = Rig(body.skin, motions[0])
    model = DetailModel("regional-gp", folds=0).fit(walks, rig, motions)
    other, truth = walk_motion(body.skin.skeleton, 1.35), walk(1.35, True)
    shown = [skin_clip(rig, other), model.pose(other), truth]
    frames = [20, 24, 28, 32, 36, 40]
    names = ["skin alone", "with detail", "truth"]
    views = ("three-quarter",)
    save("detail-skirt", contact_sheet(shown, frames, views, cell=CELL, names=names, track=True))


def walk_motion(skeleton: Any, speed: float) -> SkeletonClip:
    return tempose.samples.MOTIONS["human"]["walk"](skeleton, duration=2.0, fps=30.0, speed=speed)


def walk(speed: float, secondary: bool) -> MeshClip:
    return tempose.samples.sample_clip(
        "human", "walk", triangles=8000, duration=2.0, fps=30.0, speed=speed, secondary=secondary
    )


def proportions() -> None:
    _, _, model = crane()
    longer = {"thigh": 1.25, "shin": 1.25}
    stout = {"spine": {"length": 0.9, "thickness": 1.2}, "upper_arm": 0.85, "forearm": 0.85, "thigh": 0.85}
    stout |= {"shin": 0.8}
    shown = [model.pose(), model.pose(proportions=longer), model.pose(proportions=stout)]
    views = body_views(model.rig_.motion, ("front",), 40)
    names = ["captured proportions", "longer legs", "short and stout"]
    sheet = contact_sheet(shown, [15, 40, 75, 100, 130, 160], views, cell=CELL, names=names, track=True)
    save("detail-proportions", sheet)


PICTURES: dict[str, Callable[[], None]] = {
    "rig": rig_pictures,
    "edit": arm_raised,
    "charts": charts,
    "skirt": skirt,
    "proportions": proportions,
}


def main() -> None:
    GALLERY.mkdir(exist_ok=True)
    for name in sys.argv[1:] or PICTURES:
        PICTURES[name]()


if __name__ == "__main__":
    main()
