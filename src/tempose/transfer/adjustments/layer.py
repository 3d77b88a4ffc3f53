"""Adjustments laid over frames, one part after the other."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tempose.rotations import from_rotation_vector, multiply, rotate
from tempose.transfer.adjustments.parts import Part, residual_field, turned_field
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.limb_ik import bones_below
from tempose.typing import FloatArray, IntArray, Progress, silent

BLOCK = 16
"""Frames in memory at a time."""
_PASSES = 3


@dataclass
class Layer:
    """Frames of a job that are being adjusted, in place."""

    job: Prepared
    """The transfer."""
    frames: FloatArray
    """(T, n, 3) float32 vertices, metres."""
    rotations: FloatArray
    """(T, B, 4) rotations of the bones, as adjusted so far."""
    progress: Progress = silent
    """Called with frames done."""
    changed: set[int] = field(default_factory=set[int])
    """Frames that are no longer as they were."""

    @staticmethod
    def over(job: Prepared, frames: FloatArray, progress: Progress = silent) -> Layer:
        """Begin.

        Parameters
        ----------
        job : Prepared
            The transfer.
        frames : (T, n, 3) float32
            Its frames, which will be changed.
        progress : Progress
            Called with frames done.

        Returns
        -------
        Layer
            Nothing adjusted yet.
        """
        n_bones = job.rotations.shape[1] if job.bones is None else len(job.bones.names)
        return Layer(job, frames, np.array(job.rotations[:, :n_bones]), progress)

    def columns(self) -> FloatArray:
        """Compute the rotations of all columns of the solver.

        Returns
        -------
        (T, C, 4) ndarray
            As adjusted so far.
        """
        columns = self.job.columns
        return self.rotations if columns is None else columns.rotations(self.rotations)

    def shift_body(self, offsets: FloatArray) -> None:
        """Move the whole body.

        Parameters
        ----------
        offsets : (T, 3) float
            Metres.
        """
        for block in self._blocks(np.flatnonzero(offsets.any(axis=1)), "root"):
            self.frames[block] += offsets[block, None].astype(np.float32)

    def turn_body(self, turns: FloatArray, pivot: FloatArray) -> None:
        """Turn the whole body.

        Parameters
        ----------
        turns : (T, 3) float
            Rotation vectors.
        pivot : (T, 3) float
            About what, metres.
        """
        for block in self._blocks(np.flatnonzero(turns.any(axis=1)), "root"):
            turn = from_rotation_vector(turns[block])[:, None]
            arm = self.frames[block] - pivot[block, None]
            self.frames[block] = pivot[block, None] + rotate(turn, arm)
            self.rotations[block] = multiply(turn, self.rotations[block])

    def turn_part(self, part: Part, turns: FloatArray) -> None:
        """Turn a bone and all that hangs on it about the joint at which it starts.

        Parameters
        ----------
        part : Part
            With a bone.
        turns : (T, 3) float
            Rotation vectors, world axes.
        """
        assert part.bone is not None and self.job.bones is not None
        below = bones_below(self.job.bones.parents, part.bone)
        field_ = turned_field(self.job, part.bone)
        for block in self._blocks(np.flatnonzero(turns.any(axis=1)), part.name):
            before = self._pose(block, self.rotations[block])
            turned = np.array(self.rotations[block])
            turned[:, below] = multiply(from_rotation_vector(turns[block])[:, None], turned[:, below])
            change = self._pose(block, turned) - before
            self.frames[block] += (field_[:, None] * change).astype(np.float32)
            self.rotations[block] = turned

    def shift_part(self, part: Part, wanted: FloatArray, active: IntArray, follow: bool) -> FloatArray:
        """Bring a part's point to places: the bones reach for it, the surface takes up what they leave.

        Parameters
        ----------
        part : Part
            What to move.
        wanted : (T, 3) float
            Where its point shall be, metres.
        active : (k,) int
            In which frames.
        follow : bool
            Whether it turns with the bone that moves it.

        Returns
        -------
        (T,) ndarray
            By how much it misses its place, metres.
        """
        missed = np.zeros(len(self.frames))
        rest = residual_field(self.job, part)
        moved = None if part.chain is None else turned_field(self.job, part.chain.top)
        for block in self._blocks(active, part.name):
            V = np.asarray(self.frames[block], dtype=np.float64)
            if part.chain is not None and moved is not None:
                V = self._reach(part, V, block, wanted[block], follow, moved)
            left = wanted[block] - part.points(V)
            V += rest[:, None] * self._stretch(part, left)[:, None]
            missed[block] = np.linalg.norm(wanted[block] - part.points(V), axis=1)
            self.frames[block] = V
        return missed

    def _reach(
        self, part: Part, V: FloatArray, block: IntArray, wanted: FloatArray, follow: bool, weight: FloatArray
    ) -> FloatArray:
        assert part.chain is not None
        Q = self.rotations[block]
        before = self._pose(block, Q)
        got = part.points(V)
        shift = np.zeros_like(got)
        step, H = wanted - got, np.tile(np.eye(3), (len(block), 1, 1))
        moved, turned = V, Q
        # the surface lags behind its bones: what is missing is asked of them again, by Broyden's method
        for _ in range(_PASSES):
            shift = shift + step
            turned = part.chain.move(Q, shift, follow)
            moved = V + weight[:, None] * (self._pose(block, turned) - before)
            last, got = got, part.points(moved)
            H = _secant(H, step, got - last)
            step = np.einsum("kij,kj->ki", H, part.chain.attainable(turned, wanted - got))
        self.rotations[block] = turned
        return moved

    def _stretch(self, part: Part, left: FloatArray) -> FloatArray:
        if part.chain is None:
            return left
        free = part.chain.stretch * part.chain.length
        length = np.linalg.norm(left, axis=1, keepdims=True)
        over = np.maximum(length - free, 0.0)
        allowed = np.where(over > 0, free + free * np.tanh(over / free), length)
        return left * np.divide(allowed, length, out=np.ones_like(length), where=length > 0)

    def _pose(self, block: IntArray, Q: FloatArray) -> FloatArray:
        columns = self.job.columns
        if columns is not None:
            whole = np.array(self.rotations)
            whole[block] = Q
            Q = columns.rotations(whole)[block]
        return self.job.solver.pose(Q)

    def _blocks(self, active: IntArray, stage: str) -> list[IntArray]:
        self.changed |= {int(t) for t in active}
        return [active[i : i + BLOCK] for i in range(0, len(active), BLOCK)]

    def adjusted_job(self) -> Prepared:
        """Return the job with the rotations as they are now.

        Returns
        -------
        Prepared
            For measures and further layers.
        """
        return replace(self.job, rotations=self.columns())


def _secant(H: FloatArray, asked: FloatArray, got: FloatArray) -> FloatArray:
    """Correct (k, 3, 3) inverse Jacobians by one step each, by as little as possible."""
    predicted = np.einsum("kij,kj->ki", H, got)
    along = np.einsum("ki,kij->kj", asked, H)
    scale = np.sum(along * got, axis=1)
    # a step that had no effect, or the opposite one, was out of reach and teaches nothing
    usable = scale > 0.3 * np.sum(asked * asked, axis=1)
    change = (asked - predicted)[:, :, None] * along[:, None, :] / np.where(usable, scale, 1.0)[:, None, None]
    return H + np.where(usable[:, None, None], change, 0.0)
