"""Clip errors agree with their formulas written out, whatever the size of the blocks."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.metrics import _frames, compare
from tempose.metrics._tails import UpperTail


@pytest.fixture
def clips(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    V = rng.normal(size=(7, 40, 3)) + np.array([5.0, 0.0, -3.0])
    return V, V + 0.01 * rng.normal(size=V.shape)


def slow_errors(V: np.ndarray, V2: np.ndarray, D: float) -> dict[str, float]:
    T, n, _ = V.shape
    distances: list[float] = []
    squared = spread = 0.0
    for t in range(T):
        centroid = sum(V[t, i] for i in range(n)) / n
        for i in range(n):
            d = math.dist(V[t, i], V2[t, i])
            distances.append(d)
            squared += d * d
            spread += math.dist(V[t, i], centroid) ** 2
    rms = math.sqrt(squared / (n * T))
    return {
        "rms": rms,
        "rms_percent": 100 * rms / D,
        "p99_percent": 100 * float(np.percentile(distances, 99)) / D,
        "max_percent": 100 * max(distances) / D,
        "e_rms": 1000 * math.sqrt(squared) / math.sqrt(3 * n * T) * 2 / D,
        "kg": 100 * math.sqrt(squared) / math.sqrt(spread),
    }


@pytest.mark.parametrize("block", [1, 300, 10**9])
def test_agrees_with_the_formulas_written_as_loops(clips, monkeypatch, block: int) -> None:
    monkeypatch.setattr(_frames, "BLOCK_VALUES", block)
    ours, slow = compare(*clips, D=2.5).as_dict(), slow_errors(*clips, D=2.5)
    assert list(ours) == list(slow)
    assert_allclose(list(ours.values()), list(slow.values()), rtol=1e-12)


def test_a_clip_against_itself_is_exactly_zero(clips) -> None:
    assert set(compare(clips[0], clips[0], D=1.0).as_dict().values()) == {0.0}


def test_numbers_are_plain_so_that_they_go_into_json(clips) -> None:
    errors = compare(*clips, D=np.float32(2.5)).as_dict()  # type: ignore[arg-type]
    assert all(type(value) is float for value in errors.values())


def test_one_vertex_moved_has_the_closed_form() -> None:
    # 2 frames of the corners of a unit square, spread 4 * 1/2 a frame; one corner of one frame off by 0.1
    V = np.tile([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], (2, 1, 1))
    V2 = V.copy()
    V2[1, 2, 2] = 0.1
    errors = compare(V, V2, D=math.sqrt(2))
    assert errors.rms == pytest.approx(0.1 / math.sqrt(8))
    assert errors.max_percent == pytest.approx(10 / math.sqrt(2))
    # rank 0.99 * 7 = 6.93 lies 93 % of the way from the second largest distance (0) to the largest
    assert errors.p99_percent == pytest.approx(0.93 * 10 / math.sqrt(2))
    assert errors.kg == pytest.approx(100 * 0.1 / 2)
    assert errors.e_rms == pytest.approx(1000 * 0.1 / math.sqrt(24) * math.sqrt(2))


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_relative_measures_do_not_know_the_unit_nor_the_place(clips, rng, unit: float) -> None:
    R = Rotation.random(rng=rng).as_matrix()
    V, V2 = (unit * (clip @ R.T + [1.0, -2, 3]) for clip in clips)
    here, there = compare(*clips, D=2.0).as_dict(), compare(V, V2, D=2.0 * unit).as_dict()
    assert there.pop("rms") == pytest.approx(unit * here.pop("rms"), rel=1e-9)
    assert_allclose(list(there.values()), list(here.values()), rtol=1e-9)


def test_kg_counts_each_frame_from_its_own_centroid(clips) -> None:
    V, V2 = clips
    travel = np.arange(7.0)[:, None, None] * [100.0, 0, 0]
    assert compare(V + travel, V2 + travel, D=1).kg == pytest.approx(compare(V, V2, D=1).kg, rel=1e-9)


def test_vertices_and_frames_may_be_renumbered(clips, rng) -> None:
    V, V2 = clips
    t, i = rng.permutation(7), rng.permutation(40)
    renumbered = compare(V[t][:, i], V2[t][:, i], D=1).as_dict()
    assert_allclose(list(renumbered.values()), list(compare(V, V2, D=1).as_dict().values()), rtol=1e-12)


def test_kg_is_relative_to_the_first_and_all_others_are_symmetric(clips) -> None:
    V, V2 = clips
    forth, back = compare(V, 2 * V2, D=1).as_dict(), compare(2 * V2, V, D=1).as_dict()
    assert forth.pop("kg") > 1.5 * back.pop("kg")
    assert_allclose(list(forth.values()), list(back.values()), rtol=1e-12)


def test_one_frame_of_one_vertex() -> None:
    V = np.zeros((1, 1, 3))
    errors = compare(V, V + np.array([0.0, 3, 4]), D=10)
    assert (errors.rms, errors.p99_percent, errors.max_percent) == (5, 50, 50)
    assert errors.kg == math.inf
    assert compare(V, V, D=10).kg == 0


def test_a_float32_memory_map_gives_what_the_array_gives(tmp_path: Path, clips) -> None:
    V, V2 = (clip.astype(np.float32) for clip in clips)
    np.save(tmp_path / "V.npy", V)
    mapped = np.load(tmp_path / "V.npy", mmap_mode="r")
    assert compare(mapped, V2, D=1) == compare(V, V2, D=1)


def test_float32_clips_are_measured_in_double(clips) -> None:
    single = [(clip + 1000.0).astype(np.float32) for clip in clips]
    assert compare(*single, D=1) == compare(*(clip.astype(np.float64) for clip in single), D=1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda V: (V, V[:, :-1], 1.0), r"V2 must have the shape \(7, 40, 3\) of V, got \(7, 39, 3\)"),
        (
            lambda V: (V[0], V[0], 1.0),
            r"V must be numbers of shape \(T, n, 3\), got float64 of shape \(40, 3\)",
        ),
        (
            lambda V: (V[:0], V[:0], 1.0),
            r"V must hold at least one frame and one vertex, got shape \(0, 40, 3\)",
        ),
        (lambda V: (V[:, :0], V[:, :0], 1.0), "at least one frame and one vertex"),
        (lambda V: (V.astype(str), V, 1.0), "V must be numbers"),
        (lambda V: (V, V, 0.0), "D must be the positive diagonal .* got 0.0"),
        (lambda V: (V, V, math.nan), "D must be the positive diagonal .* got nan"),
    ],
)
def test_what_cannot_be_compared_is_refused(clips, change, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        compare(*change(clips[0]))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
@pytest.mark.parametrize("which", [0, 1])
def test_nan_is_refused_with_its_place(clips, monkeypatch, bad: float, which: int) -> None:
    monkeypatch.setattr(_frames, "BLOCK_VALUES", 300)
    clips[which][5, 17, 1] = bad
    with pytest.raises(ValueError, match=rf"{('V', 'V2')[which]} must be finite, .* frame 5, vertex 17"):
        compare(*clips, D=1)


@pytest.mark.parametrize("percent", [0, 1, 50, 99, 100])
@pytest.mark.parametrize("total", [1, 2, 3, 100, 101, 1234])
def test_the_running_tail_equals_numpy_percentile(rng, total: int, percent: float) -> None:
    values = rng.normal(size=total)
    tail = UpperTail(total, percent)
    for part in np.array_split(values, 7):
        tail.add(part)
    assert tail.percentile == pytest.approx(float(np.percentile(values, percent)), rel=1e-12)
    assert tail.maximum == values.max()


def test_the_running_tail_keeps_only_its_share(rng) -> None:
    tail = UpperTail(100_000, 99)
    for part in rng.normal(size=(100, 1000)):
        tail.add(part)
    assert len(tail._tail) <= 1002
