"""A clip becomes signals: the stages of section 3 of the paper, in their order."""

from __future__ import annotations

import time
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tempose._validate import as_floats
from tempose.clips import Mesh, MeshClip
from tempose.shape_spaces import ShapeSpace, VertexSpace, shape_space
from tempose.signals import _standin
from tempose.signals.fidelity import POSE_SHARE, SHAPE_SHARE, choose_controls, choose_sites
from tempose.signals.options import FitOptions, check_pins
from tempose.signals.pose.signal import PoseSignal
from tempose.signals.shape.fit import FittedShape, Percent, fit_examples, fit_shape, rescaled
from tempose.signals.signals import Signals
from tempose.signals.still import still_signals
from tempose.signals.time.signal import TimeSignal
from tempose.typing import FloatArray, IntArray, Progress, silent


@dataclass(frozen=True, eq=False)
class FittedClip:
    """Signals of a clip, and what led to them."""

    signals: Signals
    """h, g, f and the time spline."""
    shape: FittedShape
    """What h leaves out."""
    positions: FloatArray
    """(T, 2) places of the frames in the pose plane."""
    site_frames: IntArray
    """(l,) frames at whose places the sites of g stand."""
    diagonal: float
    """D, metres."""
    seconds: dict[str, float]
    """Of every stage."""
    warnings: list[str] = field(default_factory=list[str])
    """Sentences for a person."""
    facts: dict[str, Any] = field(default_factory=dict[str, Any])
    """What else the stages found: the layout's name, the period."""


def fit_clip(
    clip: MeshClip,
    options: FitOptions,
    pins: Mapping[int, Any] | None = None,
    examples: Any = None,
    progress: Progress = silent,
) -> FittedClip:
    """Fit signals to a clip.

    Parameters
    ----------
    clip : MeshClip
        T frames, 2 or more.
    options : FitOptions
        Checked options.
    pins : mapping of int to (x, y), optional
        Places of frames in the pose plane.
    examples : (m + 1, n, 3) float or sequence of Mesh, optional
        Poses that span the shape signal instead of principal components.
    progress : Progress, optional
        Told which stage is at work.

    Returns
    -------
    FittedClip
        The signals.

    Raises
    ------
    ValueError
        If the clip is too short, or k, l, m, a pin or the examples do not suit it.
    """
    T = clip.n_frames
    Q = example_vertices(examples, clip.mesh)
    options.check_frames(T, None if Q is None else len(Q) - 1)
    pins = check_pins(pins, T)
    fit = _Fit(clip, options, pins, progress)
    with fit.stage("encode"):
        space, Z = fit.encoded(Q)
    with fit.stage("shape"):
        shape = fit.shaped(space, Z, Q)
    if shape.X.shape[1] == 0:
        return fit.still(shape)
    with fit.stage("layout"):
        P = fit.laid_out(shape)
    with fit.stage("pose"):
        pose, sites = fit.posed(P, shape)
    with fit.stage("time"):
        f = fit.timed(P, pose, shape)
        path = _standin.path(shape.X) if options.between == "path" else None
    signals = Signals(shape.shape, _unturned(pose, shape), f, path, None, (), clip.fps, clip.fps, clip.mesh)
    return FittedClip(signals, shape, P, sites, fit.diagonal, fit.seconds, fit.warnings, fit.facts)


