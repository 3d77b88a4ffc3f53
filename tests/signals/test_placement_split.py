"""The placement of each frame is found, and taking it out and putting it back changes nothing."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.rotations import (
    angle_between,
    from_rotation_vector,
    multiply,
    normalise,
    procrustes_rotation,
    to_matrix,
)
from tempose.signals.placement import (
    fit_placements,
    in_body,
    place,
    placed,
    placement_at,
    placement_spline,
    split_placement,
)
from tempose.signals.placement.spline import continuous_signs
from tempose.typing import FloatArray


def body(n: int = 40, seed: int = 0) -> FloatArray:
    V = np.random.default_rng(seed).standard_normal((n, 3)) * [0.3, 1.0, 0.5]
    return V - V.mean(axis=0)


def tumbling(T: int, turns: float = 2.0, seed: int = 1) -> FloatArray:
    """Smooth placements that turn more than once about an axis that moves, so that signs must follow."""
    s = np.linspace(0, 1, T)
    axis = np.stack([0.3 * np.sin(3 * s), np.ones(T), 0.2 * s], axis=1)
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    q = from_rotation_vector(2 * np.pi * turns * s[:, None] * axis)
    path = np.stack([4 * s, 0.1 * np.sin(9 * s), s**2], axis=1)
    return np.concatenate([q, path + np.random.default_rng(seed).standard_normal(3)], axis=1)


def wobbling(T: int, n: int = 40, amount: float = 0.05) -> FloatArray:
    random = np.random.default_rng(2)
    modes = random.standard_normal((3, n, 3))
    phases = np.sin(np.linspace(0, 7, T)[:, None] * [1.0, 1.7, 2.3])
    return body(n) + amount * np.einsum("tk,kni->tni", phases, modes)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_a_known_rigid_motion_is_found(unit: float) -> None:
    truth = tumbling(50)
    truth[:, 4:] *= unit
    V = place(unit * body(), truth)
    found = fit_placements(V, unit * body())
    assert angle_between(found[:, :4], truth[:, :4]).max() < 1e-7
    assert_allclose(found[:, 4:], truth[:, 4:], atol=1e-12 * unit)
    assert_allclose(in_body(V, found), np.broadcast_to(unit * body(), V.shape), atol=1e-12 * unit)


def test_splitting_and_placing_gives_the_clip_back() -> None:
    V = place(wobbling(30), tumbling(30))
    placements, bodies = split_placement(V)
    assert_allclose(place(bodies, placements), V, atol=1e-13)
    assert_allclose(bodies.mean(axis=1), 0, atol=1e-13)
    assert_allclose(np.linalg.norm(placements[:, :4], axis=1), 1, atol=1e-14)


def test_the_first_round_is_kabsch_against_the_reference() -> None:
    V, reference = place(wobbling(20), tumbling(20)), body(seed=5)
    found = fit_placements(V, reference, rounds=1)
    R = procrustes_rotation(np.broadcast_to(reference, V.shape), V)
    assert_allclose(to_matrix(found[:, :4]), R, atol=1e-12)


def test_later_rounds_leave_less_to_the_shape() -> None:
    V, reference = place(wobbling(40, amount=0.3), tumbling(40)), body()
    spread = [float(split_placement(V, reference, rounds)[1].var(axis=0).sum()) for rounds in (1, 2, 6)]
    assert spread[0] > spread[1] >= spread[2]
    assert spread[1] - spread[2] < 0.2 * (spread[0] - spread[2])


def test_a_clip_moved_as_a_whole_has_the_same_bodies() -> None:
    V = place(wobbling(25), tumbling(25))
    move = np.concatenate([normalise(np.array([0.5, 0.1, -0.7, 0.2])), [1.0, -2.0, 3.0]])
    reference = body()
    placements, bodies = split_placement(V, reference)
    moved, same = split_placement(place(V, move), reference)
    assert_allclose(same, bodies, atol=1e-12)
    assert angle_between(moved[:, :4], multiply(move[:4], placements[:, :4])).max() < 1e-7


def test_renumbered_vertices_have_the_same_placements() -> None:
    V, order = place(wobbling(10), tumbling(10)), np.random.default_rng(3).permutation(40)
    assert_allclose(fit_placements(V[:, order]), fit_placements(V), atol=1e-12)


def test_the_mean_shape_stays_turned_like_the_reference() -> None:
    reference = body()
    V = place(wobbling(30, amount=0.2), tumbling(30))
    for rounds in (2, 3, 8):
        bodies = split_placement(V, reference, rounds)[1]
        turn = procrustes_rotation(reference, bodies.mean(axis=0))
        assert_allclose(turn, np.eye(3), atol=2e-3)


def test_signs_follow_through_many_turns() -> None:
    truth = tumbling(200, turns=5)
    flipped = truth * np.where(
        np.random.default_rng(0).random((200, 1)) < 0.5, 1.0, [-1, -1, -1, -1, 1, 1, 1]
    )
    found = continuous_signs(flipped)
    assert (np.sum(found[1:, :4] * found[:-1, :4], axis=1) > 0).all()
    assert_allclose(np.abs(np.sum(found[:, :4] * truth[:, :4], axis=1)), 1, atol=1e-14)
    assert_allclose(found[:, 4:], truth[:, 4:])
    assert found[0].tobytes() == flipped[0].tobytes()


def test_the_spline_goes_through_the_frames_and_is_a_rotation_between_them() -> None:
    truth = tumbling(60)
    spline = placement_spline(truth)
    at_frames = placement_at(spline, np.arange(60.0))
    assert angle_between(at_frames[:, :4], truth[:, :4]).max() < 1e-7
    assert_allclose(at_frames[:, 4:], truth[:, 4:], atol=1e-12)
    between = placement_at(spline, np.linspace(0, 59, 1001))
    assert_allclose(np.linalg.norm(between[:, :4], axis=1), 1, atol=1e-14)
    # halved steps: an error that falls with the third power or faster is that of a cubic through the frames
    errors = []
    for step in (2, 1):
        dense = tumbling(121)
        coarse = placement_at(placement_spline(dense[:: 2 * step]), (np.arange(121.0) / (2 * step))[12:-12])
        errors.append(angle_between(coarse[:, :4], dense[12:-12, :4]).max())
    assert errors[1] < errors[0] / 8


@pytest.mark.parametrize("batch", [(), (1,), (3, 1, 2)])
def test_placing_any_batch_is_rotating_and_moving(batch: tuple[int, ...]) -> None:
    random = np.random.default_rng(4)
    V, placements = random.standard_normal((*batch, 5, 3)), random.standard_normal((*batch, 7))
    found = place(V, placements)
    for i in np.ndindex(batch):
        R = to_matrix(normalise(placements[i][:4]))
        assert_allclose(found[i], (R @ V[i].T).T + placements[i][4:], atol=1e-13)
    assert_allclose(in_body(found, placements), V, atol=1e-12)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_placing_into_an_array_or_in_place_is_the_same(dtype: type) -> None:
    random = np.random.default_rng(4)
    V, placements = random.standard_normal((6, 5, 3)).astype(dtype), random.standard_normal((6, 7))
    placements[2, :4] = 0
    for move in (place, in_body):
        plain = move(V, placements)
        assert plain.dtype == dtype
        assert_allclose(plain, move(V.astype(np.float64), placements), atol=1e-6)
        room = np.zeros((5, 6, 3), dtype).transpose(1, 0, 2)
        for out in (np.zeros_like(V), room, V.copy()):
            assert move(V, placements, out) is out
            np.testing.assert_array_equal(out, plain)
        own = V.copy()
        move(own, placements, own)
        np.testing.assert_array_equal(own, plain)
        np.testing.assert_array_equal(move(V, placements[0])[3], move(V[3], placements[0]))
    assert_allclose(place(V, placements)[2], V[2] + placements[2, 4:].astype(dtype), atol=1e-6)
    with pytest.raises(ValueError, match="out must have shape"):
        place(V, placements, V[:3])


def test_placed_places_only_where_there_is_a_placement() -> None:
    V, truth = wobbling(9), tumbling(9)
    assert placed(V, None, np.arange(9.0)) is V
    assert_allclose(placed(V, placement_spline(truth), np.arange(9.0)), place(V, truth), atol=1e-12)
    at = placed(V[0], placement_spline(truth), 2.5)
    assert at.shape == (40, 3)


def test_blocks_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    V = place(wobbling(23), tumbling(23))
    whole = fit_placements(V)
    monkeypatch.setattr("tempose.signals.blocks.BLOCK_VALUES", 3 * 40 * 4)
    assert_allclose(fit_placements(V), whole, atol=1e-13)


def test_bad_input_is_refused() -> None:
    V = place(wobbling(4), tumbling(4))
    with pytest.raises(ValueError, match="rounds must be at least 1"):
        fit_placements(V, rounds=0)
    with pytest.raises(ValueError, match=r"reference must have shape \(40, 3\)"):
        fit_placements(V, V[0, :10])
    V[2, 7, 1] = np.nan
    with pytest.raises(ValueError, match="frame 2, vertex 7"):
        fit_placements(V)
