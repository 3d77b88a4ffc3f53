"""Take hold of mesh animations.

The names below are imported when they are first used, so that ``import tempose`` stays light.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from tempose._version import __version__

if TYPE_CHECKING:
    from tempose import (
        clips,
        datasets,
        formats,
        geometry,
        kinematics,
        linalg,
        metrics,
        render,
        rotations,
        samples,
        transfer,
    )
    from tempose.clips import MarkerClip, Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
    from tempose.formats import load, save
    from tempose.transfer import MotionTransfer

_HOMES = {
    "MarkerClip": "tempose.clips",
    "Mesh": "tempose.clips",
    "MeshClip": "tempose.clips",
    "MotionTransfer": "tempose.transfer",
    "Skeleton": "tempose.clips",
    "SkeletonClip": "tempose.clips",
    "SkinnedMesh": "tempose.clips",
    "load": "tempose.formats",
    "save": "tempose.formats",
}
_PACKAGES = (
    "clips",
    "datasets",
    "formats",
    "geometry",
    "kinematics",
    "linalg",
    "metrics",
    "render",
    "rotations",
    "samples",
    "transfer",
)

__all__ = [
    "MarkerClip",
    "Mesh",
    "MeshClip",
    "MotionTransfer",
    "Skeleton",
    "SkeletonClip",
    "SkinnedMesh",
    "__version__",
    "clips",
    "datasets",
    "formats",
    "geometry",
    "kinematics",
    "linalg",
    "load",
    "metrics",
    "render",
    "rotations",
    "samples",
    "save",
    "transfer",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        value: Any = getattr(importlib.import_module(_HOMES[name]), name)
    elif name in _PACKAGES:
        value = importlib.import_module(f"tempose.{name}")
    else:
        raise AttributeError(f"module 'tempose' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
