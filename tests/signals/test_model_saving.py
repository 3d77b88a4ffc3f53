"""A saved model plays bit for bit what it played before, and keeps all that it was made from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from model_clips import clip_of, still, swinging, wandering

from tempose.clips.source import Source
from tempose.curves import monotone_map
from tempose.models import load_model, save_model
from tempose.shape_spaces import SPACES
from tempose.signals import SignalModel
from tempose.signals.time.origin import Origin

OPTIONS = [
    {},
    {"k": 20, "l": 15, "m": 5},
    {"between": "paper"},
    {"between": "dense"},
    {"placement": True},
    {"window": 16},
    {"layout": "mds", "period": 13.3},
]


def round_trip(model: SignalModel, tmp_path: Path) -> SignalModel:
    return SignalModel.load(model.save(tmp_path / "m.tempose"))


@pytest.mark.parametrize("options", OPTIONS)
def test_what_is_loaded_plays_bit_for_bit_alike(options: dict[str, object], tmp_path: Path) -> None:
    model = SignalModel(**options).fit(swinging())  # type: ignore[arg-type]
    loaded = round_trip(model, tmp_path)
    for dtype in (np.float32, np.float64):
        assert np.array_equal(loaded.sample(fps=97, dtype=dtype), model.sample(fps=97, dtype=dtype))
    assert np.array_equal(loaded.pose_at((0.1, 0.2)), model.pose_at((0.1, 0.2)))
    assert np.array_equal(loaded.positions_, model.positions_)
    assert np.array_equal(loaded.site_frames_, model.site_frames_)
    assert loaded.report_ == model.report_ and loaded.options == model.options


@pytest.mark.parametrize("space", SPACES)
def test_so_does_it_in_every_shape_space(space: str, tmp_path: Path) -> None:
    model = SignalModel(space, k=14, l=12, m=5).fit(wandering(size=0.05))
    assert np.array_equal(round_trip(model, tmp_path).sample(fps=40), model.sample(fps=40))


def test_a_still_clip_survives(tmp_path: Path) -> None:
    model = SignalModel().fit(still())
    assert np.array_equal(round_trip(model, tmp_path).sample(), model.sample())


def test_edited_clocks_survive(tmp_path: Path) -> None:
    model = SignalModel().fit(swinging())
    slow = monotone_map(np.array([0.0, 60.0]), np.array([0.0, 39.0]))
    origin = Origin(np.array([0.0, 10.0]), np.array([0.0, 25.0]), np.array([1.0, -1.0]))
    model.signals_ = replace(model.signals_, retimings=(slow,), origin=origin, fps=50.0)
    loaded = round_trip(model, tmp_path)
    assert loaded.signals_.fps == 50 and len(loaded.signals_.times) == len(model.signals_.times)
    assert np.array_equal(loaded.sample(), model.sample())


def test_uvs_groups_and_names_are_kept(tmp_path: Path) -> None:
    V = swinging().vertices
    clip = clip_of(
        V,
        fps=12.5,
        uv=np.linspace(0, 1, 10).reshape(5, 2),
        uv_faces=np.array([[0, 1, 2], [2, 3, 4], [0, 2, 4], [1, 3, 0]]),
        colors=np.full((4, 3), 0.25),
        groups={"top": np.array([0, 2]), "none": np.zeros(0, np.int32)},
        polygons=np.array([4, 4]),
        name="tetra",
    )
    clip = replace(clip, source=Source("a.obj", "obj", "z", 0.01, 25.0, ("fps",), ("one note",)))
    played = round_trip(SignalModel().fit(clip), tmp_path).clip()
    mesh = played.mesh
    for name in ("vertices", "faces", "uv", "uv_faces", "colors", "polygons"):
        found, expected = getattr(mesh, name), getattr(clip.mesh, name)
        assert np.array_equal(found, expected) and found.dtype == expected.dtype
    assert mesh.name == "tetra" and played.fps == 12.5 and played.source == clip.source
    assert {k: v.tolist() for k, v in mesh.groups.items()} == {"top": [0, 2], "none": []}


def test_a_model_is_written_the_same_twice(tmp_path: Path) -> None:
    model = SignalModel().fit(swinging())
    first = model.save(tmp_path / "a.tempose").read_bytes()
    assert round_trip(model, tmp_path).save(tmp_path / "b.tempose").read_bytes() == first


@pytest.mark.parametrize("part", ["signals_", "positions_", "source_"])
def test_a_file_without_a_part_is_told(part: str, tmp_path: Path) -> None:
    path = SignalModel().fit(wandering()).save(tmp_path / "m.tempose")
    arrays, header = load_model(path, "signals")
    del header["tree"][part]
    save_model(path, "signals", arrays, header)
    with pytest.raises(ValueError, match=r"m\.tempose: a model of signals whose parts do not fit"):
        SignalModel.load(path)


@pytest.mark.parametrize("name", ["signals.pose.sites", "signals.time.curve.knots", "signals.shape.mean"])
def test_arrays_that_do_not_fit_are_told(name: str, tmp_path: Path) -> None:
    path = SignalModel().fit(wandering()).save(tmp_path / "m.tempose")
    arrays, header = load_model(path, "signals")
    arrays[name] = arrays[name][:-1]
    save_model(path, "signals", arrays, header)
    with pytest.raises(ValueError, match=r"m\.tempose: a model of signals whose parts do not fit"):
        SignalModel.load(path)


def test_a_damaged_file_is_told_or_still_a_model(tmp_path: Path, rng: np.random.Generator) -> None:
    whole = SignalModel(placement=True, window=16).fit(swinging()).save(tmp_path / "m.tempose").read_bytes()
    header = 8 + int.from_bytes(whole[:8], "little")
    refused = told = 0
    for i in range(150):
        damaged = bytearray(whole)
        for at in rng.integers(0, header if i % 2 else len(whole), 2):
            damaged[at] = rng.integers(32, 127)
        (tmp_path / "n.tempose").write_bytes(damaged)
        try:
            assert isinstance(SignalModel.load(tmp_path / "n.tempose"), SignalModel)
        except ValueError as error:
            refused += 1
            told += str(tmp_path / "n.tempose") in str(error)
    assert refused == told > 75


def test_a_rate_that_is_none_is_told(tmp_path: Path) -> None:
    path = SignalModel().fit(wandering()).save(tmp_path / "m.tempose")
    arrays, header = load_model(path, "signals")
    header["tree"]["signals_"]["fields"]["fps"] = 0
    save_model(path, "signals", arrays, header)
    with pytest.raises(ValueError, match="fps and rate must be positive"):
        SignalModel.load(path)


def test_a_file_cannot_name_what_is_no_part_of_signals(tmp_path: Path) -> None:
    path = SignalModel().fit(wandering()).save(tmp_path / "m.tempose")
    arrays, header = load_model(path, "signals")
    header["tree"]["signals_"] = {"class": "Popen", "fields": {"args": "true"}}
    save_model(path, "signals", arrays, header)
    with pytest.raises(ValueError, match="unknown part 'Popen'"):
        SignalModel.load(path)
