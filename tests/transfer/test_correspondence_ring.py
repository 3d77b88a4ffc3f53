"""The cross-section rule: exact on parts of revolution, free of numbering, turned with the mesh."""

from __future__ import annotations

import numpy as np
import pytest
from correspondence_shapes import PARTS, capsule, cylinder, face_near, merged, moved, renumbered
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import human_body

from tempose.clips import Mesh
from tempose.transfer import Alignment, Ring, Sections, align_points, complete_ring
from tempose.transfer.correspondence import find_limb
from tempose.transfer.correspondence.limb_axis import thickness
from tempose.transfer.correspondence.rays import shoot_ring


def pick_of(mesh: Mesh, y: float = 0.93) -> int:
    return face_near(mesh, [0.05, y, 0.25])


@pytest.mark.parametrize("name", PARTS)
def test_the_axis_of_a_part_of_revolution_is_exact(name: str) -> None:
    mesh = PARTS[name]()
    limb = find_limb(Sections(mesh.vertices, mesh.faces), pick_of(mesh))
    assert limb is not None and limb.loop.closed
    assert_allclose(np.abs(limb.axis), [0, 1, 0], atol=1e-9)
    assert_allclose(limb.centre[[0, 2]], 0, atol=1e-9)


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("count", [3, 8, 13])
def test_rays_stand_at_equal_angles_from_the_pick(name: str, count: int) -> None:
    mesh = PARTS[name]()
    face = pick_of(mesh)
    first = mesh.vertices[mesh.faces[face]].mean(axis=0)
    limb = find_limb(Sections(mesh.vertices, mesh.faces), face)
    assert limb is not None
    angles = np.arange(count) * 2 * np.pi / count
    faces, points, met = shoot_ring(limb, first, angles)
    assert met.all() and faces[0] == face
    assert_allclose(points[0], first, atol=1e-9)
    way = np.arctan2(points[:, 0], points[:, 2]) - np.arctan2(first[0], first[2])
    assert_allclose(np.exp(1j * way), np.exp(1j * angles * limb.axis[1]), atol=1e-8)
    # each point lies in its face
    for f, p in zip(faces, points):
        a, b, c = mesh.vertices[mesh.faces[f]]
        weights = np.linalg.lstsq(np.stack([a, b, c]).T, p, rcond=None)[0]
        assert weights.min() > -1e-9 and abs(weights.sum() - 1) < 1e-9


def test_the_same_mesh_gives_the_same_faces() -> None:
    mesh = capsule()
    face = pick_of(mesh)
    ring = complete_ring(mesh, mesh, (face, face))
    assert_array_equal(ring.source, ring.target)
    assert ring.target[0] == face and ring.closed and ring.warnings == ()
    assert len(set(ring.target)) == len(ring.target) == 12


def test_a_ring_turns_with_its_meshes(rng: np.random.Generator) -> None:
    body = human_body().mesh
    shin = face_near(body, [0.1, 0.3, 0.08])
    other, R, shift = moved(body, rng, scale=1.7)
    ring = complete_ring(body, other, (shin, shin), alignment=align_points(body.vertices, other.vertices))
    assert_array_equal(ring.source, ring.target)
    here, there = ring.limbs
    assert here is not None
    assert_allclose(np.abs((R @ here.axis) @ there.axis), 1, atol=1e-9)
    assert_allclose(1.7 * R @ here.centre + shift, there.centre, atol=1e-9)


def test_a_ring_is_free_of_numbering(rng: np.random.Generator) -> None:
    body = human_body().mesh
    shin = face_near(body, [0.1, 0.3, 0.08])
    other, face_of, _ = renumbered(body, rng)
    ring = complete_ring(body, other, (shin, int(face_of[shin])))
    assert_array_equal(face_of[ring.source], ring.target)


