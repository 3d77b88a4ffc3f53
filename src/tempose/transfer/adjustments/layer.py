"""Adjustments laid over frames, one part after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from tempose.rotations import (
    conjugate,
    from_matrix,
    from_rotation_vector,
    multiply,
    procrustes_rotation,
    rotate,
)
from tempose.transfer.adjustments.limb_chain import LimbChain
from tempose.transfer.adjustments.part_fields import (
    carried_field,
    residual_field,
    rigid_vertices,
    turned_field,
)
from tempose.transfer.adjustments.parts import Part
from tempose.transfer.adjustments.posing import job_with, pose_frames
from tempose.transfer.bodies.limb_ik import bones_below
from tempose.transfer.from_skeleton import Prepared
from tempose.typing import FloatArray, IntArray, Progress, silent

BLOCK = 16
"""Frames in memory at a time."""
_PASSES, _ENOUGH = 6, 0.03
"""Passes at most, and which share of the stretch that is free may be left to the surface."""


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
        weight = turned_field(self.job, part.bone)[:, None]
        core = rigid_vertices(self.job, part.bone)
        for block in self._blocks(np.flatnonzero(turns.any(axis=1)), part.name):
            before = pose_frames(self.job, self.rotations, block, self.rotations[block])
            asked = turn = from_rotation_vector(turns[block])
            turned, after = self._turned(block, below, turn)
            for _ in range(2 if len(core) else 0):
                # a head lags behind its marks by a tenth: the glue shares its turn with the neck
                done = from_matrix(procrustes_rotation(before[:, core], after[:, core]))
                turn = multiply(multiply(asked, conjugate(done)), turn)
                turned, after = self._turned(block, below, turn)
            self.frames[block] += (weight * (after - before)).astype(np.float32)
            self.rotations[block] = turned

    def _turned(self, block: IntArray, below: IntArray, turn: FloatArray) -> tuple[FloatArray, FloatArray]:
        turned = np.array(self.rotations[block])
        turned[:, below] = multiply(_short(turn)[:, None], turned[:, below])
        return turned, pose_frames(self.job, self.rotations, block, turned)

    def shift_part(
        self, part: Part, wanted: FloatArray, active: IntArray, follow: bool, swivel: FloatArray | None = None
    ) -> FloatArray:
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
        swivel : (T,) float, optional
            Radians by which elbow or knee turns about the line to the part, which a limb has.

        Returns
        -------
        (T,) ndarray
            By how much it misses its place, metres.
        """
        missed = np.zeros(len(self.frames))
        rest = residual_field(self.job, part)
        moved = None if part.chain is None else turned_field(self.job, part.chain.top)
        carried = None
        if isinstance(part.chain, LimbChain) and not follow:
            carried = carried_field(self.job, part.chain.limb)
        for block in self._blocks(active, part.name):
            V = np.asarray(self.frames[block], dtype=np.float64)
            if part.chain is not None and moved is not None:
                Q = self.rotations[block]
                if swivel is not None and isinstance(part.chain, LimbChain):
                    Q = part.chain.swivelled(Q, swivel[block])
                V = self._reach(part, V, block, Q, wanted[block], follow, moved)
            if carried is not None:
                # the glue tilts a foot by some millimetres with its shin: it is to be moved, not turned
                entry = self.frames[block]
                whole = entry + (part.points(V) - part.points(entry))[:, None]
                V += carried[:, None] * (whole - V)
            left = wanted[block] - part.points(V)
            V += rest[:, None] * self._stretch(part, left)[:, None]
            missed[block] = np.linalg.norm(wanted[block] - part.points(V), axis=1)
            self.frames[block] = V
        return missed

    def _reach(
        self,
        part: Part,
        V: FloatArray,
        block: IntArray,
        Q: FloatArray,
        wanted: FloatArray,
        follow: bool,
        weight: FloatArray,
    ) -> FloatArray:
        assert part.chain is not None
        before = pose_frames(self.job, self.rotations, block, self.rotations[block])
        got = part.points(V)
        shift = np.zeros_like(got)
        step, H = wanted - got, np.tile(np.eye(3), (len(block), 1, 1))
        moved, turned = V, Q
        # the surface lags behind its bones: what is missing is asked of them again, by Broyden's method
        for _ in range(_PASSES):
            shift = shift + step
            turned = part.chain.move(Q, shift, follow)
            moved = V + weight[:, None] * (pose_frames(self.job, self.rotations, block, turned) - before)
            last, got = got, part.points(moved)
            H = _secant(H, step, got - last)
            missing = part.chain.attainable(turned, wanted - got)
            if np.linalg.norm(missing, axis=1).max() < _ENOUGH * part.chain.stretch * part.chain.length:
                break
            step = np.einsum("kij,kj->ki", H, missing)
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

    def _blocks(self, active: IntArray, stage: str) -> Iterator[IntArray]:
        """Cut frames into runs without gaps, none longer than a block."""
        self.changed |= {int(t) for t in active}
        runs = np.split(active, np.flatnonzero(np.diff(active) > 1) + 1)
        done = 0
        for block in (run[i : i + BLOCK] for run in runs for i in range(0, len(run), BLOCK)):
            yield block
            done += len(block)
            self.progress(done, len(active), f"adjusting {stage}")

    def adjusted_job(self) -> Prepared:
        """Return the job with the rotations as they are now.

        Returns
        -------
        Prepared
            For measures and further layers.
        """
        return job_with(self.job, self.rotations)


def _short(q: FloatArray) -> FloatArray:
    """Give rotations the sign of less than half a turn, so that signs go on agreeing with the neighbours'."""
    return np.where(q[..., :1] < 0, -q, q)


def _secant(H: FloatArray, asked: FloatArray, got: FloatArray) -> FloatArray:
    """Correct (k, 3, 3) inverse Jacobians by one step each, by as little as possible."""
    predicted = np.einsum("kij,kj->ki", H, got)
    along = np.einsum("ki,kij->kj", asked, H)
    scale = np.sum(along * got, axis=1)
    # a step that had no effect, or the opposite one, was out of reach and teaches nothing
    usable = scale > 0.3 * np.sum(asked * asked, axis=1)
    change = (asked - predicted)[:, :, None] * along[:, None, :] / np.where(usable, scale, 1.0)[:, None, None]
    return H + np.where(usable[:, None, None], change, 0.0)
