"""What a person should know before trusting a fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tempose.clips import MeshClip
from tempose.clips.still import stands_still
from tempose.detail.fitting import Gathered
from tempose.detail.report.heldout import FEWEST, HeldOut
from tempose.detail.residuals import Basis
from tempose.rotations import angle_between

_TURNS = 30.0
"""Degrees of the root beyond which residuals in world axes do not last."""
_EXACT = 1e-3
"""Percent of the diagonal, two hundredths of a millimetre of a person: files and solvers leave as much."""


def warnings_of(clips: Sequence[MeshClip], gathered: Gathered, chosen: HeldOut, basis: Basis) -> list[str]:
    """Look for what makes learned detail doubtful.

    Parameters
    ----------
    clips : sequence of MeshClip
        The true frames.
    gathered : Gathered
        What was learned from.
    chosen : HeldOut
        The learner and the table.
    basis : {"blended", "root", "world"}
        Of the residuals.

    Returns
    -------
    list of str
        A sentence each.
    """
    found: list[str] = []
    T = len(gathered.training.inputs)
    if T < FEWEST:
        found.append(
            f"only {T} frames: too few to leave any out and test what was learned; "
            f"the {chosen.learner.name} is used"
        )
    still = _still(clips)
    if still:
        found.append(f"{still}: no motion, nothing to learn from but a constant residual")
    turn = _root_turn(gathered)
    if basis == "world" and turn > _TURNS:
        found.append(
            f"residuals are kept in world axes, and the root turns by {turn:.0f} degrees: the pose does "
            'not say which way the body faces; take basis="blended"'
        )
    unbound = int((gathered.rig.skin.weights.sum(axis=1) == 0).sum())
    if unbound:
        found.append(f"{unbound} vertices are bound to no joint: they stay where they are and get no detail")
    found += _doubts(chosen)
    return found


def _still(clips: Sequence[MeshClip]) -> str:
    """Name what does not move."""
    constant = [i for i, clip in enumerate(clips) if stands_still(clip)]
    if len(constant) == len(clips):
        return "all frames are the same"
    return f"clip {constant[0]} is the same in all frames" if constant else ""


def _root_turn(gathered: Gathered) -> float:
    """Degrees between the rotation of the root and that of the first frame, at most."""
    first = gathered.motions[0].rotations[:1, 0]
    return max(float(np.degrees(angle_between(m.rotations[:, 0], first).max())) for m in gathered.motions)


def _doubts(chosen: HeldOut) -> list[str]:
    """Say where parts left out were predicted no better than without learning."""
    row, skin = chosen.rows.get(chosen.learner.name), chosen.rows.get("skin")
    if row is None or skin is None:
        return []
    if skin["rms_percent"] < _EXACT:
        return [
            f"the skin alone follows the clips to {skin['rms_percent']:.2g} % of the diagonal: next to "
            "nothing is left to learn"
        ]
    if row["rms"] >= skin["rms"]:
        return [
            f"on parts left out {chosen.learner.name} has {row['part']:.2f} of the skin's own error: "
            "new motion is better posed with strength 0"
        ]
    if chosen.learner.name == "mean":
        return ["no learner predicted parts left out better than their mean: detail is a constant"]
    return []
