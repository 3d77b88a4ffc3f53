"""Files read back as what was written; half a file never appears."""

from __future__ import annotations

import re
import subprocess
import sys

import imageio_ffmpeg
import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from tempose.clips import Mesh, MeshClip
from tempose.render import contact_sheet, film, render, render_frame, save_gif, save_mp4, save_png
from tempose.render.camera import Camera
from tempose.render.writers import gif_delays


def moving(count=7, width=61, height=40):
    frames = np.full((count, height, width, 3), [30, 60, 90], np.uint8)
    for t in range(count):
        frames[t, 10:20, 5 * t : 5 * t + 12] = [200, 160 - 10 * t, 20]
    return frames


def read_mp4(path):
    """Decode with ffmpeg itself: size, what ffmpeg says about the stream, frames."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(command, capture_output=True, check=True)
    stream = next(line for line in done.stderr.decode().splitlines() if "Video:" in line)
    width, height = (int(k) for k in re.search(r"(\d{2,})x(\d{2,})", stream).groups())
    return (width, height), stream, np.frombuffer(done.stdout, np.uint8).reshape(-1, height, width, 3)


def read_gif(path):
    with Image.open(path) as image:
        frames, delays = [], []
        for t in range(image.n_frames):
            image.seek(t)
            frames.append(np.asarray(image.convert("RGB")))
            delays.append(image.info["duration"])
        return frames, delays, image.info.get("loop")


def test_png_reads_back_exactly(tmp_path, rng):
    picture = rng.integers(0, 256, (13, 17, 3), dtype=np.uint8)
    save_png(picture, tmp_path / "a.png")
    assert_array_equal(np.asarray(Image.open(tmp_path / "a.png")), picture)


def test_gif_keeps_frames_colours_speed_and_loops(tmp_path):
    frames = moving()
    save_gif(frames, tmp_path / "a.gif", 24.0)
    shots, delays, loop = read_gif(tmp_path / "a.gif")
    assert len(shots) == 7 and loop == 0
    assert_allclose(sum(delays), 7 * 1000 / 24, atol=10)
    for shot, frame in zip(shots, frames):
        assert shot.shape == frame.shape
        assert np.abs(shot.astype(int) - frame).max() <= 12


@pytest.mark.parametrize("fps", [7.0, 24.0, 29.97, 30.0, 50.0])
def test_gif_delays_keep_the_speed(fps):
    delays = gif_delays(300, fps)
    assert_allclose(sum(delays), 300_000 / fps, atol=10)
    assert min(delays) >= 20 and all(d % 10 == 0 for d in delays)


@pytest.mark.parametrize(("width", "height"), [(60, 40), (61, 41), (16, 16)])
def test_mp4_keeps_frames_size_speed_and_colours(tmp_path, width, height):
    frames = moving(9, width, height)
    save_mp4(frames, tmp_path / "a.mp4", 24.0)
    size, stream, shots = read_mp4(tmp_path / "a.mp4")
    assert "h264" in stream and "yuv420p" in stream and "24 fps" in stream
    assert size == (width + width % 2, height + height % 2)
    assert len(shots) == 9
    for shot, frame in zip(shots, frames):
        assert_allclose(shot[:height, :width].astype(int).mean(axis=(0, 1)), frame.mean(axis=(0, 1)), atol=4)


@pytest.mark.parametrize(("save", "name"), [(save_gif, "a.gif"), (save_mp4, "a.mp4")])
def test_what_breaks_half_way_leaves_the_old_file(tmp_path, save, name):
    path = tmp_path / name
    path.write_bytes(b"old")

    def broken():
        yield from moving(3)
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        save(broken(), path)
    with pytest.raises(ValueError, match=r"one size, got \(40, 50, 3\) at 1 after \(40, 61, 3\)"):
        save([moving(1)[0], moving(1, 50)[0]], path)
    with pytest.raises(ValueError, match="at least one picture"):
        save([], path)
    with pytest.raises(ValueError, match="fps must be positive"):
        save(moving(2), path, 0.0)
    with pytest.raises(ValueError, match=r"frames\[0\] must be uint8"):
        save(moving(2).astype(float), path)
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_frames_are_asked_for_one_by_one(tmp_path):
    seen = []
    frames = moving(5)
    save_mp4(iter(frames), tmp_path / "a.mp4", 10, total=5, progress=lambda *a: seen.append(a))
    assert seen == [(k, 5, "rendering") for k in range(1, 6)]


def box_clip(frames=3):
    box = trimesh.creation.box()
    V = np.asarray(box.vertices) + np.linspace(0, 0.4, frames)[:, None, None] * [1.0, 0, 0]
    return MeshClip(V, Mesh(V[0], box.faces, name="box"), fps=12.0)


def test_render_chooses_by_the_extension(tmp_path):
    clip, look = box_clip(), {"quality": "draft", "workers": 1}
    render(clip, tmp_path / "a.png", frames=2, cell=(30, 30), **look)
    assert_array_equal(
        np.asarray(Image.open(tmp_path / "a.png")), contact_sheet(clip, 2, cell=(30, 30), **look)
    )
    render([clip, clip], tmp_path / "a.mp4", size=(24, 20), **look)
    size, stream, shots = read_mp4(tmp_path / "a.mp4")
    assert size == (48, 20) and "12 fps" in stream and len(shots) == 3
    render(clip, tmp_path / "a.gif", size=(24, 20), frames=[2, 0], **look)
    shots, _, _ = read_gif(tmp_path / "a.gif")
    for shot, frame in zip(shots, film(clip, size=(24, 20), frames=[2, 0], **look)):
        assert np.abs(shot.astype(int) - frame).mean() < 4
    with pytest.raises(ValueError, match=r"\.png, \.gif, \.mp4, got '\.bmp'"):
        render(clip, tmp_path / "a.bmp")


def test_one_frame_is_a_film_too(tmp_path):
    render(box_clip(1), tmp_path / "a.mp4", size=(20, 20), quality="draft")
    render(box_clip(1), tmp_path / "a.gif", size=(20, 20), quality="draft")
    assert len(read_mp4(tmp_path / "a.mp4")[2]) == len(read_gif(tmp_path / "a.gif")[0]) == 1


def test_missing_packages_are_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    for work in (
        lambda: save_png(moving(1)[0], tmp_path / "a.png"),
        lambda: save_mp4(moving(1), tmp_path / "a.mp4"),
    ):
        with pytest.raises(ImportError, match=r'pip install "tempose\[render\]"'):
            work()
    # Pixels need neither.
    assert render_frame(np.eye(3), [[0, 1, 2]], Camera.fit(np.eye(3)), size=(4, 4)).shape == (4, 4, 3)
