"""Which places of the source move which faces of the target."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from tempose._validate import as_floats, as_indices, read_only
from tempose.typing import FloatArray, IntArray

Kind = Literal["joints", "faces", "vertices"]
KINDS: tuple[Kind, ...] = ("joints", "faces", "vertices")
HOW = ("picked", "suggested", "ring", "mirror", "automatic")
FEWEST = {"joints": 2, "faces": 3, "vertices": 3}


@dataclass(frozen=True, eq=False)
class Pairs:
    """Correspondences between a moving source and a still target, 0-based."""

    kind: Kind
    """What `source` holds: joint names of a skeleton, or faces or vertices of a mesh."""
    source: tuple[str, ...] | IntArray
    """k joint names, or (k,) int."""
    target: IntArray
    """(k,) int: faces of the target, or its vertices for kind ``"vertices"``."""
    parts: tuple[str, ...] = ()
    """Name of the body part of each pair, or nothing."""
    joints: Mapping[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    """Joint name to its (3,) position in the target, metres; may be empty, then they are estimated."""
    ends: Mapping[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    """Joint name to the (3,) far end of its bone in the target, metres; may be empty."""
    origin: str = ""
    """Where the pairs come from, for messages."""
    how: tuple[str, ...] = ()
    """How each pair came to be: ``"picked"`` by a person, ``"suggested"`` and accepted, ``"ring"``,
    ``"mirror"`` or ``"automatic"``; or nothing."""
    comment: str = ""
    """What a person wrote about them."""
    files: tuple[str, str] = ("", "")
    """Names of the source and target files, for a person to read."""

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            raise ValueError(f"kind of pairs must be one of {', '.join(KINDS)}, got {self.kind!r}")
        target = as_indices(self.target, "target of pairs", ("k",))
        set_ = object.__setattr__
        set_(self, "target", read_only(target))
        if self.kind == "joints":
            set_(self, "source", tuple(str(name) for name in self.source))
        else:
            set_(self, "source", read_only(as_indices(self.source, "source of pairs", ("k",))))
        if len(self.source) != len(target):
            raise ValueError(
                f"pairs need as many sources as targets, got {len(self.source)} and {len(target)}"
            )
        if self.parts and len(self.parts) != len(target):
            raise ValueError(f"part must name every one of the {len(target)} pairs, got {len(self.parts)}")
        if self.how and len(self.how) != len(target):
            raise ValueError(f"how must stand for every one of the {len(target)} pairs, got {len(self.how)}")
        strange = [word for word in self.how if word not in HOW]
        if strange:
            raise ValueError(f"how of a pair must be one of {', '.join(HOW)}, got {strange[0]!r}")
        for name in ("joints", "ends"):
            places = getattr(self, name)
            set_(self, name, {k: as_floats(v, f"{name}[{k!r}]", (3,)) for k, v in places.items()})

    def __len__(self) -> int:
        return len(self.target)

    def check(self, n_source: int, n_target: int, joint_names: tuple[str, ...] = ()) -> None:
        """Hold the pairs against the two things they speak of.

        Parameters
        ----------
        n_source : int
            Faces or vertices of the source mesh; ignored for joints.
        n_target : int
            Faces (or vertices, for that kind) of the target.
        joint_names : tuple of str
            Joints of the source skeleton; ignored for meshes.

        Raises
        ------
        ValueError
            If a pair names what does not exist, a target twice, or there are too few; the message names
            the first such pair.
        """
        where = f" in {self.origin}" if self.origin else ""
        what = "vertex" if self.kind == "vertices" else "triangle"
        wrong = np.flatnonzero(self.target >= n_target)
        if len(wrong):
            raise ValueError(
                f"pair {wrong[0]}{where} names target {what} {self.target[wrong[0]]}, "
                f"but the target has {n_target} (0 to {n_target - 1})"
            )
        order = np.argsort(self.target, kind="stable")
        twice = order[1:][np.diff(self.target[order]) == 0]
        if len(twice):
            raise ValueError(
                f"pair {twice.min()}{where} names target {what} {self.target[twice.min()]} "
                "a second time; give each one a single partner"
            )
        self._check_source(n_source, joint_names, where, what)
        distinct = len(set(self.source)) if self.kind == "joints" else len(self)
        if distinct < FEWEST[self.kind]:
            noun = "different joints" if self.kind == "joints" else f"pairs of {self.kind}"
            raise ValueError(
                f"pairs{where} are too few: at least {FEWEST[self.kind]} {noun} are needed, got {distinct}"
            )

    def _check_source(self, n_source: int, joint_names: tuple[str, ...], where: str, what: str) -> None:
        if self.kind == "joints":
            unknown = [(i, name) for i, name in enumerate(self.source) if name not in joint_names]
            if unknown:
                raise ValueError(
                    f"pair {unknown[0][0]}{where} names joint {unknown[0][1]!r}, which the source "
                    f"does not have; it has {', '.join(joint_names)}"
                )
            return
        source = np.asarray(self.source)
        wrong = np.flatnonzero(source >= n_source)
        if len(wrong):
            raise ValueError(
                f"pair {wrong[0]}{where} names source {what} {source[wrong[0]]}, "
                f"but the source has {n_source} (0 to {n_source - 1})"
            )
