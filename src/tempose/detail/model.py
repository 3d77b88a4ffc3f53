"""Learned detail as an estimator: fit, pose, save."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tempose.clips import MeshClip, SkeletonClip
from tempose.detail.basis import DetailBasis
from tempose.detail.checks import check_clips, check_options
from tempose.detail.edits import damped, region_strengths, size_ratio, vertex_mask
from tempose.detail.fitting import at_one_rate, gather, training_inputs
from tempose.detail.learners import LEARNERS
from tempose.detail.multiresolution import CoarseBasis
from tempose.detail.posing import DetailPoser
from tempose.detail.posing.live import LivePoser
from tempose.detail.prediction import coefficients, nearest_distances, usual_distance, variances
from tempose.detail.query import Query, make_query
from tempose.detail.report import fit_report, held_out
from tempose.detail.residuals import Basis
from tempose.detail.saving.model_file import read_detail_model, write_detail_model
from tempose.detail.training import Inputs, Learner, Predictor
from tempose.rigging import Rig
from tempose.rigging.proportions import change_proportions
from tempose.typing import FloatArray, Progress, silent


class DetailModel:
    """Learn from clips what a skeleton alone does not carry: cloth, flesh, folds.

    Parameters
    ----------
    learner : str or Learner, default "auto"
        A name of `tempose.detail.LEARNERS`, or a learner of one's own; ``"auto"`` takes the one that predicts
        parts of the clips best that are left out, and the mean residual where none beats it.
    basis : {"blended", "root", "world"}, default "blended"
        In which residuals are kept: the blended rotation of each vertex, that of the root, or none as in the
        paper.
    tolerance : float, default 0.1
        What the modes may lose, rms over vertices and frames in percent of the diagonal of the bind pose.
    resolution : float, optional
        Percentage of the vertices that are learned from, as in section 6 of [1]_; all of them where left out.
    folds : int, default 5
        Parts of the clips that are left out in turn to compare learners; 0 compares none.

    Attributes
    ----------
    rig_ : Rig
        The rig in the digits that a file keeps, with the motion of the first clip.
    motions_ : tuple of SkeletonClip
        Motion of every clip that was learned from.
    detail_ : DetailBasis
        Residuals of the training in few modes.
    coarse_ : CoarseBasis or None
        The same on the vertices of `resolution`, which a file keeps instead.
    shares_ : (n, R) ndarray
        Share of every vertex in every region; the regions are the joints.
    predictor_ : Predictor
        The fitted learner.
    report_ : dict
        Errors, table of parts left out, seconds, warnings: what JSON can hold.

    References
    ----------
    .. [1] de Aguiar and Ukita, "Representing mesh-based character animations", Computers & Graphics 38,
       2014.
    """

    rig_: Rig
    motions_: tuple[SkeletonClip, ...]
    detail_: DetailBasis
    coarse_: CoarseBasis | None
    shares_: FloatArray
    predictor_: Predictor
    report_: dict[str, Any]

    def __init__(
        self,
        learner: str | Learner = "auto",
        basis: Basis = "blended",
        *,
        tolerance: float = 0.1,
        resolution: float | None = None,
        folds: int = 5,
    ) -> None:
        self.learner, self.tolerance = learner, tolerance
        self.basis: Basis = basis
        self.resolution, self.folds = resolution, folds

    def fit(
        self,
        clips: MeshClip | Sequence[MeshClip],
        rig: Rig,
        motions: Sequence[SkeletonClip] | None = None,
        progress: Progress = silent,
    ) -> DetailModel:
        """Learn from one clip or several.

        Parameters
        ----------
        clips : MeshClip or sequence of MeshClip
            Of the mesh of the rig.
        rig : Rig
            Skin and skeleton.
        motions : sequence of SkeletonClip, optional
            Motion of the skeleton in every clip; found by `tempose.rigging.fit_poses` where left out.
        progress : Progress, optional
            Told which stage is at work.

        Returns
        -------
        DetailModel
            This model; unchanged if an error is raised.

        Raises
        ------
        ValueError
            If an option is out of range, or clips, rig and motions do not belong together.
        """
        began = time.perf_counter()
        check_options(self, LEARNERS)
        clips = [clips] if isinstance(clips, MeshClip) else list(clips)
        check_clips(clips, rig, motions)
        clips, motions = at_one_rate(clips, motions)
        gathered = gather(clips, rig, motions, self.basis, self.tolerance, self.resolution, progress)
        training, seconds = gathered.training, dict(gathered.seconds)
        start = time.perf_counter()
        chosen = held_out(gathered, self.learner, self.folds, progress)
        seconds["parts left out"] = time.perf_counter() - start
        start = time.perf_counter()
        predictor = chosen.learner.fit(training)
        seconds["learning"] = time.perf_counter() - start
        C = coefficients(predictor, gathered.detail, training.inputs, gathered.shares.shape[1])
        report = fit_report(clips, gathered, chosen, C, self.basis, progress)
        report["warnings"] += getattr(predictor, "warnings", ())
        self.rig_, self.motions_, self.detail_ = gathered.rig, gathered.motions, gathered.detail
        self.shares_, self.predictor_, self.coarse_ = gathered.shares, predictor, gathered.coarse
        self._prepare(training.inputs)
        self.report_ = {**report, "seconds": {**seconds, "total": time.perf_counter() - began}}
        return self

    def pose(
        self,
        motion: SkeletonClip | None = None,
        *,
        strength: float | Mapping[str, float] = 1.0,
        damp: float | None = None,
        mask: Any = None,
        proportions: Mapping[str, Any] | None = None,
        progress: Progress = silent,
    ) -> MeshClip:
        """Pose the rig with its detail.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames of the joints of the rig, at any rate; the motion of the first clip where left out.
        strength : float or mapping of str to float, default 1.0
            How much of the detail is shown: 0 is the skin alone. A mapping names joints; the others keep 1.
        damp : float, optional
            Seconds over which detail is smoothed in time.
        mask : (n,) float, sequence of str, or None
            Where detail is shown: from 0 to 1 a vertex, or names of joints.
        proportions : mapping, optional
            Other bones, as `tempose.rigging.change_proportions` takes them; the detail grows with them.
        progress : Progress, optional
            Told about the frames.

        Returns
        -------
        MeshClip
            Posed frames at the rate of the motion.

        Raises
        ------
        ValueError
            If the motion moves other joints, or an edit names what does not exist.
        """
        motion = self._motion(motion)
        C = self.coefficients(motion) * region_strengths(strength, self.regions)[:, None]
        if damp is not None:
            C = damped(C, damp, motion.fps)
        rig, scale = self.rig_, vertex_mask(mask, self.regions, self.shares_)
        if proportions is not None:
            rig = change_proportions(replace(rig, motion=motion), proportions)
            before, after = (r.skin.mesh for r in (self.rig_, rig))
            grown = size_ratio(before.vertices, after.vertices, before.faces, self.shares_)
            scale, motion = grown if scale is None else grown * scale, rig.motion
        poser = self._poser
        if scale is not None or proportions is not None:
            poser = DetailPoser(rig, self.detail_, self.shares_, self.basis, scale)
        V = poser.frames(motion, C, progress)
        return MeshClip(V, rig.skin.mesh, motion.fps, rig.skin.mesh.source)

    def coefficients(self, motion: SkeletonClip | None = None) -> FloatArray:
        """Predict the coefficients of the modes of `detail_`.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames; the motion of the first clip where left out.

        Returns
        -------
        (T, R, 1 + K) float32 ndarray
            Of the mean and of K modes in every region, metres.
        """
        query = self._query(motion)
        return query.frames(coefficients(self.predictor_, self.detail_, query.inputs, len(self.regions)))

    def residual(self, motion: SkeletonClip | None = None) -> FloatArray:
        """Predict residuals.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames; the motion of the first clip where left out.

        Returns
        -------
        (T, n, 3) float32 ndarray
            Metres, in the basis of the model.
        """
        C = self.coefficients(motion)
        modes = self.detail_.modes
        D = np.zeros((len(C), *modes.shape[1:]), np.float32)
        for r in range(len(self.regions)):
            inside = np.flatnonzero(self.shares_[:, r])
            part = np.tensordot(C[:, r], modes[:, inside].astype(np.float32), axes=1)
            D[:, inside] += self.shares_[inside, r, None].astype(np.float32) * part
        return D

    def variance(self, motion: SkeletonClip | None = None) -> FloatArray:
        """Predict how wrong the residuals are.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames; the motion of the first clip where left out.

        Returns
        -------
        (T, n) ndarray
            Variance of one coordinate of every vertex, metres squared.
        """
        return self.region_variance(motion) @ self.shares_.T

    def region_variance(self, motion: SkeletonClip | None = None) -> FloatArray:
        """Predict how wrong the residuals of every region are.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames; the motion of the first clip where left out.

        Returns
        -------
        (T, R) ndarray
            Variance of one coordinate, metres squared.
        """
        query = self._query(motion)
        return query.frames(variances(self.predictor_, query.inputs, len(self.regions)))

    def far(self, motion: SkeletonClip | None = None) -> FloatArray:
        """Measure how far poses are from those learned.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames; the motion of the first clip where left out.

        Returns
        -------
        (T,) ndarray
            Angle to the most alike pose of the training, over that which 95 % of its own poses have to one at
            another time (or 0.3 of their distance from the mean pose); above 1 detail is a guess.
        """
        query = self._query(motion)
        angle = query.frames(nearest_distances(query.inputs, self._learned))
        return angle / max(self._usual, np.radians(1.0))

    def live(self, fps: float | None = None) -> LivePoser:
        """Pose frame by frame, as frames come.

        Parameters
        ----------
        fps : float, optional
            Rate at which they will come; that of the training where left out.

        Returns
        -------
        LivePoser
            Its `pose` takes one frame.
        """
        self._fitted()
        return LivePoser(self, fps)

    @property
    def mean_angles(self) -> FloatArray:
        """(J - 1, 3) mean rotation vectors of the training below the root, radians."""
        self._fitted()
        return self._near

    @property
    def regions(self) -> tuple[str, ...]:
        """R names: those of the joints."""
        return self._fitted().skin.skeleton.names

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the model to a file.

        Parameters
        ----------
        path : path-like
            By custom ``NAME.tempose``.

        Returns
        -------
        Path
            The file; `load` gives back a model that poses alike.

        Raises
        ------
        OSError
            If the place cannot be written.
        """
        self._fitted()
        return write_detail_model(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> DetailModel:
        """Read a model from a file.

        Parameters
        ----------
        path : path-like
            As `save` wrote it.

        Returns
        -------
        DetailModel
            The fitted model.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If it is cut short, no model of detail, or of a newer version; the message names it.
        """
        options, state = read_detail_model(path)
        model = cls(**options)
        for name, value in state.items():
            setattr(model, name, value)
        model._prepare(training_inputs(model.motions_))
        return model

    def _prepare(self, inputs: Inputs) -> None:
        self._learned, self._near = inputs, inputs.angles.mean(axis=0)
        self._usual = usual_distance(inputs)
        self._poser = DetailPoser(self.rig_, self.detail_, self.shares_, self.basis)

    def _query(self, motion: SkeletonClip | None) -> Query:
        return make_query(self.rig_, self._motion(motion), self.motions_[0].fps, self._near)

    def _motion(self, motion: SkeletonClip | None) -> SkeletonClip:
        self._fitted()
        return self.motions_[0] if motion is None else motion

    def _fitted(self) -> Rig:
        if not hasattr(self, "rig_"):
            raise ValueError("the model has learned nothing yet: call fit(clips, rig), or load a file")
        return self.rig_
