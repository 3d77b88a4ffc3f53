"""Edge lengths and dihedral angles: closed forms, slow twins, and what happens to numbers of no mesh."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from spaces_zoo import ZOO, closed, crumpled, diagonal, grid, joined, parts, poses, unaligned

import tempose
from tempose.shape_spaces import EdgeDihedralSpace
from tempose.shape_spaces.edge_dihedral.derivatives import NormalEquations
from tempose.shape_spaces.edge_dihedral.hinges import find_hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals, normals
from tempose.shape_spaces.edge_dihedral.parts import steady_weights
from tempose.shape_spaces.edge_dihedral.positions import VertexPositions
from tempose.shape_spaces.edge_dihedral.triangles import areas_from_lengths, lay_out
from tempose.shape_spaces.edge_dihedral.turns import FaceTurns
from tempose.shape_spaces.edge_dihedral.weights import hinge_stiffness


def measured(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return lengths_and_dihedrals(V, F, find_hinges(F))


def numbers(space: EdgeDihedralSpace, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return z[: space.n_edges] / space.length_weights, z[space.n_edges : space.n_shape] / space.angle_weights


def test_a_cube_has_right_angles() -> None:
    box = trimesh.creation.box(extents=(1, 2, 3))
    lengths, angles = measured(np.array(box.vertices), np.array(box.faces))
    assert len(lengths) == 18
    sides = np.isin(lengths.round(9), [1, 2, 3])
    assert sides.sum() == 12
    assert_allclose(angles[sides], np.pi / 2, atol=1e-12)
    assert_allclose(angles[~sides], 0, atol=1e-12)


def test_dihedrals_of_a_solid_turned_inside_out_change_sign() -> None:
    V, F = closed(1)
    assert_allclose(measured(V, F[:, ::-1])[1], -measured(V, F)[1], atol=1e-12)
    assert_allclose(measured(V * [1, -1, 1], F)[1], -measured(V, F)[1], atol=1e-12)


def folded(angle: float) -> np.ndarray:
    """Two triangles, the second turned about their edge; 0 is flat, positive bends away from the front."""
    return np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0.4, 0], [np.cos(angle), 0.6, -np.sin(angle)]])


FOLD = np.array([[0, 1, 2], [1, 0, 3]])


@pytest.mark.parametrize("angle", [0.0, 0.3, -0.3, 2.0, -3.0, np.pi])
def test_paper_folds_by_its_angle(angle: float) -> None:
    lengths, angles = measured(folded(angle), FOLD)
    assert_allclose(angles[0], angle, atol=1e-12)
    assert_allclose(angles[1:], 0)
    assert_allclose(lengths[0], 1)


def test_folding_goes_on_past_half_a_turn() -> None:
    swings = np.linspace(-0.5, 1.5 * np.pi, 60)
    frames = np.stack([folded(a) for a in swings])
    space = EdgeDihedralSpace.from_clip(frames[0], FOLD, frames)
    path = space.encode_path(frames)
    angles = np.array([numbers(space, z)[1][0] for z in path])
    assert_allclose(np.diff(angles), np.diff(swings), atol=1e-9)
    assert_allclose(space.decode(path), frames, atol=1e-9)


def test_halfway_between_two_folds_is_folded_half() -> None:
    frames = np.stack([folded(0.2), folded(2.2)])
    space = EdgeDihedralSpace.from_clip(frames[0], FOLD, frames)
    middle = space.decode(space.encode(frames).mean(axis=0))
    assert unaligned(middle, folded(1.2)) < 1e-9


@pytest.mark.parametrize("mesh", ["closed", "opened", "crumpled", "pinched"])
def test_measures_equal_a_loop(mesh: str) -> None:
    V, F = ZOO[mesh]()
    hinges = find_hinges(F)
    lengths, angles = measured(V, F)
    faces_of: dict[tuple[int, int], list[int]] = {}
    for f, face in enumerate(F):
        for k in range(3):
            pair = sorted((int(face[k]), int(face[(k + 1) % 3])))
            faces_of.setdefault((pair[0], pair[1]), []).append(f)
    assert [tuple(e) for e in hinges.edges] == sorted(faces_of)
    assert len(hinges.edge) == sum(len(fs) - 1 for fs in faces_of.values())
    for e, (i, j) in enumerate(hinges.edges):
        assert_allclose(lengths[e], np.linalg.norm(V[i] - V[j]), rtol=1e-14)
    for h in range(len(hinges.edge)):
        f, g = hinges.faces[h]
        i, j = hinges.edges[hinges.edge[h]]
        assert {f, g} <= set(faces_of[(i, j)])
        n, m = (np.cross(V[F[t, 1]] - V[F[t, 0]], V[F[t, 2]] - V[F[t, 0]]) for t in (f, g))
        cosine = n @ m / np.linalg.norm(n) / np.linalg.norm(m)
        size = np.arccos(np.clip(cosine, -1, 1))
        sign = np.sign(np.cross(n, m) @ (V[j] - V[i]))
        assert_allclose(angles[hinges.slot[h]], sign * size, atol=1e-7)


def test_triangles_laid_out_have_their_sides(rng: np.random.Generator) -> None:
    corners = rng.standard_normal((200, 3, 2))
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    directions, apex = lay_out(sides)
    P = np.stack([np.zeros_like(apex), np.column_stack([sides[:, 0], 0 * apex[:, 0]]), apex], axis=1)
    steps = np.roll(P, -1, axis=1) - P
    assert_allclose(np.linalg.norm(steps, axis=2), sides, rtol=1e-9)
    unit = np.stack([np.cos(directions), np.sin(directions)], axis=2)
    assert_allclose(unit * sides[..., None], steps, atol=1e-9)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    doubled = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    assert_allclose(areas_from_lengths(sides), doubled / 2, rtol=1e-7)


def test_a_needle_keeps_its_angle_and_no_triangle_is_flat() -> None:
    directions, apex = lay_out(np.array([[1.0, 1e-9, 1.0], [1.0, 1.0, 3.0], [3.0, 1.0, 1.0]]))
    assert_allclose(directions[0, 2] - np.pi, 1e-9, rtol=1e-7)
    assert_allclose(apex[1:, 1], 0, atol=1e-12)
    assert np.isfinite(directions).all()


@pytest.mark.parametrize("mesh", ["closed", "opened", "one_sided", "pinched"])
def test_gradients_equal_differences(mesh: str, rng: np.random.Generator) -> None:
    V, F = ZOO[mesh]()
    hinges = find_hinges(F)
    equations = NormalEquations(F, len(V), hinges)
    lengths, _ = measured(V, F)
    move, step = rng.standard_normal(V.shape), 1e-6
    after, before = measured(V + step * move, F), measured(V - step * move, F)
    G = equations.angle_gradients(V, normals(V, F, hinges), lengths)
    wrapped = np.angle(np.exp(1j * (after[1] - before[1]))) / (2 * step)
    assert_allclose(
        np.einsum("hvc,hvc->h", G, move[equations.of_hinge]), wrapped[hinges.slot], rtol=1e-4, atol=1e-5
    )
    G = equations.length_gradients(V, lengths)
    found = np.einsum("evc,evc->e", G, move[hinges.edges])
    assert_allclose(found, (after[0] - before[0]) / (2 * step), atol=1e-7)


def test_normal_equations_equal_dense_ones(rng: np.random.Generator) -> None:
    V, F = closed(1)
    hinges, n = find_hinges(F), len(V)
    equations = NormalEquations(F, n, hinges)
    lengths, _ = measured(V, F)
    A, B = (
        equations.length_gradients(V, lengths),
        equations.angle_gradients(V, normals(V, F, hinges), lengths),
    )
    w, x = rng.uniform(1, 2, len(A)), rng.uniform(1, 2, len(B))
    r, s = rng.standard_normal(len(A)), rng.standard_normal(len(B))
    blocks, rhs = equations.system(((A, w, r), (B, x, s)))
    J = np.zeros((len(A) + len(B), n, 3))
    for row, (vertices, gradient, weight) in enumerate(
        [*zip(hinges.edges, A, w), *zip(equations.of_hinge, B, x)]
    ):
        J[row, vertices] += weight * gradient
    J = J.reshape(len(J), -1)
    dense = np.zeros((n, 3, n, 3))
    rows = np.repeat(np.arange(n), np.diff(equations.indptr))
    dense[rows, :, equations.indices, :] = blocks
    assert_allclose(dense.reshape(3 * n, 3 * n), J.T @ J, atol=1e-10)
    assert_allclose(rhs.ravel(), -J.T @ np.r_[r, s], atol=1e-10)


def test_rotations_of_no_mesh_are_the_best(rng: np.random.Generator) -> None:
    """Against a general minimiser over rotation vectors, on a tetrahedron with wrong angles."""
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0.3, 1, 0], [0.2, 0.3, 0.9]])
    F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    hinges = find_hinges(F)
    lengths, angles = measured(V, F)
    angles = angles + 0.3 * rng.standard_normal(6)
    weights = rng.uniform(1, 3, 6)
    turns = FaceTurns(hinges, weights)
    directions, _ = lay_out(lengths[hinges.face_edges])
    R, mismatch, _ = turns.rotations(directions, angles, 200)

    def about(axis: int, angle: float) -> np.ndarray:
        return Rotation.from_rotvec(angle * np.eye(3)[axis]).as_matrix()

    between = []
    for h in range(6):
        (f, g), (s, t) = hinges.faces[h], hinges.sides[h]
        a = directions[f, s] + (np.pi if hinges.along[f, s] < 0 else 0)
        b = directions[g, t] + (np.pi if hinges.along[g, t] < 0 else 0)
        between.append(about(2, a) @ about(0, angles[hinges.slot[h]]) @ about(2, -b))

    def energy(x: np.ndarray) -> float:
        Q = Rotation.from_rotvec(x.reshape(4, 3)).as_matrix() @ R
        terms = [np.sum((Q[g] - Q[f] @ M) ** 2) for (f, g), M in zip(hinges.faces, between)]
        return float(weights @ terms)

    found = energy(np.zeros(12))
    # |A - B|^2 = 2 (2 - 2 cos): twice what is minimised and reported
    assert_allclose(2 * mismatch**2 * weights.sum(), found, rtol=1e-9)
    assert found <= minimize(energy, 0.01 * rng.standard_normal(12)).fun * (1 + 2e-3)
    assert_allclose(R @ R.transpose(0, 2, 1), np.broadcast_to(np.eye(3), R.shape), atol=1e-12)


def test_positions_are_those_of_least_squares(rng: np.random.Generator) -> None:
    V, F = closed(1)
    hinges = find_hinges(F)
    sides = measured(V, F)[0][hinges.face_edges]
    apex = lay_out(sides)[1]
    solver = VertexPositions(F, len(V), sides, apex)
    R = Rotation.random(len(F), rng=rng).as_matrix()
    flat = np.stack([np.zeros_like(apex), np.column_stack([sides[:, 0], 0 * sides[:, 0]]), apex], axis=1)
    rows, right = [], []
    for f, face in enumerate(F):
        for k in range(3):
            row = np.zeros(len(V))
            row[face[(k + 1) % 3]], row[face[k]] = 1, -1
            w = np.sqrt(solver.weights[f, k])
            rows.append(w * row)
            right.append(w * R[f][:, :2] @ (flat[f, (k + 1) % 3] - flat[f, k]))
    expected = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    found = solver.solve(sides, apex, R)
    assert_allclose(found - found.mean(axis=0), expected - expected.mean(axis=0), atol=1e-9)


@pytest.mark.parametrize("mesh", ["closed", "parts"])
def test_only_six_numbers_see_a_rigid_motion(mesh: str, rng: np.random.Generator) -> None:
    V, F = ZOO[mesh]()
    frames = poses(V)
    space = EdgeDihedralSpace.from_clip(V, F, frames)
    z = space.encode(frames[2])
    R = Rotation.random(rng=rng).as_matrix()
    moved = space.encode(frames[2] @ R.T + [3.0, -1.0, 2.0])
    same = np.ones(len(z), dtype=bool)
    same[space.n_shape : space.n_shape + 6] = False
    assert_allclose(moved[same], z[same], atol=1e-9)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_coordinates_are_free_of_units(unit: float) -> None:
    V, F = parts()
    frames = poses(V)
    z = EdgeDihedralSpace.from_clip(V, F, frames).encode(frames)
    assert_allclose(
        EdgeDihedralSpace.from_clip(unit * V, F, unit * frames).encode(unit * frames), z, atol=1e-9
    )


def test_a_uniform_strain_has_its_size() -> None:
    """Scaled by 1 + s, the lengths are s away: distances read as strains."""
    V, F = closed()
    space = EdgeDihedralSpace.from_clip(V, F)
    step = space.encode(1.25 * V) - space.encode(V)
    assert_allclose(np.linalg.norm(step[: space.n_edges]), 0.25, rtol=1e-12)
    assert_allclose(step[space.n_edges : space.n_shape], 0, atol=1e-9)


def test_the_dimension_counts_parts_and_fins() -> None:
    for mesh, extra in (("closed", 6), ("opened", 6), ("parts", 3 * 6 + 3), ("pinched", 2 * 6 + 1)):
        V, F = ZOO[mesh]()
        space = EdgeDihedralSpace.from_clip(V, F)
        assert space.dimension == 2 * len(find_hinges(F).edges) + extra


def test_refining_finds_the_mesh_again(rng: np.random.Generator) -> None:
    V, F = closed(1)
    space = EdgeDihedralSpace.from_clip(V, F)
    lengths, angles = numbers(space, space.encode(V))
    found = space.refinement.refine(V + 0.02 * rng.standard_normal(V.shape), lengths, angles, 30)
    assert found.converged
    assert unaligned(found.vertices, V) < 1e-6


def test_refining_never_goes_up_and_measures_what_is_left() -> None:
    V, F = closed(2)
    frames = poses(V, 3, size=0.12)
    space = EdgeDihedralSpace.from_clip(V, F, frames)
    z = space.encode(frames[1:]).mean(axis=0)
    found = [space.decode_measured(z, k, near=0.0) for k in range(5)]
    distances = [f.distance for f in found]
    assert all(b <= a for a, b in itertools.pairwise(distances))
    assert distances[-1] < 0.9 * distances[0]
    for f in found:
        away = (space.encode(f.vertices) - z)[: space.n_shape]
        assert_allclose(np.linalg.norm(away), f.distance, rtol=1e-6)
    assert found[-1].mismatch > 1e-4
    exact = space.decode_measured(space.encode(frames[1]), near=0.0)
    assert (exact.n_iter, exact.converged) == (0, True)
    assert max(exact.distance, exact.mismatch) < 1e-9


def test_a_small_part_rides_on_the_large_one() -> None:
    """An eye on a bending neck: halfway it sits where the neck is, not on the straight line between."""
    neck, F = grid(24, 3, 0.0)
    eye, G = closed(0)
    V, faces = joined((neck, F), (0.05 * eye + [1.0, 0.1, 0.6], G))

    def bent(angle: float) -> np.ndarray:
        # the sheet rolled into an arc of that angle
        r, a = 1 / angle, V[:, 0] * angle
        return np.stack([(r - V[:, 1]) * np.sin(a), r - (r - V[:, 1]) * np.cos(a), V[:, 2]], axis=1)

    frames = np.stack([bent(0.1), bent(2.5)])
    space = EdgeDihedralSpace.from_clip(V, faces, frames)
    middle = space.decode(space.encode_path(frames).mean(axis=0))
    assert unaligned(middle, bent(1.3)) < 0.01
    straight = frames.mean(axis=0)
    assert unaligned(straight, bent(1.3)) > 0.05


@pytest.mark.parametrize(("noise", "limit"), [(1e-4, 1e-4), (1e-3, 1e-3), (1e-2, 1e-2), (5e-2, 5e-2)])
def test_noise_bends_a_mesh_little(noise: float, limit: float, rng: np.random.Generator) -> None:
    V, F = closed(2)
    frames = poses(V)
    space = EdgeDihedralSpace.from_clip(V, F, frames)
    z = space.encode(frames[2])
    z[: space.n_shape] *= 1 + noise * rng.standard_normal(space.n_shape)
    assert unaligned(space.decode(z), frames[2]) < limit * diagonal(frames[2])


def test_a_collapsed_face_comes_back() -> None:
    V, F = closed(1)
    X = V.copy()
    X[F[3, 2]] = 0.3 * X[F[3, 0]] + 0.7 * X[F[3, 1]]
    space = EdgeDihedralSpace.from_clip(V, F, np.stack([V, X]))
    assert np.abs(space.decode(space.encode(X)) - X).max() < 1e-6 * diagonal(V)
    line = V * [1.0, 0, 0] + 0.0
    line[:, 0] = np.arange(len(V)) ** 1.1
    assert np.abs(space.decode(space.encode(line)) - line).max() < 1e-6 * diagonal(line)


def test_bad_meshes_are_refused() -> None:
    V, F = closed(1)
    with pytest.raises(ValueError, match="faces must hold at least one face"):
        EdgeDihedralSpace.from_clip(V, F[:0])
    with pytest.raises(ValueError, match=r"three vertices each, got \[5, 5, 7\] at index 80"):
        EdgeDihedralSpace.from_clip(V, np.concatenate([F, [[5, 5, 7]]]))
    merged = V.copy()
    merged[F[0, 1]] = merged[F[0, 0]]
    with pytest.raises(ValueError, match="at the same point"):
        EdgeDihedralSpace.from_clip(merged, F)
    space = EdgeDihedralSpace.from_clip(V, F)
    with pytest.raises(ValueError, match="at the same point"):
        space.encode(merged)
    with pytest.raises(ValueError, match=r"finite, got nan at index \(3, 1\)"):
        space.encode(np.where(np.arange(V.size).reshape(V.shape) == 10, np.nan, V))
    with pytest.raises(ValueError, match=r"frames must have shape \(T, 42, 3\)"):
        EdgeDihedralSpace.from_clip(V, F, V)
    with pytest.raises(ValueError, match="refinements must be 0 or more"):
        EdgeDihedralSpace(space.reference, -1)
    with pytest.raises(ValueError, match="state must hold lengths"):
        EdgeDihedralSpace.from_state({k: v for k, v in space.state().items() if k != "lengths"})


def test_crumpled_meshes_come_back_from_every_pose() -> None:
    V, F = crumpled()
    frames = poses(V, 8, size=0.4)
    space = EdgeDihedralSpace.from_clip(V, F, frames)
    assert np.abs(space.decode(space.encode(frames)) - frames).max() < 1e-9 * diagonal(frames)


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize(
    "clip", ["horse-poses", "horse-gallop", "vlasic-crane", "elephant-poses", "elephant-gallop-2frames"]
)
def test_real_meshes_come_back(clip: str, data_folder) -> None:
    loaded = tempose.load(data_folder(clip))
    frames = np.asarray(loaded.vertices[:: max(1, len(loaded.vertices) // 8)], dtype=np.float64)
    space = EdgeDihedralSpace.from_clip(frames[0], loaded.faces, frames[:4])
    assert np.abs(space.decode(space.encode(frames)) - frames).max() < 1e-9 * diagonal(frames)


def test_single_folds_lie_near_those_of_the_clip() -> None:
    """A fold that swings about half a turn is not cut there."""
    frames = np.stack([folded(a) for a in np.linspace(2.5, 3.7, 7)])
    space = EdgeDihedralSpace.from_clip(frames[0], FOLD, frames)
    angles = [numbers(space, space.encode(X))[1][0] for X in frames]
    assert_allclose(np.diff(angles), 0.2, atol=1e-9)


def test_the_frame_of_a_body_follows_what_moves_rigidly() -> None:
    """A ball turns slowly while an arm on it swings: the ball's own turn is found."""
    V, F = closed(2)
    is_arm = V[:, 1] > 0.8
    frames = []
    for t in np.linspace(-1, 1, 9):
        X = V.copy()
        X[is_arm] = (X[is_arm] - [0, 0.8, 0]) @ Rotation.from_rotvec([1.5 * t, 0, 0]).as_matrix().T + [
            0,
            0.8,
            0,
        ]
        frames.append(X @ Rotation.from_rotvec([0, 0.2 * t, 0]).as_matrix().T)
    weights = steady_weights(V, F, np.stack(frames))
    plain = steady_weights(V, F, V[None])
    assert_allclose([weights.sum(), plain.sum()], 1)
    assert weights[is_arm].sum() < 0.1 * plain[is_arm].sum()


