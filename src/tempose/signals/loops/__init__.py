"""Loops in a clip: where it comes back to a pose and a motion it has been in, and how to close them."""

from tempose.signals.loops.closing import close_loop
from tempose.signals.loops.finding import Loop, find_loops

__all__ = ["Loop", "close_loop", "find_loops"]
