"""Heights over tangent planes: closed forms, slow twins, and the signs they leave open."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import trimesh
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from spaces_zoo import ZOO, closed, crumpled, diagonal, parts, poses, unaligned

import tempose
from tempose.shape_spaces import RotationInvariantSpace
from tempose.shape_spaces.edge_dihedral.hinges import find_hinges
from tempose.shape_spaces.edge_dihedral.measure import lengths_and_dihedrals
from tempose.shape_spaces.edge_dihedral.triangles import lay_out
from tempose.shape_spaces.rotation_invariant.angles import dihedrals_from_normals, views_of_normals
from tempose.shape_spaces.rotation_invariant.branches import search
from tempose.shape_spaces.rotation_invariant.fans import corner_fronts
from tempose.shape_spaces.rotation_invariant.heights import heights_and_cosines
from tempose.shape_spaces.rotation_invariant.normals import normals_in_faces
from tempose.shape_spaces.rotation_invariant.signs import SignSearch


def seen(V: np.ndarray, F: np.ndarray):
    """Heights, cosines, and what the decoder sees of the normals."""
    hinges = find_hinges(F)
    heights, cosines = heights_and_cosines(V, F, hinges, corner_fronts(F, hinges))
    sides = lengths_and_dihedrals(V, F, hinges)[0][hinges.face_edges]
    directions, _ = lay_out(sides)
    N = normals_in_faces(hinges, sides, directions, heights)
    return hinges, heights, cosines, N, *views_of_normals(hinges, directions, N)


def test_heights_on_an_icosahedron() -> None:
    """Normals point from the centre: x_i . (x_j - x_i) / r = -l^2 / (2 r)."""
    ball = trimesh.creation.icosphere(subdivisions=0, radius=2.0)
    V, F = np.array(ball.vertices), np.array(ball.faces)
    hinges, heights, cosines, *_ = seen(V, F)
    lengths = lengths_and_dihedrals(V, F, hinges)[0]
    assert_allclose(heights, np.repeat(-(lengths**2) / 4.0, 2).reshape(-1, 2), rtol=1e-12)
    assert cosines.min() > 0


def test_a_flat_sheet_has_no_heights() -> None:
    V, F = ZOO["flat"]()
    _, heights, cosines, *_ = seen(V, F)
    assert_allclose(heights, 0, atol=1e-15)
    assert_allclose(cosines, 1)


@pytest.mark.parametrize("mesh", ["closed", "opened", "crumpled"])
def test_heights_and_normals_equal_loops(mesh: str) -> None:
    V, F = ZOO[mesh]()
    hinges, heights, cosines, N, _, _ = seen(V, F)
    normals = np.zeros(V.shape)
    for face in F:
        a, b, c = V[face]
        n = np.cross(b - a, c - a)
        n /= np.linalg.norm(n)
        for k in range(3):
            u, v = V[face[(k + 1) % 3]] - V[face[k]], V[face[(k + 2) % 3]] - V[face[k]]
            normals[face[k]] += np.arccos(u @ v / np.linalg.norm(u) / np.linalg.norm(v)) * n
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    for e, (i, j) in enumerate(hinges.edges):
        assert_allclose(heights[e], [normals[i] @ (V[j] - V[i]), normals[j] @ (V[i] - V[j])], atol=1e-12)
    for f, face in enumerate(F):
        x = V[face[1]] - V[face[0]]
        x /= np.linalg.norm(x)
        n = np.cross(x, V[face[2]] - V[face[0]])
        n /= np.linalg.norm(n)
        frame = np.stack([x, np.cross(n, x), n])
        there = normals[face] @ frame.T
        assert_allclose(cosines[f], there[:, 2], atol=1e-12)
        assert_allclose(N[f], np.column_stack([there[:, :2], np.abs(there[:, 2])]), atol=1e-6)


@pytest.mark.parametrize("mesh", ["closed", "opened", "slivers", "crumpled", "pinched", "one_sided"])
def test_dihedrals_follow_from_heights_and_signs(mesh: str) -> None:
    V, F = ZOO[mesh]()
    V = poses(V, 3)[2]
    hinges, _, cosines, _, corners, views = seen(V, F)
    signs = np.where(cosines.ravel() < 0, -1.0, 1.0)
    found = dihedrals_from_normals(hinges, corners, views, signs)
    wanted = lengths_and_dihedrals(V, F, hinges)[1]
    assert_allclose(np.exp(1j * found), np.exp(1j * wanted), atol=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_signs_of_folded_corners_are_found_without_a_hint(seed: int) -> None:
    V, F = closed(2)
    V = V + 0.15 * np.random.default_rng(seed).standard_normal(V.shape)
    hinges, _, cosines, _, corners, views = seen(V, F)
    wanted = np.where(cosines.ravel() < 0, -1.0, 1.0)
    assert (wanted < 0).sum() > 5
    search = SignSearch(F, len(V), hinges.edges[hinges.edge])
    found, doubt = search.signs(corners, views, np.ones(F.size))
    matters = np.abs(cosines.ravel()) > 1e-6
    assert_array_equal(found[matters], wanted[matters])
    assert doubt < 1e-9


def test_the_search_equals_trying_all_patterns() -> None:
    """Octahedron with numbers of no mesh: 2^24 patterns are too many, those of two vertices are not."""
    rng = np.random.default_rng(1)
    solid = trimesh.creation.icosphere(subdivisions=0)
    V, F = np.array(solid.vertices) + 0.5 * rng.standard_normal((12, 3)), np.array(solid.faces)
    _, _, cosines, _, corners, views = seen(V, F)
    views = views + 0.02 * rng.standard_normal(views.shape)
    start = np.where(cosines.ravel() < 0, -1.0, 1.0)
    own = np.flatnonzero(np.isin(F.ravel(), [0, int(F[F[:, 0] == 0][0, 1])]))
    around = np.flatnonzero(np.isin(corners, own).any(axis=(1, 2)))

    def cost(signs: np.ndarray) -> float:
        total = 0.0
        for h in around:
            w = []
            for end in range(2):
                first, second = (
                    views[h, end, s, 0] + 1j * signs[corners[h, end, s]] * views[h, end, s, 1]
                    for s in range(2)
                )
                w.append(first * np.conj(second))
            total += abs(w[0]) * abs(w[1]) - (w[0] * np.conj(w[1])).real
        return total

    least = np.inf
    for pattern in itertools.product([1.0, -1.0], repeat=len(own)):
        trial = start.copy()
        trial[own] = pattern
        least = min(least, cost(trial))
    worst = start.copy()
    worst[own] *= -1
    search(views, corners, worst, own, around, np.inf, 10_000_000)
    assert_allclose(cost(worst), least, rtol=1e-9)


def test_fans_of_a_moebius_band_agree() -> None:
    F = ZOO["one_sided"]()[1]
    hinges = find_hinges(F)
    fronts = corner_fronts(F, hinges)
    assert (fronts < 0).any()
    for h in range(len(hinges.edge)):
        f, g = hinges.faces[h]
        against = hinges.along[f, hinges.sides[h, 0]] == hinges.along[g, hinges.sides[h, 1]]
        for v in hinges.edges[hinges.edge[h]]:
            a, b = fronts[f, F[f] == v][0], fronts[g, F[g] == v][0]
            assert (a != b) == against
    assert_array_equal(corner_fronts(*(lambda m: (m[1], find_hinges(m[1])))(closed(1))), 1)


@pytest.mark.parametrize("mesh", ["closed", "parts"])
def test_only_six_numbers_see_a_rigid_motion(mesh: str, rng: np.random.Generator) -> None:
    V, F = ZOO[mesh]()
    frames = poses(V)
    space = RotationInvariantSpace.from_clip(V, F, frames)
    z = space.encode(frames[2])
    moved = space.encode(frames[2] @ Rotation.random(rng=rng).as_matrix().T + [3.0, -1.0, 2.0])
    same = np.ones(len(z), dtype=bool)
    same[space.n_shape : space.n_shape + 6] = False
    assert_allclose(moved[same], z[same], atol=1e-9)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_coordinates_are_free_of_units(unit: float) -> None:
    V, F = parts()
    frames = poses(V)
    z = RotationInvariantSpace.from_clip(V, F, frames).encode(frames)
    again = RotationInvariantSpace.from_clip(unit * V, F, unit * frames).encode(unit * frames)
    assert_allclose(again, z, atol=1e-9)


def test_the_dimension_is_three_edges_and_six() -> None:
    for mesh, extra in (("closed", 6), ("opened", 6), ("parts", 3 * 6 + 3), ("pinched", 2 * 6)):
        V, F = ZOO[mesh]()
        space = RotationInvariantSpace.from_clip(V, F)
        assert space.dimension == 3 * len(find_hinges(F).edges) + extra


@pytest.mark.parametrize(("noise", "limit"), [(1e-5, 1e-4), (1e-4, 1e-3), (1e-3, 1e-2), (1e-2, 5e-2)])
def test_noise_bends_a_mesh_little(noise: float, limit: float, rng: np.random.Generator) -> None:
    """Of a mesh with folds, whose signs must be found in spite of the noise."""
    V, F = closed(2)
    V = V + 0.06 * rng.standard_normal(V.shape)
    frames = poses(V)
    space = RotationInvariantSpace.from_clip(V, F)
    z = space.encode(frames[2])
    z[: space.n_shape] *= 1 + noise * rng.standard_normal(space.n_shape)
    assert unaligned(space.decode(z), frames[2]) < limit * diagonal(frames[2])


def test_crumpled_meshes_come_back_from_every_pose() -> None:
    V, F = crumpled()
    frames = poses(V, 8)
    space = RotationInvariantSpace.from_clip(V, F, frames)
    assert np.abs(space.decode(space.encode(frames)) - frames).max() < 1e-9 * diagonal(frames)


@pytest.mark.real
@pytest.mark.slow
@pytest.mark.parametrize(
    "clip", ["horse-poses", "horse-gallop", "vlasic-crane", "elephant-poses", "elephant-gallop-2frames"]
)
def test_real_meshes_come_back(clip: str, data_folder) -> None:
    """Folds of every frame are told apart although only the first is known."""
    loaded = tempose.load(data_folder(clip))
    frames = np.asarray(loaded.vertices[:: max(1, len(loaded.vertices) // 8)], dtype=np.float64)
    space = RotationInvariantSpace.from_clip(frames[0], loaded.faces)
    assert np.abs(space.decode(space.encode(frames)) - frames).max() < 1e-9 * diagonal(frames)
