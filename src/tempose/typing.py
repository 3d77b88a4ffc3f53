"""Array aliases and the progress protocol shared by every level."""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.floating[Any]]
"""Array of float32 or float64; the shape stands in the docstring of whoever takes it."""

IntArray: TypeAlias = npt.NDArray[np.integer[Any]]
"""Array of integer indices, 0-based."""

BoolArray: TypeAlias = npt.NDArray[np.bool_]
"""Array of truth values, mostly masks."""


class Progress(Protocol):
    """Called now and then by long work; raising from it cancels the work."""

    def __call__(self, done: int, total: int, stage: str) -> None:
        """Report progress.

        Parameters
        ----------
        done : int
            Units of work finished so far.
        total : int
            Units of work in this stage; 0 when unknown.
        stage : str
            What is being done, for a person to read.
        """
        ...


def silent(done: int, total: int, stage: str) -> None:
    """Report nothing: the default progress callback.

    Parameters
    ----------
    done, total : int
        Ignored.
    stage : str
        Ignored.
    """
