"""What the report says about feet: contacts held, what they cost, how hard the feet accelerate."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from tempose.metrics import foot_acceleration
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.placing import Placed


def contact_facts(job: Prepared, placed: Placed, fps: float) -> dict[str, Any]:
    """Say which contacts were held, what it cost, and how hard the feet accelerate.

    Parameters
    ----------
    job : Prepared
        Source and target.
    placed : Placed
        How its frames were placed.
    fps : float
        Frames per second.

    Returns
    -------
    dict
        ``contacts``: a dict a foot, see `Standing.facts`, in frames of the source;
        ``ground``: its height, by how much hands were lifted, how much was still pressed flat; None without;
        ``foot_acceleration``: ``rms``, ``p99`` and ``max`` of the target's ankles over those of the source's
        times the ratio of leg lengths; None where there is nothing to compare.
    """
    feet, standing = job.feet, placed.standing
    held = feet.standing if placed.held else np.zeros_like(feet.standing)
    ratio = None
    if feet.names and feet.legs and feet.ankles is not None:
        ankles = standing.ankles[:, : len(feet.names)] + placed.placement.shift[:, None]
        ratio = foot_acceleration(ankles, feet.ankles, job.leg_ratio, fps)
    return {
        "contacts": {name: standing.facts(held, f, job.first_frame) for f, name in enumerate(feet.names)},
        **_ground_facts(placed, len(feet.names)),
        "foot_acceleration": None if ratio is None else asdict(ratio),
    }


def _ground_facts(placed: Placed, n_feet: int) -> dict[str, Any]:
    if not placed.solid:
        return {"ground": None}
    hands = placed.standing.paths[:, n_feet:, 1]
    return {
        "ground": {
            "height": placed.ground,
            "hands_lifted_cm": float(100 * hands.max(initial=0.0)),
            "pressed_cm": 100 * placed.pressed,
        }
    }


def contact_warnings(job: Prepared, placed: Placed) -> list[str]:
    """Say which contacts could not be held.

    Parameters
    ----------
    job : Prepared
        Source and target.
    placed : Placed
        How its frames were placed.

    Returns
    -------
    list of str
        One line for each kind of trouble.
    """
    if not placed.held:
        return []
    if not job.feet.names:
        return ["source and target share no feet: nothing is held, and the height is that of the hips"]
    told: list[str] = []
    for f, name in enumerate(job.feet.names):
        facts = placed.standing.facts(job.feet.standing, f, job.first_frame)
        if facts["unmet_frames"]:
            first, stop = facts["unmet_frames"][0]
            more = f" and {len(facts['unmet_frames']) - 1} more" if len(facts["unmet_frames"]) > 1 else ""
            told.append(
                f"{name} cannot reach where it should stand, by {facts['unmet_cm']:.1f} cm at most: "
                f"frames {first} to {stop - 1}{more}; state other contacts or hold none"
            )
    return told
