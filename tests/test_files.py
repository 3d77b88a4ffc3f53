"""Nothing but a whole result ever stands under the final name, whatever goes wrong."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tempose._files import atomic_path


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("given", [str, Path])
def test_a_file_appears_when_the_block_ends_and_not_before(tmp_path: Path, given) -> None:
    target = tmp_path / "clip.npz"
    with atomic_path(given(target)) as part:
        assert part.suffix == ".npz" and part.name == "clip.npz" and not part.exists()
        part.write_text("half")
        assert not target.exists()
        part.write_text("whole")
    assert target.read_text() == "whole"
    assert names(tmp_path) == ["clip.npz"]


def test_a_folder_appears_when_the_block_ends(tmp_path: Path) -> None:
    with atomic_path(tmp_path / "frames", folder=True) as part:
        assert part.is_dir() and names(part) == []
        (part / "1.obj").write_text("v")
        assert names(tmp_path) != ["frames"]
    assert names(tmp_path) == ["frames"] and names(tmp_path / "frames") == ["1.obj"]


def test_an_existing_file_is_replaced_and_an_existing_folder_as_a_whole(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("old")
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "old.obj").write_text("old")
    with atomic_path(tmp_path / "a.obj") as part:
        part.write_text("new")
        assert (tmp_path / "a.obj").read_text() == "old"
    with atomic_path(tmp_path / "frames", folder=True) as part:
        (part / "new.obj").write_text("new")
        assert names(tmp_path / "frames") == ["old.obj"]
    assert (tmp_path / "a.obj").read_text() == "new"
    assert names(tmp_path / "frames") == ["new.obj"]
    assert names(tmp_path) == ["a.obj", "frames"]


@pytest.mark.parametrize("folder", [False, True])
@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit, MemoryError])
@pytest.mark.parametrize("existing", [False, True])
def test_a_block_that_fails_leaves_what_was_there(
    tmp_path: Path, folder: bool, error, existing: bool
) -> None:
    target = tmp_path / "result"
    inside = target / "old.obj" if folder else target
    if existing:
        inside.parent.mkdir(exist_ok=True)
        inside.write_text("old")

    def write_half(part: Path) -> None:
        (part / "1.obj" if folder else part).write_text("half")
        raise error

    with pytest.raises(error), atomic_path(target, folder=folder) as part:
        write_half(part)
    assert names(tmp_path) == (["result"] if existing else [])
    assert not existing or inside.read_text() == "old"


def test_a_full_disk_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "clip.npz"
    target.write_text("old")

    def full(self: Path, data: bytes) -> int:
        with open(self, "wb") as file:
            file.write(data[: len(data) // 2])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left on device"), atomic_path(target) as part:
        part.write_bytes(b"0123456789")
    assert names(tmp_path) == ["clip.npz"] and target.read_text() == "old"


def refuse(call: Callable[..., None], when: Callable[[Path], bool]) -> Callable[[Path, Path], None]:
    def replace(source: Path, destination: Path) -> None:
        if when(Path(destination)):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(destination))
        call(source, destination)

    return replace


@pytest.mark.parametrize("folder", [False, True])
def test_a_rename_that_fails_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: bool
) -> None:
    target = tmp_path / "result"
    inside = target / "old.obj" if folder else target
    inside.parent.mkdir(exist_ok=True)
    inside.write_text("old")
    attempts: list[Path] = []

    def first_time_at_the_target(destination: Path) -> bool:
        attempts.append(destination)
        return destination == target and attempts.count(target) == 1

    monkeypatch.setattr(os, "replace", refuse(os.replace, first_time_at_the_target))
    with pytest.raises(PermissionError), atomic_path(target, folder=folder) as part:
        (part / "new.obj" if folder else part).write_text("new")
    assert names(tmp_path) == ["result"] and inside.read_text() == "old"


def test_a_block_that_writes_nothing_is_an_error_and_keeps_the_old(tmp_path: Path) -> None:
    target = tmp_path / "clip.npz"
    target.write_text("old")
    with pytest.raises(FileNotFoundError), atomic_path(target):
        pass
    assert target.read_text() == "old" and names(tmp_path) == ["clip.npz"]


def test_a_missing_parent_is_named(tmp_path: Path) -> None:
    with pytest.raises(
        FileNotFoundError, match=r"missing: no such folder to write 'a.obj' in; create it first"
    ):
        with atomic_path(tmp_path / "missing" / "a.obj"):
            raise AssertionError("the block must not run")


def test_a_parent_that_is_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileNotFoundError, match=r"file: no such folder to write 'a.obj' in"):
        with atomic_path(tmp_path / "file" / "a.obj"):
            raise AssertionError("the block must not run")


def test_a_read_only_folder_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(path: str, mode: int = 0o777) -> None:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)

    monkeypatch.setattr(os, "mkdir", refused)
    with pytest.raises(PermissionError) as caught, atomic_path(tmp_path / "a.obj"):
        raise AssertionError("the block must not run")
    assert str(tmp_path) in str(caught.value)
    assert names(tmp_path) == []


def test_a_folder_does_not_replace_a_file_nor_a_file_a_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("old")
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError, match="file"), atomic_path(tmp_path / "file", folder=True):
        pass
    with pytest.raises(OSError, match="folder"), atomic_path(tmp_path / "folder") as part:
        part.write_text("new")
    assert names(tmp_path) == ["file", "folder"] and (tmp_path / "file").read_text() == "old"


def test_two_writers_of_one_name_do_not_meet_and_the_last_wins(tmp_path: Path) -> None:
    target = tmp_path / "a.obj"
    with atomic_path(target) as first, atomic_path(target) as second:
        assert first != second
        first.write_text("first")
        second.write_text("second")
    assert target.read_text() == "first" and names(tmp_path) == ["a.obj"]


def test_new_files_have_the_usual_permissions(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    (tmp_path / "plain_folder").mkdir()
    with atomic_path(tmp_path / "file") as part:
        part.write_text("")
    with atomic_path(tmp_path / "folder", folder=True):
        pass
    assert (tmp_path / "file").stat().st_mode == (tmp_path / "plain").stat().st_mode
    assert (tmp_path / "folder").stat().st_mode == (tmp_path / "plain_folder").stat().st_mode
