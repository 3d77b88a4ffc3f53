"""Patches: what a turn of the whole leaves alone, and rotations found again from their differences."""

from __future__ import annotations

import numpy as np
import pytest
from gradient_meshes import ZOO, ball, bent, deformed, lone_triangle, pieces, sheet, strip
from numpy.testing import assert_allclose, assert_array_equal
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from tempose.rotations import polar_rotation
from tempose.shape_spaces import PatchSpace, shape_space, space_from_state
from tempose.shape_spaces.gradient.faces import FaceGradients
from tempose.shape_spaces.gradient.references import as_axes, as_rows
from tempose.shape_spaces.patch.connection import mean_turn, rotations_from_steps
from tempose.shape_spaces.patch.kernels import sum_turns, turn_frames
from tempose.shape_spaces.patch.patches import Patches, make_patches, weighed_patches


def diagonal(V: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(V.reshape(-1, 3), axis=0)))


def whole(space: PatchSpace) -> list[int]:
    """Places in a vector that a movement of the whole changes: its rotation and the places of pieces."""
    faces, e, d = 9 * space.gradients.n_faces, len(space.patches.pairs), space.dimension
    turn = [faces + c * (e + 1) + e for c in range(3)]
    return turn + list(range(d - 3 * space.gradients.n_pieces, d))


@pytest.mark.parametrize("name", ZOO)
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_decoding_what_was_encoded_gives_the_mesh(name: str, scale: float, rng) -> None:
    V, F = ZOO[name]()
    frames = scale * deformed(V, rng, 5)
    for space in (PatchSpace(scale * V, F), PatchSpace.from_clip(scale * V, F, frames)):
        for z in (space.encode(frames), space.encode_path(frames)):
            assert_allclose(space.decode(z), frames, rtol=0, atol=1e-12 * diagonal(frames))
            assert_allclose(space.decode(z[2]), frames[2], rtol=0, atol=1e-12 * diagonal(frames))


def test_the_dimension_counts_faces_pairs_and_pieces() -> None:
    for make, count in ((ball, 1), (sheet, 1), (pieces, 4), (lone_triangle, 1)):
        V, F = make()
        space = PatchSpace(V, F)
        assert space.dimension == 9 * len(F) + 3 * len(space.patches.pairs) + 3 + 3 * count
        assert space.encode(V).shape == (space.dimension,)
    assert len(PatchSpace(*lone_triangle()).patches.pairs) == 0


@pytest.mark.parametrize("make", [ball, pieces])
def test_a_movement_of_the_whole_changes_only_its_own_numbers(make, rng) -> None:
    V, F = make()
    frames = deformed(V, rng, 4)
    space = PatchSpace.from_clip(V, F, frames)
    Q = Rotation.from_rotvec([0.4, 2.0, -1.1])
    z, moved = space.encode(frames[2]), space.encode(Q.apply(frames[2]) + np.array([1.0, 2, 3]))
    other = np.delete(moved - z, whole(space))
    assert_allclose(other, 0, atol=1e-11)
    assert np.abs((moved - z)[whole(space)]).max() > 0.1


def test_references_do_not_depend_on_where_the_body_faces(rng) -> None:
    """A clip turned by another rotation in every frame makes the same space but for its first frame."""
    V, F = ball()
    frames = deformed(V, rng, 6)
    turns = Rotation.from_rotvec(rng.normal(size=(6, 3)))
    turned = np.stack([Q.apply(frame) for Q, frame in zip(turns, frames)])
    z = PatchSpace.from_clip(V, F, frames).encode(frames)
    space = PatchSpace.from_clip(V, F, turned)
    keep = np.delete(np.arange(space.dimension), whole(space))
    # both start from their first frame: the same up to one rotation of the references
    distances = [
        np.linalg.norm(x[:, None, keep] - x[None][..., keep], axis=2) for x in (z, space.encode(turned))
    ]
    assert_allclose(distances[1], distances[0], atol=1e-10)


def test_the_unit_of_length_does_not_matter(rng) -> None:
    V, F = pieces()
    frames = deformed(V, rng, 3)
    z = PatchSpace(V, F).encode(frames)
    assert_allclose(PatchSpace(1e3 * V, F).encode(1e3 * frames), z, rtol=0, atol=1e-11)


@pytest.mark.parametrize("angle", [2.0, 5.5])
def test_half_way_to_a_bent_strip_is_half_bent(angle: float) -> None:
    """Even bent by 315 degrees, whose ends lie more than half a turn apart; turned as a whole besides."""
    V, F = strip(48)
    space = PatchSpace(V, F)
    Q = Rotation.from_rotvec([0.3, 1.0, 0.2])
    z = space.encode(np.stack([V, Q.apply(bent(V, angle))]))
    half, expected = space.decode(z.mean(axis=0)), bent(V, angle / 2)
    P, X = half - half.mean(axis=0), expected - expected.mean(axis=0)
    R = polar_rotation(P.T @ X)
    assert_allclose(P @ R, X, atol=0.004 * diagonal(V))


def test_a_path_turns_on_past_half_a_turn() -> None:
    V, F = ball(1)
    degrees = np.linspace(0, 500, 41)
    R = Rotation.from_rotvec(np.radians(degrees)[:, None] * [0, 0.6, 0.8]).as_matrix()
    frames = V @ R.transpose(0, 2, 1)
    space = PatchSpace.from_clip(V, F, frames)
    z = space.encode_path(frames)
    assert_allclose(space.decode(z), frames, rtol=0, atol=1e-12)
    turns = space._rotations(z)[:, :, -1]
    assert_allclose(np.degrees(np.linalg.norm(np.diff(turns, axis=0), axis=1)), 12.5, atol=1e-8)
    assert_allclose(space.encode_path(frames[20:], after=z[19]), z[20:], rtol=0, atol=1e-11)


