"""Real clips: which there are, where they lie on this machine, and how to get them.

No clip is part of Tempose. `fetch` takes them from the public repositories and commits named in
``registry.json`` and keeps them in the user's cache; the folder named by the environment variable
``TEMPOSE_DATA`` goes first.
"""

from tempose.datasets.download import FetchError, fetch
from tempose.datasets.folders import DatasetMissing, cache_folder, dataset_folder, is_complete
from tempose.datasets.registry import Dataset, RemoteFile, dataset, dataset_names

__all__ = [
    "Dataset",
    "DatasetMissing",
    "FetchError",
    "RemoteFile",
    "cache_folder",
    "dataset",
    "dataset_folder",
    "dataset_names",
    "fetch",
    "is_complete",
]
