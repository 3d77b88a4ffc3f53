"""Fetching clips from the repositories that publish them."""

from __future__ import annotations

import hashlib
import logging
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pooch

from tempose.datasets.folders import DatasetMissing, cache_folder, dataset_folder
from tempose.datasets.registry import RemoteFile, dataset
from tempose.typing import Progress, silent

HOST = "https://raw.githubusercontent.com"
"""Serves files of public repositories by owner, name, commit and path."""


class FetchError(OSError):
    """A data set could not be fetched; the message says why and where its files may be put by hand."""


@contextmanager
def _quiet_pooch() -> Generator[None, None, None]:
    logger = pooch.get_logger()
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def _digest(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _why(error: OSError) -> str:
    response = getattr(error, "response", None)
    if response is not None:
        return f"the server answered {response.status_code}"
    return error.strerror if error.strerror else "no connection"


def _fetch_file(file: RemoteFile, folder: Path, host: str, timeout: float) -> None:
    path = folder / file.name
    if path.is_file() and _digest(path) == file.sha256:
        return
    url = f"{host}/{file.address}"
    downloader: Any = pooch.HTTPDownloader(progressbar=False, timeout=timeout)
    by_hand = f"its files may be put by hand in {folder}"
    try:
        with _quiet_pooch():
            pooch.retrieve(url, f"sha256:{file.sha256}", file.name, folder, downloader=downloader)
    except ValueError:
        raise FetchError(
            f"{folder.name}: {url} is not the file it was (another SHA-256 checksum); {by_hand}"
        ) from None
    except OSError as error:
        raise FetchError(f"{folder.name}: cannot fetch {url}: {_why(error)}; {by_hand}") from None


def fetch(name: str, progress: Progress = silent, *, host: str = HOST, timeout: float = 30.0) -> Path:
    """Get a data set, from this machine if it is here, else from the repositories that publish it.

    Every file is checked against its SHA-256 checksum. Files that arrived stay when a later one fails.

    Parameters
    ----------
    name : str
        One of `dataset_names`.
    progress : Progress, default silent
        Called with the number of files that are here.
    host : str
        Serves ``/owner/name/commit/path``; a mirror may stand in for the default.
    timeout : float, default 30
        Seconds to wait for an answer.

    Returns
    -------
    Path
        Folder that holds every file.

    Raises
    ------
    ValueError
        If there is no data set of that name.
    FetchError
        If a file cannot be had or is not the file it was.
    """
    try:
        return dataset_folder(name)
    except DatasetMissing:
        folder = cache_folder() / name
    files = dataset(name).files
    for i, file in enumerate(files):
        progress(i, len(files), f"fetching {name}")
        _fetch_file(file, folder, host, timeout)
    progress(len(files), len(files), f"fetching {name}")
    return folder
