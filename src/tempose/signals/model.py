"""The signals of a clip as an estimator: fit, play, edit, save."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import MeshClip
from tempose.clips.source import Source
from tempose.signals.fit.clip import fit_clip
from tempose.signals.fit.options import FitOptions
from tempose.signals.report.report import fit_report
from tempose.signals.room import check_room
from tempose.signals.sampling import sample, sample_blocks
from tempose.signals.saving.model_file import read_signal_model, write_signal_model
from tempose.signals.signals import Signals
from tempose.typing import FloatArray, IntArray, Progress, silent


class SignalModel:
    """A clip as a continuous function of time, ``psi = h o g o f`` of [1]_.

    Parameters
    ----------
    space : str, default "vertex"
        Shape space, a name of `tempose.shape_spaces.SPACES`.
    tolerance : float, optional
        Largest rms error at the frames, percent of the diagonal of the rest mesh, from which those of `k`,
        `l` and `m` are chosen that are not given. 0.5 if left out, less for a clip that hardly moves.
    k : int, optional
        Control points of the time signal, from 4 to T + 2 for a clip of T frames.
    l : int, optional
        Sites of the pose signal, from 3 to T.
    m : int, optional
        Modes of the shape signal, from 0 to T - 1. ``k - 2 = l = m + 1 = T`` gives every frame back.
    between : str, default "path"
        What is played between frames: ``"path"`` the cubic in time through the shape coordinates, plus what
        edits change of ``g(f(t))``; ``"paper"`` g(f(t)) alone; ``"dense"`` the same with g fitted to quarter
        frames.
    layout : str, default "auto"
        Where the frames lie in the pose plane: ``"auto"`` looks for a layout without bad transitions,
        ``"mds"`` is multidimensional scaling as in the paper.
    placement : bool, default False
        Whether where the body is and which way it turns is split off as a fourth signal.
    period : float, "auto" or None
        Frames after which a cyclic clip repeats; ``"auto"`` looks for them.
    window : int, default 300
        Clips of more frames get pose signals of so many frames each, joined smoothly.

    Attributes
    ----------
    signals_ : Signals
        What is played; edits replace it.
    report_ : dict
        Errors, their budget over h, g and f, seconds of every stage, warnings: what JSON can hold.
    positions_ : (T, 2) ndarray
        Where the frames of the fitted clip lie in the pose plane.
    site_frames_ : (l,) ndarray of int
        The frames at whose places the sites of g stand.
    edits_ : tuple of dict
        Operations applied since the fit, the first first.
    source_ : Source
        What the file of the clip said.

    References
    ----------
    .. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with
       separate signals for time, pose and shape", Computer Graphics Forum 31, 2012.
    """

    signals_: Signals
    report_: dict[str, Any]
    positions_: FloatArray
    site_frames_: IntArray
    edits_: tuple[dict[str, Any], ...]
    source_: Source

    def __init__(
        self,
        space: str = "vertex",
        *,
        tolerance: float | None = None,
        k: int | None = None,
        l: int | None = None,
        m: int | None = None,
        between: str = "path",
        layout: str = "auto",
        placement: bool = False,
        period: float | str | None = "auto",
        window: int = 300,
    ) -> None:
        self.space, self.tolerance, self.k, self.l, self.m = space, tolerance, k, l, m
        self.between, self.layout, self.placement = between, layout, placement
        self.period, self.window = period, window

    @property
    def options(self) -> FitOptions:
        """The arguments of the constructor, checked.

        Raises
        ------
        ValueError
            If one is out of its range.
        """
        names = FitOptions.__dataclass_fields__
        return FitOptions(**{name: getattr(self, name) for name in names})

    def fit(
        self,
        clip: MeshClip,
        pins: Mapping[int, Any] | None = None,
        examples: Any = None,
        progress: Progress = silent,
    ) -> SignalModel:
        """Fit the signals of a clip.

        Parameters
        ----------
        clip : MeshClip
            T >= 2 frames. One that does not move becomes a constant.
        pins : mapping of int to (x, y), optional
            Places of frames in the pose plane, frame numbers 0-based; the others are laid out around them.
        examples : (m + 1, n, 3) float or sequence of Mesh, optional
            Poses that span the shape signal instead of principal components, the reference pose first
            (section 4.3 of the paper).
        progress : Progress, optional
            Told which stage is at work.

        Returns
        -------
        SignalModel
            This model; unchanged if an error is raised.

        Raises
        ------
        ValueError
            If the clip is too short, or an option, a pin or an example does not suit it.
        """
        options = self.options
        fitted = fit_clip(clip, options, pins, examples, progress)
        report = fit_report(clip, fitted, options, progress)
        self.signals_, self.report_ = fitted.signals, report
        self.positions_, self.site_frames_ = fitted.positions, fitted.site_frames
        self.edits_, self.source_ = (), clip.source
        return self

    def __call__(self, t: FloatArray | float, dtype: Any = np.float32) -> FloatArray:
        """Evaluate psi.

        Parameters
        ----------
        t : (...) float
            Seconds of what is played; before the start and after the end the end poses hold.
        dtype : dtype, default float32
            Of the result.

        Returns
        -------
        (..., n, 3) ndarray
            Vertices, metres.

        Raises
        ------
        ValueError
            If a time is not finite.
        """
        return sample(self._fitted(), np.asarray(t, dtype=np.float64), dtype=dtype)

    def sample(
        self,
        times: FloatArray | None = None,
        fps: float | None = None,
        *,
        out: Any = None,
        dtype: Any = np.float32,
    ) -> FloatArray:
        """Evaluate psi at many times.

        Parameters
        ----------
        times : (K,) float, optional
            Seconds; without them the frames played at `fps`.
        fps : float, optional
            Frames per second; those of the model without it.
        out : (K, n, 3) array, optional
            Where to write, such as a memory map.
        dtype : dtype, default float32
            Of the result, where `out` is not given.

        Returns
        -------
        (K, n, 3) ndarray
            Vertices, metres; `out` where it is given.

        Raises
        ------
        ValueError
            If a time is not finite, `fps` is not positive, `out` has another shape, or the result is larger
            than memory.
        """
        return sample(self._fitted(), self.frame_times(fps) if times is None else times, out, dtype)

    def sample_blocks(self, times: FloatArray, dtype: Any = np.float32) -> Any:
        """Evaluate psi at more times than fit into memory.

        Parameters
        ----------
        times : (K,) float
            Seconds.
        dtype : dtype, default float32
            Of the vertices.

        Returns
        -------
        iterator of (slice, (k, n, 3) ndarray)
            Which of the times, and the vertices there.
        """
        return sample_blocks(self._fitted(), np.asarray(times, dtype=np.float64), dtype)

    def frame_times(self, fps: float | None = None) -> FloatArray:
        """Return the seconds of the frames that are played.

        Parameters
        ----------
        fps : float, optional
            Frames per second; those of the model without it.

        Returns
        -------
        (K,) ndarray
            From 0 on: twice the rate gives ``2 (T - 1) + 1`` frames.

        Raises
        ------
        ValueError
            If `fps` is not positive, or so high that memory cannot hold the times.
        """
        signals = self._fitted()
        if fps is None:
            return signals.times
        if not 0 < fps < float("inf"):
            raise ValueError(f"fps must be positive, got {fps}")
        check_room(8e-9 * signals.duration * fps, f"times at fps = {fps:.6g}", "give a lower fps")
        return replace(signals, fps=float(fps)).times

    def clip(self, fps: float | None = None, times: FloatArray | None = None, *, out: Any = None) -> MeshClip:
        """Play the model into a clip.

        Parameters
        ----------
        fps : float, optional
            Frames per second of the clip; those of the model without it.
        times : (K,) float, optional
            Seconds of the model that its frames show; without them one after another at `fps`.
        out : (K, n, 3) float32 array, optional
            Holds the frames, such as a memory map.

        Returns
        -------
        MeshClip
            With the topology, UVs and groups of the mesh that was fitted.
        """
        rate = self._fitted().fps if fps is None else float(fps)
        vertices = self.sample(times, fps, out=out)
        return MeshClip(vertices, self.signals_.mesh, rate, self.source_)

    def pose_at(self, p: FloatArray, frame: float | None = None, dtype: Any = np.float32) -> FloatArray:
        """Return the meshes at places of the pose plane, ``h(g(p))``.

        Parameters
        ----------
        p : (..., 2) float
            Places.
        frame : float, optional
            Frame of the fitted clip near which to look, for a long clip whose pose signal is made of windows.
        dtype : dtype, default float32
            Of the result.

        Returns
        -------
        (..., n, 3) ndarray
            Vertices, metres, about the body's own origin if the placement was split off.
        """
        signals, p = self._fitted(), np.asarray(p, dtype=np.float64)
        origin = None if frame is None else np.full(p.shape[:-1], float(frame))
        return signals.shape.vertices(signals.pose(p, origin)).astype(dtype, copy=False)

    def edited(
        self, operations: Sequence[Mapping[str, Any]], folder: str | os.PathLike[str] | None = None
    ) -> SignalModel:
        """Apply edits; leaving out the last one undoes it.

        Parameters
        ----------
        operations : sequence of mapping
            As in an edit list: ``{"op": "move", "control": 12, "by": [x, y]}``...
        folder : path-like, optional
            Where relative file names in the operations begin.

        Returns
        -------
        SignalModel
            A new model; this one stays as it is. ``report_["edit_notes"]`` holds what a person should know
            of what was done.

        Raises
        ------
        ValueError
            If an operation does not exist or names what does not exist.
        """
        from tempose.signals.edits import apply_edits

        notes: list[str] = []
        place = None if folder is None else Path(folder)
        signals = apply_edits(self._fitted(), operations, place, notes)
        report = {**self.report_, "edit_notes": notes}
        return self._with(signals, (*self.edits_, *(dict(o) for o in operations)), report)

    @classmethod
    def from_signals(cls, signals: Signals) -> SignalModel:
        """Make a model of signals that no clip was fitted for, such as a design.

        Parameters
        ----------
        signals : Signals
            What is played.

        Returns
        -------
        SignalModel
            Its report holds the numbers k, l, m and d only.
        """
        k, l, m = len(signals.time.curve.controls), len(signals.pose.sites), len(signals.shape.components)
        space = signals.shape.space
        model = cls(space.name)
        model.signals_, model.edits_, model.source_ = signals, (), Source()
        model.report_ = {"k": k, "l": l, "m": m, "dimension": space.dimension, "warnings": []}
        model.positions_, model.site_frames_ = np.array(signals.pose.sites), np.zeros(0, np.int64)
        return model

    def _with(
        self, signals: Signals, edits: tuple[dict[str, Any], ...], report: dict[str, Any]
    ) -> SignalModel:
        model = SignalModel(**asdict(self.options))
        model.signals_, model.report_, model.edits_ = signals, report, edits
        model.positions_, model.site_frames_ = self.positions_, self.site_frames_
        model.source_ = self.source_
        return model

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the model to a file.

        Parameters
        ----------
        path : path-like
            By custom ``NAME.tempose``.

        Returns
        -------
        Path
            The file; `load` gives back a model that plays bit for bit alike.

        Raises
        ------
        OSError
            If the place cannot be written.
        """
        self._fitted()
        return write_signal_model(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> SignalModel:
        """Read a model from a file.

        Parameters
        ----------
        path : path-like
            As `save` wrote it.

        Returns
        -------
        SignalModel
            The fitted model.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If it is cut short, no model of signals, or of a newer version; the message names it.
        """
        options, state = read_signal_model(path)
        model = cls(**options)
        for name, value in state.items():
            setattr(model, name, value)
        return model

    def _fitted(self) -> Signals:
        if not hasattr(self, "signals_"):
            raise ValueError("the model has no signals yet: call fit(clip), or load a file")
        return self.signals_