@pytest.mark.parametrize(("place", "side"), [([0.1, 0.3, 0.08], 1), ([-0.1, 0.7, 0.1], -1)])
def test_a_ring_never_reaches_the_other_leg(place: list[float], side: int) -> None:
    body = human_body().mesh
    ring = complete_ring(None, body, (0, face_near(body, place)))
    centres = body.vertices[body.faces[ring.target]].mean(axis=1)
    assert (side * centres[:, 0] > 0).all() and ring.closed and len(ring.source) == 0
    assert np.ptp(centres[:, 1]) < 0.12


def test_outwards_decides_even_when_the_part_is_turned_over(rng: np.random.Generator) -> None:
    # an arm that hangs here and is raised there: only its end tells which way the ring runs
    body = human_body().mesh
    shin = face_near(body, [0.1, 0.3, 0.08])
    over = body.with_vertices(body.vertices * [-1, -1, 1])
    wrong = Alignment(1.0, np.array([1.0, 0, 0, 0]), np.zeros(3))
    ring = complete_ring(body, over, (shin, shin), alignment=wrong)
    assert_array_equal(ring.source, ring.target)
    limb = find_limb(Sections(body.vertices, body.faces), shin)
    assert limb is not None and limb.distal * limb.axis[1] < 0


def test_without_ends_the_alignment_decides() -> None:
    mesh = cylinder()
    face = pick_of(mesh, 1.0)
    half_turn = mesh.with_vertices(mesh.vertices * [1, -1, -1] + [0, 2, 0])
    turned = align_points(mesh.vertices, half_turn.vertices)
    ring = complete_ring(mesh, half_turn, (face, face), alignment=turned)
    assert_array_equal(ring.source, ring.target)


def test_a_given_axis_is_kept() -> None:
    mesh = cylinder()
    face = pick_of(mesh)
    slanting = np.array([0.3, 1, 0.1])
    limb = find_limb(Sections(mesh.vertices, mesh.faces), face, slanting)
    assert limb is not None
    assert_allclose(limb.axis, slanting / np.linalg.norm(slanting), atol=1e-12)
    assert_allclose((limb.loop.points - limb.loop.points[0]) @ limb.axis, 0, atol=1e-12)


def test_a_half_open_part_is_said_to_be_open() -> None:
    mesh = cylinder()
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    half = Mesh(mesh.vertices, mesh.faces[centres[:, 2] > 0])
    ring = complete_ring(None, half, (0, pick_of(half)), target_axis=np.array([0, 1.0, 0]))
    assert not ring.closed and "not closed" in ring.warnings[0]


def test_thickness_is_the_way_through() -> None:
    mesh = cylinder()
    assert_allclose(thickness(mesh.vertices, mesh.faces, pick_of(mesh)), 0.5 * np.cos(np.pi / 24), rtol=1e-9)
    two = merged(mesh, mesh.with_vertices(mesh.vertices - [0, 0, 0.9]))
    assert_allclose(thickness(two.vertices, two.faces, pick_of(two)), 0.5 * np.cos(np.pi / 24), rtol=1e-9)


@pytest.mark.parametrize(
    ("pair", "options", "message"),
    [
        ((0, 10**6), {}, "target face 1000000"),
        ((-1, 5), {}, "source face -1"),
        ((5, 5), {"count": 2}, "count must be at least 3"),
    ],
)
def test_bad_picks_are_refused(pair: tuple[int, int], options: dict[str, int], message: str) -> None:
    mesh = cylinder()
    with pytest.raises(ValueError, match=message):
        complete_ring(mesh, mesh, pair, **options)  # type: ignore[arg-type]


def test_a_face_without_area_has_no_section() -> None:
    mesh = cylinder()
    flat = Mesh(mesh.vertices, np.vstack([mesh.faces, [[3, 3, 3]]]))
    with pytest.raises(ValueError, match="no cross section"):
        complete_ring(None, flat, (0, len(flat.faces) - 1))


def test_ring_type() -> None:
    mesh = cylinder()
    assert isinstance(complete_ring(None, Sections(mesh.vertices, mesh.faces), (0, pick_of(mesh))), Ring)
