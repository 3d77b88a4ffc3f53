"""Where clips lie on this machine."""

from __future__ import annotations

import os
from pathlib import Path

import pooch

from tempose.datasets.registry import dataset


class DatasetMissing(FileNotFoundError):
    """A data set is not on this machine; the message says how to get it."""


def cache_folder() -> Path:
    """Return the folder of the user's cache that `fetch` fills.

    Returns
    -------
    Path
        It need not exist yet.
    """
    return Path(pooch.os_cache("tempose")) / "data"


def is_complete(name: str, folder: Path) -> bool:
    """Say whether a folder holds every file of a data set, by name.

    Parameters
    ----------
    name : str
        One of `dataset_names`.
    folder : Path
        Folder to look in.

    Returns
    -------
    bool
        True if no file is missing.
    """
    return all((folder / file.name).is_file() for file in dataset(name).files)


def dataset_folder(name: str) -> Path:
    """Find the folder of a data set: below ``TEMPOSE_DATA`` if it is there, else in the user's cache.

    Parameters
    ----------
    name : str
        One of `dataset_names`.

    Returns
    -------
    Path
        A folder that holds every file.

    Raises
    ------
    ValueError
        If there is no data set of that name.
    DatasetMissing
        If it is in neither place.
    """
    dataset(name)
    given = os.environ.get("TEMPOSE_DATA")
    places = [Path(given) / name] if given else []
    places.append(cache_folder() / name)
    for folder in places:
        if is_complete(name, folder):
            return folder
    where = " nor ".join(str(folder) for folder in places)
    raise DatasetMissing(f"{name}: not found in {where}; run `tempose data fetch {name}` or set TEMPOSE_DATA")
