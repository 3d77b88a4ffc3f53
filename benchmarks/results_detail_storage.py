"""How small a file of learned detail is beside the clip it was learned from, and what it loses.

python benchmarks/results_detail_storage.py [CRANE]     table of docs/results.md; CRANE is a folder
"""

from __future__ import annotations

import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

from results_page import line, table, write_block
from tempose import formats
from tempose.clips import MeshClip
from tempose.detail import DetailModel
from tempose.kinematics.skinning import bake
from tempose.metrics import compare
from tempose.rigging import Rig, fit_rig
from tempose.samples import MOTIONS, human_character, secondary_motion

FRAMES = 400
TOLERANCES = (0.2, 0.1, 0.05)
DATA = Path(__file__).resolve().parents[2] / "shared" / "data" / "vlasic-crane"


def sample() -> tuple[MeshClip, Rig]:
    """The built-in human in a skirt, 400 frames of a walk that turns, on its true skeleton."""
    body = human_character(20_000)
    motion = MOTIONS["human"]["walk"](body.skin.skeleton, fps=30.0, duration=FRAMES / 30, seed=1)
    motion = motion.frames(slice(0, FRAMES))
    V = secondary_motion(body.skin, motion, bake(body.skin, motion), body.regions)
    return MeshClip(V, body.skin.mesh, motion.fps), Rig(body.skin, motion)


def rows(name: str, clip: MeshClip, rig: Rig) -> list[str]:
    raw = clip.vertices.nbytes
    zipped = len(zlib.compress(np.ascontiguousarray(clip.vertices).tobytes(), 9))
    D, found = clip.mesh.diagonal, list[str]()
    for tolerance in TOLERANCES:
        model = DetailModel("regional-gp", folds=0, tolerance=tolerance).fit(clip, rig, [rig.motion])
        with tempfile.TemporaryDirectory() as folder:
            path = model.save(Path(folder) / "model.tempose")
            size, played = path.stat().st_size, DetailModel.load(path)
        skin = compare(clip.vertices, played.pose(strength=0).vertices, D)
        whole = compare(clip.vertices, played.pose().vertices, D)
        cells = [
            f"{name}, {clip.n_frames} frames, {len(clip.rest)} vertices",
            f"{raw / 1e6:.1f} ({100 * zipped / raw:.0f} %)",
            tolerance,
            model.detail_.n_modes,
            f"{size / 1e6:.2f}",
            f"**{100 * size / raw:.1f} %**",
            f"{skin.rms_percent:.3f}",
            f"{whole.rms_percent:.3f}",
            f"{whole.p99_percent:.3f}",
            f"{whole.max_percent:.2f}",
        ]
        found.append(line(*cells))
        print(found[-1], flush=True)
    return found


def main() -> None:
    crane = formats.load(sys.argv[1] if len(sys.argv) > 1 else DATA)
    assert isinstance(crane, MeshClip)
    found = [*rows("crane", crane, fit_rig(crane)), *rows("sample human, walk", *sample())]
    columns = ("clip", "float32, MB (zipped)", "tolerance", "modes", "model, MB", "of the clip")
    errors = ("skin alone, rms", "with detail, rms", "p99", "worst")
    write_block("detail-storage", table([*columns, *errors], found))


if __name__ == "__main__":
    main()
