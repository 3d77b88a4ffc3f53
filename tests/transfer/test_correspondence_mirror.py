"""Mirroring: an involution where the mesh is symmetric, whatever its pose; names change sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from correspondence_shapes import face_near, merged, moved, renumbered
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import human_body
from transfer_zoo import sphere

from tempose.clips import Mesh
from tempose.samples.skeletons import human_skeleton
from tempose.transfer import Pairs, find_symmetry, mirror_pairs, skeleton_mesh
from tempose.transfer.correspondence.side_names import swap_side


def symmetric_body() -> Mesh:
    """Half of a bumpy ball and its mirror image, sewn along x = 0: no other symmetry."""
    ball = sphere(3)
    V = ball.vertices * [0.5, 1, 1]
    keep = (V[ball.faces][:, :, 0] > -0.12).all(axis=1)
    F = ball.faces[keep]
    edges = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    directed = {(int(a), int(b)) for a, b in edges}
    border = np.unique([a for a, b in directed if (b, a) not in directed])
    V = np.array(V)
    V[:, 0] += 0.12
    V[border, 0] = 0.0
    other = V * [-1, 1, 1]
    both = merged(Mesh(V, F), Mesh(other, F[:, ::-1]))
    return both


def posed(mesh: Mesh) -> Mesh:
    """Bent to one side, so that no plane reflects it."""
    V = mesh.vertices
    bend = Rotation.from_rotvec(np.outer(0.8 * np.maximum(V[:, 1], 0), [0.3, 0.2, 1])).as_matrix()
    return mesh.with_vertices(np.einsum("nij,nj->ni", bend, V) + np.array([0.3, 0, 0]))


@pytest.mark.parametrize("pose", [False, True])
def test_mirroring_twice_is_the_identity(pose: bool) -> None:
    rest = symmetric_body()
    opposite = np.r_[len(rest.faces) // 2 : len(rest.faces), : len(rest.faces) // 2]
    found = find_symmetry(posed(rest) if pose else rest)
    assert found.sure.all()
    assert_array_equal(found.faces, opposite)
    assert_array_equal(found.faces[found.faces], np.arange(len(rest.faces)))


def test_the_plane_turns_with_the_mesh(rng: np.random.Generator) -> None:
    rest = symmetric_body()
    turned, R, shift = moved(rest, rng, 2.0)
    found = find_symmetry(turned)
    assert_allclose(np.abs(found.normal @ R[:, 0]), 1, atol=1e-9)
    assert_allclose((found.point - shift) @ R[:, 0], 0, atol=1e-9)
    assert found.residual < 1e-9 and found.errors.max() < 1e-9
    P = turned.vertices[turned.faces].mean(axis=1)
    assert_allclose(found.reflect(P), P[found.faces], atol=1e-9)


def test_opposites_are_free_of_numbering(rng: np.random.Generator) -> None:
    rest = symmetric_body()
    other, face_of, _ = renumbered(posed(rest), rng)
    assert_array_equal(face_of[find_symmetry(rest).faces], find_symmetry(other).faces[face_of])


@pytest.mark.slow
def test_a_scan_without_symmetric_triangles_goes_by_place() -> None:
    body = human_body().mesh
    squeezed = body.with_vertices(body.vertices * [1, 1, 1.001])
    F = np.array(squeezed.faces)
    # one edge turned over on one side only
    left = face_near(squeezed, [0.09, 0.7, 0.1])
    shared = next(f for f in range(len(F)) if f != left and len(np.intersect1d(F[f], F[left])) == 2)
    a = next(v for v in F[left] if v not in F[shared])
    b = next(v for v in F[shared] if v not in F[left])
    k = list(F[left]).index(a)
    p, q = F[left][(k + 1) % 3], F[left][(k + 2) % 3]
    F[left], F[shared] = [a, p, b], [a, b, q]
    found = find_symmetry(Mesh(squeezed.vertices, F))
    assert not found.sure.any()
    assert np.median(found.errors) < 0.01
    assert_allclose(np.abs(found.normal), [1, 0, 0], atol=0.01)


def test_groups_of_sides_are_exchanged() -> None:
    from transfer_bodies import clip_of

    template = skeleton_mesh(clip_of(human_skeleton(), {}, 1)).mesh
    found = find_symmetry(template)
    for name, faces in template.groups.items():
        assert np.isin(found.faces[faces], template.groups[swap_side(name)]).all()


def test_joints_change_sides() -> None:
    body = symmetric_body()
    left, middle = face_near(body, [0.4, 0.5, 0.3]), face_near(body, [0, 1.5, 0])
    opposite = find_symmetry(body).faces
    pairs = Pairs(
        "joints",
        ("left_hand", "spine"),
        [left, middle],
        ("left_hand", "spine"),
        joints={"left_hand": [0.3, 0.5, 0.1]},
        comment="kept",
    )
    found = mirror_pairs(pairs, body, human_skeleton())
    assert found.added == 2 - (opposite[middle] == middle)
    assert found.pairs.source[:3] == ("left_hand", "spine", "right_hand")
    assert found.pairs.parts[2] == "right_hand" and found.pairs.comment == "kept"
    assert found.pairs.target[2] == opposite[left]
    assert found.pairs.how == ("picked", "picked", *("mirror",) * found.added)
    assert_allclose(found.pairs.joints["right_hand"], [-0.3, 0.5, 0.1], atol=1e-9)


def test_mirroring_again_adds_nothing() -> None:
    body = symmetric_body()
    faces = [face_near(body, p) for p in ([0.4, 0.5, 0.3], [0.4, -0.5, 0.3], [0.3, 1.0, -0.3])]
    once = mirror_pairs(Pairs("faces", faces, faces), body, body)
    opposite = find_symmetry(body).faces
    assert_array_equal(once.pairs.source[3:], opposite[faces])
    assert_array_equal(once.pairs.target[3:], opposite[faces])
    again = mirror_pairs(once.pairs, body, body)
    assert again.added == 0
    assert_array_equal(again.pairs.target, once.pairs.target)
    # the mirrored half alone gives back the first half
    half = replace(Pairs("faces", once.pairs.source[3:], once.pairs.target[3:]))
    assert_array_equal(mirror_pairs(half, body, body).pairs.target[3:], faces)


def test_vertices_are_mirrored_too() -> None:
    body = symmetric_body()
    n = len(body.vertices) // 2
    outside = np.flatnonzero(body.vertices[:n, 0] > 0.1)[::9]
    found = mirror_pairs(Pairs("vertices", outside, outside), body, body)
    assert_array_equal(found.pairs.target[len(outside) :], outside + n)
    assert_array_equal(found.pairs.source[len(outside) :], outside + n)


def test_what_has_no_counterpart_is_left_out_and_said() -> None:
    body = symmetric_body()
    bag = Mesh(sphere(1).vertices * 0.3 + [1.2, 0, 0], sphere(1).faces)
    both = merged(body, bag)
    faces = [face_near(both, [1.2, 0, 0.2]), face_near(both, [0.4, 0.5, 0.3])]
    found = mirror_pairs(Pairs("joints", ("left_hand", "left_forearm"), faces), both)
    assert found.added == 1 and "1 marks have no counterpart" in found.warnings[0]


def test_a_mesh_source_must_be_given() -> None:
    with pytest.raises(ValueError, match="need the source mesh"):
        mirror_pairs(Pairs("faces", [0], [0]), symmetric_body())
    with pytest.raises(ValueError, match="below"):
        mirror_pairs(Pairs("joints", ("a",), [10**6]), symmetric_body())


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("mixamorig:LeftForeArm", "mixamorig:RightForeArm"),
        ("left_shin", "right_shin"),
        ("thigh.L", "thigh.R"),
        ("lowerarm_l", "lowerarm_r"),
        ("lhumerus", "rhumerus"),
        ("rthumb", "lthumb"),
        ("Bip01 L Hand", "Bip01 R Hand"),
        ("RHipJoint", "LHipJoint"),
        ("upperarm01.R", "upperarm01.L"),
        ("leftarm", "rightarm"),
    ],
)
def test_sides_of_names(name: str, other: str) -> None:
    assert swap_side(name) == other and swap_side(other) == name


@pytest.mark.parametrize(
    "name", ["spine", "LowerBack", "Hips", "rotation", "neck", "lower_back", "Head", "root"]
)
def test_names_without_a_side_stay(name: str) -> None:
    assert swap_side(name) == name


@given(
    st.sampled_from(["left_", "right_", "Left", "Right", "L_", "r_"]), st.sampled_from(["arm", "Foot", "x1"])
)
def test_swapping_twice_is_the_identity(side: str, part: str) -> None:
    assert swap_side(swap_side(side + part)) == side + part
