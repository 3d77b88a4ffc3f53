"""Deformation gradients: what is exact, what does not change, what is known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from gradient_meshes import ZOO, ball, bent, deformed, pieces, sheet, strip
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.shape_spaces import GradientSpace, shape_space, space_from_state

SCALES = [1e-3, 1.0, 1e3]


def diagonal(V: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(V.reshape(-1, 3), axis=0)))


def about(V: np.ndarray, axis: list[float], degrees: np.ndarray | float) -> np.ndarray:
    """The mesh turned about an axis through the origin, a frame for every angle."""
    unit = np.array(axis) / np.linalg.norm(axis)
    R = Rotation.from_rotvec(np.radians(np.atleast_1d(degrees))[:, None] * unit).as_matrix()
    return V @ R.transpose(0, 2, 1)


def rotation_vectors(space: GradientSpace, z: np.ndarray) -> np.ndarray:
    """(..., 3, m) without weights."""
    m = space.gradients.n_faces
    return z[..., : 3 * m].reshape(*z.shape[:-1], 3, m) / space.gradients.scale


def stretches(space: GradientSpace, z: np.ndarray) -> np.ndarray:
    m = space.gradients.n_faces
    return z[..., 3 * m : 9 * m]


@pytest.mark.parametrize("name", ZOO)
@pytest.mark.parametrize("scale", SCALES)
def test_decoding_what_was_encoded_gives_the_mesh(name: str, scale: float, rng) -> None:
    V, F = ZOO[name]()
    frames = scale * deformed(V, rng, 5)
    for space in (GradientSpace(scale * V, F), GradientSpace.from_clip(scale * V, F, frames)):
        for z in (space.encode(frames), space.encode_path(frames)):
            assert z.shape == (5, space.dimension)
            assert_allclose(space.decode(z), frames, rtol=0, atol=1e-12 * diagonal(frames))


@pytest.mark.parametrize("shape", [(), (1,), (3, 1, 2)])
def test_any_batch_shape_gives_the_same_numbers(shape: tuple[int, ...], rng) -> None:
    V, F = ball(1)
    frames = deformed(V, rng, int(np.prod(shape))).reshape(*shape, *V.shape)
    space = GradientSpace(V, F)
    z = space.encode(frames)
    W = space.decode(z)
    assert z.shape == (*shape, space.dimension) and W.shape == frames.shape
    for index in np.ndindex(shape):
        assert_array_equal(z[index], space.encode(frames[index]))
        assert_allclose(W[index], space.decode(z[index]), rtol=0, atol=1e-13)
    assert space.encode(np.zeros((0, *V.shape))).shape == (0, space.dimension)
    assert space.decode(np.zeros((0, space.dimension))).shape == (0, *V.shape)


def test_a_long_batch_is_solved_in_blocks_without_a_seam(rng) -> None:
    V, F = sheet()
    frames = deformed(V, rng, 37)
    space = GradientSpace(V, F)
    z = space.encode(frames)
    assert_allclose(space.decode(z), frames, rtol=0, atol=1e-12)
    assert_allclose(space.decode(z)[20], space.decode(z[20]), rtol=0, atol=1e-13)


def test_the_dimension_is_nine_a_face_and_three_a_piece() -> None:
    for make, count in ((ball, 1), (sheet, 1), (pieces, 4)):
        V, F = make()
        assert GradientSpace(V, F).dimension == 9 * len(F) + 3 * count


def test_zero_is_the_rest_turned_by_its_references(rng) -> None:
    V, F = pieces()
    assert_allclose(GradientSpace(V, F).decode(np.zeros(9 * len(F) + 12)), V, rtol=0, atol=1e-12)
    assert_allclose(GradientSpace(V, F).encode(V), 0, atol=1e-12)


@pytest.mark.parametrize("scale", SCALES)
def test_the_unit_of_length_does_not_matter(scale: float, rng) -> None:
    V, F = pieces()
    frames = deformed(V, rng, 4)
    z, scaled = GradientSpace(V, F).encode(frames), GradientSpace(scale * V, F).encode(scale * frames)
    assert_allclose(scaled, z, rtol=0, atol=1e-12)


def test_turning_the_mesh_changes_only_rotations(rng) -> None:
    V, F = ball()
    pose, Q = deformed(V, rng, 2)[1], Rotation.from_rotvec([0.3, -0.8, 0.5])
    space = GradientSpace(V, F)
    z, turned = space.encode(np.stack([pose, Q.apply(pose)]))
    assert_allclose(stretches(space, turned), stretches(space, z), rtol=0, atol=1e-13)
    (R, S), (QR, QS) = space.deformations(z), space.deformations(turned)
    assert_allclose(QR, Q.as_matrix() @ R, rtol=0, atol=1e-12)
    assert_allclose(QS, S, rtol=0, atol=1e-12)


def test_moving_the_mesh_changes_only_its_place(rng) -> None:
    V, F = ball()
    pose = deformed(V, rng, 2)[1]
    space = GradientSpace(V, F)
    z, moved = space.encode(np.stack([pose, pose + np.array([3.0, -1.0, 0.5])]))
    assert_allclose(moved[:-3], z[:-3], rtol=0, atol=1e-12)
    assert_allclose((moved - z)[-3:] / (moved - z)[-3], [1, -1 / 3, 1 / 6], rtol=1e-12)


def test_the_rest_may_be_turned_without_changing_distances(rng) -> None:
    """The axes of a face at rest are its own: rest and poses turned together give the same distances."""
    V, F = ball(1)
    frames, Q = deformed(V, rng, 3), Rotation.from_rotvec([1.0, 0.4, -0.3])
    z = GradientSpace(V, F).encode(frames)
    turned = GradientSpace(Q.apply(V), F).encode(np.stack([Q.apply(frame) for frame in frames]))
    assert_allclose(np.linalg.norm(turned - turned[0], axis=1), np.linalg.norm(z - z[0], axis=1), rtol=1e-12)


def test_renumbering_changes_no_distance(rng) -> None:
    V, F = ball(1)
    frames = deformed(V, rng, 3)
    z = GradientSpace.from_clip(V, F, frames).encode(frames)
    order, faces = rng.permutation(len(V)), rng.permutation(len(F))
    place = np.argsort(order)
    G = np.stack([np.roll(f, k) for f, k in zip(place[F[faces]], rng.integers(0, 3, len(F)))])
    renumbered = GradientSpace.from_clip(V[order], G, frames[:, order]).encode(frames[:, order])
    expected = np.linalg.norm(z[:, None] - z, axis=2)
    found = np.linalg.norm(renumbered[:, None] - renumbered, axis=2)
    assert_allclose(found, expected, rtol=0, atol=1e-12)


def test_finer_faces_change_no_distance_of_an_affine_deformation(rng) -> None:
    (V, F), (W, G) = sheet(3, 3), sheet(3, 3)
    middle = W[G].mean(axis=1)
    k = len(W) + np.arange(len(G))
    W, G = np.concatenate([W, middle]), np.concatenate([np.c_[G[:, [i, (i + 1) % 3]], k] for i in range(3)])
    A = np.eye(3) + 0.3 * rng.normal(size=(3, 3))
    coarse, fine = GradientSpace(V, F), GradientSpace(W, G)
    rotated = np.linalg.norm(rotation_part(coarse, V @ A.T)), np.linalg.norm(rotation_part(fine, W @ A.T))
    assert_allclose(*rotated, rtol=1e-12)
    stretched = [np.linalg.norm(stretches(s, s.encode(X @ A.T))) for s, X in ((coarse, V), (fine, W))]
    assert_allclose(*stretched, rtol=1e-12)


def rotation_part(space: GradientSpace, V: np.ndarray) -> np.ndarray:
    return space.encode(V)[: 3 * space.gradients.n_faces]


@pytest.mark.parametrize("degrees", [1e-6, 30.0, 161.0, 163.0, 179.99])
def test_a_turn_of_the_whole_is_as_long_as_its_angle(degrees: float) -> None:
    V, F = ball()
    space = GradientSpace(V, F)
    z = space.encode(about(V, [1, 2, -1], degrees)[0])
    assert_allclose(np.linalg.norm(z[: 3 * len(F)]), np.radians(degrees), rtol=1e-9)
    assert_allclose(stretches(space, z), 0, atol=1e-12)


@pytest.mark.parametrize("factor", [0.25, 1.0, 3.0])
def test_uniform_scaling_is_the_factor_times_the_identity(factor: float) -> None:
    """In all three directions: the normal is scaled by the root of the area."""
    V, F = ball()
    R, S = GradientSpace(V, F).deformations(GradientSpace(V, F).encode(factor * V))
    assert_allclose(R, np.broadcast_to(np.eye(3), R.shape), atol=1e-12)
    assert_allclose(S, np.broadcast_to(factor * np.eye(3), S.shape), atol=1e-12)


def test_a_bent_strip_is_turned_column_by_column_and_keeps_its_width() -> None:
    """Chords of the arc: column i stands at (i + 1/2) of the angle, shortened to the chord."""
    V, F = strip(24)
    angle, space = 2.5, GradientSpace(V, F)
    R, S = space.deformations(space.encode(bent(V, angle)))
    column = np.floor(V[F][:, :, 0].mean(axis=1) / (2.0 / 24))
    expected = Rotation.from_rotvec(((column + 0.5) / 24 * angle)[:, None] * [0, 0, 1.0]).as_matrix()
    assert_allclose(R, expected, atol=1e-12)
    chord = np.sin(angle / 48) / (angle / 48)
    assert_allclose(S, np.broadcast_to(np.diag([chord, np.sqrt(chord), 1.0]), S.shape), atol=1e-12)


def test_half_way_to_a_bent_strip_is_half_bent() -> None:
    """Columns at half the angle, half shortened: put end to end they are the mesh."""
    V, F = strip(24)
    angle, space = 2.5, GradientSpace(V, F)
    z = space.encode(np.stack([V, bent(V, angle)]))
    columns = (np.arange(24) + 0.5) / 24 * angle / 2
    width = 2.0 / 24 * (1 + np.sin(angle / 48) / (angle / 48)) / 2
    steps = width * np.stack([np.cos(columns), np.sin(columns)], axis=1)
    curve = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
    found = space.decode(z.mean(axis=0)).reshape(25, 4, 3)
    shift = found[0, 0, :2]
    assert_allclose(found[:, :, :2], curve[:, None] + shift + np.zeros((1, 4, 1)), atol=1e-12)
    assert_allclose(found[:, :, 2], V.reshape(25, 4, 3)[:, :, 2], atol=1e-12)


def test_half_way_between_two_rotations_is_the_half_rotation() -> None:
    V, F = ball()
    space = GradientSpace(V, F)
    turned = about(V, [0.3, 1, 0.2], np.array([0.0, 60.0, 120.0]))
    z = space.encode(turned)
    assert_allclose(centred(space.decode((z[0] + z[2]) / 2)), centred(turned[1]), atol=1e-12)


def centred(V: np.ndarray) -> np.ndarray:
    return V - V.mean(axis=-2, keepdims=True)


@pytest.mark.parametrize("largest", [170.0, 400.0, 650.0])
def test_a_path_turns_on_past_half_a_turn(largest: float) -> None:
    """From the reference in the middle, angles grow evenly both ways and every frame decodes."""
    V, F = ball(1)
    degrees = np.linspace(0, largest, 41)
    frames = about(V, [1, 1, 0.2], degrees)
    space = GradientSpace.from_clip(V, F, frames)
    z = space.encode_path(frames)
    w = rotation_vectors(space, z)
    assert_allclose(space.decode(z), frames, rtol=0, atol=1e-12 * diagonal(V))
    steps = np.degrees(np.linalg.norm(np.diff(w, axis=0), axis=1))
    assert_allclose(steps, largest / 40, atol=1e-6)
    assert np.degrees(np.linalg.norm(w, axis=1)).max() < largest / 2 + 10
    between = space.decode((z[:-1] + z[1:]) / 2)
    expected = about(V, [1, 1, 0.2], (degrees[:-1] + degrees[1:]) / 2)
    assert_allclose(centred(between), centred(expected), rtol=0, atol=1e-9)


def test_from_the_rest_a_path_reaches_any_angle() -> None:
    V, F = ball(1)
    degrees = np.linspace(0, 1000, 60)
    space = GradientSpace(V, F)
    z = space.encode_path(about(V, [0, 1, 0], degrees))
    angles = np.degrees(np.linalg.norm(rotation_vectors(space, z), axis=1))
    assert_allclose(angles, np.broadcast_to(degrees[:, None], angles.shape), atol=1e-6)


def test_a_path_goes_on_from_the_frame_before() -> None:
    V, F = ball(1)
    frames = about(V, [0, 1, 0], np.linspace(0, 500, 30))
    space = GradientSpace(V, F)
    z = space.encode_path(frames)
    assert_allclose(space.encode_path(frames[12:], after=z[11]), z[12:], rtol=0, atol=1e-11)


def test_references_are_the_mean_rotations_of_a_clip() -> None:
    V, F = ball(1)
    space = GradientSpace.from_clip(V, F, about(V, [0, 0, 1], np.array([10.0, 30.0, 50.0])))
    expected = Rotation.from_euler("z", 30, degrees=True).as_matrix()
    assert_allclose(space.references, np.broadcast_to(expected, space.references.shape), atol=1e-12)


def test_decoding_is_least_squares(rng) -> None:
    """Against a dense solution for the edges that the vector asks for, weighted by cotangents."""
    V, F = sheet(3, 3)
    space = GradientSpace.from_clip(V, F, deformed(V, rng, 3))
    z = space.encode(V) + 0.05 * rng.normal(size=space.dimension)
    R, S = space.deformations(z)
    rows, wanted = [], []
    for f, T in zip(F, R @ S):
        for k in range(3):
            i, j, at = f[(k + 1) % 3], f[(k + 2) % 3], f[k]
            a, b = V[i] - V[at], V[j] - V[at]
            cotangent = np.clip(a @ b / np.linalg.norm(np.cross(a, b)), 0.01, 20.0)
            row = np.zeros(len(V))
            row[i], row[j] = np.sqrt(cotangent / 2), -np.sqrt(cotangent / 2)
            rows.append(row)
            wanted.append(np.sqrt(cotangent / 2) * T @ (V[i] - V[j]))
    expected = np.linalg.lstsq(np.array(rows), np.array(wanted), rcond=None)[0]
    assert_allclose(centred(space.decode(z)), centred(expected), atol=1e-12)


def test_a_place_decodes_to_the_centre_of_every_piece(rng) -> None:
    V, F = pieces()
    space = GradientSpace(V, F)
    z = space.encode(V)
    shift = rng.normal(size=(4, 3))
    z[9 * len(F) :] += (shift * space.gradients._place_scale).ravel()
    found = space.decode(z) - V
    for v in (0, 45, 70, len(V) - 1):
        assert np.abs(found[v] - shift).sum(axis=1).min() < 1e-11


def test_the_state_makes_the_same_space(rng) -> None:
    V, F = pieces()
    frames = deformed(V, rng, 4)
    space = GradientSpace.from_clip(V, F, frames)
    again = space_from_state("gradient", {key: np.array(value) for key, value in space.state().items()})
    assert_array_equal(again.encode_path(frames), space.encode_path(frames))
    assert_array_equal(again.decode(space.encode(frames)), space.decode(space.encode(frames)))


def test_the_registry_knows_it(rng) -> None:
    V, F = sheet()
    assert isinstance(shape_space("gradient", V, F, deformed(V, rng, 2)), GradientSpace)


@pytest.mark.real
@pytest.mark.parametrize("name", ["horse-gallop", "vlasic-crane"])
def test_real_clips_come_back(name: str, data_folder) -> None:
    import tempose

    clip = tempose.load(data_folder(name))
    frames = np.asarray(clip.vertices[::20], dtype=float)
    space = GradientSpace.from_clip(clip.rest, clip.faces, frames)
    assert space.dimension == 9 * len(clip.faces) + 3
    assert_allclose(space.decode(space.encode_path(frames)), frames, rtol=0, atol=1e-11 * diagonal(clip.rest))
