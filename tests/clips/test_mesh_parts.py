"""Parts of meshes: what is kept is unchanged, order included."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from tempose.clips import Mesh, MeshClip
from tempose.clips.mesh_parts import keep_clip_group, keep_faces, keep_group
from tempose.geometry import vertex_components, weld


def quads(rng) -> Mesh:
    V = rng.random((10, 3))
    F = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [7, 8, 9]]
    uv_faces = np.array([[5, 4, 3], [5, 3, 2], [0, 1, 2], [0, 2, 3], [3, 4, 5]])
    groups = {"a": [0, 1], "b": [2, 3, 4], "ab": [1, 2], "c": [4]}
    return Mesh(V, F, rng.random((6, 2)), uv_faces, rng.random((10, 3)), groups, np.array([4, 4, 3]))


@given(st.lists(st.booleans(), min_size=5, max_size=5))
def test_corners_keep_position_texture_and_colour(chosen):
    mesh, mask = quads(np.random.default_rng(1)), np.array(chosen)
    part, vertex_index = keep_faces(mesh, mask)
    assert_array_equal(part.vertices[part.faces], mesh.vertices[mesh.faces[mask]])
    assert_array_equal(part.colors[part.faces], mesh.colors[mesh.faces[mask]])
    assert_array_equal(part.uv[part.uv_faces], mesh.uv[mesh.uv_faces[mask]])
    assert_array_equal(part.vertices, mesh.vertices[vertex_index])
    assert (np.diff(vertex_index) > 0).all()
    assert set(np.unique(part.faces)) == set(range(len(part.vertices)))
    for name, members in part.groups.items():
        kept = [f for f in mesh.groups[name] if mask[f]]
        assert_array_equal(np.flatnonzero(mask)[members], kept)


def test_whole_polygons_stay_polygons(rng):
    mesh = quads(rng)
    assert_array_equal(keep_group(mesh, "b")[0].polygons, [4, 3])
    assert keep_group(mesh, "ab")[0].polygons is None
    assert keep_group(mesh, "c")[0].polygons is None


def test_a_clip_keeps_its_motion(rng):
    mesh = quads(rng)
    clip = MeshClip(rng.random((4, 10, 3)), mesh, fps=50)
    part = keep_clip_group(clip, "b")
    assert_array_equal(part.vertices[:, part.faces], clip.vertices[:, mesh.faces[2:]])
    assert part.fps == 50


def test_unknown_groups_name_the_closest(rng):
    mesh = quads(rng)
    with pytest.raises(ValueError, match="no group named 'bc' among 4; the closest: "):
        keep_group(mesh, "bc")
    with pytest.raises(ValueError, match="has no groups"):
        keep_group(Mesh(mesh.vertices, mesh.faces), "a")


@given(st.lists(st.tuples(*[st.sampled_from([0.0, -0.0, 1.0, 1.0 + 2**-52])] * 3), max_size=30))
def test_weld_joins_equal_positions_and_no_others(points):
    V = np.array(points, float).reshape(-1, 3)
    unique, inverse = weld(V)
    assert_array_equal(V[unique][inverse], V)
    assert len(unique) == len(set(points))
    assert (np.diff(unique) > 0).all()
    for k, first in enumerate(unique):
        assert first == np.flatnonzero(inverse == k)[0]


def test_components_count_pieces_and_loose_vertices():
    F = np.array([[0, 1, 2], [2, 3, 4], [6, 7, 8]])
    count, label = vertex_components(F, 10)
    assert count == 4
    assert label.tolist() == [0, 0, 0, 0, 0, 1, 2, 2, 2, 3]
    assert vertex_components(np.zeros((0, 3), int), 3)[0] == 3
