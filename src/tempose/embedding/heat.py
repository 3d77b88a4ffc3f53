"""Heat-equilibrium weights (Baran and Popovic 2007, section 4)."""

from __future__ import annotations

from typing import Any

from tempose.clips import Mesh
from tempose.typing import FloatArray


def heat_weights(mesh: Mesh, bones: Any) -> FloatArray:
    """Weights of the bones on the vertices."""
    raise NotImplementedError
