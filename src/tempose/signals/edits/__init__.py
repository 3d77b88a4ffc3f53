"""Edits: small functions from signals to signals, and lists of them as files."""

from tempose.signals.edits.apply import apply_edits, check_edits, load_edits
from tempose.signals.edits.bridge import blend, insert_curve
from tempose.signals.edits.controls import insert_control, move_control, place_control
from tempose.signals.edits.layout import pin_frames, repair_transitions
from tempose.signals.edits.operations import OPERATIONS, Operation
from tempose.signals.edits.pieces import close_loop, cut, keep, loop, paste, reverse
from tempose.signals.edits.timing import retime, set_fps, set_speed

__all__ = [
    "OPERATIONS",
    "Operation",
    "apply_edits",
    "blend",
    "check_edits",
    "close_loop",
    "cut",
    "insert_control",
    "insert_curve",
    "keep",
    "load_edits",
    "loop",
    "move_control",
    "paste",
    "pin_frames",
    "place_control",
    "repair_transitions",
    "retime",
    "reverse",
    "set_fps",
    "set_speed",
]
