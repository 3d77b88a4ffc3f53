"""The data types every method speaks: frozen dataclasses with read-only arrays."""

from tempose.clips.markers import MarkerClip
from tempose.clips.mesh import Mesh
from tempose.clips.mesh_clip import MeshClip
from tempose.clips.skeleton import Skeleton, SkeletonClip
from tempose.clips.skinned_mesh import SkinnedMesh
from tempose.clips.source import Source

__all__ = ["MarkerClip", "Mesh", "MeshClip", "Skeleton", "SkeletonClip", "SkinnedMesh", "Source"]
