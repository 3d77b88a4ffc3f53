"""Fig. 7 of the paper: the horse's gallop on the elephant through pairs of poses, for docs/results.md.

python benchmarks/results_signals_elephant.py
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from real_bodies import DATA
from results_page import PAGE, line, table, write_block
from tempose.clips import MeshClip
from tempose.formats import load_clip
from tempose.metrics import edge_ratios, volume_change
from tempose.render import contact_sheet, save_png
from tempose.rotations import procrustes_rotation
from tempose.signals import SignalModel
from tempose.signals.replace_shape import PoseSet, load_poses, replace_shape
from tempose.signals.sampling import evaluate
from tempose.typing import FloatArray, IntArray

PICTURE = PAGE.parent / "gallery" / "signals-elephant.png"

COLUMNS = ("space", "pairs", "multiples", "not shown", "frame 1", "frame 2", "edges p1 / p99", "volume %")

PROTOTYPE = {
    ("vertex", 8): "3.10 / 3.21",
    ("vertex", 10): "3.03 / 2.91",
    ("gradient", 8): "2.65 / 2.56",
    ("gradient", 10): "2.88 / 2.53",
}


@dataclass
class Elephant:
    poses: PoseSet
    truth: FloatArray

    @property
    def faces(self) -> IntArray:
        return self.poses.mesh.faces

    def errors(self, V: FloatArray) -> list[float]:
        """Rms percent of D of the first two frames against the true ones, after rigid alignment."""
        found: list[float] = []
        for mine, true in zip(V, self.truth):
            R = procrustes_rotation(mine, true)
            off = (mine - mine.mean(axis=0)) @ R.T - (true - true.mean(axis=0))
            found.append(100 * float(np.sqrt(np.square(off).sum(axis=1).mean())) / self.poses.mesh.diagonal)
        return found

    def shape(self, V: FloatArray) -> tuple[str, str]:
        """Edge ratios of the clip and volume of its first two frames against the reference pose."""
        rest = self.poses.mesh.vertices
        edges = edge_ratios(V, self.faces, rest)
        volume = volume_change(V[:2], self.faces, rest)
        return f"{edges.p1:.2f} / {edges.p99:.2f}", f"{volume[0]:+.1f}, {volume[1]:+.1f}"


def main() -> None:
    gallop = load_clip(DATA / "horse-gallop", fps=24)
    stride = MeshClip(gallop.vertices[:24], gallop.mesh, gallop.fps)
    horse = load_poses(["horse-poses"], DATA, "source")
    elephant = Elephant(
        load_poses(["elephant-poses"], DATA, "target"),
        load_poses(["elephant-gallop-2frames"], DATA, "truth").vertices,
    )
    rows: list[str] = []
    shown = {"horse": stride}
    for space in ("vertex", "gradient"):
        model = SignalModel(space, k=16, l=12, m=23).fit(stride)
        for use in (8, 10):
            for regions in (0, None):
                result = replace_shape(model.signals_, horse, elephant.poses, use=use, regions=regions)
                V = evaluate(result.signals, result.signals.times, np.float64)
                rows.append(row(space, use, result, V, elephant))
                if use == 8:
                    name = f"{space}, {'whole' if regions == 0 else 'by regions'}"
                    shown[name] = MeshClip(V, elephant.poses.mesh, stride.fps)
    rows.append(line("the true frames", "", "", "", "0", "0", *elephant.shape(elephant.truth)))
    bodies, _ = elephant.poses.aligned()
    near = np.array([elephant.errors(np.stack([body, body])) for body in bodies])
    best = [f"{value:.2f}" for value in near.min(axis=0)]
    rows.append(line("nearest single pose", "1", "", "", *best, "", ""))
    picture(shown, PICTURE)
    write_block("signals-elephant", [*table(COLUMNS, rows), "", "![Gallop](gallery/signals-elephant.png)"])


def row(space: str, use: int, result: object, V: FloatArray, elephant: Elephant) -> str:
    mixtures, local = result.mixtures, result.local  # type: ignore[attr-defined]
    errors = [f"{value:.2f}" for value in elephant.errors(V)]
    shown = f"{mixtures.residual:.2f}"
    if local is not None:
        shown = f"pair left out: {local.error:.2f} of {local.plain:.2f}"
    known = PROTOTYPE.get((space, use)) if local is None else None
    how = (
        "one set (paper)" if local is None else f"by {len(local.weights)} regions, power {local.sharpness:g}"
    )
    return line(
        space,
        use,
        how + (f"; prototype {known}" if known else ""),
        shown,
        *errors,
        *elephant.shape(V),
    )


def picture(clips: dict[str, MeshClip], path: Path) -> None:
    sheet = contact_sheet(
        list(clips.values()), frames=[0, 4, 8, 12, 16, 20], views=("right",), names=list(clips), cell=230
    )
    save_png(sheet, path)


if __name__ == "__main__":
    main()
