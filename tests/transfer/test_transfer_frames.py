"""Frames in a file are the frames in memory, and the file costs none."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from transfer_bodies import about, clip_of, human_body

from tempose.clips import MeshClip
from tempose.transfer import transfer_motion
from tempose.transfer.frames import gather, make_frames, release

MEASURES = (
    "edge_ratio", "edge_ratio_max", "flipped_percent", "folded_percent", "volume", "quaternion_norm_min",
    "skate", "source_skate", "penetration_cm", "bone_direction_deg", "scale", "root_correction_m",
)  # fmt: skip


def test_a_result_on_disk_is_the_result_in_memory(tmp_path: Path) -> None:
    body = human_body()
    bends = np.stack([about("x", d) for d in np.linspace(0, 60, 21)])
    clip = clip_of(body.skeleton, {"left_shin": bends, "right_upper_arm": bends}, 21)
    memory = transfer_motion(clip, body)
    disk = transfer_motion(clip, body, scratch=tmp_path)
    assert isinstance(disk.clip.vertices, np.memmap) and not disk.clip.vertices.flags.writeable
    assert_array_equal(disk.clip.vertices, memory.clip.vertices)
    for key in MEASURES:
        assert disk.report[key] == memory.report[key], key
    assert sum(p.stat().st_size for p in tmp_path.iterdir()) == disk.clip.vertices.nbytes


def test_what_is_let_go_of_is_still_there(tmp_path: Path, rng: np.random.Generator) -> None:
    frames = make_frames(40, 500, tmp_path)
    expected = rng.normal(size=frames.shape).astype(np.float32)
    for t in range(0, 40, 7):
        frames[t : t + 7] = expected[t : t + 7]
        release(frames)
    assert_array_equal(frames, expected)
    clip = frames.view()
    release(clip)
    release(expected)
    assert_array_equal(clip[3:9, 7], expected[3:9, 7])
    chosen = rng.integers(0, 500, 30)
    assert_array_equal(gather(frames, chosen), expected[:, chosen])
    assert gather(frames, chosen).dtype == np.float64


def test_two_results_in_one_folder_are_two_files(tmp_path: Path) -> None:
    a, b = make_frames(2, 3, tmp_path), make_frames(2, 3, tmp_path)
    a[:] = 1
    assert (b == 0).all()


class _Usage(NamedTuple):
    free: int


def test_a_folder_that_cannot_hold_them_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(FileNotFoundError, match="no such folder to keep frames in"):
        make_frames(1, 1, tmp_path / "none")
    monkeypatch.setattr(shutil, "disk_usage", lambda place: _Usage(free=12 * 20 - 1))
    with pytest.raises(OSError, match="no room for frames"):
        make_frames(4, 5, tmp_path)
    assert list(tmp_path.iterdir()) == []
    assert make_frames(3, 5, tmp_path).shape == (3, 5, 3)


LONG = """
import resource, sys, numpy as np
from pathlib import Path
import tempose
from tempose.clips import Mesh, Skeleton, SkeletonClip
from tempose.cli.transfer_frames import releasing
from tempose.typing import silent
T, k = {frames}, 150
x, z = np.meshgrid(np.linspace(0, 2, k), np.linspace(0, 2 * np.pi, k, endpoint=False), indexing="ij")
V = np.stack([0.2 * np.cos(z).ravel(), x.ravel(), 0.2 * np.sin(z).ravel()], axis=1)
i = (np.arange(k - 1)[:, None] * k + np.arange(k)).ravel()
j = (np.arange(k - 1)[:, None] * k + (np.arange(k) + 1) % k).ravel()
mesh = Mesh(V, np.concatenate([np.c_[i, i + k, j], np.c_[j, i + k, j + k]]))
skeleton = Skeleton(("low", "high"), [-1, 0], [[0, 0, 0], [0, 1, 0]], tips=[[np.nan] * 3, [0, 1, 0]])
turns = np.tile([1.0, 0, 0, 0], (T, 2, 1))
turns[:, 1, 0], turns[:, 1, 1] = np.cos(np.linspace(0, 1, T)), np.sin(np.linspace(0, 1, T))
clip = SkeletonClip(skeleton, turns, np.zeros((T, 3)), 30.0)
y = V[mesh.faces].mean(axis=1)[:, 1]
low, high = np.flatnonzero(abs(y - 0.5) < 0.02), np.flatnonzero(abs(y - 1.5) < 0.02)
pairs = tempose.transfer.Pairs("joints", ["low"] * len(low) + ["high"] * len(high), np.r_[low, high])
result = tempose.transfer.transfer_motion(clip, mesh, pairs, scratch={scratch!r})
tempose.save("{out}", result.clip, progress=releasing(silent, result.clip))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


@pytest.mark.slow
def test_memory_does_not_grow_with_the_clip(tmp_path: Path) -> None:
    """22500 vertices: 200 more frames are 52 MB as float32; only what lies near the feet is kept of them."""
    peak: list[float] = []
    for frames in (100, 300):
        code = LONG.format(frames=frames, scratch=str(tmp_path), out=tmp_path / "out.npz")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        peak.append(int(done.stdout.split()[-1]) / 1024)
    assert peak[1] - peak[0] < 26, peak


def test_a_clip_on_disk_can_be_saved(tmp_path: Path) -> None:
    import tempose

    body = human_body()
    frames = make_frames(5, len(body.mesh.vertices), tmp_path)
    frames[:] = body.mesh.vertices + np.arange(5)[:, None, None]
    clip = MeshClip(frames, body.mesh)
    tempose.save(tmp_path / "a.npz", clip)
    tempose.save(tmp_path / "b.npz", MeshClip(np.array(frames), body.mesh))
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
