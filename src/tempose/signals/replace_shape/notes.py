"""What a person should know of a deformation transfer."""

from __future__ import annotations

from tempose.signals.replace_shape.local import LocalMap
from tempose.signals.replace_shape.mixtures import Mixtures
from tempose.signals.replace_shape.poses import PoseSet

ILL_CONDITIONED = 1e8
"""Beyond this some poses are nearly mixtures of others, and multiples of them grow without meaning."""


def transfer_notes(
    mixtures: Mixtures, local: LocalMap | None, q: PoseSet, r: PoseSet, scale: float | str
) -> tuple[str, ...]:
    """Say how far a transfer by pairs of poses can be trusted.

    Parameters
    ----------
    mixtures : Mixtures
        The clip in terms of the source poses.
    local : LocalMap or None
        How regions follow regions; None for one set of multiples.
    q, r : PoseSet
        Source and target poses.
    scale : float or str
        How many times as far the target travels.

    Returns
    -------
    tuple of str
        Sentences for a person.
    """
    found = [
        f"{len(mixtures.used)} of {len(q)} pairs used ({', '.join(map(str, mixtures.used))}); what their "
        f"mixtures cannot show is {mixtures.residual:.2f} times the motion's spread (rms); pairs nearer to "
        "the poses of the clip lower it"
    ]
    if local is not None:
        found.append(
            f"a pair predicted from the others is missed by {100 * local.error:.0f} % of its distance to "
            f'their mean, region by region; by {100 * local.plain:.0f} % as a whole ("regions": 0)'
        )
    if mixtures.condition > ILL_CONDITIONED:
        found.append(
            f"the poses are nearly mixtures of one another (condition {mixtures.condition:.1e}): leave one "
            "out or give a ridge such as 0.001"
        )
    ratio = r.mesh.diagonal / q.mesh.diagonal
    if scale == 1 and not 2 / 3 < ratio < 1.5:
        found.append(
            f'the target is {ratio:.3g} times as large and travels as far; "scale": "size" changes that'
        )
    return tuple(found)
