"""What a transfer gives back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tempose.clips import MeshClip
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.from_skeleton import Prepared
from tempose.transfer.pairing.pairs import Pairs


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
    job: Prepared | None = field(default=None, repr=False)
    """Factorised target and rotations, for what is layered on the result; None if it was not kept."""
    base: TransferResult | None = field(default=None, repr=False)
    """The result without adjustments, where this one has any."""
    adjustments: tuple[Adjustment, ...] = ()
    """What was layered on `base`, in order."""