def test_hinges_that_flip_to_and_fro_count_little() -> None:
    frames = np.stack([folded(a) for a in (-1.5, 1.5, -1.4, 1.4)])
    still = EdgeDihedralSpace.from_clip(frames[0], FOLD)
    swinging = EdgeDihedralSpace.from_clip(frames[0], FOLD, frames)
    spread = swinging.reference.spread[0]
    assert_allclose(spread, -2 * np.log(np.abs(np.exp(1j * np.array([1.5, 1.4])).real.mean())), rtol=1e-9)
    ratio = hinge_stiffness(still.hinges, still.reference) / hinge_stiffness(
        swinging.hinges, swinging.reference
    )
    assert_allclose(ratio, (0.02 + spread) / 0.02, rtol=1e-9)


def test_a_second_start_may_end_lower() -> None:
    V, F = closed(2)
    space = EdgeDihedralSpace.from_clip(V, F)
    turns, gains = space.assembly.turns, []
    for seed in range(8):
        rng = np.random.default_rng(seed)
        lengths, angles = numbers(space, space.encode(V))
        angles = angles + 0.8 * rng.standard_normal(len(angles))
        directions, _ = lay_out(lengths[space.hinges.face_edges])
        both = turns.rotations(directions, angles)[1]
        rest, turns.at_rest = turns.at_rest, None
        alone = turns.rotations(directions, angles)[1]
        turns.at_rest = rest
        gains.append(alone - both)
    assert min(gains) >= 0
    assert max(gains) > 0
