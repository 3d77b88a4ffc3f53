"""Model files: exact, atomic, and clear about what is wrong with them."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import save_file

from tempose.models import FORMAT_VERSION, load_model, save_model

ARRAYS = {
    "a": np.arange(6, dtype=np.float64).reshape(2, 3) / 7,
    "b": np.array([1, -2], np.int32),
    "none": np.zeros((0, 4)),
    "one": np.float32([np.pi]),
}


def saved(tmp_path: Path, kind: str = "signals", **header: object) -> Path:
    return save_model(tmp_path / "x.tempose", kind, ARRAYS, {"what": [1, "two", None], **header})


def with_header(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "y.tempose"
    save_file({"a": np.zeros(2)}, path, metadata={"tempose": text})
    return path


def test_arrays_and_header_come_back_exactly(tmp_path: Path) -> None:
    arrays, header = load_model(saved(tmp_path), "signals")
    assert set(arrays) == set(ARRAYS)
    for name, array in ARRAYS.items():
        assert arrays[name].dtype == array.dtype and arrays[name].shape == array.shape
        assert arrays[name].tobytes() == array.tobytes()
    assert header["what"] == [1, "two", None] and header["kind"] == "signals"
    assert header["format_version"] == FORMAT_VERSION


def test_arrays_that_are_no_plain_block_of_memory_come_back_too(tmp_path: Path) -> None:
    A = np.arange(24.0).reshape(4, 6)
    path = save_model(tmp_path / "x.tempose", "signals", {"t": A.T, "s": A[::2, ::3]}, {})
    arrays, _ = load_model(path, "signals")
    assert np.array_equal(arrays["t"], A.T) and np.array_equal(arrays["s"], A[::2, ::3])


def test_equal_models_are_equal_files(tmp_path: Path) -> None:
    first = saved(tmp_path).read_bytes()
    assert saved(tmp_path).read_bytes() == first


def test_every_way_of_cutting_a_file_short_is_told(tmp_path: Path) -> None:
    path = saved(tmp_path)
    whole = path.read_bytes()
    for length in [*range(0, len(whole), 37), len(whole) - 1]:
        path.write_bytes(whole[:length])
        with pytest.raises(ValueError, match=r"x\.tempose: no Tempose model, or one cut short"):
            load_model(path, "signals")


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"ply\n",
        b"\x80\x04K\x01.",
        b"PK\x03\x04" + bytes(60),
        struct.pack("<Q", 2**62) + b"{}",
        bytes(500),
    ],
)
def test_foreign_files_are_told_by_name(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.tempose"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"x\.tempose: no Tempose model"):
        load_model(path, "signals")


def test_safetensors_of_others_are_told(tmp_path: Path) -> None:
    save_file({"a": np.zeros(2)}, tmp_path / "x.tempose")
    with pytest.raises(ValueError, match="Tempose did not write"):
        load_model(tmp_path / "x.tempose", "signals")


@pytest.mark.parametrize("text", ["", "[]", "{", '{"kind": "signals"}', '{"kind": 1, "format_version": "x"}'])
def test_a_broken_header_is_told(tmp_path: Path, text: str) -> None:
    with pytest.raises(ValueError, match=r"y\.tempose"):
        load_model(with_header(tmp_path, text), "signals")


def test_a_newer_format_says_to_update(tmp_path: Path) -> None:
    newer = {"kind": "signals", "format_version": FORMAT_VERSION + 1, "version": "9.9"}
    with pytest.raises(ValueError, match=r"model format 2 by Tempose 9.9.*update Tempose"):
        load_model(with_header(tmp_path, json.dumps(newer)), "signals")


def test_another_kind_is_told(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="kind 'detail', expected 'signals'"):
        load_model(saved(tmp_path, "detail"), "signals")


def test_what_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nothing\.tempose: no such file"):
        load_model(tmp_path / "nothing.tempose", "signals")
    with pytest.raises(ValueError, match="a folder"):
        load_model(tmp_path, "signals")


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    path = saved(tmp_path)
    before = path.read_bytes()
    with pytest.raises(TypeError):
        save_model(path, "signals", ARRAYS, {"x": object()})
    with pytest.raises(ValueError, match="JSON"):
        save_model(path, "signals", ARRAYS, {"x": float("nan")})
    assert path.read_bytes() == before and list(tmp_path.iterdir()) == [path]


def test_whoever_may_read_a_new_file_may_read_a_model(tmp_path: Path) -> None:
    (tmp_path / "new").touch()
    assert saved(tmp_path).stat().st_mode == (tmp_path / "new").stat().st_mode
