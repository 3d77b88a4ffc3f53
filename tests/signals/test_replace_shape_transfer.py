"""A clip played by another mesh: what is known exactly comes out exactly."""

from __future__ import annotations

import numpy as np
import pytest
from edit_clips import bending, played, signals_of, tube
from numpy.testing import assert_allclose, assert_array_equal

from tempose.clips import Mesh, MeshClip
from tempose.formats import load_clip
from tempose.rotations import from_rotation_vector, procrustes_rotation, to_matrix
from tempose.shape_spaces import shape_space
from tempose.signals.edits import move_control
from tempose.signals.replace_shape import PoseSet, load_poses, replace_shape
from tempose.signals.replace_shape.regions import regions_of
from tempose.typing import FloatArray

CLIP = bending(14)
BENDS = [(0, 0), (0.8, 0), (-0.8, 0), (0, 0.9), (0, -0.9), (0.6, 0.7), (-0.5, 0.8), (0.7, -0.6)]


def poses(**shape: float) -> list[Mesh]:
    return [tube(bend=b, **shape) for b in BENDS]  # type: ignore[arg-type]


def aligned_error(A: FloatArray, B: FloatArray) -> float:
    """Largest rms distance of two clips, frame by frame, after rigid alignment."""
    worst = 0.0
    for a, b in zip(A, B):
        R = procrustes_rotation(a, b)
        off = (a - a.mean(axis=0)) @ R.T - (b - b.mean(axis=0))
        worst = max(worst, float(np.sqrt(np.square(off).sum(axis=1).mean())))
    return worst


@pytest.mark.parametrize("space", ["vertex", "gradient"])
def test_the_frames_themselves_as_pairs_give_the_clip_back(space: str) -> None:
    signals = signals_of(CLIP, space)
    frames = [CLIP.mesh.with_vertices(V) for V in np.asarray(CLIP.vertices, float)]
    result = replace_shape(signals, frames, frames, regions=0)
    assert result.mixtures.residual < 1e-6
    assert_allclose(played(result.signals), played(signals), atol=1e-5)


@pytest.mark.parametrize("edited", [False, True])
def test_a_target_of_any_topology_shows_the_mixture_of_its_poses(edited: bool) -> None:
    """Each target pose is a linear image of the source pose: so is each frame, whatever the vertices."""
    rng = np.random.default_rng(0)
    n = len(CLIP.rest)
    A = rng.dirichlet(np.ones(4), 70)
    pick = rng.integers(0, n, (70, 4))
    image = lambda V: np.einsum("pk,pkc->pc", A, V[pick])  # noqa: E731
    signals = signals_of(CLIP, placement=True)
    if edited:
        signals = move_control(signals, 6, [0.1, 0.05])
    source = [CLIP.mesh.with_vertices(V) for V in played(signals_of(CLIP))]
    F = rng.integers(0, 70, (40, 3)).astype(np.int32)
    F = F[(F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 0] != F[:, 2])]
    body = played(signals)
    target = [Mesh(image(m.vertices), F) for m in source]
    result = replace_shape(signals, source, target, regions=0).signals
    same = np.ones(14, bool)
    if edited:
        same = (played(signals) == played(signals_of(CLIP, placement=True))).all(axis=(1, 2))
        assert 3 < same.sum() < 14
    # the image of a rigid motion is that motion, as weights sum to 1: only the mean orientations differ
    wanted = np.array([image(V) for V in body])
    assert aligned_error(played(result)[same], wanted[same]) < 0.03


def test_the_time_signal_stays_and_edits_play_on() -> None:
    signals = move_control(signals_of(CLIP), 6, [0.1, 0.05])
    result = replace_shape(signals, poses(), poses(thick=0.35, sides=9), regions=0).signals
    assert result.time is signals.time and result.retimings == signals.retimings
    unedited = replace_shape(signals_of(CLIP), poses(), poses(thick=0.35, sides=9), regions=0).signals
    same = (played(result) == played(unedited)).all(axis=(1, 2))
    before = (played(signals) == played(signals_of(CLIP))).all(axis=(1, 2))
    assert_array_equal(same, before)


