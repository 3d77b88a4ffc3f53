"""A rig goes to Blender, an arm is turned there, it comes back, and the clip changes there and nowhere else.

Run by ``make test-interop``, which keeps Blender's Python in a folder of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tempose import formats
from tempose.clips import MeshClip, SkeletonClip
from tempose.detail import DetailModel
from tempose.formats.glb_layout import lay_out
from tempose.kinematics import forward_kinematics
from tempose.metrics import compare
from tempose.rigging import Rig
from tempose.rigging.export import export_rig
from tempose.rigging.motions import matched_motion
from tempose.rotations import angle_between, conjugate, multiply
from tempose.samples import human_character, sample_clip
from tempose.samples.motions import find_motion

pytestmark = pytest.mark.interop

ROOT = Path(__file__).resolve().parents[2]
_MEMORY = 12
EDITED, DEGREES, JOINT, FRAMES = range(12, 19), 40.0, "left_upper_arm", 36
LOOKS = (0, FRAMES // 2, FRAMES - 1)


@pytest.fixture(scope="module")
def blender() -> str:
    given = os.environ.get("TEMPOSE_BLENDER")
    python = Path(given) if given else ROOT / ".venv-blender" / "bin" / "python"
    if not python.is_file():
        message = "no Blender: run `make test-interop`, or set TEMPOSE_BLENDER to a Python that has bpy"
        pytest.fail(message) if given else pytest.skip(message)
    return str(python)


@pytest.fixture(scope="module")
def learned() -> tuple[Rig, DetailModel]:
    """A human who runs in a skirt: true skeleton, detail learned from the clip."""
    options = {"fps": 30.0, "duration": FRAMES / 30.0}
    skin = human_character(3000).skin
    motion = find_motion("human", "run")(skin.skeleton, **options)
    motion = SkeletonClip(motion.skeleton, motion.rotations, motion.root_position, motion.fps, "run")
    clip = sample_clip("human", "run", triangles=3000, secondary=True, **options)
    rig = Rig(skin, motion.frames(slice(0, FRAMES)))
    clip = MeshClip(clip.vertices[:FRAMES], clip.mesh, clip.fps)
    return rig, DetailModel().fit(clip, rig, [rig.motion])


@dataclass(frozen=True)
class Trip:
    """What came back from Blender."""

    seen: np.ndarray | None
    """(3, n, 3) vertices as Blender showed them."""
    motion: SkeletonClip
    """The edited motion on the joints of the rig."""
    warnings: tuple[str, ...]
    """What matching it had to say."""


@pytest.fixture(scope="module", params=["bvh", "glb", "usda", "usdc"])
def trip(request, blender, learned, tmp_path_factory) -> Trip:
    rig, folder, ending = learned[0], tmp_path_factory.mktemp(request.param), request.param
    if ending.startswith("usd"):
        pytest.importorskip("pxr")
    out, edited, points = folder / f"rig.{ending}", folder / f"edited.{ending}", folder / "seen.npz"
    export_rig(rig, out)
    order = {"open": str(out), "fps": rig.motion.fps, "save": str(edited), "count": FRAMES}
    order |= {"joint": JOINT, "frames": list(EDITED), "degrees": DEGREES}
    if ending != "bvh":
        order |= {"points": str(points), "look": LOOKS}
    script = Path(__file__).with_name("blender_edit.py")
    run = subprocess.run([blender, str(script), json.dumps(order)], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr[-2000:]
    result = matched_motion(rig.skin.skeleton, formats.load_skeleton_clip(edited))
    seen = np.load(points)["vertices"] if points.exists() else None
    return Trip(seen, result.motion, result.warnings)


def other_frames(history: int = 0) -> np.ndarray:
    kept = np.ones(FRAMES, dtype=bool)
    kept[EDITED.start : EDITED.stop + history] = False
    return kept


def test_blender_shows_the_vertices_of_the_rig(trip, learned):
    if trip.seen is None:
        pytest.skip("a BVH holds no vertices")
    rig = learned[0]
    seen, ours = trip.seen, rig.vertices()[list(LOOKS)]
    if len(seen[0]) != len(ours[0]):
        # glTF splits vertices at seams of the texture
        ours = ours[:, lay_out(rig.skin.mesh).vertex_of]
    assert seen.shape == ours.shape
    assert np.abs(seen - ours).max() < 1e-5 * rig.skin.mesh.diagonal


def test_the_motion_comes_back_with_its_frames_and_without_guesses(trip, learned):
    motion = learned[0].motion
    assert trip.motion.n_frames == motion.n_frames and abs(trip.motion.fps - motion.fps) < 1e-3
    assert not [line for line in trip.warnings if "other axes" not in line]


def test_the_arm_turned_by_the_angle_and_no_other_joint_did(trip, learned):
    motion = learned[0].motion
    before, after = motion.rotations, trip.motion.rotations
    angle = np.degrees(angle_between(before, after))
    arm = motion.skeleton.index(JOINT)
    np.testing.assert_allclose(angle[list(EDITED), arm], DEGREES, atol=0.01)
    angle[list(EDITED), arm] = 0
    assert angle.max() < 0.01
    np.testing.assert_allclose(trip.motion.root_position, motion.root_position, atol=1e-5)
    worlds = [forward_kinematics(m.skeleton, m.rotations, m.root_position)[0] for m in (motion, trip.motion)]
    hand = motion.skeleton.index("left_hand")
    turned = np.degrees(angle_between(multiply(conjugate(worlds[0]), worlds[1]), np.array([1.0, 0, 0, 0])))
    np.testing.assert_allclose(turned[list(EDITED), hand], DEGREES, atol=0.02)


def test_the_skin_changes_on_the_arm_in_those_frames_only(trip, learned):
    rig = learned[0]
    D = rig.skin.mesh.diagonal
    moved = np.linalg.norm(rig.vertices(trip.motion) - rig.vertices(), axis=2) / D
    assert moved[other_frames()].max() < 1e-5
    arm = _below(rig, JOINT)
    free = rig.skin.weights[:, arm].sum(axis=1) == 0
    assert free.any() and moved[list(EDITED)][:, free].max() < 1e-5
    held = rig.skin.weights[:, rig.skin.skeleton.index("left_hand")] > 0.9
    assert moved[list(EDITED)][:, held].min() > 0.05


def test_the_detail_follows(trip, learned):
    rig, model = learned
    D = rig.skin.mesh.diagonal
    before, after = model.pose(), model.pose(trip.motion)
    moved = np.linalg.norm(after.vertices - before.vertices, axis=2) / D
    # detail listens to speeds, and some learners to those of some frames ago
    kept = other_frames(history=_MEMORY)
    assert kept.sum() > _MEMORY and moved[kept].max() < 1e-4
    # a runner's arms always go with the legs, so the skirt listens to them a little: far less than it swings
    free = rig.skin.weights[:, _below(rig, JOINT)].sum(axis=1) == 0
    swing = np.linalg.norm(before.vertices - rig.vertices(), axis=2)[:, free] / D
    elsewhere = moved[list(EDITED)][:, free]
    assert np.sqrt((elsewhere**2).mean()) < 0.2 * np.sqrt((swing**2).mean())
    assert elsewhere.max() < 0.25 * swing.max()
    held = rig.skin.weights[:, rig.skin.skeleton.index("left_hand")] > 0.9
    assert moved[list(EDITED)][:, held].min() > 0.05
    # the detail itself is there: with it the unedited frames are nearer to the clip than the skin alone
    clip = sample_clip("human", "run", triangles=3000, fps=30.0, duration=FRAMES / 30.0).vertices[:FRAMES]
    with_detail = compare(clip[kept], after.vertices[kept], D).rms
    assert with_detail < 0.5 * compare(clip[kept], rig.vertices(trip.motion)[kept], D).rms


def _below(rig: Rig, joint: str) -> list[int]:
    below = [rig.skin.skeleton.index(joint)]
    for j, parent in enumerate(rig.skin.skeleton.parents):
        if int(parent) in below:
            below.append(j)
    return below
