"""The measures on a real clip whose properties its publishers state."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tempose.metrics import compare, component_volumes, edge_ratios, folded_percent, volume_change

pytestmark = pytest.mark.real


@pytest.fixture(scope="module")
def gallop(data_folder) -> tuple[np.ndarray, np.ndarray]:
    def rows(path: Path, key: str) -> list[list[str]]:
        return [line.split()[1:4] for line in path.read_text().splitlines() if line.startswith(key + " ")]

    paths = sorted(data_folder("horse-gallop").glob("*.obj"))
    return np.array([rows(p, "v") for p in paths], dtype=np.float32), np.array(
        rows(paths[0], "f"), dtype=int
    ) - 1


def diagonal(V: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(V[0], axis=0)))


def test_the_second_stride_repeats_the_first(gallop) -> None:
    V, _ = gallop
    errors = compare(V[:24], V[24:], diagonal(V))
    assert errors.max_percent < 0.005
    assert compare(V[:23], V[1:24], diagonal(V)).rms_percent > 1


def test_kg_of_principal_components_is_the_tail_of_their_spectrum(gallop) -> None:
    V = gallop[0].astype(np.float64)
    X = V.reshape(len(V), -1)
    mean = X.mean(axis=0)
    U, S, Vt = np.linalg.svd(X - mean, full_matrices=False)
    spread = np.linalg.norm(V - V.mean(axis=1, keepdims=True))
    for k in (1, 5, 20):
        approximate = (mean + (U[:, :k] * S[:k]) @ Vt[:k]).reshape(V.shape)
        expected = 100 * np.linalg.norm(S[k:]) / spread
        assert compare(V, approximate, diagonal(V)).kg == pytest.approx(expected, rel=1e-6)


def test_a_galloping_horse_keeps_its_volume_and_hardly_folds(gallop) -> None:
    V, F = gallop
    assert component_volumes(V[:1], F).shape == (1, 1)
    assert np.abs(volume_change(V, F, V[0])).max() < 2.5
    assert folded_percent(V, F, V[0]).max() < 0.2
    assert edge_ratios(V[:1], F, V[0]).max == 1
