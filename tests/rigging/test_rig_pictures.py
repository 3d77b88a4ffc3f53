"""Pictures of rigs show what is there: bones of true length, the body from before, weights as mixtures."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import rest_motion
from tempose.render.drawing import Stroke, Words
from tempose.rigging import Rig
from tempose.rigging.pictures import bone_lines, draw_frame_errors, plot_rig, weight_colors
from tempose.rigging.pictures.plot import frame_errors
from tempose.rigging.pictures.views import body_views, facing_azimuth
from tempose.rigging.pictures.weights import joint_colors
from tempose.rotations import from_rotation_vector
from tempose.samples import human_skeleton


def posed(turn: float = 0.0, n_frames: int = 4, seed: int = 0) -> SkeletonClip:
    """A human skeleton in some poses, the whole body turned about the vertical."""
    skeleton = human_skeleton()
    rng = np.random.default_rng(seed)
    q = from_rotation_vector(0.15 * rng.normal(size=(n_frames, skeleton.n_joints, 3)))
    q[:, 0] = from_rotation_vector(np.array([0.0, turn, 0.0]))
    return SkeletonClip(skeleton, q, np.tile([0.3, 0.9, -0.2], (n_frames, 1)))


def test_bones_keep_their_lengths_and_start_at_joints() -> None:
    motion = posed()
    lines = bone_lines(motion)
    J, skeleton = motion.skeleton.n_joints, motion.skeleton
    lengths = np.linalg.norm(lines[:, :, 1] - lines[:, :, 0], axis=-1)
    assert_allclose(
        lengths[:, : J - 1], np.tile(np.linalg.norm(skeleton.offsets[1:], axis=1), (4, 1)), atol=1e-9
    )
    known = np.isfinite(skeleton.tips).all(axis=1)
    assert lines.shape == (4, J - 1 + known.sum(), 2, 3)
    assert_allclose(
        lengths[:, J - 1 :], np.tile(np.linalg.norm(skeleton.tips[known], axis=1), (4, 1)), atol=1e-9
    )
    first = np.flatnonzero(skeleton.parents[1:] == 0)
    assert_allclose(
        lines[:, first, 0], np.repeat(motion.root_position[:, None], len(first), axis=1), atol=1e-9
    )


@pytest.mark.parametrize("turn", [0.0, 0.7, -2.5, 3.1])
def test_the_front_turns_with_the_body(turn: float) -> None:
    still = facing_azimuth(posed(0.0))
    apart = facing_azimuth(posed(turn)) - still - turn
    assert abs((apart + np.pi) % (2 * np.pi) - np.pi) < 1e-9
    assert abs(still) < 0.1
    (front, _), (side, _) = body_views(posed(turn), ("front", "side"))
    assert front == pytest.approx(facing_azimuth(posed(turn)))
    assert side - front == pytest.approx(np.pi / 2)


def test_what_has_no_sides_faces_forward() -> None:
    skeleton = Skeleton(("a", "b"), np.array([-1, 0]), np.eye(2, 3))
    turns = np.tile([1.0, 0, 0, 0], (1, 2, 1))
    assert facing_azimuth(SkeletonClip(skeleton, turns, np.zeros((1, 3)))) == 0.0


def test_weights_mix_the_colours_of_their_joints() -> None:
    skeleton = human_skeleton()
    J = skeleton.n_joints
    colors = joint_colors(skeleton)
    assert_allclose(weight_colors(np.eye(J), skeleton), colors, atol=1e-9)
    grey = weight_colors(np.zeros((1, J)), skeleton)
    assert np.ptp(grey) < 1e-12
    half = weight_colors(0.5 * (np.eye(J)[:1] + np.eye(J)[1:2]), skeleton)[0]
    assert (half >= np.minimum(colors[0], colors[1]) - 1e-9).all()
    assert (half <= np.maximum(colors[0], colors[1]) + 1e-9).all()
    beside = np.linalg.norm(colors[1:] - colors[skeleton.parents[1:]], axis=1)
    assert beside.min() > 0.12


def tube() -> Rig:
    angle, count = 2 * np.pi * np.arange(8) / 8, 6
    ring = np.column_stack([0.1 * np.cos(angle), np.zeros(8), 0.1 * np.sin(angle)])
    V = np.concatenate([ring + np.array([0, y, 0]) for y in np.linspace(-0.5, 0.5, count)])
    a = np.array([8 * r + i for r in range(count - 1) for i in range(8)])
    b = a - a % 8 + (a + 1) % 8
    F = np.concatenate([np.column_stack([a, a + 8, b]), np.column_stack([b, a + 8, b + 8])])
    W = np.clip(V[:, 1] + 0.5, 0, 1)[:, None]
    skeleton = Skeleton(("low", "high"), np.array([-1, 0]), np.array([[0.0, -0.5, 0], [0, 0.5, 0]]))
    skin = SkinnedMesh(Mesh(V, F), skeleton, np.column_stack([1 - W, W]))
    q = np.tile([1.0, 0, 0, 0], (5, 2, 1))
    q[:, 1] = from_rotation_vector(np.linspace(0, 0.8, 5)[:, None] * np.array([0, 0, 1.0]))
    return Rig(skin, SkeletonClip(skeleton, q, np.tile([0.0, -0.5, 0], (5, 1))))


def test_errors_of_frames_are_in_percent_of_the_diagonal() -> None:
    rig = tube()
    V = rig.vertices()
    clip = MeshClip((V + np.array([0.03, 0, 0.04])).astype(np.float32), rig.skin.mesh, 30.0)
    assert_allclose(frame_errors(clip, V), 5.0 / rig.skin.mesh.diagonal, rtol=1e-4)


def test_rest_is_the_bind_pose() -> None:
    rig = tube()
    assert_allclose(rig.vertices(rest_motion(rig.skin.skeleton))[0], rig.skin.mesh.vertices, atol=1e-12)


def test_curves_keep_their_order_and_break_where_values_are_missing() -> None:
    gap = np.array([1.0, 2, np.nan, 3, 4])
    drawing = draw_frame_errors({"skin": gap, "ours": np.zeros(5)}, "error", parts=[2])
    words = [s.text for s in drawing.shapes if isinstance(s, Words)]
    assert {"error", "skin", "ours", "frame"} <= set(words)
    lines = [s for s in drawing.shapes if isinstance(s, Stroke) and len(s.points) == 2 and s.width == 1.8]
    ends = sorted(tuple(np.round(s.points[:, 0] - s.points[0, 0]).tolist()) for s in lines)
    assert len(ends) >= 2, "two parts of the broken curve"
    assert any(len(s.points) == 5 for s in drawing.shapes if isinstance(s, Stroke))


@pytest.mark.slow
def test_all_pictures_of_a_rig(tmp_path: Path) -> None:
    rig = tube()
    clip = MeshClip(rig.vertices().astype(np.float32), rig.skin.mesh, 30.0)
    written = plot_rig(rig, tmp_path / "new", clip)
    assert all(path.is_file() for path in written) and len(written) == 5
    assert len(plot_rig(rig, tmp_path / "still")) == 2
    short = replace(clip, vertices=clip.vertices[:3])
    with pytest.raises(ValueError, match="5 frames"):
        plot_rig(rig, tmp_path / "new", short)
