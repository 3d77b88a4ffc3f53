"""Learned detail on frames of the crane clip that no learner has seen: bases, learners, baselines.

python benchmarks/results_detail_heldout.py         both tables of docs/results.md
python benchmarks/results_detail_heldout.py print   printed only

Real clips are found through TEMPOSE_DATA, else beside the checkout.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from real_bodies import DATA
from results_page import line, table, write_block
from tempose.clips import MeshClip
from tempose.detail.evaluation import Evaluation, evaluate, rank_correlation
from tempose.detail.inputs import motion_inputs
from tempose.detail.learners import LEARNERS
from tempose.detail.regions import region_grams, region_shares
from tempose.detail.residuals import BASES, Basis, residuals
from tempose.detail.training import Learner, Training
from tempose.formats import load
from tempose.rigging import Rig, fit_rig

Split = list[tuple[np.ndarray, np.ndarray]]
BLOCKS = (0.2, 0.45, 0.7)


@dataclass
class Material:
    training: Training
    D: np.ndarray
    shares: np.ndarray


def splits(T: int) -> dict[str, Split]:
    """The last 30 % from the rest; three interior blocks of 10 %, a frame left out on either side."""
    frames = np.arange(T)
    cut, width = int(0.7 * T), T // 10
    blocks: Split = []
    for begin in (int(T * part) for part in BLOCKS):
        test = frames[begin : begin + width]
        blocks.append((np.r_[frames[: begin - 1], frames[begin + width + 1 :]], test))
    return {"last 30 %": [(frames[:cut], frames[cut:])], "interior": blocks}


def material(rig: Rig, clip: MeshClip, basis: Basis) -> Material:
    D = np.asarray(residuals(rig, rig.motion, clip.vertices, basis))
    shares = region_shares(rig.skin.weights)
    grams, sizes = region_grams(D, shares)
    return Material(Training(motion_inputs(rig.motion), grams, sizes), D, shares)


def pooled(parts: list[Evaluation]) -> tuple[float, float, float, float]:
    """Rms in metres, rank correlation over frames and over frames and regions, calibration."""
    errors, said = (np.concatenate([getattr(p, name) for p in parts]) for name in ("errors", "predicted"))
    regions = [
        np.concatenate([getattr(p, name).ravel() for p in parts])
        for name in ("by_region", "predicted_by_region")
    ]
    rms = float(np.sqrt(np.mean(errors**2)))
    calibration = float(np.sqrt(np.mean(said**2))) / rms
    return rms, rank_correlation(said, errors), rank_correlation(regions[1], regions[0]), calibration


def alone(m: Material, split: Split) -> float:
    test = np.concatenate([test for _, test in split])
    return float(np.sqrt(np.square(m.D[test]).sum(axis=2).mean()))


def bound(m: Material, split: Split) -> float:
    """The mixture of training residuals that is nearest to the truth, found with the truth."""
    squares = 0.0
    for train, test in split:
        mean = m.D[train].mean(axis=0)
        A, B = ((m.D[some] - mean).reshape(len(some), -1).astype(np.float64) for some in (train, test))
        Q, _ = np.linalg.qr(A[:-1].T)
        squares += float(np.square(B).sum() - np.square(B @ Q).sum())
    return float(np.sqrt(squares / (sum(len(test) for _, test in split) * m.D.shape[1])))


def judged(learner: Callable[[], Learner], m: Material, split: Split) -> tuple[list[Evaluation], float]:
    start = time.process_time()
    parts = [evaluate(learner(), m.training, *part, D=m.D, shares=m.shares) for part in split]
    return parts, (time.process_time() - start) / len(split)


def basis_rows(rig: Rig, clip: MeshClip, kinds: dict[str, Split], unit: float) -> list[str]:
    rows: list[str] = []
    for basis in BASES:
        m = material(rig, clip, basis)
        cells: list[str] = []
        for split in kinds.values():
            for name in ("mean", "gp", "regional-gp"):
                rms = pooled(judged(LEARNERS[name], m, split)[0])[0]
                cells.append(f"{unit * rms:.3f} ({rms / alone(m, split):.2f})")
        rows.append(line(basis, *cells))
        print(rows[-1], flush=True)
    return rows


def learner_rows(m: Material, kinds: dict[str, Split], unit: float) -> list[str]:
    rows = [line("none", *_pairs([alone(m, s) for s in kinds.values()], kinds, m, unit), "")]
    plain = {kind: pooled(judged(LEARNERS["gp"], m, split)[0])[0] for kind, split in kinds.items()}
    for name, make in LEARNERS.items():
        cells, seconds = [], 0.0
        for kind, split in kinds.items():
            parts, seconds = judged(make, m, split)
            rms, frames, regions, calibration = pooled(parts)
            cells += [f"{unit * rms:.3f}", f"{rms / alone(m, split):.2f}", f"{rms / plain[kind]:.2f}"]
            cells += [f"{frames:.2f}", f"{regions:.2f}", f"{calibration:.2f}"]
        rows.append(line(name, *cells, f"{seconds:.2f}"))
        print(rows[-1], flush=True)
    least = [bound(m, s) for s in kinds.values()]
    return [*rows, line("bound, found with the truth", *_pairs(least, kinds, m, unit), "")]


def _pairs(rms: list[float], kinds: dict[str, Split], m: Material, unit: float) -> list[str]:
    cells: list[str] = []
    for r, split in zip(rms, kinds.values()):
        cells += [f"{unit * r:.3f}", f"{r / alone(m, split):.2f}", "", "", "", ""]
    return cells


def main() -> None:
    clip = load(DATA / "vlasic-crane")
    rig = fit_rig(clip, frame=10)
    unit = 100 / clip.mesh.diagonal
    kinds = splits(clip.n_frames)
    by_basis = basis_rows(rig, clip, kinds, unit)
    rows = learner_rows(material(rig, clip, "blended"), kinds, unit)
    if sys.argv[1:] == ["print"]:
        return
    columns = [f"{kind}: {name}" for kind in kinds for name in ("mean", "gp", "regional-gp")]
    write_block("detail-bases", table(["basis", *columns], by_basis))
    one = ["rms %", "/ none", "/ gp", "rho", "rho regions", "calibration"]
    columns = [f"{kind}: {name}" if name == one[0] else name for kind in kinds for name in one]
    write_block("detail-heldout", table(["learner", *columns, "processor, s"], rows))


if __name__ == "__main__":
    main()