@pytest.mark.parametrize("space", ["vertex", "gradient"])
def test_pairs_of_tubes_carry_the_motion_of_tubes(space: str) -> None:
    thick = bending(14, thick=0.3, sides=8)
    result = replace_shape(signals_of(CLIP), poses(), poses(thick=0.3, sides=8), space=space, regions=0)
    still = aligned_error(np.repeat(thick.vertices[:1], 14, axis=0), thick.vertices)
    assert aligned_error(played(result.signals), thick.vertices) < 0.2 * still


def test_regions_do_better_where_no_whole_pose_shows_the_motion() -> None:
    """Pairs that bend one half at a time or both alike; the clip bends both at speeds of their own."""
    bends = [(0, 0), (0.9, 0.9), (-0.9, -0.9), (0.9, 0.4), (-0.4, -0.9), (0.4, 0.9)]
    source = [tube(rings=15, bend=b) for b in bends]
    target = [tube(rings=15, bend=b, thick=0.3, sides=8) for b in bends]
    clip, true = bending(14, rings=15), bending(14, rings=15, thick=0.3, sides=8)
    errors = []
    for regions in (0, 12):
        result = replace_shape(signals_of(clip), source, target, space="gradient", regions=regions)
        errors.append(aligned_error(played(result.signals), true.vertices))
    assert errors[1] < errors[0] * 1.02
    assert result.local is not None and result.local.error <= result.local.plain * 1.001


@pytest.mark.parametrize("placement", [False, True])
def test_where_the_clip_goes_the_target_goes(placement: bool) -> None:
    clip = bending(14, drift=1.2)
    target = poses(thick=0.3)
    result = replace_shape(signals_of(clip, placement=placement), poses(), target, regions=0)
    still = replace_shape(signals_of(bending(14)), poses(), target, regions=0)
    way = played(result.signals).mean(axis=1) - played(still.signals).mean(axis=1)
    wanted = played(signals_of(clip)).mean(axis=1) - played(signals_of(bending(14))).mean(axis=1)
    assert_allclose(way, wanted, atol=0.02)


def test_scale_multiplies_the_way_only() -> None:
    signals = signals_of(bending(14, drift=1.2))
    big = [m.with_vertices(3 * m.vertices) for m in poses()]
    plain = replace_shape(signals, poses(), big, regions=0)
    wide = replace_shape(signals, poses(), big, regions=0, scale="size")
    assert any("3 times as large" in w for w in plain.warnings)
    a, b = played(plain.signals), played(wide.signals)
    assert_allclose(b - b.mean(axis=1, keepdims=True), a - a.mean(axis=1, keepdims=True), atol=1e-9)
    ways = [np.ptp(V.mean(axis=1)[:, 0]) for V in (a, b)]
    assert_allclose(ways[1] / ways[0], 3.0, rtol=1e-6)


def test_how_the_poses_stand_does_not_matter() -> None:
    rng = np.random.default_rng(1)
    signals = signals_of(CLIP)
    source = poses()
    turned = [source[0]]
    for mesh in source[1:]:
        R = to_matrix(from_rotation_vector(rng.normal(size=3)))
        turned.append(mesh.with_vertices(mesh.vertices @ R.T + rng.normal(size=3)))
    a = replace_shape(signals, source, poses(thick=0.3), regions=8)
    b = replace_shape(signals, turned, poses(thick=0.3), regions=8)
    assert_allclose(played(a.signals), played(b.signals), atol=1e-4)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_the_unit_does_not_matter(unit: float) -> None:
    def scaled(meshes: list[Mesh]) -> list[Mesh]:
        return [m.with_vertices(unit * m.vertices) for m in meshes]

    big = MeshClip(unit * np.asarray(CLIP.vertices), CLIP.mesh.with_vertices(unit * CLIP.rest), CLIP.fps)
    a = replace_shape(signals_of(CLIP, "gradient"), poses(), poses(thick=0.3), regions=8)
    b = replace_shape(signals_of(big, "gradient"), scaled(poses()), scaled(poses(thick=0.3)), regions=8)
    assert_allclose(played(b.signals), unit * played(a.signals), atol=1e-4 * unit)


