"""Whether an array fits into the memory of this machine: told before it is asked for."""

from __future__ import annotations

import os


def check_room(gigabytes: float, what: str, instead: str) -> None:
    """Refuse what does not fit into memory.

    Parameters
    ----------
    gigabytes : float
        How much is wanted.
    what : str
        What takes it, for the message.
    instead : str
        What to do.

    Raises
    ------
    ValueError
        If the machine has less.
    """
    try:
        machine = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 1e9
    except (AttributeError, OSError, ValueError):  # a system that does not say
        return
    if gigabytes > machine:
        raise ValueError(f"{what} take {gigabytes:.3g} GB, more than this machine has; {instead}")
