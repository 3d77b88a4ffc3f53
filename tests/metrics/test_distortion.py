"""Edge and area ratios of deformations whose stretch is known exactly."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.metrics import _frames, area_ratios, edge_ratios


@pytest.fixture(scope="module")
def sphere() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=2)
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)


def moved(V: np.ndarray, rng: np.random.Generator, T: int = 5) -> np.ndarray:
    return V + 0.05 * rng.normal(size=(T, *V.shape))


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_rigid_motion_changes_nothing(sphere, rng, unit: float) -> None:
    V, F = sphere
    R = Rotation.random(4, rng=rng).as_matrix()
    clip = unit * (np.einsum("tij,nj->tni", R, V) + rng.normal(size=(4, 1, 3)))
    for measure in (edge_ratios, area_ratios):
        assert_allclose(list(vars(measure(clip, F, unit * V)).values()), 1, rtol=1e-12)


@pytest.mark.parametrize("s", [0.5, 3.0])
def test_scaling_by_s_scales_edges_by_s_and_areas_by_s_squared(sphere, s: float) -> None:
    V, F = sphere
    assert_allclose(list(vars(edge_ratios(s * V[None], F, V)).values()), s, rtol=1e-12)
    assert_allclose(list(vars(area_ratios(s * V[None], F, V)).values()), s * s, rtol=1e-12)


def test_stretching_a_square_along_x_has_the_closed_form() -> None:
    V, F = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    edges, areas = (measure((V * [2, 1, 1])[None], F, V) for measure in (edge_ratios, area_ratios))
    # lengths 2, 2 along x, 1, 1 along y, sqrt(5) / sqrt(2) on the diagonal
    assert (edges.min, edges.max) == (1, 2)
    assert edges.p1 == pytest.approx(1) and edges.p99 == pytest.approx(2)
    assert_allclose(list(vars(areas).values()), 2)
    only_upper = edge_ratios((V * [2, 1, 1])[None], F, V, vertices=np.array([True, False, True, False]))
    assert_allclose(list(vars(only_upper).values()), math.sqrt(2.5))


def slow_ratios(clip: np.ndarray, F: np.ndarray, V: np.ndarray, keep) -> np.ndarray:
    edges = {tuple(sorted((int(f[k]), int(f[k - 1])))) for f in F for k in range(3)}
    return np.array(
        [math.dist(v[i], v[j]) / math.dist(V[i], V[j]) for v in clip for i, j in sorted(edges) if keep(i, j)]
    )


@pytest.mark.parametrize("block", [1, 10**9])
def test_edges_agree_with_a_loop_each_counted_once(sphere, rng, monkeypatch, block: int) -> None:
    monkeypatch.setattr(_frames, "BLOCK_VALUES", block)
    V, F = sphere
    clip = moved(V, rng)
    upper, some = V[:, 1] > 0, rng.random(len(F)) < 0.3
    near = {tuple(sorted((int(f[k]), int(f[k - 1])))) for f in F[some] for k in range(3)}
    for ours, keep in [
        (edge_ratios(clip, F, V), lambda i, j: True),
        (edge_ratios(clip, F, V, vertices=upper), lambda i, j: upper[i] and upper[j]),
        (edge_ratios(clip, F, V, faces=some), lambda i, j: (i, j) in near),
    ]:
        slow = slow_ratios(clip, F, V, keep)
        expected = [slow.min(), *np.percentile(slow, [1, 99]), slow.max()]
        assert_allclose([ours.min, ours.p1, ours.p99, ours.max], expected, rtol=1e-12)


def test_areas_agree_with_heron(sphere, rng) -> None:
    V, F = sphere

    def heron(v: np.ndarray, f: np.ndarray) -> float:
        a, b, c = (math.dist(v[f[k]], v[f[k - 1]]) for k in range(3))
        s = (a + b + c) / 2
        return math.sqrt(s * (s - a) * (s - b) * (s - c))

    clip = moved(V, rng, 2)
    some = rng.random(len(F)) < 0.3
    slow = [heron(v, f) / heron(V, f) for v in clip for f in F[some]]
    ours = area_ratios(clip, F, V, faces=some)
    expected = [min(slow), *np.percentile(slow, [1, 99]), max(slow)]
    assert_allclose([ours.min, ours.p1, ours.p99, ours.max], expected, rtol=1e-9)


def test_vertices_and_faces_may_be_renumbered(sphere, rng) -> None:
    V, F = sphere
    clip, order = moved(V, rng), rng.permutation(len(V))
    place = np.argsort(order)
    for measure in (edge_ratios, area_ratios):
        ours = measure(clip[:, order], place[F][rng.permutation(len(F))][:, [1, 2, 0]], V[order])
        assert_allclose(list(vars(ours).values()), list(vars(measure(clip, F, V)).values()), rtol=1e-12)


def test_what_has_no_size_at_rest_is_left_out() -> None:
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 1, 0]])
    F = np.array([[0, 1, 2], [1, 2, 3]])
    posed = V.copy()
    posed[3] = [5, 5, 5]
    assert edge_ratios(V[None], F, V) == edge_ratios(V[None], F[:1], V)
    assert area_ratios(posed[None], F, V).max == 1
    with pytest.raises(ValueError, match="at least one face with a size at rest, got none of 1"):
        area_ratios(V[None], F[1:], V)


@pytest.mark.parametrize("measure", [edge_ratios, area_ratios])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda V, F: (V, F, V), "V must be numbers of shape"),
        (lambda V, F: (V[None], F + 1, V), f"F must hold indices from 0 and below 162, got {162}"),
        (lambda V, F: (V[None], F, V[:-1]), r"V_rest must have shape \(162, 3\), got \(161, 3\)"),
        (lambda V, F: (V[None], F[:0], V), "F must leave at least one (edge|face)"),
        (lambda V, F: (V[None] * np.nan, F, V), "V must be finite"),
        (lambda V, F: (V[None], F, V * np.nan), "V_rest must be finite"),
        (lambda V, F: (V[:0, None].repeat(162, 1), F, V), "at least one frame"),
    ],
)
def test_bad_input_is_refused(sphere, measure, change, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        measure(*change(*sphere))


def test_masks_of_another_length_or_type_are_refused(sphere) -> None:
    V, F = sphere
    with pytest.raises(ValueError, match=r"faces must be bool of shape \(320,\), got bool of shape \(162,\)"):
        edge_ratios(V[None], F, V, faces=np.ones(162, dtype=bool))
    with pytest.raises(ValueError, match=r"vertices must be bool of shape \(162,\), got int64"):
        edge_ratios(V[None], F, V, vertices=np.arange(162))
    with pytest.raises(ValueError, match="at least one edge"):
        edge_ratios(V[None], F, V, faces=np.zeros(320, dtype=bool))