class _Fit:
    """One fit on its way: what every stage reads, and the notes it leaves."""

    def __init__(
        self, clip: MeshClip, options: FitOptions, pins: dict[int, FloatArray], progress: Progress
    ) -> None:
        self.clip, self.options, self.pins, self.progress = clip, options, pins, progress
        self.V: FloatArray = np.asarray(clip.vertices, dtype=np.float64)
        self.diagonal = clip_diagonal(clip)
        self.unit = 100.0 / (self.diagonal * np.sqrt(self.V.shape[0] * max(self.V.shape[1], 1)))
        self.limit = options.percent
        self.seconds: dict[str, float] = {}
        self.warnings: list[str] = []
        self.facts: dict[str, Any] = {}

    @contextmanager
    def stage(self, name: str) -> Generator[None, None, None]:
        self.progress(len(self.seconds), 5, name)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start

    def encoded(self, Q: FloatArray | None) -> tuple[ShapeSpace, FloatArray]:
        frames = self.V if Q is None else np.concatenate([self.V, Q])
        space = shape_space(self.options.space, self.clip.rest, self.clip.faces, frames)
        return space, space.encode_path(self.V)

    def shaped(self, space: ShapeSpace, Z: FloatArray, Q: FloatArray | None) -> FittedShape:
        check = None if isinstance(space, VertexSpace) else self.percent(space)
        if Q is None:
            m = self.options.m
            if m is None and self.options.tolerance is None:
                self.limit = min(self.limit, 0.05 * self.motion())
            fitted = fit_shape(space, Z, m, SHAPE_SHARE * self.limit, self.unit, check)
            if m is not None and fitted.X.shape[1] < m:
                self.warnings.append(f"m {m} was asked for; the frames span {fitted.X.shape[1]} dimensions")
            return fitted
        fitted = fit_examples(space, Z, space.encode(Q), self.unit)
        return fitted if check is None else rescaled(fitted, check)

    def motion(self) -> float:
        """Rms percent of the diagonal by which vertices move about their means."""
        return self.unit * float(np.linalg.norm(self.V - self.V.mean(axis=0)))

    def percent(self, space: ShapeSpace) -> Percent:
        def measure(Z: FloatArray, frames: IntArray) -> float:
            off = space.decode(Z) - self.V[frames]
            return 100.0 / self.diagonal * float(np.sqrt(np.square(off).sum() / (off.size / 3)))

        return measure

    def still(self, shape: FittedShape) -> FittedClip:
        """One pose for the whole clip: it does not move, or by less than the tolerance."""
        left = float(shape.percent(shape.left_out.sum()))
        if left > 0:
            self.warnings.append(
                f"the motion is {left:.3g} % of the diagonal, within the tolerance: one pose stands for all"
            )
        signals = still_signals(shape.shape, self.clip.n_frames, self.clip.fps, self.clip.mesh)
        P, sites = np.zeros((self.clip.n_frames, 2)), np.zeros(0, np.int64)
        return FittedClip(signals, shape, P, sites, self.diagonal, self.seconds, self.warnings, self.facts)

    def laid_out(self, shape: FittedShape) -> FloatArray:
        return _standin.layout(shape.straight, {k: (p[0], p[1]) for k, p in self.pins.items()})

    def posed(self, P: FloatArray, shape: FittedShape) -> tuple[PoseSignal, IntArray]:
        order = _standin.Order(P, shape.straight)
        l = self.options.l
        if l is None:
            l = choose_sites(order.errors, self.base(shape), self.allowed(shape, POSE_SHARE))
        return order.signal(l), np.unique(np.linspace(0, len(P) - 1, l).round().astype(int))

    def timed(self, P: FloatArray, pose: PoseSignal, shape: FittedShape) -> TimeSignal:
        X, base, T = shape.straight, self.base(shape), len(P)
        k = self.options.k

        def error(k: int) -> float:
            f = _standin.fit_time(P, k)
            return base + float(np.square(pose(f(np.arange(T))) - X).sum())

        if k is None:
            k, _ = choose_controls(error, T, self.allowed(shape, 1.0), self.progress)
        return _standin.fit_time(P, k)

    def base(self, shape: FittedShape) -> float:
        """Squared sum that h leaves out; examples are chosen by the user, so g and f are judged without."""
        return float(shape.left_out.sum()) if shape.turn is None else 0.0

    def allowed(self, shape: FittedShape, share: float) -> float:
        """Largest squared sum in the shape space for a share of the tolerance."""
        return (share * self.limit / shape.scale) ** 2 if shape.scale > 0 else np.inf


def _unturned(pose: PoseSignal, shape: FittedShape) -> PoseSignal:
    """Take a pose signal fitted in an orthonormal basis to the shape coordinates."""
    if shape.turn is None:
        return pose
    back = np.linalg.inv(shape.turn)
    return PoseSignal(pose.sites, pose.weights @ back, pose.affine @ back, pose.centre, pose.radius)


def clip_diagonal(clip: MeshClip) -> float:
    """Return the D of tolerances.

    Parameters
    ----------
    clip : MeshClip
        Any clip.

    Returns
    -------
    float
        Metres: of the rest mesh, of all frames where that is a point, 1 where those are too.
    """
    extent = np.ptp(np.asarray(clip.vertices).reshape(-1, 3), axis=0) if clip.vertices.size else np.zeros(3)
    return clip.mesh.diagonal or float(np.linalg.norm(extent)) or 1.0


def example_vertices(examples: Any, mesh: Mesh) -> FloatArray | None:
    """Check example poses.

    Parameters
    ----------
    examples : (e, n, 3) float, sequence of Mesh, or None
        Poses of the mesh.
    mesh : Mesh
        The mesh of the clip.

    Returns
    -------
    (e, n, 3) ndarray or None
        Their vertices.

    Raises
    ------
    ValueError
        If there are fewer than two, or one has another number of vertices.
    """
    if examples is None:
        return None
    n = len(mesh.vertices)
    rows = [e.vertices if isinstance(e, Mesh) else e for e in examples]
    Q = [as_floats(row, f"examples[{i}]", (n, 3)) for i, row in enumerate(rows)]
    if len(Q) < 2:
        raise ValueError(f"examples must hold two poses or more, got {len(Q)}")
    return np.stack(Q)
