"""Clips and poses for the tests of edits: a tube that bends, and signals of small clips."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from tempose.clips import Mesh, MeshClip
from tempose.signals import SignalModel, Signals


def tube(rings: int = 9, sides: int = 6, bend: tuple[float, float] = (0.0, 0.0), thick: float = 0.2) -> Mesh:
    """A closed tube of unit length along Y, bent about X at its lower and about Z at its upper half."""
    s = np.linspace(0.0, 1.0, rings)
    a, b = bend[0] * np.clip(2 * s, 0, 1), bend[1] * np.clip(2 * s - 1, 0, 1)
    along = np.stack([-np.sin(b), np.cos(b) * np.cos(a), np.sin(a) * np.cos(b)], axis=1)
    middle = np.concatenate([[np.zeros(3)], np.cumsum(0.5 * (along[1:] + along[:-1]), axis=0)]) / (rings - 1)
    x = np.stack([np.cos(b), np.sin(b), 0 * b], axis=1)
    z = np.cross(x, along)
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = thick * (np.cos(angle)[:, None] * x[:, None] + np.sin(angle)[:, None] * z[:, None])
    V = np.concatenate([(middle[:, None] + ring).reshape(-1, 3), middle[[0, -1]]])
    i, j = np.meshgrid(np.arange(rings - 1), np.arange(sides), indexing="ij")
    q = [i * sides + j, i * sides + (j + 1) % sides, (i + 1) * sides + (j + 1) % sides, (i + 1) * sides + j]
    wall = np.concatenate([np.stack([q[0], q[2], q[1]], -1), np.stack([q[0], q[3], q[2]], -1)]).reshape(-1, 3)
    n, k = rings * sides, np.arange(sides)
    caps = [np.stack([np.full(sides, n), k, (k + 1) % sides], -1)]
    top = n - sides
    caps.append(np.stack([np.full(sides, n + 1), top + (k + 1) % sides, top + k], -1))
    return Mesh(V, np.concatenate([wall, *caps]))


def bending(T: int = 24, cycles: float = 1.7, drift: float = 0.0, **shape: float) -> MeshClip:
    """The tube swaying about both axes at speeds that do not repeat; it may travel along X and turn."""
    s = np.arange(T) / T
    bends = np.stack(
        [np.sin(2 * np.pi * cycles * s), 0.9 * np.sin(2 * np.pi * 1.31 * cycles * s + 0.6) + 0.3 * s], axis=1
    )
    meshes = [tube(bend=(a, b), **shape) for a, b in bends]  # type: ignore[arg-type]
    V = np.array([m.vertices for m in meshes])
    turn = drift * s
    R = np.zeros((T, 3, 3))
    R[:, 1, 1] = 1
    R[:, 0, 0], R[:, 2, 2], R[:, 0, 2], R[:, 2, 0] = np.cos(turn), np.cos(turn), np.sin(turn), -np.sin(turn)
    V = V @ R.transpose(0, 2, 1) + drift * s[:, None, None] * np.array([3.0, 0, 0])
    return MeshClip(V.astype(np.float32), meshes[0], 24.0)


def signals_of(clip: MeshClip, space: str = "vertex", **options: object) -> Signals:
    """Signals that pass through every frame."""
    T = clip.n_frames
    fitted = SignalModel(
        space, **{"k": T + 2, "l": T, "m": T - 1, "period": None, "layout": "mds", **options}
    )  # type: ignore[arg-type]
    return fitted.fit(clip).signals_


def played(signals: Signals) -> np.ndarray:
    from tempose.signals.sampling import evaluate

    return evaluate(signals, signals.times, np.float64)


def reach(signals: Signals, control: int) -> np.ndarray:
    """(T,) whether a control has any weight in each frame played."""
    curve = signals.time.curve
    unit = np.zeros(len(curve.controls))
    unit[control] = 1.0
    u = signals.time.pace(signals.ticks(signals.times))
    return BSpline(curve.knots, unit, 3)(np.clip(u, *curve.domain)) != 0
