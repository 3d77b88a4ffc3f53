"""A mesh bound to a skeleton, and the motion of the skeleton that follows a clip."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

from tempose.clips import MeshClip, SkeletonClip, SkinnedMesh
from tempose.clips._frozen import Frozen
from tempose.kinematics import dual_quaternion_skinning, linear_blend_skinning
from tempose.typing import FloatArray

Blending = Literal["linear", "dual-quaternion"]


@dataclass(frozen=True, eq=False)
class Rig(Frozen):
    """What any animation package can pose: a skin, and how its joints moved in the clip it was made from."""

    skin: SkinnedMesh
    """Mesh in its bind pose, J joints, weights."""
    motion: SkeletonClip
    """Motion fitted to the clip, on the joints of `skin`; one frame at rest where there was no clip."""
    blending: Blending = "linear"
    """How weights blend transforms."""
    report: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """Errors, seconds a stage, warnings: what JSON can hold."""

    def __post_init__(self) -> None:
        if self.motion.skeleton.names != self.skin.skeleton.names:
            raise ValueError("motion must move the joints of the skin, got other joint names")
        object.__setattr__(self, "report", MappingProxyType(dict(self.report)))

    def vertices(self, motion: SkeletonClip | None = None) -> FloatArray:
        """Pose the skin, without detail.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames on the joints of the skin; by default the fitted motion.

        Returns
        -------
        (T, n, 3) ndarray
            Posed vertices, metres.
        """
        motion = motion or self.motion
        pose = dual_quaternion_skinning if self.blending == "dual-quaternion" else linear_blend_skinning
        return pose(self.skin, motion.rotations, motion.root_position, motion.skeleton)

    def clip(self, motion: SkeletonClip | None = None) -> MeshClip:
        """Pose the skin as a clip, without detail.

        Parameters
        ----------
        motion : SkeletonClip, optional
            T frames on the joints of the skin; by default the fitted motion.

        Returns
        -------
        MeshClip
            Posed frames at the rate of the motion.
        """
        motion = motion or self.motion
        return MeshClip(self.vertices(motion), self.skin.mesh, motion.fps, self.skin.mesh.source)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the rig as one ``.tempose`` file.

        Parameters
        ----------
        path : path-like
            Where to; the folder must exist.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        OSError
            If the place cannot be written.
        """
        from tempose.rigging.saving import save_rig

        return save_rig(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Rig:
        """Read a rig that was saved.

        Parameters
        ----------
        path : path-like
            The file.

        Returns
        -------
        Rig
            Equal to what was saved, to the last bit.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        ValueError
            If it is no rig, cut short, or of a newer version; the message names it.
        """
        from tempose.rigging.saving import load_rig

        return load_rig(path)
