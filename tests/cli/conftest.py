"""Small clips on disk and a way to run a command as the shell would."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tempose.cli import main
from tempose.clips import Mesh, MeshClip

FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32)
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1.5, 0], [0, 0, 1]])


@dataclass
class Ran:
    """What a command left behind."""

    code: int
    out: str
    err: str

    @property
    def line(self) -> str:
        """The one line of standard error of a command that failed."""
        assert self.err.endswith("\n") and self.err.count("\n") == 1, self.err
        assert self.err.startswith("tempose: ") and "Traceback" not in self.err
        return self.err.removesuffix("\n")


@pytest.fixture
def run(capfd: pytest.CaptureFixture[str]) -> Callable[..., Ran]:
    def run_(*words: object) -> Ran:
        capfd.readouterr()
        code = main([str(word) for word in words])
        out, err = capfd.readouterr()
        return Ran(code, out, err)

    return run_


@pytest.fixture
def clip(rng: np.random.Generator) -> MeshClip:
    """Five frames of a tetrahedron, its first frame its rest pose."""
    frames = (CORNERS + 0.1 * rng.normal(size=(5, 4, 3))).astype(np.float32)
    return MeshClip(frames, Mesh(frames[0], FACES), 30.0)


def write_frames(folder: Path, clip: MeshClip) -> Path:
    folder.mkdir()
    for t, V in enumerate(clip.vertices):
        lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in V]
        lines += [f"f {a} {b} {c}" for a, b, c in clip.faces + 1]
        (folder / f"{t}.obj").write_text("\n".join(lines) + "\n")
    return folder


@pytest.fixture
def frames(tmp_path: Path, clip: MeshClip) -> Path:
    """A folder with `clip` in it, one OBJ a frame."""
    return write_frames(tmp_path / "frames", clip)
