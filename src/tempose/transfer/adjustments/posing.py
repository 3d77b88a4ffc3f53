"""Frames of a job solved anew with other rotations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.rotations import conjugate, multiply
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.turns.references import References, choose_references
from tempose.typing import FloatArray, IntArray


def pose_frames(job: Prepared, rotations: FloatArray, block: IntArray, Q: FloatArray) -> FloatArray:
    """Solve some frames that follow each other.

    Parameters
    ----------
    job : Prepared
        The transfer.
    rotations : (T, B, 4) float
        Rotations of the bones through the whole clip, which tell how often limbs have turned round.
    block : (k,) int
        Frames, without gaps.
    Q : (k, B, 4) float
        Rotations of the bones in these frames.

    Returns
    -------
    (k, n, 3) ndarray
        Vertices, metres, the anchor at its rest place.
    """
    whole = np.array(rotations)
    whole[block] = Q
    Q = _columns(job, whole)[block]
    out = np.zeros((len(block), len(job.solver.mesh.vertices), 3))

    def receive(part: slice, V: FloatArray) -> None:
        out[part] = V

    job.solver.pose_blocks(Q, receive, _references(job, block, Q))
    return out


def job_with(job: Prepared, rotations: FloatArray) -> Prepared:
    """Give a job other rotations.

    Parameters
    ----------
    job : Prepared
        The transfer.
    rotations : (T, B, 4) float
        Rotations of the bones.

    Returns
    -------
    Prepared
        With the rotations of all columns, and reference poses where it had any.
    """
    turned = replace(job, rotations=_columns(job, rotations))
    if turned.references is None:
        return turned
    return replace(turned, references=choose_references(turned.solver.spread, turned.rotations))


def _references(job: Prepared, block: IntArray, Q: FloatArray) -> References | None:
    """Carry the reference poses of the clip over to some frames with other rotations."""
    references = job.references
    if references is None:
        return None
    turns, before = np.array(Q), np.searchsorted(references.frames, block, side="left") - 1
    for k, i in enumerate(before):
        if i >= 0:
            turns[k] = multiply(Q[k], conjugate(job.rotations[references.frames[i]]))
    return References(references.frames - block[0], references.fields, turns)


def _columns(job: Prepared, Q: FloatArray) -> FloatArray:
    return Q if job.columns is None else job.columns.rotations(Q)
