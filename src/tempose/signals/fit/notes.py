"""What the stages of a fit leave behind for its report."""

from __future__ import annotations

import time
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from tempose.typing import Progress, silent

STAGES = 6


@dataclass
class Notes:
    """Seconds of every stage, warnings and facts, gathered on the way."""

    progress: Progress = silent
    """Told when a stage begins."""
    seconds: dict[str, float] = field(default_factory=dict[str, float])
    """Of every stage."""
    warnings: list[str] = field(default_factory=list[str])
    """Sentences for a person, each with its measure."""
    facts: dict[str, Any] = field(default_factory=dict[str, Any])
    """What JSON can hold: the name of the layout, the period..."""

    @contextmanager
    def stage(self, name: str) -> Generator[None, None, None]:
        """Time a stage.

        Parameters
        ----------
        name : str
            Its name, for the report and for the progress.

        Yields
        ------
        None
            While the stage is at work.
        """
        self.progress(len(self.seconds), STAGES, name)
        start = time.perf_counter()
        yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
