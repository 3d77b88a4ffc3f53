"""Built-in characters are closed surfaces of the asked size, bound to their skeletons."""

from __future__ import annotations

import numpy as np
import pytest

from tempose.geometry import boundary_edges, edge_list, face_areas, vertex_components
from tempose.kinematics import linear_blend_skinning, rest_transforms
from tempose.metrics import volumes
from tempose.samples import CHARACTERS, human_character


@pytest.fixture(scope="module", params=[("human", 3000), ("animal", 3000), ("human", 20_000)], ids=str)
def character(request):
    name, triangles = request.param
    return CHARACTERS[name](triangles), triangles


def test_surface_is_closed_connected_and_without_handles(character):
    mesh = character[0].mesh
    edges = edge_list(mesh.faces)
    assert len(boundary_edges(mesh.faces)) == 0
    assert vertex_components(mesh.faces, len(mesh.vertices))[0] == 1
    assert len(mesh.vertices) - len(edges) + len(mesh.faces) == 2
    assert 2 * len(edges) == 3 * len(mesh.faces)


def test_surface_faces_outwards_and_has_no_slivers(character):
    mesh = character[0].mesh
    assert volumes(mesh.vertices[None], mesh.faces)[0] > 0
    assert face_areas(mesh.vertices, mesh.faces).min() > 0


def test_size_is_about_what_was_asked(character):
    skin, triangles = character
    assert abs(len(skin.mesh.faces) - triangles) < 0.15 * triangles


def test_it_stands_on_the_ground_as_tall_as_its_kind(character):
    mesh = character[0].mesh
    assert abs(mesh.vertices[:, 1].min()) < 0.02
    assert 1.2 < mesh.height < 2.2


def test_weights_are_few_and_sum_to_one(character):
    weights = character[0].weights
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-9)
    assert (weights > 0).sum(axis=1).max() <= 4


def test_rest_pose_of_the_skeleton_is_the_bind_pose(character):
    skin = character[0]
    rest = np.asarray(skin.skeleton.rest_rotations)[None]
    V = linear_blend_skinning(skin, rest, skin.skeleton.offsets[:1])
    np.testing.assert_allclose(V[0], skin.mesh.vertices, atol=1e-12)


def test_left_side_is_left(character):
    skin = character[0]
    positions = rest_transforms(skin.skeleton)[1]
    for j, name in enumerate(skin.skeleton.names):
        if name.startswith("left_"):
            assert positions[j, 0] > 0
            mine = skin.weights[:, j] > 0.6
            assert (skin.mesh.vertices[mine, 0] > -0.02).all()


def test_same_call_gives_the_same_character():
    a, b = CHARACTERS["human"](3000), CHARACTERS["human"](3000)
    np.testing.assert_array_equal(a.mesh.vertices, b.mesh.vertices)
    np.testing.assert_array_equal(a.weights, b.weights)


def test_soft_regions_lie_on_the_body():
    character = human_character(3000)
    n = len(character.skin.mesh.vertices)
    for name in ("belly", "skirt"):
        weight = character.regions[name]
        assert weight.shape == (n,)
        assert 0 <= weight.min() and 0.3 < weight.max() <= 1
