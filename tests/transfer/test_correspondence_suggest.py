"""Suggested partners: the place itself on the same mesh, through the pairs, never the far side of a limb."""

from __future__ import annotations

import numpy as np
import pytest
from correspondence_shapes import face_near, moved, renumbered
from numpy.testing import assert_allclose
from transfer_bodies import human_body, t_body
from transfer_zoo import sphere

from tempose.clips import Mesh
from tempose.geometry import face_normals
from tempose.transfer import Alignment, Pairs, PartnerFinder, suggest_partner
from tempose.transfer.correspondence.closest import spread_points
from tempose.transfer.correspondence.warp import Warp
from tempose.transfer.correspondence.ways import Ways

STILL = Alignment(1.0, np.array([1.0, 0, 0, 0]), np.zeros(3))


@pytest.fixture(scope="module")
def body() -> Mesh:
    return human_body().mesh


@pytest.mark.parametrize("kind", ["faces", "vertices"])
def test_on_the_same_mesh_the_partner_is_the_place_itself(body: Mesh, kind: str) -> None:
    finder = PartnerFinder(body, body, alignment=STILL, kind=kind)  # type: ignore[arg-type]
    for place in range(0, len(body.vertices), 97):
        best = finder.suggest(place)[0]
        assert best.index == place
        assert best.score > 0.999 and best.distance < 1e-6 and best.normal_deg < 0.01


def test_an_accepted_pair_is_met(body: Mesh) -> None:
    other = t_body().mesh
    places = [
        [0.09, 0.3, 0.08],
        [-0.09, 0.3, 0.08],
        [0, 1.2, 0.12],
        [0, 1.6, 0.1],
        [0.09, 0.7, 0.1],
        [-0.09, 0.7, 0.1],
    ]
    pairs = Pairs("faces", [face_near(body, p) for p in places], [face_near(other, p) for p in places])
    finder = PartnerFinder(body, other, pairs, alignment=STILL)
    for s, t in zip(np.asarray(pairs.source), pairs.target):
        candidates = finder.suggest(int(s))
        assert candidates[0].index == t
        assert [c.score for c in candidates] == sorted((c.score for c in candidates), reverse=True)


def test_the_far_side_of_a_thin_plate_is_not_taken() -> None:
    k = 20
    x, y = np.meshgrid(np.linspace(0, 1, k), np.linspace(0, 1.4, k), indexing="ij")
    grid = np.stack([x.ravel(), y.ravel(), 0.05 * np.sin(3 * x + y).ravel()], axis=1)
    i = (np.arange(k - 1)[:, None] * k + np.arange(k - 1)).ravel()
    quads = np.concatenate([np.c_[i, i + k, i + k + 1], np.c_[i, i + k + 1, i + 1]])
    plate = Mesh(
        np.concatenate([grid, grid - [0, 0, 0.004]]), np.concatenate([quads, quads[:, ::-1] + k * k])
    )
    # nearer to the back of the shifted plate than to its front
    shifted = plate.with_vertices(plate.vertices + np.array([0, 0, 0.0035]))
    finder = PartnerFinder(plate, shifted, alignment=STILL)
    N = face_normals(shifted.vertices, shifted.faces)
    for face in range(0, len(quads), 41):
        assert N[finder.suggest(face)[0].index] @ N[face] > 0.9


def test_marks_keep_legs_apart(body: Mesh) -> None:
    # the target stands with its legs where the source's other leg is: only the ways along the surface differ
    aside = body.with_vertices(body.vertices + np.array([0.17, 0, 0]))
    places = [
        [0.09, 0.5, 0.08],
        [0.09, 0.15, 0.05],
        [-0.09, 0.5, 0.08],
        [-0.09, 0.15, 0.05],
        [0, 1.2, 0.12],
        [0, 1.6, 0.1],
    ]
    faces = [face_near(body, p) for p in places]
    finder = PartnerFinder(body, aside, Pairs("faces", faces, faces), alignment=STILL)
    shin = face_near(body, [0.09, 0.33, 0.07])
    best = finder.suggest(shin)[0].index
    assert body.vertices[body.faces[best]].mean(axis=0)[0] > 0.03


