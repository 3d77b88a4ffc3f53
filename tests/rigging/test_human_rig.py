"""A human rig from a mesh or a clip: joints inside, doubts said with their measure."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from rig_bodies import human_skin, random_rig, tube

from tempose.clips import Mesh, MeshClip
from tempose.clips.mesh_parts import keep_faces
from tempose.embedding import Embedding, embed_skeleton
from tempose.kinematics import rest_motion, rest_transforms
from tempose.rigging import Rig, fit_rig
from tempose.rigging.skeletons import frames
from tempose.rigging.skeletons import human_skin as bind_human
from tempose.rigging.skeletons.frames import surest_human
from tempose.rigging.skeletons.human import check_human
from tempose.rigging.skeletons.inside import joints_outside, mesh_cells
from tempose.rigging.skeletons.surface import enclosed_volume, surface_warnings
from tempose.samples import animal_character
from tempose.typing import silent


@lru_cache
def human_rig() -> Rig:
    return fit_rig(human_skin().mesh)


@lru_cache
def moving() -> tuple[Rig, MeshClip]:
    """The true rig, arms and legs turning, and the clip it makes."""
    rig = random_rig(human_skin(), 8, 0.25)
    return rig, MeshClip(rig.vertices(), rig.skin.mesh, 24.0)


def test_a_still_mesh_gets_18_joints_inside_and_one_frame_at_rest() -> None:
    rig = human_rig()
    assert rig.skin.skeleton.n_joints == 18 == rig.report["joints"]
    assert joints_outside(rig.skin.skeleton, mesh_cells(rig.skin.mesh).solid) == []
    assert rig.motion.n_frames == 1
    assert_allclose(rig.vertices()[0], rig.skin.mesh.vertices, atol=1e-12)
    assert rig.report["embedding"]["inside_percent"] == 100 and rig.report["frame"] == 0
    true = dict(zip(human_skin().skeleton.names, rest_transforms(human_skin().skeleton)[1]))
    found = zip(rig.skin.skeleton.names, rest_transforms(rig.skin.skeleton)[1])
    away = [np.linalg.norm(p - true[name]) / 1.75 for name, p in found]
    assert np.median(away) < 0.02 and max(away) < 0.08


def test_a_skirt_that_joins_the_legs_is_seen_and_said() -> None:
    # at this resolution the skirt is thicker than the gap between it and the legs
    assert human_rig().report["embedding"]["penalty"] < 1
    assert "placed by the stature" in human_rig().report["warnings"][0]


def test_weights_are_sparse_and_sum_to_one() -> None:
    weights = human_rig().skin.weights
    assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    assert (weights > 0).sum(axis=1).mean() < 10


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_unit_does_not_matter(unit: float) -> None:
    mesh = human_skin().mesh
    scaled = fit_rig(mesh.with_vertices(unit * mesh.vertices))
    expected = unit * human_rig().skin.skeleton.offsets
    # the inside is found in single precision
    assert_allclose(scaled.skin.skeleton.offsets, expected, atol=1e-5 * unit)
    assert scaled.report["warnings"] == human_rig().report["warnings"]


def test_a_clip_gets_its_motion_its_rate_and_better_joints() -> None:
    _, clip = moving()
    rig = fit_rig(clip, frame=0)
    assert rig.motion.n_frames == 8 and rig.motion.fps == 24.0 and rig.report["frame"] == 0
    rms = rig.report["refined"]["rms_percent"]
    assert (np.diff(rms) < 0).all()
    assert rig.report["errors"]["rms_percent"] == pytest.approx(rms[-1], rel=2e-2)
    assert rig.report["errors"]["rms_percent"] < 2.0
    plain = fit_rig(clip, frame=0, refine=False)
    assert "refined" not in plain.report
    assert plain.report["errors"]["rms_percent"] == pytest.approx(rms[0], rel=2e-2)


def test_the_bind_pose_is_the_frame_that_was_asked_for() -> None:
    _, clip = moving()
    bound = surest_human(clip, 5, silent)
    assert_array_equal(bound.skin.mesh.vertices, clip.vertices[5].astype(np.float64))


def test_a_sure_frame_is_taken_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    _, clip = moving()
    seen = watch_embedding(monkeypatch, dict.fromkeys(range(8), (0.3, 1.0)))
    bound = surest_human(clip, None, silent)
    assert seen == [0] and bound.facts["frame"] == 0 and "candidates" not in bound.facts


def test_the_frame_that_fits_the_clip_best_wins(monkeypatch: pytest.MonkeyPatch) -> None:
    _, clip = moving()
    # tried from the ends inwards; frame 3 is unlike on both sides, 6 would be surest but fits worse
    seen = watch_embedding(
        monkeypatch,
        {0: (0.9, 1.0), 7: (0.95, 1.0), 1: (0.99, 1.0), 6: (0.8, 1.0), 3: (0.75, 1.8), 4: (0.96, 1.0)},
    )
    rms = {0: 0.01, 6: 0.02, 7: 0.03}
    monkeypatch.setattr(frames, "_sample_rms", lambda bound, sample: rms[bound.facts["frame"]])
    monkeypatch.setattr(frames, "_bound", lambda c, clip: frames.Bound(human_skin(), {"frame": c.frame}))
    bound = surest_human(clip, None, silent)
    assert sorted(seen) == sorted({0, 7, 1, 6, 3, 4})
    assert bound.facts["frame"] == 0
    assert [c["frame"] for c in bound.facts["candidates"]] == [6, 0, 7, 4, 1, 3]
    assert [c.get("rms_percent") for c in bound.facts["candidates"]] == [0.02, 0.01, 0.03, None, None, None]


def watch_embedding(monkeypatch: pytest.MonkeyPatch, say: dict[int, tuple[float, float]]) -> list[int]:
    """Replace the search for a skeleton by stated penalties and side ratios."""
    _, clip = moving()
    real = embed_skeleton(human_skin().mesh)
    seen: list[int] = []

    def embed(mesh: Mesh) -> tuple[Embedding, None]:
        t = next(t for t in range(8) if np.allclose(mesh.vertices, clip.vertices[t]))
        seen.append(t)
        penalty, ratio = say[t]
        return replace(real, penalty=penalty, report={**real.report, "side_ratios": {"arms": ratio}}), None

    monkeypatch.setattr(frames, "embed_whole_or_piece", embed)
    return seen


@pytest.mark.slow
def test_an_animal_is_refused_with_the_measure_and_the_way_out() -> None:
    pony = animal_character(2000).skin.mesh
    embedding = embed_skeleton(pony)
    message = r"doubtful, with penalty \d\.\d\d where people have less than 1.*"
    with pytest.raises(ValueError, match=message + "--skeleton FILE"):
        check_human(embedding, moving=False)
    with pytest.raises(ValueError, match=message + "--skeleton auto"):
        fit_rig(MeshClip(np.stack([pony.vertices] * 2), pony), frame=0)


def test_between_sure_and_refused_stands_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    real = embed_skeleton(human_skin().mesh)
    unsure = replace(real, penalty=1.2, reasons=("arms are odd",))
    monkeypatch.setattr(
        "tempose.rigging.skeletons.human.embed_whole_or_piece", lambda mesh, progress: (unsure, None)
    )
    said = bind_human(human_skin().mesh, moving=True).warnings[0]
    assert "doubtful (penalty 1.20, sure below 1): arms are odd" in said and "--skeleton auto" in said
    check_human(unsure, moving=True)
    with pytest.raises(ValueError, match=r"penalty 1\.51"):
        check_human(replace(real, penalty=1.51, reasons=("arms are odd",)), moving=True)


def test_open_inside_out_and_broken_surfaces_are_said() -> None:
    mesh = tube()
    assert surface_warnings(mesh) == ()
    assert enclosed_volume(mesh) > 0
    opened = keep_faces(mesh, np.arange(len(mesh.faces)) != 40)[0]
    assert "open: 3 edges" in surface_warnings(opened)[0]
    assert "inside out" in surface_warnings(Mesh(mesh.vertices, mesh.faces[:, ::-1]))[0]
    n = len(mesh.vertices)
    two = Mesh(
        np.concatenate([mesh.vertices, mesh.vertices + 5]), np.concatenate([mesh.faces, mesh.faces + n])
    )
    assert "in 2 pieces" in surface_warnings(two)[0]
    # seams of UVs are no holes
    corners = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(3 * len(mesh.faces)).reshape(-1, 3))
    assert surface_warnings(corners) == ()


def test_a_human_inside_out_is_rigged_all_the_same() -> None:
    mesh = human_skin().mesh
    flipped = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    rig = fit_rig(flipped)
    assert_allclose(rig.skin.skeleton.offsets, human_rig().skin.skeleton.offsets, atol=1e-9)
    assert any("inside out" in w for w in rig.report["warnings"])


def test_frames_that_are_all_the_same_are_said() -> None:
    mesh = human_skin().mesh
    rig = fit_rig(MeshClip(np.stack([mesh.vertices] * 3), mesh), frame=0)
    assert any("all 3 frames are the same" in w for w in rig.report["warnings"])
    assert_allclose(rig.vertices(), np.stack([mesh.vertices] * 3), atol=1e-4)
    assert not any("the same" in w for w in fit_rig(moving()[1], frame=0).report["warnings"])


def test_a_mesh_that_encloses_nothing_is_refused() -> None:
    flat = Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="encloses no volume"):
        fit_rig(flat)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"skeleton": "auto"}, "needs a clip of at least 2 frames"),
        ({"skeleton": "auto", "frame": 2}, "frame is for other skeletons than 'auto'"),
        ({"bones": 5}, "bones is for skeleton 'auto'"),
        ({"blending": "cubic"}, "got 'cubic'"),
        ({"frame": 3}, "frame must be from 0 to 0, got 3"),
        ({"skeleton": "humann"}, "humann"),
    ],
)
def test_wrong_arguments_are_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fit_rig(human_skin().mesh, **arguments)


def test_something_else_than_a_clip_is_refused() -> None:
    with pytest.raises(ValueError, match="clip must be a MeshClip or a Mesh, got SkeletonClip"):
        fit_rig(rest_motion(human_skin().skeleton))  # type: ignore[arg-type]
