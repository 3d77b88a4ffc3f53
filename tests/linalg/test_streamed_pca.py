"""Principal components read in blocks are those of the whole matrix, and the error told is the error made."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.linalg.streamed_pca import StreamedPca, streamed_pca
from tempose.typing import FloatArray


def in_blocks(Z: FloatArray, step: int = 7) -> Callable[[], Iterator[FloatArray]]:
    return lambda: (Z[i : i + step] for i in range(0, len(Z), step))


def falling(T: int, d: int, decay: float, seed: int = 0, unit: float = 1.0) -> FloatArray:
    """Rows with singular values decay^j about a mean that is far from zero."""
    random = np.random.default_rng(seed)
    r = min(T - 1, d)
    U = np.linalg.qr(random.standard_normal((T, r)))[0]
    U = np.linalg.qr(U - U.mean(axis=0))[0]
    W = np.linalg.qr(random.standard_normal((d, r)))[0]
    return unit * ((U * decay ** np.arange(r)) @ W.T + 30.0 * random.standard_normal(d))


def reconstruction(found: StreamedPca) -> FloatArray:
    return found.mean + found.coordinates @ found.components


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_equals_the_svd_of_the_centred_rows(unit: float) -> None:
    Z = falling(60, 90, 0.5, unit=unit)
    found = streamed_pca(in_blocks(Z), 90, 8)
    U, s, Vt = np.linalg.svd(Z - Z.mean(axis=0), full_matrices=False)
    assert_allclose(found.mean, Z.mean(axis=0), rtol=1e-13)
    assert_allclose(found.singular_values, s[:8], rtol=1e-7)
    signs = np.sign(np.sum(found.components * Vt[:8], axis=1))
    assert_allclose(found.components, signs[:, None] * Vt[:8], atol=1e-5)
    assert_allclose(found.coordinates, signs * (U * s)[:, :8], atol=1e-5 * unit)


def test_components_are_orthonormal_and_coordinates_uncorrelated() -> None:
    Z = falling(50, 40, 0.8)
    found = streamed_pca(in_blocks(Z), 40, 12)
    assert_allclose(found.components @ found.components.T, np.eye(12), atol=1e-12)
    assert_allclose(found.coordinates.mean(axis=0), 0, atol=1e-12)
    moments = found.coordinates.T @ found.coordinates
    assert_allclose(moments, np.diag(found.singular_values**2), atol=1e-12)
    assert_allclose(found.coordinates, (Z - found.mean) @ found.components.T, atol=1e-12)


@pytest.mark.parametrize(("m", "decay"), [(1, 0.9), (5, 0.95), (20, 0.99)])
def test_residual_told_is_the_residual_made_and_nearly_the_best(m: int, decay: float) -> None:
    Z = falling(80, 120, decay)
    found = streamed_pca(in_blocks(Z), 120, m)
    Y = Z - Z.mean(axis=0)
    s = np.linalg.svd(Y, compute_uv=False)
    assert_allclose(found.total, np.vdot(Y, Y), rtol=1e-12)
    assert_allclose(found.residual, np.square(Z - reconstruction(found)).sum(), rtol=1e-9)
    assert_allclose(found.rms, np.sqrt(found.residual / 80), rtol=1e-14)
    assert_allclose(found.left_out, np.square(Z - reconstruction(found)).sum(axis=1), rtol=1e-8, atol=1e-12)
    assert_allclose(found.spectrum[:m], found.singular_values)
    assert (found.spectrum <= s[: len(found.spectrum)] * (1 + 1e-12)).all()
    best = float(np.square(s[m:]).sum())
    assert best * (1 - 1e-12) <= found.residual <= 1.15 * best


def test_power_passes_bring_it_nearer_to_the_best() -> None:
    Z = falling(100, 150, 0.995)
    s = np.linalg.svd(Z - Z.mean(axis=0), compute_uv=False)
    best = float(np.square(s[6:]).sum())
    excess = [streamed_pca(in_blocks(Z), 150, 6, power_passes=q).residual - best for q in (0, 1, 4)]
    assert excess[0] > 1.5 * excess[1] > 0
    assert excess[1] > 1.5 * excess[2] > 0


@pytest.mark.parametrize("tolerance", [0.3, 1e-2, 1e-4])
@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_tolerance_is_met_with_hardly_more_components_than_needed(tolerance: float, unit: float) -> None:
    Z = falling(200, 150, 0.93, unit=unit)
    limit = tolerance * unit / np.sqrt(200)
    found = streamed_pca(in_blocks(Z, 33), 150, tolerance=limit)
    Y = Z - Z.mean(axis=0)
    s = np.linalg.svd(Y, compute_uv=False)
    needed = next(m for m in range(1, 150) if np.sqrt(np.square(s[m:]).sum() / 200) <= limit)
    assert found.rms <= limit
    assert_allclose(found.rms, np.sqrt(np.square(Z - reconstruction(found)).sum() / 200), rtol=1e-5)
    assert needed <= len(found.components) <= needed + 1
    assert_allclose(found.components @ found.components.T, np.eye(len(found.components)), atol=1e-12)


def test_no_component_where_none_is_wanted_or_needed() -> None:
    Z = falling(60, 40, 0.7)
    motion = float(np.linalg.norm(Z - Z.mean(axis=0)))
    for found in (streamed_pca(in_blocks(Z), 40, tolerance=motion), streamed_pca(in_blocks(Z), 40, 0)):
        assert found.components.shape == (0, 40) and found.coordinates.shape == (60, 0)
        assert_allclose(found.residual, motion**2, rtol=1e-12)
        assert_allclose(found.left_out.sum(), motion**2, rtol=1e-12)


def test_every_component_gives_every_row_back() -> None:
    Z = falling(20, 60, 0.9)
    for found in (streamed_pca(in_blocks(Z), 60, 40), streamed_pca(in_blocks(Z), 60, tolerance=1e-12)):
        assert len(found.components) <= 19
        assert_allclose(reconstruction(found), Z, atol=1e-11)


@pytest.mark.parametrize("step", [1, 13, 64])
def test_blocks_do_not_matter(step: int) -> None:
    Z = falling(64, 50, 0.8)
    a, b = streamed_pca(in_blocks(Z, 64), 50, 5), streamed_pca(in_blocks(Z, step), 50, 5)
    assert_allclose(np.abs(np.sum(a.components * b.components, axis=1)), 1, atol=1e-12)
    assert_allclose(a.residual, b.residual, rtol=1e-9)


def test_same_seed_same_bits() -> None:
    Z = falling(30, 50, 0.9)
    a, b, c = (streamed_pca(in_blocks(Z), 50, 4, seed=seed) for seed in (3, 3, 4))
    assert a.components.tobytes() == b.components.tobytes()
    assert a.components.tobytes() != c.components.tobytes()


def test_two_passes_suffice_and_no_block_is_kept() -> None:
    Z, seen = falling(40, 30, 0.5), [0, 0]

    def blocks() -> Iterator[FloatArray]:
        seen[0] += 1
        scratch = np.zeros((4, 30))
        for i in range(0, 40, 4):
            scratch[:] = Z[i : i + 4]
            seen[1] += 1
            yield scratch  # overwritten by the next block: keeping a view of it would be noticed
            scratch[:] = np.nan

    found = streamed_pca(blocks, 30, 3)
    assert seen == [2, 20] and found.n_passes == 2
    assert_allclose(found.residual, np.square(Z - reconstruction(found)).sum(), rtol=1e-9)


def test_rows_that_never_change_have_one_component_of_no_energy() -> None:
    found = streamed_pca(in_blocks(np.full((9, 5), 3.0)), 5, tolerance=1e-6)
    assert found.residual == 0 and found.rms == 0 and len(found.components) == 0
    assert_allclose(reconstruction(found), 3.0, atol=1e-14)


def test_single_precision_rows_are_summed_in_double() -> None:
    Z = falling(40, 30, 0.5).astype(np.float32)
    found = streamed_pca(in_blocks(Z), 30, 29)
    assert_allclose(reconstruction(found), Z.astype(np.float64), atol=1e-6)
    assert_allclose(found.mean, Z.astype(np.float64).mean(axis=0), rtol=1e-13)


def test_bad_input_is_refused() -> None:
    Z = falling(10, 8, 0.5)
    with pytest.raises(ValueError, match="either m or tolerance"):
        streamed_pca(in_blocks(Z), 8)
    with pytest.raises(ValueError, match="either m or tolerance"):
        streamed_pca(in_blocks(Z), 8, 3, tolerance=0.1)
    with pytest.raises(ValueError, match="tolerance must not be negative"):
        streamed_pca(in_blocks(Z), 8, tolerance=-1.0)
    with pytest.raises(ValueError, match="m must not be negative"):
        streamed_pca(in_blocks(Z), 8, -1)
    with pytest.raises(ValueError, match="power_passes not negative"):
        streamed_pca(in_blocks(Z), 8, 2, power_passes=-1)
    with pytest.raises(ValueError, match=r"blocks must have shape \(k, 7\), got \(7, 8\)"):
        streamed_pca(in_blocks(Z), 7, 2)
    with pytest.raises(ValueError, match="at least two rows, got 1"):
        streamed_pca(in_blocks(Z[:1]), 8, 2)
    with pytest.raises(ValueError, match="blocks must be finite"):
        streamed_pca(in_blocks(np.where(Z > Z.min(), Z, np.nan)), 8, 2)
    once = iter(in_blocks(Z)())
    with pytest.raises(ValueError, match="not an iterator"):
        streamed_pca(lambda: once, 8, 2)


def test_progress_counts_the_rows_of_every_pass() -> None:
    calls: list[tuple[int, int, str]] = []
    streamed_pca(
        in_blocks(falling(10, 8, 0.5), 5),
        8,
        2,
        progress=lambda done, total, stage: calls.append((done, total, stage)),
    )
    assert [done for done, _, _ in calls] == [5, 10, 5, 10]
    assert [total for _, total, _ in calls] == [0, 0, 10, 10]
