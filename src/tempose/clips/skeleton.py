"""A tree of joints, still and moving."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tempose._validate import as_floats, as_indices, read_only
from tempose.clips._frozen import Frozen
from tempose.clips.source import Source
from tempose.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Skeleton(Frozen):
    """Joints, parents first; the root has parent -1."""

    names: tuple[str, ...]
    """J distinct names."""
    parents: IntArray
    """(J,) int32, each smaller than its own index; -1 for the root, which is joint 0."""
    offsets: FloatArray
    """(J, 3) float64 metres, joint position in the parent's basis; of the root: its rest position."""
    rest_rotations: FloatArray | None = None
    """(J, 4) float64 wxyz, local rotation in the rest pose; None means identity."""
    tips: FloatArray | None = None
    """(J, 3) float64 metres, end of a leaf bone in the joint's own basis; NaN where none is known."""

    def __post_init__(self) -> None:
        names = tuple(str(name) for name in self.names)
        J = len(names)
        if J == 0:
            raise ValueError("names must hold at least one joint, got none")
        if len(set(names)) != J:
            twice = next(name for i, name in enumerate(names) if name in names[:i])
            raise ValueError(f"names must be distinct, got {twice!r} twice")
        parents = np.asarray(self.parents)
        if parents.shape != (J,) or parents.dtype.kind not in "iu":
            raise ValueError(
                f"parents must be integers of shape ({J},), got {parents.dtype} of shape {parents.shape}"
            )
        parents = parents.astype(np.int32)
        if parents[0] != -1 or (parents[1:] < 0).any() or (parents >= np.arange(J)).any():
            raise ValueError("parents must come before their children, with joint 0 the only root (-1)")
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "parents", read_only(parents))
        self._check_pose(J)

    def _check_pose(self, J: int) -> None:
        rest = np.tile([1.0, 0, 0, 0], (J, 1)) if self.rest_rotations is None else self.rest_rotations
        rest = as_floats(rest, "rest_rotations", (J, 4))
        norms = np.linalg.norm(rest, axis=-1)
        if np.abs(norms - 1).max() > 1e-3:
            j = int(np.abs(norms - 1).argmax())
            raise ValueError(
                f"rest_rotations must be unit quaternions, got norm {norms[j]:.4g} at joint {self.names[j]!r}"
            )
        tips = np.full((J, 3), np.nan) if self.tips is None else np.asarray(self.tips, dtype=np.float64)
        if tips.shape != (J, 3):
            raise ValueError(f"tips must have shape ({J}, 3), got {tips.shape}")
        if np.isinf(tips).any():
            raise ValueError("tips must be finite or NaN (unknown), found infinity")
        object.__setattr__(self, "offsets", read_only(as_floats(self.offsets, "offsets", (J, 3))))
        object.__setattr__(self, "rest_rotations", read_only(rest))
        object.__setattr__(self, "tips", read_only(tips))

    @property
    def n_joints(self) -> int:
        """Number of joints J."""
        return len(self.names)

    def index(self, name: str) -> int:
        """Return the index of a joint.

        Parameters
        ----------
        name : str
            Exact joint name.

        Returns
        -------
        int
            Its index.

        Raises
        ------
        ValueError
            If there is no such joint; the message lists the names.
        """
        if name not in self.names:
            raise ValueError(f"no joint named {name!r}; the skeleton has {', '.join(self.names)}")
        return self.names.index(name)

    def children(self, joint: int) -> IntArray:
        """Return the indices of the joints whose parent is `joint`.

        Parameters
        ----------
        joint : int
            Index of a joint.

        Returns
        -------
        (k,) ndarray of int
            Children, in order.
        """
        return as_indices(np.flatnonzero(self.parents == joint), "children", ("k",))


@dataclass(frozen=True, eq=False)
class SkeletonClip(Frozen):
    """Motion of a skeleton: a rotation a joint and the place of the root, per frame."""

    skeleton: Skeleton
    """The joints."""
    rotations: FloatArray
    """(T, J, 4) float64 wxyz unit quaternions, local to the parent (the whole local rotation)."""
    root_position: FloatArray
    """(T, 3) float64, world position of joint 0, metres."""
    fps: float = 30.0
    """Frames per second."""
    name: str = ""
    """Name for a person to read."""
    source: Source = field(default_factory=Source)
    """What the file said."""

    def __post_init__(self) -> None:
        J = self.skeleton.n_joints
        rotations = as_floats(self.rotations, "rotations", ("T", J, 4))
        norms = np.linalg.norm(rotations, axis=-1)
        if norms.size and np.abs(norms - 1).max() > 1e-3:
            t, j = np.unravel_index(int(np.abs(norms - 1).argmax()), norms.shape)
            raise ValueError(
                f"rotations must be unit quaternions, got norm {norms[t, j]:.4g} "
                f"at frame {t}, joint {self.skeleton.names[int(j)]!r}"
            )
        root = as_floats(self.root_position, "root_position", (len(rotations), 3))
        if not 0 < self.fps < float("inf"):
            raise ValueError(f"fps must be positive, got {self.fps}")
        object.__setattr__(self, "rotations", read_only(rotations))
        object.__setattr__(self, "root_position", read_only(root))
        object.__setattr__(self, "fps", float(self.fps))

    @property
    def n_frames(self) -> int:
        """Number of frames T."""
        return len(self.rotations)

    @property
    def times(self) -> FloatArray:
        """(T,) seconds, frame 0 at 0."""
        return np.arange(self.n_frames) / self.fps

    def frames(self, index: slice | IntArray) -> SkeletonClip:
        """Return the clip restricted to some frames; the rate is kept unless a slice has a step.

        Parameters
        ----------
        index : slice or (k,) int
            Frames to keep, in order.

        Returns
        -------
        SkeletonClip
            The shorter clip.
        """
        step = index.step or 1 if isinstance(index, slice) else 1
        return SkeletonClip(
            self.skeleton,
            self.rotations[index],
            self.root_position[index],
            self.fps / abs(step),
            self.name,
            self.source,
        )
