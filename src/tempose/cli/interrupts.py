"""Ctrl-C that is not lost.

Python raises KeyboardInterrupt wherever it happens to be; inside a finaliser or a callback from compiled code
the exception is printed and dropped. So it is remembered here, and raised again when work reports progress.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Generator
from contextlib import contextmanager
from types import FrameType

_asked = threading.Event()


def _interrupt(number: int, frame: FrameType | None) -> None:
    _asked.set()
    raise KeyboardInterrupt


@contextmanager
def remembering_interrupts() -> Generator[None, None, None]:
    """Remember Ctrl-C while the block runs.

    Yields
    ------
    None
        Nothing.
    """
    _asked.clear()
    ignored = signal.getsignal(signal.SIGINT) is signal.SIG_IGN  # as a shell does for its background jobs
    if ignored or threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, _interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        _asked.clear()


def stop_if_interrupted() -> None:
    """Raise KeyboardInterrupt again if it was raised before and got lost.

    Raises
    ------
    KeyboardInterrupt
        If Ctrl-C was pressed since the command began.
    """
    if _asked.is_set():
        raise KeyboardInterrupt
