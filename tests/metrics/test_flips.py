"""Flipped faces and folded edges are counted where they were put, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.metrics import _frames, flipped_faces, flipped_percent, folded_percent

IDENTITY = np.array([1.0, 0, 0, 0])


def grid(k: int) -> tuple[np.ndarray, np.ndarray]:
    """k by k unit squares in the plane y = 0, normals along +Y."""
    x, z = np.meshgrid(np.arange(k + 1.0), np.arange(k + 1.0), indexing="ij")
    V = np.stack([x.ravel(), 0 * x.ravel(), z.ravel()], axis=1)
    i = (np.arange(k)[:, None] * (k + 1) + np.arange(k)).ravel()
    return V, np.concatenate([np.c_[i, i + 1, i + k + 2], np.c_[i, i + k + 2, i + k + 1]]).astype(np.int32)


@pytest.fixture(scope="module")
def sphere() -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=2)
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)


def quaternions(R: Rotation) -> np.ndarray:
    return R.as_quat()[..., [3, 0, 1, 2]]


def test_a_rotated_body_is_flipped_nowhere_by_its_own_rotation(sphere, rng) -> None:
    V, F = sphere
    R = Rotation.random(6, rng=rng)
    clip = np.stack([r.apply(V) + np.array([1.0, 2, 3]) for r in R])
    own = np.repeat(quaternions(R)[:, None], len(F), axis=1)
    assert_array_equal(flipped_percent(clip, F, V, own), np.zeros(6))
    assert_array_equal(flipped_percent(clip, F, V, -own), np.zeros(6))
    # against a fixed direction half of a sphere would seem flipped after half a turn
    turned = Rotation.from_rotvec([np.pi, 0, 0]).apply(V)[None]
    assert flipped_percent(turned, F, V, np.tile(IDENTITY, (1, len(F), 1)))[0] > 40


def test_a_mirrored_plane_is_flipped_everywhere_and_folded_nowhere() -> None:
    V, F = grid(3)
    still = np.tile(IDENTITY, (1, len(F), 1))
    assert flipped_percent(V[None] * [-1, 1, 1], F, V, still)[0] == 100
    assert_array_equal(folded_percent(V[None] * [-1, 1, 1], F, V), [0])


def test_one_vertex_pulled_across_flips_what_it_should() -> None:
    V, F = grid(3)
    posed = V.copy()
    posed[5] += [0, 0, 1.5]  # past its neighbour along the rows
    still = np.tile(IDENTITY, (len(F), 1))
    normals = np.cross(posed[F[:, 1]] - posed[F[:, 0]], posed[F[:, 2]] - posed[F[:, 0]])
    expected = normals[:, 1] < -1e-9
    assert 0 < expected.sum() < 6
    assert_array_equal(flipped_faces(posed, F, V, still), expected)
    assert flipped_percent(posed[None], F, V, still[None])[0] == pytest.approx(100 * expected.mean())


def creased(V: np.ndarray, degrees: float) -> np.ndarray:
    """The part beyond x = 1 turned about that line."""
    posed, right = V.copy(), V[:, 0] > 1
    R = Rotation.from_rotvec([0, 0, np.radians(degrees)])
    posed[right] = R.apply(V[right] - [1, 0, 0]) + np.array([1, 0, 0])
    return posed


@pytest.mark.parametrize(("angle", "folded"), [(0, 0), (60, 0), (119.9, 0), (120.1, 1), (170, 1)])
@pytest.mark.parametrize("side", [1, -1])
def test_a_crease_over_120_degrees_is_a_fold(angle: float, folded: int, side: int) -> None:
    V, F = grid(2)
    # 16 edges, 8 of them on the rim; the crease has 2
    assert folded_percent(creased(V, side * angle)[None], F, V)[0] == pytest.approx(100 * 2 * folded / 8)


def test_an_edge_folded_at_rest_is_no_new_fold() -> None:
    V, F = grid(2)
    posed = creased(V, 170)
    assert_array_equal(folded_percent(np.stack([posed, V]), F, posed), [0, 0])
    assert folded_percent(posed[None], F, V)[0] == 25


def test_orientation_conflicts_are_no_folds_and_do_not_hide_them() -> None:
    V, F = grid(2)
    mixed, right = F.copy(), (V[F, 0] > 1).any(axis=1)
    mixed[right] = mixed[right][:, ::-1]
    assert folded_percent(creased(V, 170)[None], mixed, V)[0] == 25
    clip = np.stack([V, creased(V, 170)])
    assert_array_equal(folded_percent(clip, mixed, V), folded_percent(clip, F, V))


def test_edges_of_one_or_three_faces_do_not_count() -> None:
    V = np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0]])
    fan = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    posed = V.copy()
    posed[3] = [1, 0.01, 0]
    assert folded_percent(posed[None], fan[:2], V)[0] == 100
    assert folded_percent(posed[None], fan, V)[0] == 0
    assert folded_percent(posed[None], fan[:1], V)[0] == 0


def test_slow_twin_of_folds(sphere, rng, monkeypatch) -> None:
    monkeypatch.setattr(_frames, "BLOCK_VALUES", 1)
    V, F = sphere
    clip = V + 0.15 * rng.normal(size=(3, *V.shape))
    owners: dict[tuple[int, int], list[int]] = {}
    for f, face in enumerate(F):
        for k in range(3):
            owners.setdefault(tuple(sorted((int(face[k]), int(face[k - 1])))), []).append(f)

    def normal(v: np.ndarray, f: int) -> np.ndarray:
        N = np.cross(v[F[f][1]] - v[F[f][0]], v[F[f][2]] - v[F[f][0]])
        return N / np.linalg.norm(N)

    slow = [100 * np.mean([normal(v, a) @ normal(v, b) < -0.5 for a, b in owners.values()]) for v in clip]
    assert min(slow) > 0
    assert_allclose(folded_percent(clip, F, V), slow)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_rigid_motion_scale_and_renumbering_change_nothing(sphere, rng, unit: float) -> None:
    V, F = sphere
    clip = V + 0.15 * rng.normal(size=(3, *V.shape))
    R = Rotation.random(rng=rng)
    folded = folded_percent(clip, F, V)
    turned = np.stack([unit * R.apply(v) + unit for v in clip])
    assert_allclose(folded_percent(turned, F, unit * V), folded)
    assert_allclose(folded_percent(clip[:, ::-1], len(V) - 1 - F[::-1], V[::-1]), folded)
    prescribed = np.tile(quaternions(R), (3, len(F), 1))
    still = np.tile(IDENTITY, (3, len(F), 1))
    flipped = flipped_percent(clip, F, V, still)
    assert flipped.min() > 0
    assert_allclose(flipped_percent(turned, F, V, prescribed), flipped)


def test_degenerate_faces_are_ignored_at_rest_and_posed() -> None:
    V = np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 1], [0, 0, 2]])
    F = np.array([[0, 1, 2], [0, 1, 3]])  # the second is a line
    still = np.tile(IDENTITY, (1, 2, 1))
    mirrored = V * [-1, 1, 1]
    assert flipped_percent(mirrored[None], F, V, still)[0] == 100
    wobbled = V.copy()
    wobbled[3] += [-1e-3, 0, 0]
    assert flipped_percent(wobbled[None], F, V, still)[0] == 0
    assert folded_percent(wobbled[None], F, V)[0] == 0
    collapsed = np.zeros((1, 4, 3))
    assert flipped_percent(collapsed, F, V, still)[0] == 0
    assert folded_percent(collapsed, F, V)[0] == 0
    assert_array_equal(flipped_percent(V[None], F[1:], V, still[:, 1:]), [0])


def test_the_normal_of_a_sliver_is_noise_and_not_judged() -> None:
    F = np.array([[0, 1, 2], [0, 2, 3]])
    square = np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]])
    sliver, still = square.copy(), np.tile(IDENTITY, (1, 2, 1))
    sliver[1] = [0.5 + 1e-13, 0, 0.5 - 1e-13]  # across the diagonal by less than rounding can tell
    assert flipped_percent(sliver[None], F, square, still)[0] == 0
    assert flipped_percent(square[None], F, sliver, still)[0] == 0
    assert folded_percent(sliver[None], F, square)[0] == 0
    sliver[1] = [0.51, 0, 0.49]
    assert flipped_percent(sliver[None], F, square, still)[0] == 50
    assert folded_percent(sliver[None], F, square)[0] == 100


def test_one_frame_and_a_batch_are_the_same_code(sphere, rng) -> None:
    V, F = sphere
    clip = V + 0.15 * rng.normal(size=(3, *V.shape))
    q = rng.normal(size=(3, len(F), 4))
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    batch = flipped_faces(clip, F, V, q)
    assert_array_equal(batch, [flipped_faces(v, F, V, r) for v, r in zip(clip, q)])


def test_no_face_is_no_flip() -> None:
    none = np.zeros((0, 3), dtype=int)
    assert_array_equal(
        flipped_percent(np.zeros((2, 3, 3)), none, np.zeros((3, 3)), np.zeros((2, 0, 4))), [0, 0]
    )
    assert_array_equal(folded_percent(np.zeros((2, 3, 3)), none, np.zeros((3, 3))), [0, 0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda V, F, q: (V[None], F, V, q[0]), r"rotations must have shape \(1, 320, 4\), got \(320, 4\)"),
        (lambda V, F, q: (V[None], F, V, 2 * q), "rotations must be unit quaternions"),
        (lambda V, F, q: (V[None], F, V, q * np.nan), "rotations must be finite"),
        (lambda V, F, q: (V[None] * np.nan, F, V, q), "V must be finite"),
        (lambda V, F, q: (V[None], -F, V, q), "F must hold indices from 0"),
        (lambda V, F, q: (V[:0, None], F, V, q), "V must hold at least one frame|must be numbers"),
    ],
)
def test_bad_input_is_refused(sphere, change, message: str) -> None:
    V, F = sphere
    with pytest.raises(ValueError, match=message):
        flipped_percent(*change(V, F, np.tile(IDENTITY, (1, len(F), 1))))