def test_regions_share_out_every_product() -> None:
    meshes = poses()
    V = np.array([m.vertices for m in meshes])
    for name in ("vertex", "gradient"):
        space = shape_space(name, V[0], meshes[0].faces, V)
        regions = regions_of(space, V[0], meshes[0].faces, 7)
        assert regions is not None and regions.count == 7
        Z = space.encode(V)
        assert_allclose(regions.products(Z, Z[:3]).sum(axis=0), Z @ Z[:3].T, atol=1e-9)


def test_what_does_not_fit_is_refused() -> None:
    signals = signals_of(CLIP)
    for source, target, options, message in (
        (poses(), poses()[:5], {}, "same poses in pairs, got 8 and 5"),
        (poses()[:1], poses()[:1], {}, "two poses or more"),
        ([], [], {}, "got none"),
        (poses(sides=9), poses(), {}, "poses of the clip's mesh, 56 vertices"),
        (poses(), poses(), {"use": 1}, "use must be from 2 to 8"),
        (poses(), poses(), {"use": 9}, "use must be from 2 to 8"),
        (poses(), poses(), {"scale": -1.0}, "scale must be a positive number"),
        (poses(), poses(), {"scale": "large"}, "scale must be a positive number"),
        (poses(), poses(), {"regions": 1}, "regions must be 0 or 2 or more"),
        (poses()[:3], poses()[:3], {"regions": 8}, "regions need 4 pairs"),
        (poses(), poses(), {"space": "no"}, "space must be one of"),
        (poses(), [*poses()[:7], tube(sides=8)], {}, r"target\[7\] has other faces"),
        (poses(), [*poses()[:7], poses()[0]], {"regions": 0}, "mixture"),
    ):
        with pytest.raises(ValueError, match=message):
            replace_shape(signals, source, target, **options)  # type: ignore[arg-type]


def test_poses_that_nearly_coincide_are_warned_of() -> None:
    source, target = poses()[:4], poses(thick=0.3)[:4]
    near = tube(bend=(0.8001, 0.0)), tube(bend=(0.8001, 0.0), thick=0.3)
    result = replace_shape(signals_of(CLIP), [*source, near[0]], [*target, near[1]], regions=0)
    assert any("nearly mixtures of one another" in w for w in result.warnings)


@pytest.mark.real
@pytest.mark.slow
def test_gallop_of_the_elephant_is_nearer_to_the_truth_than_the_prototype(data_folder) -> None:
    gallop = load_clip(data_folder("horse-gallop"), fps=24)
    signals = signals_of(MeshClip(gallop.vertices[:24], gallop.mesh, 24))
    root = data_folder("horse-poses").parent
    source, target = (load_poses([name], root, name) for name in ("horse-poses", "elephant-poses"))
    truth = load_poses(["elephant-gallop-2frames"], root, "truth").vertices
    for space, regions, limit in (("vertex", 0, 3.05), ("gradient", 0, 2.95), ("gradient", None, 1.65)):
        result = replace_shape(signals, source, target, space=space, regions=regions)
        error = aligned_error(played(result.signals)[:2], truth)
        assert 100 * error / target.mesh.diagonal < limit


def test_a_set_of_poses_is_frozen() -> None:
    poses_ = PoseSet(np.asarray(CLIP.vertices), CLIP.mesh)
    assert len(poses_) == 14
    with pytest.raises(ValueError, match="read-only"):
        poses_.vertices[0] = 0
