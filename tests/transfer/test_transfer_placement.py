"""Placement: a walker whose feet are planted by construction stands still again after it."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from tempose.transfer.feet.placement import fit_scale as fit_scale_of
from tempose.transfer.feet.placement import place_clip, root_steps
from tempose.transfer.feet.soles import find_sole

T, FPS, HEIGHT, SCALE = 120, 30.0, 1.7, 0.63
STRIDE = 30


def walker(scale: float = SCALE, bob: float = 0.0) -> tuple[np.ndarray, list[np.ndarray], np.ndarray]:
    """Source path of the hips, target soles with the hips held, and when each foot stands.

    In the world each foot stands on the ground for two thirds of its stride and then steps ahead; the
    target travels `scale` times as far as the source.
    """
    t = np.arange(T)
    path = np.stack([0.3 * np.sin(t / 25), bob * np.sin(t / 5), 0.045 * t], axis=1)
    world = path * [scale, 1.0, scale]
    soles, contact = [], np.zeros((T, 2), dtype=bool)
    patch = np.array([[-0.05, 0, -0.1], [0.05, 0, -0.1], [0, 0.0, 0.12], [0, 0.09, 0]])
    for f, shift in enumerate((0, STRIDE // 2)):
        phase = (t + shift) % STRIDE
        step = (t + shift) // STRIDE
        swing = np.clip((phase - 20) / 10, 0, 1)
        ahead = 0.045 * STRIDE * scale * (step + swing * swing * (3 - 2 * swing))
        foot = np.stack([np.full(T, 0.1 - 0.2 * f), 0.08 * np.sin(np.pi * swing), ahead], axis=1)
        contact[:, f] = (phase >= 1) & (phase < 19)
        soles.append(foot[:, None] + patch - world[:, None])
    return path, soles, contact


def fit_scale(
    path: np.ndarray, soles: list[np.ndarray], contact: np.ndarray, height: float, fps: float
) -> float | None:
    found = [find_sole(foot, contact[:, f], height, fps) for f, foot in enumerate(soles)]
    return fit_scale_of(path, found, height, fps)


def on_the_ground(soles: list[np.ndarray], shift: np.ndarray) -> list[np.ndarray]:
    return [foot + shift[:, None] for foot in soles]


def turn_about_y(degrees: float) -> np.ndarray:
    return Rotation.from_euler("y", degrees, degrees=True).as_matrix()


@pytest.mark.parametrize("scale", [0.2, SCALE, 1.0, 40.0])
def test_the_scale_of_the_path_is_found(scale: float) -> None:
    path, soles, contact = walker(scale)
    assert fit_scale(path, soles, contact, HEIGHT * scale, FPS) == pytest.approx(scale, rel=1e-9)


def test_feet_that_stand_still_at_the_right_scale_need_no_correction() -> None:
    path, soles, contact = walker()
    placed = place_clip(path, soles, contact, 0.0, HEIGHT, 0.8, FPS)
    assert placed.fitted
    assert placed.scale == pytest.approx(SCALE, rel=1e-9) and placed.scale_vertical == 0.8
    assert placed.correction == pytest.approx(0, abs=1e-9)
    expected = SCALE * (path - path[0])
    assert_allclose((placed.shift - placed.shift[0])[:, [0, 2]], expected[:, [0, 2]], rtol=0, atol=1e-9)
    for f, foot in enumerate(on_the_ground(soles, placed.shift)):
        moves = np.linalg.norm(np.diff(foot[..., [0, 2]], axis=0), axis=2)
        both = contact[1:, f] & contact[:-1, f]
        assert moves[both].max() < 1e-9
        assert_allclose(foot[contact[:, f], :, 1].min(axis=1), 0, rtol=0, atol=1e-9)


def test_hips_that_bob_keep_the_soles_on_the_ground() -> None:
    path, soles, contact = walker(bob=0.03)
    # the target's legs are as long as the source's: its soles come down by what its hips rise
    placed = place_clip(path, soles, contact, -0.4, HEIGHT, 1.0, FPS)
    for f, foot in enumerate(on_the_ground(soles, placed.shift)):
        assert_allclose(foot[contact[:, f], :, 1].min(axis=1), -0.4, rtol=0, atol=1e-9)


def test_a_steady_slip_is_taken_out_of_the_root() -> None:
    path, soles, contact = walker()
    drift = np.outer(np.arange(T), [0.002, 0, -0.001])
    slipping = [foot + drift[:, None] for foot in soles]
    placed = place_clip(path, slipping, contact, 0.0, HEIGHT, 0.8, FPS)
    for f, foot in enumerate(on_the_ground(slipping, placed.shift)):
        both = contact[1:, f] & contact[:-1, f]
        moves = np.linalg.norm(np.diff(foot[..., [0, 2]], axis=0), axis=2)[both]
        assert moves.max() < 1e-2 * np.linalg.norm(drift[1])
    left = place_clip(path, slipping, contact, 0.0, HEIGHT, 0.8, FPS, hold=False)
    foot = on_the_ground(slipping, left.shift)[0]
    assert np.linalg.norm(np.diff(foot[..., [0, 2]], axis=0), axis=2)[5:15].max() > 1e-3
    assert left.correction == 0


def test_the_share_of_the_root_begins_at_nothing_and_is_smooth() -> None:
    path, soles, contact = walker()
    rng = np.random.default_rng(0)
    slipping = [foot + 0.004 * rng.normal(size=(T, 1, 3)).cumsum(axis=0) for foot in soles]
    shift = SCALE * path
    found = [find_sole(foot, contact[:, f], HEIGHT, FPS) for f, foot in enumerate(slipping)]
    steps = root_steps(found, shift, FPS)
    assert_allclose(steps[0], 0, rtol=0, atol=0)
    assert np.abs(np.diff(steps, 2, axis=0)).max() < 0.5 * np.abs(np.diff(slipping[0][:, 0], 2, axis=0)).max()
    before = sum(float((sole.slip(shift) ** 2).sum()) for sole in found)
    moved = shift + np.column_stack([steps[:, 0], 0 * steps[:, 0], steps[:, 1]])
    assert sum(float((sole.slip(moved) ** 2).sum()) for sole in found) < 0.7 * before
    still = [find_sole(foot, np.zeros(T, dtype=bool), HEIGHT, FPS) for foot in slipping]
    assert not root_steps(still, shift, FPS).any()


def test_a_wavering_slip_is_mostly_taken_out() -> None:
    path, soles, contact = walker()
    sway = 0.02 * np.sin(np.arange(T) / 6)[:, None] * [1.0, 0, 0.5]
    slipping = [foot + sway[:, None] for foot in soles]

    def slip(shift: np.ndarray) -> float:
        speeds = []
        for f, foot in enumerate(on_the_ground(slipping, shift)):
            both = contact[1:, f] & contact[:-1, f]
            speeds.append(np.linalg.norm(np.diff(foot[:, 0, [0, 2]], axis=0), axis=1)[both])
        return float(np.concatenate(speeds).mean())

    held = place_clip(path, slipping, contact, 0.0, HEIGHT, 0.8, FPS)
    free = place_clip(path, slipping, contact, 0.0, HEIGHT, 0.8, FPS, hold=False)
    assert slip(held.shift) < 0.1 * slip(free.shift)
    assert 0 < held.correction < 3 * np.linalg.norm(np.diff(sway, axis=0), axis=1).sum()


def test_one_height_a_clip_where_feet_are_not_held() -> None:
    path, soles, contact = walker(bob=0.03)
    placed = place_clip(path, soles, contact, 0.0, HEIGHT, 0.5, FPS, hold=False)
    assert np.ptp(placed.shift[:, 1] - 0.5 * path[:, 1]) < 1e-12


def test_in_flight_the_height_follows_the_path() -> None:
    """A jump: the lift is interpolated between take-off and landing, so that the arc stays."""
    t = np.arange(60)
    flight = (t >= 20) & (t < 40)
    up = np.where(flight, 0.5 * np.sin(np.pi * (t - 19) / 21), 0.0)
    path = np.stack([0 * t, up, 0 * t], axis=1)
    foot = np.tile([[[0.1, -0.9, 0], [0.1, -0.9, 0.2]]], (60, 1, 1))
    contact = np.stack([~flight, ~flight], axis=1)
    placed = place_clip(path, [foot, foot - [0.2, 0, 0]], contact, 0.0, HEIGHT, 0.7, FPS)
    lowest = (foot + placed.shift[:, None])[..., 1].min(axis=1)
    assert_allclose(lowest, 0.7 * up, rtol=0, atol=1e-9)


def test_standing_still_has_no_scale_to_fit() -> None:
    path = np.zeros((30, 3))
    foot = np.tile([[[0.1, -0.9, 0.0], [0.1, -0.9, 0.2]]], (30, 1, 1))
    placed = place_clip(path, [foot], np.ones((30, 1), dtype=bool), 0.2, HEIGHT, 0.77, FPS)
    assert not placed.fitted and placed.scale == placed.scale_vertical == 0.77
    assert_allclose(placed.shift, np.tile([0, 1.1, 0], (30, 1)), rtol=0, atol=1e-12)
    assert placed.correction == pytest.approx(0, abs=1e-12)


def test_hips_that_only_sway_have_none_either() -> None:
    soles = walker()[1]
    sway = 0.01 * np.sin(np.arange(T) / 8)[:, None] * [1.0, 0, 0]
    foot = soles[0][:1] - 0.7 * sway[:, None]
    assert fit_scale(sway, [foot], np.ones((T, 1), dtype=bool), HEIGHT, FPS) is None
    assert fit_scale(50 * sway, [50 * foot], np.ones((T, 1), dtype=bool), HEIGHT, FPS) == pytest.approx(0.7)


def test_hips_that_run_against_their_feet_give_no_scale() -> None:
    path, soles, contact = walker()
    assert fit_scale(-path, soles, contact, HEIGHT, FPS) is None


@pytest.mark.parametrize("hold", [True, False])
def test_without_any_contact_the_path_is_scaled_by_the_legs(hold: bool) -> None:
    path, soles, contact = walker()
    placed = place_clip(path, soles, np.zeros_like(contact), 0.0, HEIGHT, 0.8, FPS, hold)
    assert not placed.fitted and placed.correction == 0
    assert_allclose(placed.shift[:, [0, 2]], 0.8 * path[:, [0, 2]], rtol=0, atol=1e-12)
    lows = np.min([f[..., 1].min(axis=1) for f in on_the_ground(soles, placed.shift)], axis=0)
    assert np.percentile(lows, 5) == pytest.approx(0, abs=1e-9)


def test_without_feet_only_the_path_is_scaled() -> None:
    path, _, _ = walker(bob=0.1)
    placed = place_clip(path, [], np.zeros((T, 0), dtype=bool), 5.0, HEIGHT, 0.8, FPS)
    assert not placed.fitted
    assert_allclose(placed.shift, 0.8 * path, rtol=0, atol=1e-12)


@pytest.mark.parametrize("frames", [1, 2, 3])
@pytest.mark.parametrize("standing", [True, False])
def test_clips_of_a_few_frames(frames: int, standing: bool) -> None:
    path, soles, contact = walker()
    few = [foot[:frames] for foot in soles]
    placed = place_clip(path[:frames], few, contact[:frames] | standing, 0.1, HEIGHT, 0.8, FPS)
    assert placed.shift.shape == (frames, 3) and np.isfinite(placed.shift).all()
    lows = np.min([f[..., 1].min(axis=1) for f in on_the_ground(few, placed.shift)], axis=0)
    assert_allclose(lows, 0.1, rtol=0, atol=1e-9)


@pytest.mark.parametrize("degrees", [90, 180, 33])
def test_a_turned_walk_is_placed_turned(degrees: float) -> None:
    R = turn_about_y(degrees)
    path, soles, contact = walker(bob=0.02)
    soles = [foot + 0.01 * np.sin(np.arange(T) / 9)[:, None, None] for foot in soles]
    a = place_clip(path, soles, contact, 0.0, HEIGHT, 0.8, FPS)
    b = place_clip(path @ R.T, [foot @ R.T for foot in soles], contact, 0.0, HEIGHT, 0.8, FPS)
    assert_allclose(b.shift, a.shift @ R.T, rtol=0, atol=1e-9)
    assert b.scale == pytest.approx(a.scale, rel=1e-9)
    assert b.correction == pytest.approx(a.correction, rel=1e-9)


@pytest.mark.parametrize("unit", [1e-3, 100.0])
def test_units_mean_nothing(unit: float) -> None:
    path, soles, contact = walker(bob=0.02)
    soles = [foot + 0.01 * np.sin(np.arange(T) / 9)[:, None, None] for foot in soles]
    a = place_clip(path, soles, contact, 0.3, HEIGHT, 0.8, FPS)
    source = place_clip(path * unit, soles, contact, 0.3, HEIGHT, 0.8 / unit, FPS)
    assert_allclose(source.shift, a.shift, rtol=0, atol=1e-9)
    assert source.scale == pytest.approx(a.scale / unit, rel=1e-9)
    scaled = [unit * foot for foot in soles]
    target = place_clip(path, scaled, contact, 0.3 * unit, HEIGHT * unit, 0.8 * unit, FPS)
    assert_allclose(target.shift, unit * a.shift, rtol=0, atol=1e-9 * unit)


def test_the_input_is_left_alone() -> None:
    path, soles, contact = walker(bob=0.02)
    before = path.copy(), [foot.copy() for foot in soles], contact.copy()
    place_clip(path, soles, contact, 0.0, HEIGHT, 0.8, FPS)
    assert (path == before[0]).all() and (contact == before[2]).all()
    assert all((a == b).all() for a, b in zip(soles, before[1]))
