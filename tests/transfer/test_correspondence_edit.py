"""A growing list of pairs, and the target posed by it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from transfer_bodies import about, clip_of, human_body
from transfer_zoo import sphere

from tempose.clips import MeshClip
from tempose.samples.skeletons import human_skeleton
from tempose.transfer import (
    Pairs,
    add_pairs,
    joint_pairs,
    pairs_from_skin,
    preview_pairs,
    select_pairs,
    skeleton_mesh,
    transfer_motion,
)


def test_pairs_are_added_and_replaced() -> None:
    pairs = add_pairs(None, "hips", [3, 5])
    pairs = add_pairs(pairs, ["head"], [9], part="top", how="suggested")
    pairs = add_pairs(pairs, "spine", [5, 7, 7], how="ring")
    assert pairs.source == ("hips", "head", "spine", "spine")
    assert_array_equal(pairs.target, [3, 9, 5, 7])
    assert pairs.how == ("picked", "suggested", "ring", "ring")
    assert pairs.parts == ("hips", "top", "spine", "spine")
    few = select_pairs(pairs, [2, 0])
    assert few.source == ("spine", "hips") and few.how == ("ring", "picked")


def test_numbers_stay_numbers() -> None:
    pairs = add_pairs(add_pairs(None, [4, 6], [1, 2]), [8], [2], how="mirror")
    assert pairs.kind == "faces" and pairs.parts == ()
    assert_array_equal(pairs.source, [4, 8])
    assert add_pairs(None, [1], [1], kind="vertices").kind == "vertices"
    with pytest.raises(ValueError, match="kind 'faces'"):
        add_pairs(pairs, "hips", [3])


def test_template_faces_become_joints() -> None:
    clip = clip_of(human_skeleton(), {}, 1)
    template = skeleton_mesh(clip).mesh
    names = list(template.groups)
    faces = [int(template.groups[name][0]) for name in names[:4]]
    pairs = joint_pairs(Pairs("faces", faces, [0, 1, 2, 3], how=("picked",) * 4), template)
    assert pairs.kind == "joints" and list(pairs.source) == names[:4] and pairs.how == ("picked",) * 4
    with pytest.raises(ValueError, match="belongs to no bone"):
        joint_pairs(Pairs("faces", faces, [0, 1, 2, 3]), sphere(1))
    with pytest.raises(ValueError, match="kind 'faces'"):
        joint_pairs(pairs, template)


def test_a_preview_is_the_transfer_of_those_frames() -> None:
    body = human_body()
    angles = np.linspace(0, 80, 12)
    turns = {"left_forearm": np.array([about("y", -a) for a in angles])}
    clip = clip_of(human_skeleton(), turns, 12)
    pairs = pairs_from_skin(clip.skeleton, body)
    whole = np.asarray(transfer_motion(clip, body, pairs, contacts=False, measure=False).clip.vertices)
    shown = preview_pairs(clip, body.mesh, pairs, [11, 5])
    for V, t in zip(shown.vertices, (11, 5)):
        expected = whole[t - 12]
        assert_allclose(V - V.mean(axis=0), expected - expected.mean(axis=0), atol=1e-6)
    assert shown.frames == (11, 5) and shown.report["flipped_percent"] == 0
    assert shown.report["bone_direction_deg"]["mean"] < 10
    assert shown.seconds.keys() == {"set-up", "frames", "measures"}


def test_a_mesh_previews_another() -> None:
    ball = sphere(2)
    bent = ball.vertices + 0.2 * ball.vertices[:, [1]] ** 2 * [1, 0, 0]
    clip = MeshClip(np.stack([ball.vertices, bent]), ball, 30.0)
    faces = np.arange(0, len(ball.faces), 4)
    pairs = Pairs("faces", faces, faces)
    shown = preview_pairs(clip, ball, pairs, [0, 1], rest=ball.vertices)
    # frame 0 is the rest: nothing moves
    assert_allclose(shown.vertices[0], ball.vertices, atol=1e-6)
    assert np.linalg.norm(shown.vertices[1] - bent, axis=1).max() < 0.1 * ball.diagonal
    assert "bone_direction_deg" not in shown.report


def test_frames_that_do_not_exist_are_refused() -> None:
    clip = clip_of(human_skeleton(), {}, 3)
    pairs = pairs_from_skin(clip.skeleton, human_body())
    with pytest.raises(ValueError, match="frames must be from 0 to 2"):
        preview_pairs(clip, human_body().mesh, pairs, 3)
    with pytest.raises(ValueError, match="frames must be from 0 to 2"):
        preview_pairs(clip, human_body().mesh, pairs, [])
