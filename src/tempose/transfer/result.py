"""What a transfer gives back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tempose.clips import MeshClip
from tempose.transfer.pairs import Pairs


@dataclass(frozen=True)
class TransferResult:
    """A moving target and what is known about how good it is."""

    clip: MeshClip
    """The target, moving."""
    pairs: Pairs
    """The pairs that moved it."""
    report: dict[str, Any] = field(default_factory=dict[str, Any])
    """Measures, seconds a stage and warnings, ready for JSON."""
    source: MeshClip | None = None
    """The source as a mesh (bones as closed template meshes, in its own metres), for pictures."""
