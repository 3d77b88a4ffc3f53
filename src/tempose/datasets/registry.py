"""Which clips there are: name, licence, source and checksum of every file."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any
from urllib.parse import quote


@dataclass(frozen=True)
class RemoteFile:
    """One file of a data set and where it comes from."""

    name: str
    """File name in the data set's folder."""
    address: str
    """Path below the host that serves repositories: ``owner/name/commit/path``."""
    sha256: str
    """Checksum, hexadecimal."""


@dataclass(frozen=True)
class Dataset:
    """A folder of clips."""

    name: str
    """Name to fetch it by."""
    about: str
    """What is in it, in a few words."""
    licence: str
    """Under what terms its owners give it; Tempose does not change them."""
    repositories: tuple[str, ...]
    """Public repositories it comes from, ``owner/name``."""
    files: tuple[RemoteFile, ...]
    """Every file."""


def _files(sources: list[dict[str, Any]]) -> tuple[RemoteFile, ...]:
    return tuple(
        RemoteFile(path.rpartition("/")[2], f"{s['repository']}/{s['commit']}/{quote(path)}", sha256)
        for s in sources
        for path, sha256 in s["files"].items()
    )


@cache
def _registry() -> dict[str, Dataset]:
    text = resources.files("tempose.datasets").joinpath("registry.json").read_text(encoding="utf-8")
    return {
        name: Dataset(
            name,
            entry["about"],
            entry["licence"],
            tuple(s["repository"] for s in entry["sources"]),
            _files(entry["sources"]),
        )
        for name, entry in json.loads(text).items()
    }


def dataset_names() -> tuple[str, ...]:
    """List the data sets that can be fetched.

    Returns
    -------
    tuple of str
        Names, sorted.

    Examples
    --------
    >>> "horse-gallop" in dataset_names()
    True
    """
    return tuple(sorted(_registry()))


def dataset(name: str) -> Dataset:
    """Look up a data set.

    Parameters
    ----------
    name : str
        One of `dataset_names`.

    Returns
    -------
    Dataset
        Its files, source and licence.

    Raises
    ------
    ValueError
        If there is none of that name; the message lists the names.
    """
    if name not in _registry():
        raise ValueError(f"no data set named {name!r}; there are {', '.join(dataset_names())}")
    return _registry()[name]
