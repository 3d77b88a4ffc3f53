"""What `tempose` starts: runs a command and turns every failure into one line and an exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any

from tempose.cli.interrupts import remembering_interrupts

BAD_INPUT = 2
INTERRUPTED = 130
DEFECT = 1
UNREAD = 1


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after ``tempose``; by default those of this process.

    Returns
    -------
    int
        Exit code: 0 for success, 2 for bad input, 130 after Ctrl-C, 1 for a defect of Tempose. Every
        failure writes exactly one line to standard error.
    """
    try:
        with remembering_interrupts():
            from tempose.cli.app import command

            code: Any = command(args=arguments, prog_name="tempose", standalone_mode=False)
            sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    except Exception as error:
        return _failed(error)
    if code == INTERRUPTED:
        _complain("interrupted; nothing was written under its final name")
    return code if isinstance(code, int) else 0


def _failed(error: Exception) -> int:
    if os.environ.get("TEMPOSE_TRACEBACK"):
        raise error
    name = type(error).__name__
    if name == "Abort":
        _complain("interrupted; nothing was written under its final name")
        return INTERRUPTED
    if isinstance(error, BrokenPipeError) and error.filename is None:
        # the reader of our output has gone (`tempose info x | head -1`): nobody is left to tell
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return UNREAD
    if hasattr(error, "format_message"):
        _complain(_usage(error))
    elif isinstance(error, OSError):
        _complain(_trouble(error))
    elif isinstance(error, MemoryError):
        _complain(f"out of memory{': ' if str(error) else ''}{error}; try a smaller mesh or fewer frames")
    elif isinstance(error, ValueError) or _is_missing_extra(error):
        _complain(str(error))
    else:
        _complain(f"a defect of Tempose, please report it: {name}: {error} (TEMPOSE_TRACEBACK=1 shows where)")
        return DEFECT
    return BAD_INPUT


def _is_missing_extra(error: Exception) -> bool:
    return isinstance(error, ImportError) and not (error.name or "").startswith("tempose")


def _usage(error: Any) -> str:
    context = getattr(error, "ctx", None)
    path = context.command_path if context is not None else "tempose"
    return f"{error.format_message()} (see {path} --help)"


def _trouble(error: OSError) -> str:
    if error.strerror is None:
        return str(error)
    return f"{error.filename}: {error.strerror}" if error.filename else error.strerror


def _complain(message: str) -> None:
    sys.stderr.write("tempose: " + " ".join(message.split()) + "\n")
    sys.stderr.flush()
