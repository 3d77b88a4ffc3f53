"""A clip from scratch, as Fig. 8 of the paper: horse poses placed by hand and a drawn curve; docs/results.md.

python benchmarks/results_signals_design.py
"""

from __future__ import annotations

import numpy as np

from real_bodies import DATA
from results_page import PAGE, line, table, write_block
from tempose.clips import MeshClip
from tempose.metrics import edge_ratios, volume_change
from tempose.render import contact_sheet, save_png
from tempose.signals.design import design
from tempose.signals.replace_shape import PoseSet, load_poses
from tempose.signals.sampling import evaluate

PICTURE = PAGE.parent / "gallery" / "signals-design.png"

PLACES = {
    "stand": (9, [0.0, 0.0]),
    "graze": (8, [-1.0, -0.7]),
    "head up": (7, [-0.3, 1.1]),
    "step": (4, [1.2, 0.5]),
    "trot": (5, [1.3, -0.6]),
    "canter": (3, [2.2, -0.1]),
}
"""File of horse-poses, from 0, and where it lies."""

WAY = "stand stand graze graze graze stand head-up head-up stand step trot step trot canter canter".split()


def main() -> None:
    poses = load_poses(["horse-poses"], DATA, "poses")
    files = [file for file, _ in PLACES.values()]
    chosen = PoseSet(poses.vertices[files], poses.mesh)
    places = np.array([place for _, place in PLACES.values()])
    curve = [PLACES[name.replace("-", " ")][1] for name in WAY]
    rows: list[str] = []
    clips: list[MeshClip] = []
    for space in ("vertex", "gradient"):
        signals = design(chosen, places, curve, fps=24, seconds=5, space=space, align=True)
        V = evaluate(signals, signals.times, np.float64)
        clips.append(MeshClip(V, poses.mesh, 24.0))
        edges = edge_ratios(V, poses.mesh.faces, chosen.vertices[0])
        volume = volume_change(V, poses.mesh.faces, chosen.vertices[0])
        off = signals.shape.vertices(signals.pose(places)) - aligned(chosen)
        off -= off.mean(axis=1, keepdims=True)
        rows.append(
            line(
                space,
                len(V),
                f"{100 * np.sqrt(np.square(off).sum(-1).mean()) / poses.mesh.diagonal:.1e}",
                f"{edges.p1:.2f} / {edges.p99:.2f}",
                f"{volume.min():+.1f} .. {volume.max():+.1f}",
            )
        )
    sheet = contact_sheet(clips, frames=12, views=("right",), names=["vertex", "gradient"], cell=190)
    save_png(sheet, PICTURE)
    columns = ("space", "frames", "poses at their places, rms % D", "edges p1 / p99", "volume %")
    write_block("signals-design", [*table(columns, rows), "", "![From scratch](gallery/signals-design.png)"])


def aligned(poses: PoseSet) -> np.ndarray:
    bodies, centre = poses.aligned()
    return bodies + centre


if __name__ == "__main__":
    main()
