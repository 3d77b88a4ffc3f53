"""One decomposition by py-dem-bones: run by a Python that has it, see results_rigging_decomposition.py."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import numpy as np


def settings(solver: Any, fair: bool) -> Any:
    if fair:
        solver.weightsSmooth = 0
        solver.transAffine = 0
    return solver


def main() -> None:
    from py_dem_bones import DemBones
    from py_dem_bones.portable import solve_skinning

    path, bones, fair = sys.argv[1], int(sys.argv[2]), sys.argv[3] == "fair"
    clip = np.load(path)
    solver = settings(DemBones(), fair)
    start, cpu = time.perf_counter(), time.process_time()
    solve_skinning(clip["rest"], clip["frames"], bones, faces=clip["faces"], iterations=30, solver=solver)
    seconds, cpu = time.perf_counter() - start, time.process_time() - cpu
    T = len(clip["frames"])
    motions = np.asarray(solver.m).reshape(T, 4, solver.nB, 4).transpose(0, 2, 1, 3)[:, :, :3]
    out = sys.argv[4]
    np.savez(out, weights=np.asarray(solver.get_weights()).T, motions=motions)
    print(json.dumps({"seconds": seconds, "cpu": cpu, "bones": int(solver.nB)}))


if __name__ == "__main__":
    main()
