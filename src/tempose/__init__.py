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
        curves,
        datasets,
        detail,
        embedding,
        formats,
        geometry,
        kinematics,
        linalg,
        metrics,
        models,
        regression,
        render,
        rigging,
        rotations,
        samples,
        shape_spaces,
        signals,
        transfer,
    )
    from tempose.clips import MarkerClip, Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
    from tempose.detail import DetailModel
    from tempose.formats import load, save
    from tempose.rigging import Rig
    from tempose.signals import SignalModel
    from tempose.transfer import MotionTransfer

_HOMES = {
    "DetailModel": "tempose.detail",
    "MarkerClip": "tempose.clips",
    "Mesh": "tempose.clips",
    "MeshClip": "tempose.clips",
    "MotionTransfer": "tempose.transfer",
    "Rig": "tempose.rigging",
    "SignalModel": "tempose.signals",
    "Skeleton": "tempose.clips",
    "SkeletonClip": "tempose.clips",
    "SkinnedMesh": "tempose.clips",
    "load": "tempose.formats",
    "save": "tempose.formats",
}
_PACKAGES = (
    "clips",
    "curves",
    "datasets",
    "detail",
    "embedding",
    "formats",
    "geometry",
    "kinematics",
    "linalg",
    "metrics",
    "models",
    "regression",
    "render",
    "rigging",
    "rotations",
    "samples",
    "shape_spaces",
    "signals",
    "transfer",
)

__all__ = [
    "DetailModel",
    "MarkerClip",
    "Mesh",
    "MeshClip",
    "MotionTransfer",
    "Rig",
    "SignalModel",
    "Skeleton",
    "SkeletonClip",
    "SkinnedMesh",
    "__version__",
    "clips",
    "curves",
    "datasets",
    "detail",
    "embedding",
    "formats",
    "geometry",
    "kinematics",
    "linalg",
    "load",
    "metrics",
    "models",
    "regression",
    "render",
    "rigging",
    "rotations",
    "samples",
    "save",
    "shape_spaces",
    "signals",
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
