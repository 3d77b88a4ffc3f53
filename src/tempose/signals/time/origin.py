"""Which tick of the captured clip a tick of the edited one comes from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose._validate import read_only
from tempose.typing import FloatArray


@dataclass(frozen=True, eq=False)
class Origin:
    """Pieces of the captured clip, one after another; cuts, loops and pastes make more of them."""

    starts: FloatArray
    """(K,) ticks where the pieces begin, ascending, the first 0."""
    sources: FloatArray
    """(K,) ticks of the captured clip at those starts."""
    directions: FloatArray
    """(K,) 1, or -1 where a piece runs backwards."""

    def __post_init__(self) -> None:
        for name in ("starts", "sources", "directions"):
            object.__setattr__(self, name, read_only(np.array(getattr(self, name), dtype=np.float64)))

    def __call__(self, ticks: FloatArray) -> FloatArray:
        """Return the captured ticks.

        Parameters
        ----------
        ticks : (...) float
            Ticks of the edited clip.

        Returns
        -------
        (...) ndarray
            Ticks of the captured clip.
        """
        ticks = np.asarray(ticks, dtype=np.float64)
        i = np.maximum(np.searchsorted(self.starts, ticks, side="right") - 1, 0)
        return self.sources[i] + self.directions[i] * (ticks - self.starts[i])
