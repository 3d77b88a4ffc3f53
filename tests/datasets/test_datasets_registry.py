"""The registry names every file once, by a pinned commit, and its checksums are those of the real files."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tempose import datasets


@pytest.mark.parametrize("name", datasets.dataset_names())
def test_addresses_are_pinned_and_names_distinct(name: str) -> None:
    entry = datasets.dataset(name)
    names = [file.name for file in entry.files]
    assert names and len(set(names)) == len(names)
    for file in entry.files:
        assert re.fullmatch(r"[\w.-]+/[\w.-]+/[0-9a-f]{40}/\S+", file.address)
        assert file.address.endswith("/" + file.name)
        assert re.fullmatch(r"[0-9a-f]{64}", file.sha256)
    assert {"/".join(f.address.split("/")[:2]) for f in entry.files} == set(entry.repositories)
    assert entry.about and entry.licence


@pytest.mark.real
@pytest.mark.parametrize("name", ["mocap-cmu", "rigged-gltf", "horse-camel-poses"])
def test_checksums_are_those_of_the_real_files(name: str, data_folder: Callable[[str], Path]) -> None:
    folder = data_folder(name)
    for file in datasets.dataset(name).files:
        assert hashlib.sha256((folder / file.name).read_bytes()).hexdigest() == file.sha256
