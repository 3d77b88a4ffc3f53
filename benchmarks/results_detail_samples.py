"""A skirt whose true swing is known: whether learned detail is late when the skirt is.

python benchmarks/results_detail_samples.py         table of docs/results.md
python benchmarks/results_detail_samples.py print   printed only

The built-in human moves on its true skeleton. Played eight times as slow, its skirt hangs where the pose
alone puts it; what the swing adds to that at full speed is the late part, known for every frame.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace

import numpy as np

from results_page import line, table, write_block
from tempose.clips.resample import select_frames
from tempose.detail.evaluation import mixed_residuals
from tempose.detail.inputs import joined_inputs, motion_inputs
from tempose.detail.learners import LEARNERS
from tempose.detail.regions import region_grams, region_shares
from tempose.detail.residuals import residuals
from tempose.detail.training import Inputs, Training
from tempose.kinematics.skinning import bake
from tempose.rigging import Rig
from tempose.samples import MOTIONS, human_character, secondary_motion

FPS, SLOWER, TRIANGLES = 30.0, 8, 8_000
BODY = human_character(TRIANGLES)
SKIRT = BODY.regions["skirt"] > 0.5


@dataclass
class Take:
    inputs: Inputs
    D: np.ndarray
    """(T, n, 3) residuals at full speed."""
    hanging: np.ndarray
    """(T, k, 3) of the skirt, played slowly."""


def take(motion: str, speed: float | None, duration: float, chain: int) -> Take:
    dense = MOTIONS["human"][motion](
        BODY.skin.skeleton, fps=FPS * SLOWER, duration=duration, speed=speed, seed=1
    )
    clip = select_frames(dense, step=SLOWER)
    rig = Rig(BODY.skin, clip)
    slowly = replace(dense, fps=FPS)
    V = secondary_motion(BODY.skin, slowly, bake(BODY.skin, slowly), BODY.regions)[::SLOWER]
    hanging = np.asarray(residuals(rig, clip, V))[:, SKIRT]
    V = secondary_motion(BODY.skin, clip, bake(BODY.skin, clip), BODY.regions)
    return Take(motion_inputs(clip, chain=chain), np.asarray(residuals(rig, clip, V)), hanging)


def correlation(A: np.ndarray, B: np.ndarray) -> float:
    A, B = A - A.mean(axis=0), B - B.mean(axis=0)
    return float((A * B).sum() / np.sqrt(np.square(A).sum() * np.square(B).sum() + 1e-30))


def rows(title: str, takes: list[Take], train: np.ndarray, test: np.ndarray) -> list[str]:
    D, hanging = (np.concatenate([getattr(t, name) for t in takes]) for name in ("D", "hanging"))
    shares = region_shares(BODY.skin.weights)
    grams, sizes = region_grams(D, shares)
    training = Training(joined_inputs([t.inputs for t in takes]), grams, sizes)
    late = D[test][:, SKIRT] - hanging[test]
    unit = 1000 * np.sqrt(np.square(late).sum(axis=2).mean())
    print(title, f"{len(train)} frames, {len(test)} held out, late part {unit:.1f} mm", flush=True)
    found: list[str] = []
    for name, make in LEARNERS.items():
        mixture = make().fit(training.take(train)).mix(training.inputs)
        kept = replace(mixture, weights=mixture.weights[:, test])
        P = mixed_residuals(D[train], shares, kept)
        all_of_it = np.linalg.norm(P - D[test]) / np.linalg.norm(D[test])
        said = P[:, SKIRT] - hanging[test]
        size = np.linalg.norm(said - said.mean(axis=0)) / np.linalg.norm(late - late.mean(axis=0))
        wrong = np.linalg.norm(said - late) / np.linalg.norm(late)
        cells = [f"{all_of_it:.3f}", f"{correlation(said, late):.3f}", f"{size:.2f}", f"{wrong:.2f}"]
        found.append(line(title, f"{unit:.1f}", name, *cells))
        print(found[-1], flush=True)
    return found


def cases() -> dict[str, tuple[list[tuple[str, float | None, float]], int]]:
    """Motions in order, and how many of them are learned from; 0 for the first 70 % of one."""
    walks = [("walk", speed, 4.0) for speed in (0.8, 1.2, 1.6)]
    runs = [("run", speed, 3.0) for speed in (2.5, 3.5)]
    return {
        "walk, last 30 %": ([("walk", None, 8.0)], 0),
        "walks at 0.8, 1.2, 1.6 m/s -> 1.0, 1.4": ([*walks, ("walk", 1.0, 4.0), ("walk", 1.4, 4.0)], 3),
        "walks, runs at 2.5, 3.5 m/s -> run at 3.0": ([*walks, *runs, ("run", 3.0, 3.0)], 5),
    }


def main() -> None:
    lines: list[str] = []
    for title, (motions, learned) in cases().items():
        takes = [take(*motion, chain) for chain, motion in enumerate(motions)]
        lengths = [len(t.inputs) for t in takes]
        cut = sum(lengths[:learned]) if learned else int(0.7 * lengths[0])
        frames = np.arange(sum(lengths))
        lines += rows(title, takes, frames[:cut], frames[cut:])
    if sys.argv[1:] != ["print"]:
        columns = ["learned -> held out", "late part, mm", "learner", "error / none"]
        columns += ["late part: correlation", "size", "error"]
        write_block("detail-samples", table(columns, lines))


if __name__ == "__main__":
    main()
