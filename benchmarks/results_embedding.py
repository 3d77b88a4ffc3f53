"""Embedded joints against true ones, humans against animals.

python benchmarks/results_embedding.py            both tables of docs/results.md
python benchmarks/results_embedding.py makehuman  cases whose name begins so, printed

Real bodies are found through TEMPOSE_DATA, else beside the checkout.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from embedding_bodies import CASES, Case, crane, others
from results_page import line, table, write_block
from tempose.clips import Mesh
from tempose.embedding import Embedding, embed_skeleton

STATURE = {"makehuman": 1.666, "male": 1.830, "sample": 1.750, "cesium": 1.507}
COLUMNS = ("body", "median %", "worst %", "worst joint", "sides", "penalty", "up", "reading", "seconds")


def seconds_of(mesh: Mesh) -> tuple[Embedding, float]:
    start = time.process_time()
    embedding = embed_skeleton(mesh)
    return embedding, time.process_time() - start


def sides_right(e: Embedding, joints: dict[str, np.ndarray]) -> bool:
    """Whether every joint of a pair lies nearer to its own true place than to that of the other side."""
    found = dict(zip(e.names, e.joints))
    for name in (n for n in found if n.startswith("left_") and n in joints):
        other = name.replace("left_", "right_")
        own = np.linalg.norm(found[name] - joints[name]) + np.linalg.norm(found[other] - joints[other])
        swapped = np.linalg.norm(found[name] - joints[other]) + np.linalg.norm(found[other] - joints[name])
        if swapped < own:
            return False
    return True


def row(name: str, case: Case) -> str:
    mesh, joints = case
    e, seconds = seconds_of(mesh)
    stature = STATURE[name.split()[0]] * (100 if "cm" in name else 1)
    away = {
        n: 100 * np.linalg.norm(p - joints[n]) / stature for n, p in zip(e.names, e.joints) if n in joints
    }
    worst = max(away, key=lambda n: away[n])
    cells = [
        name,
        f"{np.median(list(away.values())):.1f}",
        f"{away[worst]:.1f}",
        worst,
        "right" if sides_right(e, joints) else "exchanged",
        f"{e.penalty:.2f}" + (" doubtful" if e.doubtful else ""),
        e.up,
        e.report["reading"],
        f"{seconds:.1f}",
    ]
    return line(*cells)


def doubt_row(name: str, mesh: Mesh) -> str:
    e, seconds = seconds_of(mesh)
    reason = e.reasons[0].split(";")[0] if e.reasons else ""
    answer = "doubtful" if e.doubtful else "human"
    return line(name, f"{e.penalty:.2f}", answer, reason, f"{seconds:.1f}")


def main() -> None:
    start = sys.argv[1] if len(sys.argv) > 1 else ""
    embed_skeleton(CASES["makehuman"]()[0])  # compiles
    rows: list[str] = []
    for name, make in CASES.items():
        if name.startswith(start):
            rows.append(row(name, make()))
            print(rows[-1], flush=True)
    if start:
        return
    doubts: list[str] = []
    meshes = {f"crane {t}": crane(t) for t in range(0, 175, 40)} | others()
    for name, mesh in meshes.items():
        doubts.append(doubt_row(name, mesh))
        print(doubts[-1], flush=True)
    write_block("embedding", table(COLUMNS, rows))
    write_block("doubt", table(("mesh", "penalty", "answer", "reason", "seconds"), doubts))


if __name__ == "__main__":
    main()
