"""Built-in motions keep their feet where they stand, obey gravity, and repeat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Skeleton
from tempose.kinematics import forward_kinematics
from tempose.rotations import angle_between, rotate, to_rotation_vector
from tempose.samples.gallop import animal_walk, gallop
from tempose.samples.idle import idle, wave_hand
from tempose.samples.jump import jump
from tempose.samples.motion_clip import SampleMotion, sole_positions
from tempose.samples.motion_curves import bridge
from tempose.samples.motion_limbs import aim_limb, flexion_for_length, human_leg, limb_vector
from tempose.samples.run import bounce, run
from tempose.samples.skeletons import animal_skeleton, human_skeleton
from tempose.samples.turn import turn
from tempose.samples.walk import walk

HUMAN, ANIMAL = human_skeleton(), animal_skeleton()
MAKERS = {
    "walk": lambda: walk(HUMAN, duration=2.5),
    "run": lambda: run(HUMAN, duration=1.6),
    "turn": lambda: turn(HUMAN, duration=4.0),
    "jump": lambda: jump(HUMAN),
    "idle": lambda: idle(HUMAN, duration=2.0),
    "wave": lambda: wave_hand(HUMAN, duration=3.0),
    "animal walk": lambda: animal_walk(ANIMAL, duration=2.0),
    "gallop": lambda: gallop(ANIMAL, duration=1.2),
}


@pytest.fixture(scope="module")
def made() -> dict[str, SampleMotion]:
    return {}


@pytest.fixture(params=MAKERS)
def motion(request: pytest.FixtureRequest, made: dict[str, SampleMotion]) -> SampleMotion:
    if request.param not in made:
        made[request.param] = MAKERS[request.param]()
    return made[request.param]


def scaled(skeleton: Skeleton, factor: float) -> Skeleton:
    return replace(skeleton, offsets=factor * skeleton.offsets, tips=factor * skeleton.tips)


def test_planted_points_rest_on_the_ground_and_do_not_move(motion: SampleMotion) -> None:
    soles = sole_positions(motion)
    both = motion.contacts[1:] & motion.contacts[:-1]
    assert both.any(axis=0).all()
    assert np.abs(np.diff(soles, axis=0)[both]).max() < 1e-9
    assert np.abs(soles[..., 1][motion.contacts]).max() < 1e-9


def test_no_sole_goes_below_the_ground(motion: SampleMotion) -> None:
    assert sole_positions(motion)[..., 1].min() > -1e-9


def test_points_without_contact_leave_the_ground(motion: SampleMotion) -> None:
    # a foot in the air (none of its points in contact) is up except near landing and lift-off
    soles = sole_positions(motion)[..., 1]
    for joint in {sole.name.rsplit("_", 1)[0] for sole in motion.soles}:
        columns = [k for k, sole in enumerate(motion.soles) if sole.name.startswith(joint)]
        flying = ~motion.contacts[:, columns].any(axis=1)
        if flying.any():
            assert soles[flying][:, columns].min(axis=1).max() > 0.01


def test_bones_keep_their_length(motion: SampleMotion) -> None:
    positions = forward_kinematics(motion.skeleton, motion.rotations, motion.root_position)[1]
    parents = motion.skeleton.parents[1:]
    lengths = np.linalg.norm(positions[:, 1:] - positions[:, parents], axis=-1)
    assert_allclose(lengths, np.tile(np.linalg.norm(motion.skeleton.offsets[1:], axis=1), (len(lengths), 1)))


def test_no_joint_jumps(motion: SampleMotion) -> None:
    # 2400 degrees per second: a hoof at the gallop; humans stay below half of it
    steps = np.degrees(angle_between(motion.rotations[1:], motion.rotations[:-1])) * motion.fps
    assert steps.max() < (2400 if motion.skeleton is ANIMAL else 1300)


def test_knees_never_bend_backwards(motion: SampleMotion) -> None:
    if motion.skeleton is ANIMAL:
        return
    for side in ("left", "right"):
        bend = to_rotation_vector(motion.rotations[:, HUMAN.index(f"{side}_shin")])
        assert (bend[:, 0] - human_leg(HUMAN, side).straight[0]).min() > np.radians(3.0)


@pytest.mark.parametrize(
    ("maker", "skeleton", "speeds"),
    [
        (walk, HUMAN, (0.7, 1.3, 1.9)),
        (run, HUMAN, (2.0, 3.2, 4.7)),
        (animal_walk, ANIMAL, (0.8, 1.4)),
        (gallop, ANIMAL, (4.6, 6.6)),
    ],
)
def test_gait_has_the_speed_asked_for_and_repeats(maker, skeleton, speeds) -> None:
    for speed in speeds:
        one = maker(skeleton, duration=0.1, fps=40.0, speed=speed, loop=True)
        n = one.n_frames
        two = maker(skeleton, duration=2 * n / 40.0, fps=40.0, speed=speed, loop=True)
        assert two.n_frames == 2 * n
        assert_allclose(two.rotations[n:], two.rotations[:n], atol=1e-9)
        assert_allclose(two.rotations[:n], one.rotations, atol=1e-9)
        moved = two.root_position[n:] - two.root_position[:n]
        assert_allclose(moved, np.tile([0.0, 0.0, speed * n / 40.0], (n, 1)), atol=1e-9)
        assert (two.contacts[n:] == two.contacts[:n]).mean() > 0.99
        assert sole_positions(two)[..., 1].min() > -1e-9


@pytest.mark.parametrize("maker", [walk, run])
def test_gait_is_its_own_mirror_image_half_a_stride_later(maker) -> None:
    motion = maker(HUMAN, duration=0.1, fps=62.0, loop=True)
    half = motion.n_frames // 2
    assert 2 * half == motion.n_frames
    mirror = [
        HUMAN.index(name.replace("left_", "RIGHT_").replace("right_", "left_").replace("RIGHT_", "right_"))
        for name in HUMAN.names
    ]
    reflected = motion.rotations[:, mirror] * (1.0, 1.0, -1.0, -1.0)
    later = np.roll(motion.rotations, -half, axis=0)
    assert np.degrees(angle_between(reflected, later)).max() < 1e-6
    assert_allclose(motion.root_position[half:, 0], -motion.root_position[:half, 0], atol=1e-9)


def test_hips_fly_on_a_parabola_between_take_off_and_landing() -> None:
    motion = jump(HUMAN, fps=120.0, height=0.4)
    flying = ~motion.contacts.any(axis=1)
    y = motion.root_position[flying, 1]
    assert len(y) > 60
    assert_allclose(np.diff(y, 2) * 120.0**2, -9.81, atol=1e-6)
    assert np.ptp(motion.root_position[flying, 2]) > 0.1
    assert np.abs(np.diff(motion.root_position[flying, [2]], 2)).max() < 1e-9
    assert_allclose(y.max() - y[0], 0.4, atol=0.03)


def test_runner_flies_between_steps_and_falls_freely() -> None:
    motion = run(HUMAN, duration=2.0, fps=240.0)
    flying = ~motion.contacts.any(axis=1)
    inner = flying[2:] & flying[1:-1] & flying[:-2]
    assert 0.15 < flying.mean() < 0.5
    assert_allclose(np.diff(motion.root_position[:, 1], 2)[inner] * 240.0**2, -9.81, atol=1e-4)


def test_bounce_returns_to_its_height_and_speed() -> None:
    bob = bounce(0.35, 0.24)
    phase = np.array([0.0, 0.25, 0.5, 0.75])
    assert_allclose(bob(phase)[:2], bob(phase)[2:], atol=1e-12)
    h = 1e-6
    assert_allclose(
        bob(np.array([0.5 - h, 0.5 - 2 * h])),
        bob(np.array([h, 2 * h])) - 2 * np.array([1, 2]) * (bob(np.array([h]))[0] - bob(np.array([0.0]))[0]),
        atol=1e-10,
    )


def test_walk_has_double_support_and_run_has_none(made: dict[str, SampleMotion]) -> None:
    def feet(motion: SampleMotion) -> np.ndarray:
        return np.stack([motion.contacts[:, :3].any(axis=1), motion.contacts[:, 3:].any(axis=1)])

    walking, running = feet(walk(HUMAN, duration=2.0)), feet(run(HUMAN, duration=1.5))
    assert walking.any(axis=0).all() and 0.15 < walking.all(axis=0).mean() < 0.35
    assert not running.all(axis=0).any()


@pytest.mark.parametrize("maker", [walk, run])
def test_arms_swing_against_legs(maker) -> None:
    motion = maker(HUMAN, duration=3.0)
    positions = forward_kinematics(HUMAN, motion.rotations, motion.root_position)[1]
    ahead = positions[..., 2] - positions[:, :1, 2]
    for side in ("left", "right"):
        hand, foot = ahead[:, HUMAN.index(f"{side}_hand")], ahead[:, HUMAN.index(f"{side}_foot")]
        assert np.corrcoef(hand, foot)[0, 1] < -0.6


def test_gallop_falls_in_four_beats_with_a_gathered_suspension() -> None:
    motion = gallop(ANIMAL, duration=0.1, fps=200.0, loop=True)
    order = [
        next(
            sole.name[: -len("_hoof_heel")] for k, sole in enumerate(motion.soles) if k in np.flatnonzero(new)
        )
        for new in (motion.contacts & ~np.roll(motion.contacts, 1, axis=0))
        if any(new[k] and sole.name.endswith("heel") for k, sole in enumerate(motion.soles))
    ]
    start = order.index("left_hind")
    assert order[start:] + order[:start] == ["left_hind", "right_hind", "left_fore", "right_fore"]
    assert 0.1 < (~motion.contacts.any(axis=1)).mean() < 0.4


def test_turned_body_faces_backwards() -> None:
    motion = turn(HUMAN, duration=4.5)
    world = forward_kinematics(HUMAN, motion.rotations, motion.root_position)[0]
    spine = to_rotation_vector(world[[0, -1], HUMAN.index("chest")])
    assert abs(spine[0, 1]) < 0.2
    assert abs(spine[1, 1]) > np.pi - 0.2


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_motion_scales_with_the_skeleton(factor: float) -> None:
    # lengths by the factor, times by its root: the same Froude number gives the same angles
    small = walk(HUMAN, duration=1.0, fps=60.0)
    large = walk(scaled(HUMAN, factor), duration=np.sqrt(factor), fps=60.0 / np.sqrt(factor))
    assert_allclose(large.rotations, small.rotations, atol=1e-9)
    assert_allclose(large.root_position, factor * small.root_position, atol=1e-9)


def test_seed_makes_another_performer_and_the_same_one_again() -> None:
    plain, one, again, two = (walk(HUMAN, duration=0.5, seed=seed) for seed in (None, 1, 1, 2))
    assert np.array_equal(one.rotations, again.rotations)
    assert angle_between(one.rotations, two.rotations).max() > 0.02
    assert angle_between(one.rotations, plain.rotations).max() > 0.02


@pytest.mark.parametrize("via", [np.zeros((0, 2)), np.array([[0.4, np.nan], [0.1, 0.9]])])
def test_bridge_meets_its_ends_and_passes_through_its_keys(via: np.ndarray, rng: np.random.Generator) -> None:
    start, end = rng.normal(size=(2, 2, 2))
    at = np.array([0.3, 0.6])[: len(via)]
    h = 1e-6
    rows = bridge(np.array([0.0, h, 1.0 - h, 1.0, 0.3, 0.6]), start, end, via, at)
    assert_allclose(rows[[0, 3]], [start[0], end[0]], atol=1e-12)
    assert_allclose((rows[[1, 3]] - rows[[0, 2]]) / h, [start[1], end[1]], atol=1e-4)
    known = np.isfinite(via)
    assert_allclose(rows[4 : 4 + len(via)][known], via[known], atol=1e-12)


@pytest.mark.parametrize(
    "make",
    [
        lambda seed: walk(HUMAN, duration=1.5, speed=1.94, seed=seed),
        lambda seed: run(HUMAN, duration=1.0, speed=1.81, seed=seed),
        lambda seed: turn(HUMAN, duration=3.0, speed=1.6, angle=-2.0, rate=2.5, seed=seed),
        lambda seed: jump(HUMAN, height=0.06, distance=0.9, seed=seed),
        lambda seed: jump(HUMAN, height=0.65, distance=0.0, seed=seed),
        lambda seed: animal_walk(ANIMAL, duration=1.5, speed=1.51, seed=seed),
        lambda seed: gallop(ANIMAL, duration=0.8, speed=7.0, seed=seed),
    ],
)
def test_extreme_wishes_and_other_performers_keep_their_feet_planted(make) -> None:
    for seed in (0, 3):
        motion = make(seed)
        soles = sole_positions(motion)
        both = motion.contacts[1:] & motion.contacts[:-1]
        assert np.abs(np.diff(soles, axis=0)[both]).max() < 1e-9
        assert soles[..., 1].min() > -1e-9


def test_limb_reaches_its_target(rng: np.random.Generator) -> None:
    limb = human_leg(HUMAN, "left")
    flexion = rng.uniform(0.05, 2.0, 20)
    zero = np.zeros(20)
    vectors = limb_vector(limb, flexion, zero, zero)
    length = np.linalg.norm(vectors, axis=1)
    assert_allclose(flexion_for_length(limb, length, zero, zero), flexion, atol=1e-9)
    target = rng.normal(size=(20, 3))
    target *= (length / np.linalg.norm(target, axis=1))[:, None]
    assert_allclose(rotate(aim_limb(vectors, target, np.eye(3)[0]), vectors), target, atol=1e-12)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: walk(HUMAN, speed=5.0), "speed of a walk must be"),
        (lambda: run(HUMAN, speed=0.5), "speed of a run must be"),
        (lambda: walk(HUMAN, fps=0.0), "fps must be positive"),
        (lambda: jump(HUMAN, height=3.0), "height must be"),
        (lambda: turn(HUMAN, rate=0.0), "rate must be"),
    ],
)
def test_impossible_wishes_are_refused(call, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()