def test_patches_cover_the_surface_and_hang_together() -> None:
    for make in (ball, sheet, pieces):
        V, F = make()
        shares = FaceGradients(V, F).shape.shares
        found = make_patches(V, F, shares, 12)
        p = len(found.shares)
        assert p <= 12
        assert set(found.of_face) == set(range(p))
        a, b = found.pairs.T
        assert connected_components(coo_array((np.ones(len(a)), (a, b)), shape=(p, p)))[0] == 1
        assert_allclose(found.shares, np.bincount(found.of_face, shares), rtol=1e-12)
        assert_allclose([found.shares.sum(), found.pair_weights.sum()], 1, rtol=1e-12)
        assert found.pair_weights.min() > 0 and (a < b).all()
    # of a closed surface of even faces no patch is far larger than its share
    V, F = ball(3)
    found = make_patches(V, F, np.full(len(F), 1 / len(F)), 20)
    assert len(found.shares) == 20 and found.shares.max() < 3 / 20


def test_many_small_pieces_share_patches() -> None:
    V, F = lone_triangle()
    shifts = 3.0 * np.stack(np.meshgrid(*[np.arange(6.0)] * 3), axis=-1).reshape(-1, 1, 3)
    many = (V + shifts).reshape(-1, 3)
    faces = (F + 3 * np.arange(216)[:, None, None]).reshape(-1, 3)
    space = PatchSpace(many, faces)
    assert len(space.patches.shares) <= 11
    frames = many @ Rotation.from_rotvec([0.4, 0.1, 1.0]).as_matrix().T
    assert_allclose(space.decode(space.encode(frames)), frames, atol=1e-11)


def ring(p: int) -> Patches:
    """p patches in a ring, some chords."""
    pairs = np.unique([sorted((i, (i + k) % p)) for i in range(p) for k in (1, 3)], axis=0)
    return weighed_patches(np.arange(p), pairs, np.linspace(1, 2, p) / np.linspace(1, 2, p).sum())


def test_steps_that_agree_give_their_rotations_back(rng) -> None:
    patches = ring(9)
    P = Rotation.random(2 * 9, rng=rng).as_matrix().reshape(2, 9, 3, 3)
    a, b = patches.pairs.T
    found = rotations_from_steps(P[:, a].swapaxes(-1, -2) @ P[:, b], patches)
    gauge = P[:, :1] @ found[:, :1].swapaxes(-1, -2)
    assert_allclose(gauge @ found, P, atol=1e-12)


def test_steps_that_disagree_are_met_by_least_squares(rng) -> None:
    """Against a dense least-squares solution, one row a pair and entry, the largest patch held."""
    patches = ring(7)
    steps = Rotation.random(len(patches.pairs), rng=rng).as_matrix()
    p = 7
    rows = []
    for (a, b), w, step in zip(patches.pairs, patches.pair_weights, steps):
        row = np.zeros((3, p, 3))
        row[:, b], row[:, a] = np.sqrt(w) * np.eye(3), -np.sqrt(w) * step.T
        rows.append(row.reshape(3, -1))
    A = np.concatenate(rows).reshape(-1, p, 3)
    right = -A[:, p - 1]
    X = np.linalg.lstsq(A[:, : p - 1].reshape(len(A), -1), right, rcond=None)[0].reshape(p - 1, 3, 3)
    expected = polar_rotation(X.swapaxes(1, 2))
    assert_allclose(rotations_from_steps(steps[None], patches)[0, : p - 1], expected, atol=1e-10)


def test_kernels_agree_with_numpy(rng) -> None:
    V, F = ball(1)
    gradients = FaceGradients(V, F)
    shares, m = gradients.shape.shares, len(F)
    mean, turned = (Rotation.random(m, rng=rng).as_matrix() for _ in range(2))
    patch, P = rng.integers(0, 5, m), Rotation.random(5, rng=rng).as_matrix()
    rows = [np.concatenate([as_rows(axes).ravel(), np.ones(3)]) for axes in (turned, mean)]
    total = np.ones((5, 3, 3))
    sum_turns(*rows, shares, patch, total)
    each = shares[:, None, None] * (turned @ mean.swapaxes(1, 2))
    assert_allclose(total, [each[patch == p].sum(axis=0) for p in range(5)], atol=1e-14)
    out = np.ones(9 * m + 3)
    turn_frames(P, patch, rows[1], out)
    assert_allclose(as_axes(out), P[patch] @ mean, atol=1e-14)
    assert_allclose(mean_turn(P, np.eye(5)[2]), P[2], atol=1e-13)


def test_the_state_makes_the_same_space(rng) -> None:
    V, F = pieces()
    frames = deformed(V, rng, 4)
    space = shape_space("patch", V, F, frames)
    again = space_from_state("patch", {key: np.array(value) for key, value in space.state().items()})
    assert_array_equal(again.encode_path(frames), space.encode_path(frames))
    assert_array_equal(again.decode(space.encode(frames)), space.decode(space.encode(frames)))


@pytest.mark.real
def test_the_horse_comes_back(data_folder) -> None:
    import tempose

    clip = tempose.load(data_folder("horse-poses"))
    frames = np.asarray(clip.vertices, dtype=float)
    space = PatchSpace.from_clip(clip.rest, clip.faces, frames)
    assert len(space.patches.shares) == 80
    assert_allclose(space.decode(space.encode(frames)), frames, rtol=0, atol=1e-11 * diagonal(frames))
