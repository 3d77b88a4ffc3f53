"""Detail that follows a skeleton as it moves: a frame at a time, as the frames come."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from tempose._validate import as_floats
from tempose.detail.learners.kernel_predictor import KernelPredictor
from tempose.detail.learners.memory import frames_remembered
from tempose.detail.posing._tree_kernels import (
    dual_row,
    joint_rows,
    linear_row,
    rotation_vectors,
)
from tempose.detail.posing.poser import DetailPoser
from tempose.detail.training import Inputs
from tempose.kinematics import rest_transforms
from tempose.rotations import conjugate
from tempose.typing import FloatArray

if TYPE_CHECKING:
    from tempose.detail.model import DetailModel

_NO_TURN = np.array([1.0, 0.0, 0.0, 0.0], np.float32)


class LivePoser:
    """Poses a model frame by frame, remembering the frames before.

    Parameters
    ----------
    model : DetailModel
        Fitted.
    fps : float, optional
        Rate at which frames will come; that of the training where left out.

    Notes
    -----
    Equal to `DetailModel.pose` of the same frames, but for the first: nothing is known of how it moves, so
    its velocity is zero.
    """

    def __init__(self, model: DetailModel, fps: float | None = None) -> None:
        rig, self._poser = model.rig_, DetailPoser(model.rig_, model.detail_, model.shares_, model.basis)
        skeleton = rig.skin.skeleton
        bind_turn, bind_place = rest_transforms(skeleton)
        rest = skeleton.rest_rotations
        assert rest is not None
        self._parents, self._offsets = skeleton.parents, skeleton.offsets
        self._bind_back, self._bind_arms = conjugate(bind_turn), bind_place - bind_place[0]
        self._rest_back, self._names = conjugate(rest), skeleton.names[1:]
        dual = rig.blending == "dual-quaternion"
        self._fill = dual_row if dual else linear_row
        self._fps = model.motions_[0].fps
        self._pace = 1.0 if fps is None else fps / self._fps
        self._near = model.mean_angles
        J, R = skeleton.n_joints, len(model.regions)
        self._turns, self._shifts = np.zeros((J, 4)), np.zeros((J, 3))
        self._row = np.zeros((J, 8 if dual else 16), np.float32)
        self._modes = slice(1, 1 + model.detail_.n_modes)
        self._C = np.zeros((R, self._poser.columns), np.float32)
        self._C[:, 0] = model.detail_.step
        self._predict = _predictor(model)
        self._memory = 1 + frames_remembered(model.predictor_)
        self._V = np.zeros((len(rig.skin.mesh.vertices), 3), np.float32)
        self.reset()

    def reset(self) -> None:
        """Forget the frames before: what comes next begins a motion."""
        self._angles: list[FloatArray] = []
        self._velocity: list[FloatArray] = []

    def pose(self, rotations: FloatArray, root_position: FloatArray) -> FloatArray:
        """Pose the next frame.

        Parameters
        ----------
        rotations : (J, 4) float
            Local rotations wxyz.
        root_position : (3,) float
            World position of the root, metres.

        Returns
        -------
        (n, 3) float32 ndarray
            Vertices, metres; the next frame is written over it.

        Raises
        ------
        ValueError
            If a shape is another.
        """
        rotations = as_floats(rotations, "rotations", (len(self._parents), 4))
        root = as_floats(root_position, "root_position", (3,))
        self._remember(rotations)
        self._C[:, self._modes] = self._predict(self._inputs())
        joint_rows(
            self._parents,
            self._offsets,
            self._bind_back,
            self._bind_arms,
            rotations,
            self._turns,
            self._shifts,
        )
        self._fill(self._turns, self._shifts, self._row)
        whole = self._turns[0].astype(np.float32) if self._poser.skin.basis == "root" else _NO_TURN
        self._poser.frame(self._row, whole, root, self._C, self._V)
        return self._V

    def _remember(self, rotations: FloatArray) -> None:
        angles = np.zeros_like(self._near)
        before = self._angles[-1] if self._angles else self._near
        rotation_vectors(self._rest_back, rotations, before, angles)
        self._angles.append(angles)
        self._velocity.append(self._change())
        keep = math.ceil(self._memory * self._pace) + 1
        del self._angles[:-keep], self._velocity[:-keep]

    def _change(self) -> FloatArray:
        """Change of the angles over a frame of the training, as far as frames before are known."""
        known = len(self._angles) - 1
        if known == 0:
            return np.zeros_like(self._near)
        reach = min(self._pace, float(known))
        whole = math.floor(reach + 1e-6)
        part = max(reach - whole, 0.0)
        earlier = self._angles[-1 - whole]
        if part > 1e-6:
            earlier = (1 - part) * earlier + part * self._angles[-2 - whole]
        return (self._angles[-1] - earlier) * (self._pace / reach)

    def _inputs(self) -> Inputs:
        """Return the latest frame and those that learners look back at, a frame of the training apart."""
        last = len(self._angles) - 1
        rows = [round(last - k * self._pace) for k in range(self._memory)]
        rows = [row for row in reversed(rows) if row >= 0]
        angles, velocity = (np.stack([part[row] for row in rows]) for part in (self._angles, self._velocity))
        Q = len(rows)
        chains = np.zeros(Q, dtype=np.int64)
        return Inputs(angles, velocity, np.zeros((Q, 0)), chains, self._names, self._fps)


def _predictor(model: DetailModel) -> Callable[[Inputs], FloatArray]:
    """Choose the quickest way to the coefficients (R or 1, K) of the last of some frames, metres."""
    predictor, coordinates = model.predictor_, model.detail_.step * model.detail_.coordinates

    def by_mixing(inputs: Inputs) -> FloatArray:
        return predictor.mix(inputs).weights[:, -1] @ coordinates

    if not isinstance(predictor, KernelPredictor) or predictor.bank is None:
        return by_mixing
    bank, features = predictor.bank, predictor.features
    alive = [r for r, kernel in enumerate(predictor.kernels) if kernel is not None]
    solved = bank.solve(coordinates)
    found = np.zeros((len(predictor.kernels), coordinates.shape[1]))

    def by_means(inputs: Inputs) -> FloatArray:
        found[alive] = bank.means(features(inputs)[-1:], solved)[:, 0]
        return found

    return by_means
