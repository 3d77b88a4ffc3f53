"""Edges collapsed once are replayed as one linear map; what few vertices know comes up to all."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip, Skeleton, SkinnedMesh
from tempose.detail.multiresolution import make_control, spreading
from tempose.geometry import Collapses, collapse_edges, find_defects


def sphere(rings: int = 14, around: int = 20) -> tuple[np.ndarray, np.ndarray]:
    tilt = np.linspace(0, np.pi, rings + 1)[1:-1]
    turn = 2 * np.pi * np.arange(around) / around
    V = np.array([[np.sin(a) * np.cos(b), np.cos(a), np.sin(a) * np.sin(b)] for a in tilt for b in turn])
    V = np.concatenate([V, [[0, 1, 0], [0, -1, 0]]])
    F = []
    for r in range(rings - 2):
        for i in range(around):
            a, b = around * r + i, around * r + (i + 1) % around
            F += [[a, b, a + around], [b, b + around, a + around]]
    top, low, last = len(V) - 2, len(V) - 1, around * (rings - 2)
    for i in range(around):
        j = (i + 1) % around
        F += [[top, j, i], [low, last + i, last + j]]
    return V, np.array(F)


def grid(k: int = 9) -> tuple[np.ndarray, np.ndarray]:
    x, y = np.meshgrid(np.arange(k), np.arange(k))
    V = np.column_stack([x.ravel(), y.ravel(), np.zeros(k * k)]).astype(float)
    quads = [
        [r * k + c, r * k + c + 1, r * k + k + c + 1, r * k + k + c]
        for r in range(k - 1)
        for c in range(k - 1)
    ]
    return V, np.array([f for a, b, c, d in quads for f in ([a, b, c], [a, c, d])])


def replayed(found: Collapses, V: np.ndarray) -> np.ndarray:
    """One collapse after the other, as they were recorded."""
    P = np.array(V)
    for (a, b), s in zip(found.pairs, found.shares):
        P[a] = (1 - s) * P[a] + s * P[b]
    return P[found.kept]


@pytest.mark.parametrize("make", [sphere, grid])
@pytest.mark.parametrize("share", [0.5, 0.15])
def test_the_matrix_is_the_sequence(make, share: float, rng) -> None:
    V, F = make()
    found = collapse_edges(V, F, round(share * len(V)))
    frames = rng.normal(size=(3, *V.shape))
    assert len(found.kept) == round(share * len(V)) == len(V) - len(found.pairs)
    for frame, fast in zip(frames, found.replay(frames)):
        assert_allclose(fast, replayed(found, frame), atol=1e-12)
    assert_allclose(found.matrix.sum(axis=1), 1.0, atol=1e-12)
    assert (found.matrix.data >= 0).all() and (np.diff(found.matrix.tocsc().indptr) <= 1).all()


def test_a_closed_surface_stays_closed_and_outwards() -> None:
    V, F = sphere()
    found = collapse_edges(V, F, 40)
    P = found.replay(V)
    defects = find_defects(P, found.faces).as_dict()
    assert defects.pop("pieces") == 1 and not any(defects.values())
    corners = P[found.faces]
    volume = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    full = np.einsum("fi,fi->f", V[F[:, 0]], np.cross(V[F[:, 1]], V[F[:, 2]])).sum() / 6
    assert 0.75 * full < volume < full
    assert np.linalg.norm(P, axis=1).min() > 0.9


def test_a_flat_sheet_keeps_its_rim() -> None:
    V, F = grid()
    found = collapse_edges(V, F, 25)
    P = found.replay(V)
    corners = P[found.faces]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] / 2
    assert (area > 0).all()
    assert area.sum() == pytest.approx(64.0, rel=0.02)


def test_collapses_do_not_depend_on_place_size_or_pose(rng) -> None:
    V, F = sphere()
    R = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    R *= np.sign(np.linalg.det(R))
    V = V * [1.0, 1.3, 0.8] + 0.02 * rng.normal(size=V.shape)
    one = collapse_edges(V, F, 60)
    for unit in (1e-3, 1e3):
        other = collapse_edges(unit * V @ R.T + 5 * unit, F, 60)
        assert np.array_equal(one.kept, other.kept)
        assert_allclose(other.replay(V), one.replay(V), atol=1e-6)


def test_a_vertex_without_a_face_goes_nowhere() -> None:
    V, F = sphere()
    found = collapse_edges(np.concatenate([V, [[9.0, 9, 9]]]), F, 50)
    assert len(V) not in found.kept
    assert np.diff(found.matrix.tocsc().indptr)[-1] == 0
    assert np.abs(found.replay(np.concatenate([V, [[9.0, 9, 9]]]))).max() < 1.1


@pytest.mark.parametrize(("count", "words"), [(3, "count must be"), (10_000, "count must be")])
def test_counts_out_of_range_are_refused(count: int, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        collapse_edges(*sphere(), count)


def test_a_mesh_without_area_is_refused() -> None:
    with pytest.raises(ValueError, match="face with an area"):
        collapse_edges(np.zeros((5, 3)), np.array([[0, 1, 2]]), 4)


def test_spreading_returns_centres_exactly_and_constants_everywhere(rng) -> None:
    V = rng.normal(size=(200, 3))
    U = spreading(V, V[:40])
    assert_allclose(U.sum(axis=1), 1.0, atol=1e-9)
    values = rng.normal(size=(40, 3))
    assert_allclose((U @ values)[:40], values, atol=1e-6)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_spreading_has_no_unit(unit: float, rng) -> None:
    V = rng.normal(size=(80, 3))
    assert_allclose(spreading(unit * V, unit * V[:30]).toarray(), spreading(V, V[:30]).toarray(), atol=1e-8)


def test_spreading_solves_the_interpolation_of_its_neighbours(rng) -> None:
    V, C = rng.normal(size=(6, 3)), rng.normal(size=(12, 3))
    U, y = spreading(V, C, nearest=12), rng.normal(size=12)
    size = np.linalg.norm(np.ptp(V, axis=0))

    def kernel(A: np.ndarray, B: np.ndarray) -> np.ndarray:
        return -np.linalg.norm(A[:, None] - B, axis=-1) / size

    A = np.block([[kernel(C, C), np.ones((12, 1))], [np.ones((1, 12)), np.zeros((1, 1))]])
    solved = np.linalg.solve(A, np.append(y, 0.0))
    assert_allclose(U @ y, kernel(V, C) @ solved[:12] + solved[12], atol=1e-7)


def test_a_hand_takes_nothing_from_the_hip_beside_it() -> None:
    y = np.linspace(0, 1, 101)
    left, right = (np.column_stack([np.full(101, x), y, np.zeros(101)]) for x in (0.0, 0.02))
    V = np.concatenate([left, right])
    W = np.zeros((202, 2))
    W[:101, 0] = W[101:, 1] = 1.0
    some = np.r_[0:101:4, 101:202:4]
    values = np.where(W[some, 0] > 0, 1.0, -1.0)
    parted = spreading(V, V[some], W, W[some], nearest=4) @ values
    assert_allclose(parted[4:97], 1.0, atol=1e-9)
    assert np.abs(spreading(V, V[some], nearest=4) @ values - parted).max() > 0.1


def skinned() -> SkinnedMesh:
    V, F = sphere()
    V = V * [0.4, 1.0, 0.4]
    W = np.clip((V[:, 1] + 0.5), 0, 1)
    skeleton = Skeleton(("a", "b"), np.array([-1, 0]), np.array([[0.0, -1, 0], [0, 1, 0]]))
    return SkinnedMesh(Mesh(V, F), skeleton, np.column_stack([1 - W, W]))


def test_a_control_mesh_carries_clips_down_and_smooth_values_up(rng) -> None:
    skin = skinned()
    control = make_control(skin, percent=20)
    n, K = len(skin.mesh.vertices), len(control.skin.mesh.vertices)
    assert round(0.2 * n) == K
    frames = skin.mesh.vertices + rng.normal(size=(4, 1, 3))
    down = control.clip(MeshClip(frames.astype(np.float32), skin.mesh, 30.0)).vertices
    assert_allclose(down, control.skin.mesh.vertices + (frames - skin.mesh.vertices)[:, :1], atol=1e-5)
    field = np.sin(2 * skin.mesh.vertices)
    up = control.raise_values(control.collapses.replay(field))
    assert np.sqrt(np.square(up - field).mean()) < 0.15 * field.std()
    assert_allclose(control.raise_values(np.ones((2, K, 3))), 1.0, atol=1e-9)


@pytest.mark.parametrize(
    ("percent", "words"), [(0.0, "percent must"), (101.0, "percent must"), (0.5, "take 3.0")]
)
def test_percentages_that_leave_nothing_are_refused(percent: float, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        make_control(skinned(), percent=percent)
