"""Skinning decomposition beside py-dem-bones, in one run.

python benchmarks/results_rigging_decomposition.py           the table of docs/results.md
python benchmarks/results_rigging_decomposition.py gallop    clips whose name holds the word, printed

py-dem-bones stays out of our own environment. Once: ``python -m venv .venv-dembones`` and
``.venv-dembones/bin/pip install py-dem-bones``; another Python that has it is named by DEMBONES_PYTHON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from real_bodies import DATA
from results_page import line, table, write_block
from tempose import formats
from tempose.metrics import ClipErrors, compare
from tempose.rigging.decomposition import decompose

ROOT = Path(__file__).resolve().parents[1]
CASES = (("horse-gallop", (10, 20, 30)), ("horse-poses", (10, 20)))
COLUMNS = (
    "clip",
    "bones",
    "ours: e_rms",
    "kg %",
    "worst % D",
    "seconds",
    "fair: e_rms",
    "seconds",
    "default: e_rms",
    "seconds",
    "ours / fair: e_rms",
    "seconds",
)


def frames_of(name: str) -> tuple[np.ndarray, np.ndarray]:
    files = sorted((DATA / name).glob("*.obj"), key=lambda p: int(p.stem))
    meshes = [formats.load_mesh(p) for p in files]
    return np.stack([m.vertices for m in meshes]), np.asarray(meshes[0].faces)


def peer(folder: Path, frames: np.ndarray, faces: np.ndarray, bones: int, how: str) -> dict[str, Any]:
    python = os.environ.get("DEMBONES_PYTHON", str(ROOT / ".venv-dembones" / "bin" / "python"))
    clip, out = folder / "clip.npz", folder / "bones.npz"
    np.savez(clip, rest=frames[0], frames=frames, faces=faces)
    script = str(Path(__file__).with_name("dem_bones_peer.py"))
    command = [python, script, str(clip), str(bones), how, str(out)]
    answer = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    found = np.load(out)
    u1 = np.column_stack([frames[0], np.ones(len(frames[0]))])
    V = np.einsum("nb,np,tbrp->tnr", found["weights"], u1, found["motions"], optimize=True)
    return {**answer, "errors": errors(frames, V)}


def errors(frames: np.ndarray, V: np.ndarray) -> ClipErrors:
    return compare(frames, V, float(np.linalg.norm(np.ptp(frames[0], axis=0))))


def ours(frames: np.ndarray, bones: int) -> dict[str, Any]:
    cpu = time.process_time()
    found = decompose(frames, frames[0], bones=bones)
    cpu = time.process_time() - cpu
    assert (found.weights > 0).sum(axis=1).max() <= 4
    return {"cpu": cpu, "errors": errors(frames, found.vertices()), "bones": found.n_bones}


def short(found: dict[str, Any], bones: int) -> str:
    fewer = f" ({found['bones']} bones)" if found["bones"] != bones else ""
    return f"{found['errors'].e_rms:.3f}{fewer}"


def row(name: str, bones: int, frames: np.ndarray, faces: np.ndarray) -> str:
    with tempfile.TemporaryDirectory() as folder:
        fair = peer(Path(folder), frames, faces, bones, "fair")
        mine = ours(frames, bones)
        default = peer(Path(folder), frames, faces, bones, "default")
    e = mine["errors"]
    cells = [name, bones, short(mine, bones), f"{e.kg:.3f}", f"{e.max_percent:.2f}", f"{mine['cpu']:.1f}"]
    cells += [short(fair, bones), f"{fair['cpu']:.1f}", short(default, bones), f"{default['cpu']:.1f}"]
    return line(*cells, f"{e.e_rms / fair['errors'].e_rms:.2f}", f"{mine['cpu'] / fair['cpu']:.2f}")


def main() -> None:
    word = sys.argv[1] if len(sys.argv) > 1 else ""
    rows: list[str] = []
    for name, counts in CASES:
        if word in name:
            frames, faces = frames_of(name)
            decompose(frames[:3], frames[0], bones=3, iterations=1)  # compiles
            for bones in counts:
                rows.append(row(name, bones, frames, faces))
                print(rows[-1], flush=True)
    if not word:
        write_block("rigging-decomposition", table(COLUMNS, rows))


if __name__ == "__main__":
    main()
