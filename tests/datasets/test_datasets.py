"""Clips are found, fetched from a server on loopback, checked, and missed with a clear message."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Generator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, ClassVar

import pytest

from tempose import datasets
from tempose.datasets import download, folders, registry

NAME = "tiny"
CONTENT = {"a.txt": b"first", "b.txt": b"second"}
TINY = registry.Dataset(
    NAME,
    "two words",
    "CC0",
    ("someone/words",),
    tuple(
        registry.RemoteFile(name, f"someone/words/{'0' * 40}/deep/{name}", hashlib.sha256(data).hexdigest())
        for name, data in CONTENT.items()
    ),
)


class Quiet(SimpleHTTPRequestHandler):
    requests: ClassVar[list[str]] = []

    def log_message(self, format: str, *args: Any) -> None:
        self.requests.append(self.path)


@pytest.fixture(autouse=True)
def _own_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TEMPOSE_DATA", raising=False)
    monkeypatch.setattr(folders.pooch, "os_cache", lambda project: tmp_path / "cache" / project)
    monkeypatch.setattr(registry, "_registry", lambda: {NAME: TINY})
    Quiet.requests = []


@pytest.fixture
def published(tmp_path: Path) -> Path:
    root = tmp_path / "server"
    for file in TINY.files:
        (root / file.address).parent.mkdir(parents=True, exist_ok=True)
        (root / file.address).write_bytes(CONTENT[file.name])
    return root


@pytest.fixture
def host(published: Path) -> Generator[str, None, None]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(published)))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()
    thread.join(timeout=5)


def test_fetch_brings_every_file_and_reports_progress(host: str) -> None:
    seen: list[tuple[int, int]] = []
    folder = datasets.fetch(NAME, lambda done, total, stage: seen.append((done, total)), host=host)
    assert {p.name: p.read_bytes() for p in folder.iterdir()} == CONTENT
    assert folder == datasets.dataset_folder(NAME) == datasets.cache_folder() / NAME
    assert seen == [(0, 2), (1, 2), (2, 2)]


def test_what_is_here_is_not_fetched_again(host: str) -> None:
    datasets.fetch(NAME, host=host)
    Quiet.requests.clear()
    datasets.fetch(NAME, host=host)
    assert Quiet.requests == []


def test_interrupted_fetch_goes_on_where_it_stopped(host: str) -> None:
    folder = datasets.fetch(NAME, host=host)
    (folder / "b.txt").unlink()
    Quiet.requests.clear()
    datasets.fetch(NAME, host=host)
    assert [path.rpartition("/")[2] for path in Quiet.requests] == ["b.txt"]


def test_changed_file_is_refused_and_not_kept(host: str, published: Path) -> None:
    (published / TINY.files[1].address).write_bytes(b"tampered")
    with pytest.raises(datasets.FetchError, match=r"b\.txt is not the file it was") as caught:
        datasets.fetch(NAME, host=host)
    assert "\n" not in str(caught.value)
    assert sorted(p.name for p in (datasets.cache_folder() / NAME).iterdir()) == ["a.txt"]


def test_missing_file_names_the_answer(host: str, published: Path) -> None:
    (published / TINY.files[0].address).unlink()
    with pytest.raises(datasets.FetchError, match="the server answered 404"):
        datasets.fetch(NAME, host=host)


def test_no_network_is_one_line_that_says_where_files_may_be_put() -> None:
    with pytest.raises(datasets.FetchError, match="no connection") as caught:
        datasets.fetch(NAME, host="http://127.0.0.1:9", timeout=2.0)
    message = str(caught.value)
    assert "\n" not in message and str(datasets.cache_folder() / NAME) in message


def test_tempose_data_goes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, host: str) -> None:
    cached = datasets.fetch(NAME, host=host)
    own = tmp_path / "own" / NAME
    own.mkdir(parents=True)
    monkeypatch.setenv("TEMPOSE_DATA", str(own.parent))
    assert datasets.dataset_folder(NAME) == cached
    for name, data in CONTENT.items():
        (own / name).write_bytes(data)
    assert datasets.dataset_folder(NAME) == own == datasets.fetch(NAME, host="http://127.0.0.1:9")


def test_missing_data_set_says_how_to_get_it() -> None:
    with pytest.raises(datasets.DatasetMissing, match="run `tempose data fetch tiny` or set TEMPOSE_DATA"):
        datasets.dataset_folder(NAME)


def test_unknown_name_lists_the_known() -> None:
    for function in (datasets.dataset, datasets.dataset_folder, datasets.fetch):
        with pytest.raises(ValueError, match="no data set named 'nothing'; there are tiny"):
            function("nothing")


def test_pooch_keeps_its_log_level(host: str) -> None:
    level = download.pooch.get_logger().level
    datasets.fetch(NAME, host=host)
    assert download.pooch.get_logger().level == level