def test_suggestions_move_with_the_meshes(rng: np.random.Generator) -> None:
    # a shape without symmetry: no two distances tie
    mesh = sphere(3)
    other = mesh.with_vertices(
        mesh.vertices * [1.2, 0.9, 1.1] + 0.1 * np.sin(2 * mesh.vertices[:, [2, 0, 1]])
    )
    faces = spread_points(mesh.vertices[mesh.faces].mean(axis=1), 8, mesh.vertices.mean(axis=0))
    pairs = Pairs("faces", faces, faces)
    away, _, _ = moved(other, rng, 0.4)
    plain, far = (PartnerFinder(mesh, goal, pairs) for goal in (other, away))
    for face in range(0, len(mesh.faces), 13):
        assert plain.suggest(face)[0].index == far.suggest(face)[0].index


def test_suggestions_are_free_of_numbering(body: Mesh, rng: np.random.Generator) -> None:
    other, face_of, _ = renumbered(body, rng)
    finder = PartnerFinder(body, other, alignment=STILL)
    for face in range(0, len(body.faces), 499):
        assert finder.suggest(face)[0].index == face_of[face]


def test_candidates_are_different_places(body: Mesh) -> None:
    candidates = suggest_partner(body, body, 17, alignment=STILL, count=4)
    P = body.vertices[body.faces[[c.index for c in candidates]]].mean(axis=1)
    N = face_normals(body.vertices, body.faces[[c.index for c in candidates]])
    assert len(candidates) == 4
    for i in range(4):
        for j in range(i):
            assert np.linalg.norm(P[i] - P[j]) >= 0.01 * body.diagonal or N[i] @ N[j] <= 0


def test_the_warp_passes_through_its_pairs(body: Mesh, rng: np.random.Generator) -> None:
    V, F = body.vertices, body.faces
    points = V[spread_points(V, 12, V.mean(axis=0))]
    partners = points + 0.05 * rng.normal(size=points.shape)
    warp = Warp(points, partners, V, F, V, F)
    assert_allclose(warp.apply(points), partners, atol=1e-9)
    # one source place with two partners goes between them
    twice = Warp(np.vstack([points, points[:1]]), np.vstack([partners, partners[:1] + 0.02]), V, F, V, F)
    assert_allclose(twice.apply(points[:1]), partners[:1] + 0.01, atol=1e-9)


def test_the_warp_of_a_mesh_to_itself_is_the_identity(body: Mesh) -> None:
    V, F = body.vertices, body.faces
    assert_allclose(Warp(V[:0], V[:0], V, F, V, F).apply(V), V, atol=1e-9)
    flat = V * [1, 1, 0]
    assert np.isfinite(Warp(flat[:0], flat[:0], flat, F, flat, F).apply(flat)).all()


def test_ways_run_along_the_surface(body: Mesh) -> None:
    corners = body.vertices[body.faces].reshape(-1, 3)
    whole = Ways(body.vertices, body.faces)
    seamed = Ways(corners, np.arange(len(corners)).reshape(-1, 3))
    a, b = (way.from_place(int(way.nearest(body.vertices[:1])[0])) for way in (whole, seamed))
    assert_allclose(np.sort(a), np.sort(b), atol=1e-12)
    assert (a >= np.linalg.norm(body.vertices - body.vertices[0], axis=1) - 1e-12).all()


def test_bad_picks_are_refused(body: Mesh) -> None:
    with pytest.raises(ValueError, match="picked must be one of"):
        suggest_partner(body, body, len(body.faces), alignment=STILL)
    with pytest.raises(ValueError, match="pairs of kind 'joints'"):
        PartnerFinder(body, body, Pairs("joints", ("a", "b"), [0, 1]))
    with pytest.raises(ValueError, match="pairs name target faces 99999999"):
        PartnerFinder(body, body, Pairs("faces", [0], [99999999]))
