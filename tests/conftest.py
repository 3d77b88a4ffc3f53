"""Fixtures every test may use: a seeded generator, and the real clips where they are."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from tempose.datasets import cache_folder

settings.register_profile("default", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("ci", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("ci" if os.environ.get("CI") else "default")


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20070612)


@pytest.fixture(scope="session")
def data_folder() -> Callable[[str], Path]:
    """Find a folder of real clips: skipped when missing, a failure in CI."""

    def find(name: str) -> Path:
        beside = Path(__file__).resolve().parents[2] / "shared" / "data"
        given = os.environ.get("TEMPOSE_DATA")
        for root in (Path(given) if given else beside, cache_folder()):
            if (root / name).is_dir():
                return root / name
        message = f"no data set {name!r}: set TEMPOSE_DATA or run `tempose data fetch {name}`"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)

    return find
