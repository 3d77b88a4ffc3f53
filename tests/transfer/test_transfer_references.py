"""Previous frames as reference: no jump, no collapse, and nothing changes where the rest will do."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import clip_of, t_body, t_pose
from transfer_zoo import as_rotation, near_rotations, solver_for, tube, wxyz

from tempose.rotations import angle_between, multiply, normalise
from tempose.transfer import consistent_signs, transfer_motion
from tempose.transfer.turns.references import SHORT, choose_references
from tempose.transfer.turns.singular import half_turns, singular_measures

STILL = np.array([1.0, 0, 0, 0])


def wound(degrees: float, frames: int) -> np.ndarray:
    """Two bones of which the second turns about the tube, signs continuous: (T, 2, 4)."""
    half = np.radians(np.linspace(0, degrees, frames)) / 2
    turn = np.column_stack([np.cos(half), 0 * half, np.sin(half), 0 * half])
    return np.stack([np.tile(STILL, (frames, 1)), turn], axis=1)


def posed(solver, Q: np.ndarray, references) -> np.ndarray:
    V = np.zeros((len(Q), len(solver.mesh.vertices), 3))

    def receive(block: slice, frames: np.ndarray) -> None:
        V[block] = frames

    solver.pose_blocks(Q, receive, references)
    return V


def test_a_clip_that_needs_none_gets_none(rng) -> None:
    solver = solver_for(tube(15, 12), 3)
    assert choose_references(solver.spread, near_rotations(rng, (20, 3), 60.0)) is None


@pytest.mark.parametrize("rounds", [1, 3])
def test_a_tube_is_wound_up_without_a_jump_or_a_collapse(rounds: int) -> None:
    solver = solver_for(tube(41, 12), 2)
    Q = wound(360.0 * rounds, 36 * rounds + 1)
    references = choose_references(solver.spread, Q)
    assert references is not None and len(references.frames) >= rounds
    field = solver.field(Q, references)
    assert np.linalg.norm(field, axis=1).min() > SHORT - 0.05
    V = posed(solver, Q, references)
    steps = np.linalg.norm(np.diff(V, axis=0), axis=2).max(axis=1)
    # ten degrees a frame at a radius of a quarter, and a little for the axis
    assert steps.max() < 1.5 * np.radians(10) * 0.25
    # half-way along, the tube has turned half as far: the way of the limb, not the short one
    middle = np.abs(solver.mesh.vertices[:, 1] - 1.0) < 1e-9
    q = normalise(np.moveaxis(field, 1, 2)[middle])[0]
    path = np.unwrap(2 * np.arctan2(q[:, 2], q[:, 0]), period=2 * np.pi)
    assert path[-1] == pytest.approx(np.radians(180.0 * rounds), abs=np.radians(25))


def test_marks_keep_their_rotations_exactly() -> None:
    solver = solver_for(tube(25, 12), 2)
    Q = wound(700.0, 71)
    field = solver.field(Q, choose_references(solver.spread, Q))
    for t in (0, 30, 70):
        for b in range(2):
            mine = np.flatnonzero(solver.basis[:, b] > 1 - 1e-12)
            q = normalise(field[mine, :, t])
            assert_allclose(angle_between(q, np.broadcast_to(Q[t, b], q.shape)), 0, atol=1e-6)


def test_against_composing_rotations_frame_by_frame() -> None:
    """A slow twin: matrices of the turns since the last reference times matrices at it."""
    solver = solver_for(tube(15, 12), 2)
    Q = wound(500.0, 41)
    references = choose_references(solver.spread, Q)
    assert references is not None
    at: dict[int, np.ndarray] = {}
    for t in range(len(Q)):
        before = [r for r in references.frames if r < t]
        since = Q[t]
        if before:
            r = before[-1]
            since = np.stack([wxyz(as_rotation(Q[t, b]) * as_rotation(Q[r, b]).inv()) for b in range(2)])
            since[1] *= np.where(since[0] @ since[1] < -0.5, -1, 1)
        field = normalise(solver.spread(since[None])[:, :, 0])
        if before:
            field = wxyz(as_rotation(field) * as_rotation(at[r]))
        at[t] = field
        found = normalise(references.field(solver.spread, slice(t, t + 1))[:, :, 0])
        assert_allclose(angle_between(found, field), 0, atol=1e-6)


def test_a_turn_of_everything_needs_no_reference(rng) -> None:
    solver = solver_for(tube(15, 12), 2)
    Q = wound(500.0, 41)
    turn = wxyz(Rotation.from_rotvec(np.linspace(0, 9, 41)[:, None] * [0, 0.6, 0.8]))
    a, b = (choose_references(solver.spread, x) for x in (Q, multiply(turn[:, None], Q)))
    assert a is not None and b is not None and a.frames.tolist() == b.frames.tolist()


def test_one_frame_and_a_first_frame_that_contradicts() -> None:
    solver = solver_for(tube(15, 12), 2)
    Q = wound(340.0, 2)[1:]
    assert choose_references(solver.spread, Q) is None
    assert choose_references(solver.spread, np.repeat(Q, 3, axis=0)) is None


def wound_shin(**options: object) -> dict[str, object]:
    angle = np.radians(np.linspace(0, 350, 36))
    turns = {"left_shin": wxyz(Rotation.from_rotvec(angle[:, None] * [0, 1.0, 0]))}
    return transfer_motion(clip_of(t_pose(), turns, 36), t_body(), contacts=False, **options).report


def test_a_limb_past_half_a_turn_is_told_of_and_cured() -> None:
    plain, cured = wound_shin(singular="none"), wound_shin()
    assert plain["quaternion_norm_min"] < 0.3
    assert any("shortest quaternion" in w for w in plain["warnings"])
    found = plain["singular"]
    assert found["frames"] and "left_shin" in found["w_parent_bone"]
    assert found["bone"][found["frames"][-1]] in ("left_shin", "left_thigh")
    assert cured["singular"]["references"] and cured["quaternion_norm_min"] > 0.45


def test_first_components_are_cosines_of_half_the_turns(rng) -> None:
    degrees = np.array([0.0, 60, 179, 181, 300])
    body = wxyz(Rotation.random(rng=rng))
    limb = wxyz(Rotation.from_euler("x", degrees[:, None], degrees=True))
    Q = multiply(body, np.stack([np.tile(STILL, (5, 1)), limb], axis=1))
    reference, parent, bones = half_turns(consistent_signs(Q, np.array([-1, 0])), np.array([-1, 0]))
    expected = np.abs(np.cos(np.radians(degrees) / 2))
    assert_allclose(reference, expected, atol=1e-12)
    assert_allclose(parent, expected, atol=1e-12)
    assert (bones[1:] == 1).all()


def test_measures_name_frames_vertices_and_bones() -> None:
    norms, vertices, owner = np.array([0.9, 0.4, 0.7]), np.array([5, 6, 7]), np.arange(10) % 2
    Q = np.tile(STILL, (3, 2, 1))
    found = singular_measures(norms, vertices, owner, ("a", "b"), Q, np.array([-1, 0]))["singular"]
    assert found["frames"] == [1] and found["bone"] == ["b", "a", "b"] and found["vertex"] == [5, 6, 7]
    bare = singular_measures(norms, vertices, owner, (), Q, None)["singular"]
    assert bare["frames"] == [1] and "bone" not in bare
