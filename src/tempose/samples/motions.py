"""The built-in motions by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from tempose.samples.gallop import animal_walk, gallop
from tempose.samples.idle import idle, wave_hand
from tempose.samples.jump import jump
from tempose.samples.motion_clip import SampleMotion
from tempose.samples.run import run
from tempose.samples.turn import turn
from tempose.samples.walk import walk

Motion = Callable[..., SampleMotion]
"""Takes a skeleton and, by name, ``duration``, ``fps``, ``seed`` and more; see each."""

MOTIONS: Mapping[str, Mapping[str, Motion]] = MappingProxyType(
    {
        "human": MappingProxyType(
            {"walk": walk, "run": run, "turn": turn, "jump": jump, "idle": idle, "wave": wave_hand}
        ),
        "animal": MappingProxyType({"walk": animal_walk, "gallop": gallop}),
    }
)
"""For each kind of character, its motions."""


def find_motion(character: str, motion: str) -> Motion:
    """Look up a motion.

    Parameters
    ----------
    character : str
        ``"human"`` or ``"animal"``.
    motion : str
        Name of one of its motions.

    Returns
    -------
    callable
        Makes the motion.

    Raises
    ------
    ValueError
        If there is no such character or motion; the message lists those there are.
    """
    if character not in MOTIONS:
        raise ValueError(f"character must be one of {', '.join(MOTIONS)}, got {character!r}")
    if motion not in MOTIONS[character]:
        raise ValueError(
            f"motion of the {character} must be one of {', '.join(MOTIONS[character])}, got {motion!r}"
        )
    return MOTIONS[character][motion]
